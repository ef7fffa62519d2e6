//! `isolux bake`: a solution as a lightmap.

use crate::arguments::{WorkArguments, parse_exposure, parse_smoothing};
use crate::failure::Failure;
use crate::interrupt::watch;
use crate::numbers::{self, count, percent};
use crate::output::{self, OpenFiles, Written};
use crate::{input, terminal};
use isolux_core::lightmap::{Density, Layout, Origin};
use isolux_core::view::{self, Exposure, ViewOptions};
use isolux_io::export::lightmap::{self, BakedScene, Carrier, LightmapFormat};
use isolux_io::export::{LitScene, Smoothing};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  isolux solve room.glb -o room.isolux                            # first the light, then the map
  isolux bake room.isolux -o room-lightmap.glb                    # any viewer shows it as it is
  isolux bake room.isolux -o room.glb --carrier MOZ_lightmap      # three.js (with its loader's light map extension), Hubs
  isolux bake room.isolux -o room.glb --carrier sidecar           # and room.exr: three.js, Godot, Unity, Blender
  isolux bake room.isolux -o room.exr --texels-per-metre 50       # the map alone, a texel every 2 cm
  isolux solve room.glb -o room-lightmap.glb                      # in one go: any name that ends with -lightmap.glb

Texels hold irradiance E in lux, without the colour of the surface. three.js wants just that in material.lightMap, and
divides by pi itself; shaders that multiply the map with the base colour want E / pi. The .json beside the files has the
factors that make either as bright as the picture of 'isolux render'. docs/lightmaps.md is a guide, engine by engine.
For light in vertices (COLOR_0) no map is needed: 'isolux render room.isolux -o lit.glb'.";

/// Write a solution as a lightmap: irradiance in a texture
///
/// Keeps the lightmap coordinates of the scene's file (TEXCOORD_1) if it has any that can be used, and makes them
/// otherwise. Writes the map as .exr (linear, lux) and .png (8 bits, sRGB), the scene that shows it as .glb, and a
/// .json beside them that says what is what.
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Bake {
    /// A .isolux file, as 'isolux solve' writes it
    solution: PathBuf,

    /// A file to write, in the format of its extension (.glb .exr .png .json); repeat it for several
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    outputs: Vec<PathBuf>,

    /// How the .glb brings its light: unlit (lit surfaces in one texture, tone-mapped: for every viewer), MOZ_lightmap
    /// (the map attached to each material by that extension, in 8 bits), sidecar (materials as they were, and an .exr
    /// beside it)
    #[arg(long, default_value = "unlit", value_parser = parse_carrier)]
    carrier: Carrier,

    /// Texels for each metre of surface; the map is as large as that takes, up to 8192
    #[arg(long, value_name = "N", value_parser = parse_density, conflicts_with = "size")]
    texels_per_metre: Option<f32>,

    /// Texels across the map, and most texels down; surfaces get as many as fit
    #[arg(long, value_name = "N", default_value = "1024")]
    size: u32,

    /// Texels around each chart that continue its light, so that no mipmap mixes charts
    #[arg(long, value_name = "N", default_value = "4")]
    padding: u32,

    /// Give each chart blocks of 4 x 4 texels of its own, for compressed textures
    #[arg(long)]
    align_blocks: bool,

    /// Make new coordinates even if the scene's file has some
    #[arg(long)]
    new_coordinates: bool,

    /// Exposure in stops of what is shown as it is (unlit, MOZ_lightmap) [default: metered, as 'isolux render' does]
    #[arg(long, value_name = "EV", allow_negative_numbers = true, value_parser = parse_exposure)]
    exposure: Option<f32>,

    /// The camera for which the exposure is metered, by its name or its number from 0 [default: the first]
    #[arg(long, value_name = "CAMERA", conflicts_with = "exposure")]
    camera: Option<String>,

    /// Where neighbouring elements even each other out as far as their error bars allow, as in 'isolux render'; none leaves
    /// the noise in
    #[arg(long, value_name = "WHERE", default_value = "pictures", value_parser = parse_smoothing)]
    smooth: Smoothing,

    #[command(flatten)]
    work: WorkArguments,
}

fn parse_carrier(text: &str) -> Result<Carrier, String> {
    let found = Carrier::ALL.into_iter().find(|carrier| carrier.name().eq_ignore_ascii_case(text));
    found.ok_or_else(|| format!("it is one of {}", Carrier::ALL.map(Carrier::name).join(", ")))
}

fn parse_density(text: &str) -> Result<f32, String> {
    let density = text.parse().ok().filter(|density: &f32| (1e-3..=1e6).contains(density));
    density.ok_or_else(|| "give a number of texels between 0.001 and 1000000, like 50".to_owned())
}

impl Bake {
    pub fn run(self) -> Result<u8, Failure> {
        let pool = self.work.pool()?;
        let quiet = self.work.quiet;
        let words = watch(move |_, files| {
            let outputs = MapOutputs::open(files, &self)?;
            pool.install(|| self.bake(&outputs))
        })?;
        if !quiet {
            terminal::print(&words)?;
        }
        Ok(0)
    }

    fn bake(&self, outputs: &MapOutputs) -> Result<String, Failure> {
        let mut display = self.work.display();
        display.stage("reading the solution");
        let (problem, solution) = input::solution(&self.solution)?;
        display.stage("interpolating the light");
        let lit = LitScene::smoothed(&problem, &solution, self.smooth);
        let exposure = self.exposure.map(|stops| Exposure { stops });
        let view = ViewOptions { camera: self.camera.clone(), exposure, ..ViewOptions::default() };
        let exposure = view::exposure(&problem, lit.field(), &view)?;
        display.stage("laying out the map, and baking");
        let (layout, names) = (self.layout(), outputs.names());
        let baked = BakedScene::new(&problem, &solution, lit.field(), &layout, self.carrier, exposure, names)?;
        let written = outputs.write(&baked, |name| display.stage(&format!("writing {name}")))?;
        display.clear();
        Ok(format!("{}Wrote {}\n", in_words(&baked), output::in_words(&written)))
    }

    fn layout(&self) -> Layout {
        Layout {
            density: self.texels_per_metre.map_or(Density::Size(self.size), Density::TexelsPerMetre),
            padding: self.padding,
            align_blocks: self.align_blocks,
            keep_existing: !self.new_coordinates,
        }
    }
}

/// The files of a lightmap: those asked for, the manifest, and the map for a scene that needs one beside it.
struct MapOutputs<'a> {
    files: &'a OpenFiles,
    list: Vec<(PathBuf, &'static LightmapFormat)>,
}

impl<'a> MapOutputs<'a> {
    fn open(files: &'a OpenFiles, bake: &Bake) -> Result<MapOutputs<'a>, Failure> {
        let mut paths = bake.outputs.clone();
        let has = |paths: &[PathBuf], extension: &str| {
            paths.iter().any(|path| path.extension().is_some_and(|own| own.eq_ignore_ascii_case(extension)))
        };
        if bake.carrier == Carrier::Sidecar && has(&paths, "glb") && !has(&paths, "exr") {
            paths.push(paths[0].with_extension("exr"));
        }
        if !has(&paths, "json") {
            paths.push(paths[0].with_extension("json"));
        }
        let list: Result<Vec<_>, Failure> =
            paths.iter().map(|path| Ok((path.clone(), lightmap::for_path(path)?))).collect();
        let list = list?;
        files.open(&paths, &[&bake.solution])?;
        Ok(MapOutputs { files, list })
    }

    fn names(&self) -> Vec<String> {
        let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        self.list.iter().map(|(path, _)| name(path)).collect()
    }

    fn write(&self, baked: &BakedScene, mut tell: impl FnMut(&str)) -> Result<Vec<Written>, Failure> {
        let mut bytes = Vec::new();
        for (path, format) in &self.list {
            tell(&path.display().to_string());
            let failed = |error| Failure::other(format!("{}: {error}", path.display()));
            bytes.push((format.write)(baked).map_err(failed)?);
        }
        let mut written = Vec::new();
        for (k, ((path, _), bytes)) in self.list.iter().zip(bytes).enumerate() {
            self.files.finish(k, &bytes)?;
            written.push(Written { path: path.clone(), bytes: bytes.len() });
        }
        Ok(written)
    }
}

fn in_words(baked: &BakedScene) -> String {
    let atlas = &baked.lightmap.atlas;
    let texels = &baked.lightmap.texels.list;
    let inside = texels.iter().flatten().filter(|texel| texel.inside).count();
    let mut text = format!(
        "{}: {} x {} texels, {} texels per metre, {} charts, {} of the map on surfaces\n",
        terminal::harmless(&baked.problem.scene.name),
        atlas.width,
        atlas.height,
        numbers::digits(atlas.texels_per_metre, 3),
        count(u64::from(atlas.chart_count)),
        percent(inside as f64 / texels.len() as f64),
    );
    text += &match &atlas.origin {
        Origin::File => "Lightmap coordinates (TEXCOORD_1) are those of the scene's file\n".to_owned(),
        Origin::Made { why_not_file: None } => String::new(),
        Origin::Made { why_not_file: Some(why) } => {
            format!("Lightmap coordinates (TEXCOORD_1) are new: as to those of the file, {}\n", terminal::harmless(why))
        }
    };
    if baked.lightmap.covered > 0 {
        let covered = count(u64::from(baked.lightmap.covered));
        text += &format!("{covered} texels lie under other surfaces, and took the light beside them\n");
    }
    text
}
