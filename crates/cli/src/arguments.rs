//! Arguments that several commands share.

use crate::failure::Failure;
use crate::numbers::parse_count;
use crate::progress::{Display, ProgressArguments};
use isolux_core::Error;
use isolux_core::scene::Scene;
use isolux_io::export::{ExportOptions, Smoothing};
use isolux_io::import::{ImportOptions, Insides, LightUnits};
use std::num::NonZeroU32;

/// Which scene, and how it is read.
#[derive(Clone, Debug, clap::Args)]
pub struct SceneArguments {
    /// A scene file (.glb .gltf .obj .ply .stl), or the name of a built-in scene
    ///
    /// A file of that name wins over a built-in scene. Built-in scenes take parameters: labyrinth:rho=0.9
    pub scene: std::path::PathBuf,

    #[command(flatten)]
    pub units: UnitArguments,
}

/// How the numbers of a scene file are taken.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct UnitArguments {
    /// What the intensities of a glTF file's lamps mean
    #[arg(long, value_name = "UNITS", default_value = "spec")]
    light_units: Units,

    /// What becomes of the insides of closed two-sided surfaces, and the outside of a closed room: hide (they are no surfaces, for nobody sees
    /// them) or keep (both sides count, as the file says)
    #[arg(long, value_name = "WHAT", default_value = "hide", value_parser = parse_insides)]
    insides: Insides,
}

fn parse_insides(text: &str) -> Result<Insides, String> {
    let found = Insides::ALL.into_iter().find(|insides| insides.name() == text);
    found.ok_or_else(|| format!("it is one of {}", Insides::ALL.map(Insides::name).join(", ")))
}

/// The names of Blender's lighting modes, which does not say in the file which one was used.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Units {
    /// candela and lux, as glTF says
    Spec,
    /// watts per steradian, as Blender's "unitless" writes them
    Compat,
    /// watts, as Blender's "raw" writes them
    Raw,
}

impl UnitArguments {
    pub fn options(&self) -> ImportOptions {
        let light_units = match self.light_units {
            Units::Spec => LightUnits::Spec,
            Units::Compat => LightUnits::Compat,
            Units::Raw => LightUnits::Raw,
        };
        ImportOptions { light_units, insides: self.insides }
    }

    /// What the numbers in the file are taken for.
    pub fn assumed_units(&self) -> String {
        let lamps = match self.light_units {
            Units::Spec => "cd and lux",
            Units::Compat => "W/sr and W/m² at 683 lm/W",
            Units::Raw => "W and W/m² at 683 lm/W",
        };
        format!("lengths in m, emission in cd/m², lamps in {lamps}")
    }
}

/// How pictures (`.png`, `.exr`) are taken; camera and exposure concern `.glb` and `.html`, too.
#[derive(Clone, Debug, clap::Args)]
#[command(next_help_heading = "Pictures (.png .exr .glb .html)")]
pub struct PictureArguments {
    /// The camera, by its name or its number from 0 [default: the first, or a view of the whole scene]
    #[arg(long, value_name = "CAMERA")]
    pub camera: Option<String>,

    /// Width in pixels
    #[arg(long, default_value = "1280")]
    width: NonZeroU32,

    /// Height in pixels [default: as the camera's shape has it]
    #[arg(long)]
    height: Option<NonZeroU32>,

    /// Samples per pixel, against jagged edges
    #[arg(long, value_name = "N", default_value = "16")]
    samples: NonZeroU32,

    #[command(flatten)]
    look: LookArguments,
}

/// How the light is shown, whatever shows it.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct LookArguments {
    /// Exposure in stops: luminances in cd/m² are multiplied by 2^EV, so a bright room takes about -7 [default: metered]
    #[arg(long, value_name = "EV", allow_negative_numbers = true, value_parser = parse_exposure)]
    exposure: Option<f32>,

    /// Where neighbouring elements even each other out as far as their error bars allow: in pictures (.png .exr .glb .html), in all
    /// files but .isolux, or in none. The flux on every object is kept
    #[arg(long, value_name = "WHERE", default_value = "pictures", value_parser = parse_smoothing)]
    smooth: Smoothing,
}

impl LookArguments {
    /// What the writers are told, for a scene seen through `camera`.
    pub fn options(self, camera: Option<String>) -> ExportOptions {
        ExportOptions { camera, exposure: self.exposure, smoothing: self.smooth, ..ExportOptions::default() }
    }
}

pub fn parse_smoothing(text: &str) -> Result<Smoothing, String> {
    let found = Smoothing::ALL.into_iter().find(|smoothing| smoothing.name() == text);
    found.ok_or_else(|| format!("it is one of {}", Smoothing::ALL.map(Smoothing::name).join(", ")))
}

pub fn parse_exposure(text: &str) -> Result<f32, String> {
    let stops = text.parse().ok().filter(|stops: &f32| stops.abs() <= 100.0);
    stops.ok_or_else(|| "give a number of stops between -100 and 100, like -2.5".to_owned())
}

impl PictureArguments {
    /// What the writers are told.
    pub fn options(&self) -> ExportOptions {
        ExportOptions {
            width: self.width.get(),
            height: self.height.map(NonZeroU32::get),
            samples: self.samples.get(),
            ..self.look.options(self.camera.clone())
        }
    }

    /// Whether `scene` has the camera that was asked for: better known before the work than after it.
    ///
    /// # Errors
    /// A failure that names the nearest camera.
    pub fn check_camera(&self, scene: &Scene) -> Result<(), Failure> {
        check_camera(self.camera.as_deref(), scene)
    }
}

/// Whether `scene` has the camera `wanted`, if one is.
///
/// # Errors
/// A failure that names the nearest camera.
pub fn check_camera(wanted: Option<&str>, scene: &Scene) -> Result<(), Failure> {
    let Some(wanted) = wanted else { return Ok(()) };
    let named = scene.cameras.iter().any(|camera| camera.name == *wanted);
    let numbered = wanted.parse().is_ok_and(|number: usize| number < scene.cameras.len());
    if named || numbered {
        return Ok(());
    }
    if scene.cameras.is_empty() {
        return Err(Failure::usage(format!("the scene has no camera, so none called '{wanted}'"))
            .with_help("leave --camera out for a view of the whole scene"));
    }
    let cameras = scene.cameras.iter().map(|camera| camera.name.as_str());
    Err(Failure::from(Error::unknown_name("camera", wanted, cameras)).with_help("'isolux check' lists the cameras"))
}

/// Who works, and what is shown meanwhile.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct WorkArguments {
    #[command(flatten)]
    threads: ThreadArguments,

    /// Print nothing but errors
    #[arg(short, long)]
    pub quiet: bool,

    #[command(flatten)]
    progress: ProgressArguments,
}

impl WorkArguments {
    /// See [`ThreadArguments::pool`].
    ///
    /// # Errors
    /// A failure if the system does not give the threads.
    pub fn pool(self) -> Result<rayon::ThreadPool, Failure> {
        self.threads.pool()
    }

    pub fn display(self) -> Display {
        self.progress.display(self.quiet)
    }
}

/// How many threads.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct ThreadArguments {
    /// Number of threads; the result does not depend on it [default: one for each core]
    #[arg(long, value_name = "T", value_parser = parse_threads)]
    threads: Option<usize>,
}

fn parse_threads(text: &str) -> Result<usize, String> {
    let threads = parse_count(text).ok().filter(|&threads| threads <= 1024);
    threads.map(|threads| threads as usize).ok_or_else(|| "give a number from 1 to 1024".to_owned())
}

impl ThreadArguments {
    /// A pool of so many threads, for everything that is computed.
    ///
    /// # Errors
    /// A failure if the system does not give the threads.
    pub fn pool(self) -> Result<rayon::ThreadPool, Failure> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads.unwrap_or(0)).build();
        pool.map_err(|error| Failure::other(format!("cannot start the threads: {error}")))
    }
}
