//! The mesh of `isolux solve`: uniform, or finer where a quick solution shows that the light changes.

use crate::failure::Failure;
use crate::numbers::in_words;
use crate::progress::Display;
use clap::ValueEnum;
use isolux_core::adaptive::{Effort, Followed, SHARE, follow_light};
use isolux_core::mesh::{ElementMesh, Resolution};
use isolux_core::run::run;
use isolux_core::scene::{Contacts, Scene};
use isolux_core::solvers::budget::{self, RAYS_PER_ELEMENT};
use isolux_core::solvers::monte_carlo::{Budget, LightPart, MonteCarlo, Settings};
use isolux_core::{Problem, Solution};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Seed of what finds an adaptive mesh: the mesh does not depend on that of the solve, so that solves of several seeds can be merged.
const SEED: u64 = 0x6d65_7368;

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
    #[arg(long, value_name = "WHAT", default_value = "ignore")]
    contacts: AtContacts,

    /// Where elements are small: uniform, the same everywhere, or adaptive, where the light changes (at the edges of shadows, beside lamps). The error
    /// of an adaptive mesh is half that of a uniform one, but small elements get fewer rays and have more noise. A quick solution finds it, for a fifth
    /// of the work; the same scene, --elements and --light make the same mesh, whatever the seed and the method (but for few --rays; with little
    /// --time it is uniform). To compare solutions element by element, leave it uniform
    #[arg(long, value_enum, default_value = "uniform", hide_possible_values = true)]
    mesh: Mesh,
}

/// What a mesh may cost, and which light it follows.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Rays of the whole solve, if they are limited.
    pub rays: Option<u64>,
    /// Time of the whole solve, if it is limited.
    pub time: Option<Duration>,
    pub light: LightPart,
}

/// A scene that is cut into elements, and what is left of the budget.
pub struct Meshed {
    pub problem: Problem,
    pub budget: Budget,
    /// Time that it took to find an adaptive one.
    pub took: Duration,
}

impl MeshArguments {
    /// Cuts `scene` as `resolution` asks, adaptively if that is what is wanted, and takes the rays that it takes off the `budget`.
    /// What `check` refuses is refused before the first ray.
    ///
    /// # Errors
    /// A failure for a longest edge of an adaptive mesh; those of the core and of `check`.
    pub fn cut(
        self,
        scene: Scene,
        resolution: Resolution,
        budget: Budget,
        limits: Limits,
        display: &mut Display,
        check: impl Fn(&Problem) -> Result<(), Failure>,
    ) -> Result<Meshed, Failure> {
        display.stage("cutting the surfaces into elements");
        let elements = resolution.most(&scene);
        let adaptive = match (self.mesh, elements) {
            (Mesh::Uniform, _) => None,
            (Mesh::Adaptive, None) => {
                let what = "--max-edge makes equal elements, and those of an adaptive mesh are not";
                return Err(Failure::usage(what).with_help("ask for --elements N, or leave out --mesh adaptive"));
            }
            (Mesh::Adaptive, Some(elements)) => Some(elements),
        };
        let contacts = match self.contacts {
            AtContacts::Cut => Contacts::of(&scene, resolution.typical_edge(&scene)),
            AtContacts::Ignore => Contacts::NONE,
        };
        let Some(elements) = adaptive else {
            let cut = resolution.cut_along(&scene, &contacts)?;
            return Ok(Meshed { problem: Problem::with_cut(scene, &cut)?, budget, took: Duration::ZERO });
        };
        let before_contacts = resolution.most_before(&scene, &contacts)?.unwrap_or(elements);
        // As many rays as equal elements would get.
        let budget = match budget {
            Budget::Heuristic => Budget::Rays(budget::rays(&ElementMesh::new(&scene, resolution)?)),
            _ => budget,
        };
        let start = Instant::now();
        let whole = RAYS_PER_ELEMENT.saturating_mul(elements).min(limits.rays.unwrap_or(u64::MAX));
        let effort = Effort { rays: whole, seed: SEED, light: limits.light };
        let Followed { problem, rays } = follow_light(scene, before_contacts, effort, |problem, settings| {
            check(problem)?;
            solve_pilot(problem, settings, elements, limits.time.map(|time| time.mul_f64(SHARE)), display)
        })?;
        let cut = problem.mesh.cut().along(&problem.scene, &contacts, elements);
        Ok(Meshed { problem: problem.cut_anew(&cut)?, budget: taken_off(budget, rays), took: start.elapsed() })
    }
}

/// A quick solution; none if it would take more than `time`.
fn solve_pilot(
    problem: &Problem,
    settings: Settings,
    elements: u64,
    time: Option<Duration>,
    display: &mut Display,
) -> Result<Option<Solution>, Failure> {
    let mut solver = MonteCarlo::new(problem, settings)?;
    let (start, mut next) = (Instant::now(), Duration::ZERO);
    let is_late = || time.is_some_and(|time| start.elapsed() > time);
    let what = || format!("finding out where {} elements are needed", in_words(elements as f64));
    let solution = run(&mut solver, problem, |progress| {
        let done = progress.rays as f64 / progress.rays_in_all.unwrap_or(1).max(1) as f64;
        display.work(done.min(1.0), &mut next, start, what);
        if is_late() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    display.stage("making the mesh");
    Ok(Some(solution).filter(|_| !is_late()))
}

/// What is left of `budget` after so many `rays`, half of it at least.
fn taken_off(budget: Budget, rays: u64) -> Budget {
    let left = |all: u64| all - rays.min(all / 2);
    match budget {
        Budget::Rays(rays) => Budget::Rays(left(rays)),
        Budget::Accuracy { accuracy, most_rays } => Budget::Accuracy { accuracy, most_rays: most_rays.map(left) },
        Budget::Heuristic | Budget::Endless => budget,
    }
}
