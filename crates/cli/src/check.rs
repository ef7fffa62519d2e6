//! `isolux check`: what is in a scene, and what is wrong with it.

use crate::arguments::SceneArguments;
use crate::failure::Failure;
use crate::interrupt::watch;
use crate::numbers::{count, digits, percent, three_digits};
use crate::report::Table;
use crate::{FOUND_WRONG, input, terminal};
use isolux_core::scene::Scene;
use isolux_core::scene::check::{SceneReport, Severity, check};
use serde_json::json;

const EXAMPLES: &str = "\
Examples:
  isolux check room.glb
  isolux check room.glb --light-units raw
  isolux check cornell-box --json

The exit code is 2 if something makes the result meaningless (nothing emits light, surfaces reflect more than they
receive), and 0 otherwise, even with warnings.";

/// Say what is in a scene, and what is wrong with it
///
/// Counts, size, cameras, emitted flux in lumens; open edges, flipped normals, impossible reflectivities.
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Check {
    #[command(flatten)]
    scene: SceneArguments,

    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Emitters that are listed by name.
const MOST_EMITTERS: usize = 10;

impl Check {
    pub fn run(self) -> Result<u8, Failure> {
        watch(move |_, _| {
            let scene = input::scene(&self.scene.scene, &self.scene.units.options())?;
            let report = check(&scene);
            let units = self.scene.units.assumed_units();
            let text = if self.json { as_json(&scene, &report, &units) } else { in_words(&scene, &report, &units) };
            terminal::print(&text)?;
            let wrong = report.findings.iter().any(|finding| finding.severity == Severity::Error);
            Ok(if wrong { FOUND_WRONG } else { 0 })
        })
    }
}

fn flux(report: &SceneReport) -> f64 {
    report.emitters.iter().map(|emitter| emitter.flux.luminance_f64()).sum()
}

fn as_json(scene: &Scene, report: &SceneReport, units: &str) -> String {
    let cameras: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
    let mut object = json!(report);
    object["scene"] = json!(scene.name);
    object["hash"] = json!(format!("{:016x}", scene.hash()));
    object["camera_names"] = json!(cameras);
    object["units"] = json!(units);
    object["emitted_flux"] = json!(flux(report));
    object["remarks"] = json!(scene.remarks);
    object["version"] = json!(isolux_core::VERSION);
    format!("{object}\n")
}

fn in_words(scene: &Scene, report: &SceneReport, units: &str) -> String {
    let [x, y, z] = report.size.to_array().map(|edge| three_digits(f64::from(edge)));
    let mut text = format!(
        "{}\n  {} triangles, {} objects, {} materials, {} images, {} lamps\n",
        terminal::harmless(&scene.name),
        count(report.triangles as u64),
        count(report.objects as u64),
        count(report.materials as u64),
        count(report.images as u64),
        count(report.lights as u64),
    );
    text += &format!("  {x} x {y} x {z} m, {} m² of surface\n", digits(report.area, 4));
    let cameras: Vec<String> = scene.cameras.iter().map(|c| format!("'{}'", terminal::harmless(&c.name))).collect();
    text += &format!("  cameras: {}\n", if cameras.is_empty() { "none".to_owned() } else { cameras.join(", ") });
    text += &format!("  taken for granted: {units}\n");
    text += &emitters(report);
    for remark in &scene.remarks {
        text += &format!("\x1b[1;36mnote:\x1b[0m {}\n", terminal::harmless(remark));
    }
    for finding in &report.findings {
        let word = match finding.severity {
            Severity::Error => "\x1b[1;31merror:\x1b[0m",
            Severity::Warning => "\x1b[1;33mwarning:\x1b[0m",
            Severity::Note => "\x1b[1;36mnote:\x1b[0m",
        };
        let place = terminal::harmless(&finding.place);
        let place = if place.is_empty() || place == "scene" { String::new() } else { format!("\n  at {place}") };
        text += &format!("{word} {}{place}\n", terminal::harmless(&finding.what));
    }
    if report.findings.iter().all(|finding| finding.severity == Severity::Note) {
        text += "Nothing is wrong with it.\n";
    }
    text
}

fn emitters(report: &SceneReport) -> String {
    let total = flux(report);
    let mut emitters: Vec<(&str, f64)> =
        report.emitters.iter().map(|e| (e.name.as_str(), e.flux.luminance_f64())).collect();
    emitters.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut table = Table::new(&[]);
    for (name, flux) in emitters.iter().take(MOST_EMITTERS) {
        table.row(&format!("  {name}"), [digits(*flux, 4), percent(flux / total)]);
    }
    let mut text = format!("  emitted flux: {} lm\n{}", digits(total, 4), table.lines());
    if emitters.len() > MOST_EMITTERS {
        text += &format!("    and {} more\n", count((emitters.len() - MOST_EMITTERS) as u64));
    }
    text
}
