//! The mesh of `isolux solve`: finer where a quick solution shows that the light changes, or uniform.

use crate::failure::Failure;
use crate::numbers::in_words;
use crate::progress::Display;
use crate::terminal;
use clap::ValueEnum;
use isolux_core::Problem;
use isolux_core::adaptive::{Meshed, PATIENCE, Spread, Wish};
use isolux_core::mesh::Resolution;
use isolux_core::scene::Scene;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// How a scene is cut into elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Mesh {
    Adaptive,
    Uniform,
}

/// What is done where surfaces meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum AtContacts {
    Cut,
    Ignore,
}

#[derive(Clone, Copy, Debug, clap::Args)]
pub struct MeshArguments {
    /// Where something stands on a surface, or passes through it: cut elements along its foot, or ignore it. Cut, no light passes below, exactly;
    /// ignored, up to some hundredths of it do
    #[arg(long, value_name = "WHAT", default_value = "cut")]
    contacts: AtContacts,

    /// Where elements are small: adaptive, where the light changes (at the edges of shadows, beside lamps), or uniform, the same everywhere. As many elements hide
    /// half as much of the light on them if they are adaptive, which they are but with --max-edge, for deterministic methods, and with --every and --live, whose
    /// first draft comes at once. A quick solution finds the mesh, for some 20 rays an element; to the same error bar it takes half as long again or more than on
    /// equal elements. The same scene, --elements and --light make the same mesh, whatever the seed and the method (but for few --rays or little --time)
    #[arg(long, value_enum, hide_possible_values = true)]
    mesh: Option<Mesh>,
}

impl MeshArguments {
    /// How elements shall be spread, if that is said.
    pub fn spread(self) -> Option<Spread> {
        self.mesh.map(|mesh| match mesh {
            Mesh::Adaptive => Spread::Adaptive,
            Mesh::Uniform => Spread::Uniform,
        })
    }

    /// Whether they shall be cut along what stands on them.
    pub fn along_contacts(self) -> bool {
        self.contacts == AtContacts::Cut
    }
}

/// Cuts `scene` as `wish` says, equally if `time` for the whole solve is too short for anything else; and the time that it took to find out where
/// the light changes. What `check` refuses is refused before the first ray.
///
/// # Errors
/// A failure for a longest edge of an adaptive mesh; those of the core and of `check`.
pub fn cut(
    wish: Wish,
    scene: Scene,
    time: Option<Duration>,
    display: &mut Display,
    check: impl Fn(&Problem) -> Result<(), Failure>,
) -> Result<(Meshed, Duration), Failure> {
    if let (Some(Spread::Adaptive), Resolution::MaxEdge(_)) = (wish.spread, wish.resolution) {
        let what = "--max-edge makes equal elements, and those of an adaptive mesh are not";
        return Err(Failure::usage(what).with_help("ask for --elements N, or leave out --mesh adaptive"));
    }
    display.stage("cutting the surfaces into elements");
    let elements = wish.resolution.most(&scene).unwrap_or(0);
    let what = || format!("finding out where {} elements are needed", in_words(elements as f64));
    let (start, mut next, mut is_late) = (Instant::now(), Duration::ZERO, false);
    let meshed = wish.cut(scene, check, |progress| {
        let done = progress.rays as f64 / progress.rays_in_all.unwrap_or(1).max(1) as f64;
        display.work(done.min(1.0), &mut next, start, what);
        if done >= 1.0 {
            display.stage("making the mesh");
        }
        is_late = time.is_some_and(|time| start.elapsed() > time.mul_f64(PATIENCE));
        if is_late { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    if is_late {
        display.clear();
        terminal::note("the time is too short to find out where the light changes: the elements are equal");
    }
    let took = if wish.is_adaptive() { start.elapsed() } else { Duration::ZERO };
    Ok((meshed, took))
}
