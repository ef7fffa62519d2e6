//! The mesh of `isolux solve`: uniform, or finer where a quick solution shows that the light changes.

use crate::failure::Failure;
use crate::numbers::in_words;
use crate::progress::Display;
use clap::ValueEnum;
use isolux_core::adaptive::{self, SHARE, follow_light, pilot_settings};
use isolux_core::mesh::{ElementMesh, Resolution};
use isolux_core::run::run;
use isolux_core::scene::Scene;
use isolux_core::solvers::budget::{self, RAYS_PER_ELEMENT};
use isolux_core::solvers::monte_carlo::{Budget, LightPart, MonteCarlo};
use isolux_core::{Problem, Solution};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Seed of the pilots: the mesh does not depend on that of the solve, so that solves of several seeds can be merged.
const SEED: u64 = 0x6d65_7368;

/// How a scene is cut into elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Mesh {
    Adaptive,
    Uniform,
}

#[derive(Clone, Copy, Debug, clap::Args)]
pub struct MeshArguments {
    /// Where elements are small: uniform, the same everywhere, or adaptive, where the light changes (at the edges of shadows, beside lamps).
    /// A quick solution, a tenth of the work or less, finds that out; the same scene, --elements and --light make the same mesh, whatever the
    /// seed and the method (but for few --rays, or little --time). It gains in rooms of few large walls, and nothing in furnished ones
    #[arg(long, value_enum, default_value = "uniform", hide_possible_values = true)]
    mesh: Mesh,
}

/// What pilots may cost.
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
    /// Time that pilots took.
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
            (Mesh::Adaptive, Some(elements)) => {
                let least = Resolution::least(&scene);
                if elements <= least {
                    let what =
                        format!("--mesh adaptive has nothing to place: the scene has {least} sides of triangles");
                    return Err(Failure::usage(what).with_help("ask for more --elements, or leave out --mesh adaptive"));
                }
                Some(elements)
            }
        };
        let Some(elements) = adaptive else {
            return Ok(Meshed { problem: Problem::new(scene, resolution)?, budget, took: Duration::ZERO });
        };
        // As many rays as equal elements would get.
        let budget = match budget {
            Budget::Heuristic => Budget::Rays(budget::rays(&ElementMesh::new(&scene, resolution)?)),
            _ => budget,
        };
        let mut pilots = Pilots::new(elements, limits);
        let problem = follow_light(scene, elements, |problem, share| {
            check(problem)?;
            pilots.solve(problem, share, display)
        })?;
        Ok(Meshed { problem, budget: pilots.taken_off(budget), took: pilots.start.elapsed() })
    }
}

/// The quick solutions.
struct Pilots {
    start: Instant,
    time: Option<Duration>,
    /// Rays of all of them.
    rays: u64,
    light: LightPart,
    elements: u64,
    used: u64,
}

impl Pilots {
    fn new(elements: u64, limits: Limits) -> Pilots {
        let whole = RAYS_PER_ELEMENT.saturating_mul(elements).min(limits.rays.unwrap_or(u64::MAX));
        let rays = (SHARE * whole as f64) as u64;
        let time = limits.time.map(|time| time.mul_f64(SHARE));
        Pilots { start: Instant::now(), time, rays, light: limits.light, elements, used: 0 }
    }

    /// A solution of the pilot `problem`; none if the time was too short for one with error bars.
    fn solve(&mut self, problem: &Problem, share: f64, display: &mut Display) -> Result<Option<Solution>, Failure> {
        let settings = pilot_settings(SEED, (share * self.rays as f64) as u64, self.light);
        let mut solver = MonteCarlo::new(problem, settings)?;
        let mut next = Duration::ZERO;
        let what = || format!("finding out where {} elements are needed", in_words(self.elements as f64));
        let solution = run(&mut solver, problem, |progress| {
            let done = progress.rays as f64 / progress.rays_in_all.unwrap_or(1).max(1) as f64;
            display.work(done.min(1.0), &mut next, self.start, what);
            let is_late = self.time.is_some_and(|time| self.start.elapsed() > time);
            if is_late { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        self.used += solution.work.rays;
        Ok(Some(solution).filter(|solution| solution.work.replicates >= adaptive::LEAST_REPLICATES))
    }

    /// What is left of `budget`, its share at least.
    fn taken_off(&self, budget: Budget) -> Budget {
        let left = |rays: u64| rays - self.used.min((SHARE * rays as f64) as u64);
        match budget {
            Budget::Rays(rays) => Budget::Rays(left(rays)),
            Budget::Accuracy { accuracy, most_rays } => Budget::Accuracy { accuracy, most_rays: most_rays.map(left) },
            Budget::Heuristic | Budget::Endless => budget,
        }
    }
}
