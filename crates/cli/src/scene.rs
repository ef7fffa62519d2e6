//! `isolux scene`: a built-in scene as a file.

use crate::failure::Failure;
use crate::numbers;
use crate::output::OpenFiles;
use crate::terminal;
use isolux_core::scene::builtin::builtin;
use isolux_io::export::scene_glb;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  isolux scene cornell-box -o cornell-box.glb
  isolux scene office:size=12 -o office.glb
  isolux scene labyrinth:rho=0.9 -o labyrinth.glb

'isolux list scenes' shows the names and their parameters.";

/// Write a built-in scene as a glTF file
///
/// To look at it, to change it, or to see how a scene is made. Luminances are in cd/m², lengths in metres.
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct SceneCommand {
    /// Name of the scene, with parameters if it has any: NAME:PARAMETER=VALUE,PARAMETER=VALUE
    name: String,

    /// The file to write, a .glb
    #[arg(short, long = "output", value_name = "FILE")]
    output: PathBuf,

    /// Print nothing but errors
    #[arg(short, long)]
    quiet: bool,
}

impl SceneCommand {
    pub fn run(self) -> Result<u8, Failure> {
        let path = self.output.display();
        if !self.output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("glb")) {
            return Err(
                Failure::usage(format!("{path}: a scene is written as .glb")).with_help("give a name like scene.glb")
            );
        }
        let scene = builtin(&self.name)
            .map_err(|error| Failure::from(error).with_help("'isolux list scenes' shows names and parameters"))?;
        let files = OpenFiles::default();
        files.open(std::slice::from_ref(&self.output), &[])?;
        let bytes = scene_glb::write(&scene).map_err(|error| Failure::after_the_work(&error))?;
        files.finish(0, &bytes)?;
        if !self.quiet {
            terminal::print(&format!("Wrote {path} ({})\n", numbers::bytes(bytes.len())))?;
        }
        Ok(0)
    }
}
