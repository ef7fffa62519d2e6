//! The mesh that a solve gets: elements that follow the light, or equal ones, and what is left of its budget.
//!
//! The same scene, elements and part of the light make the same mesh, whatever else is asked for, so that solutions can be merged and compared; but
//! for few rays, of which finding it takes a fifth, and where whoever watches has no time for it: then elements are equal.

use super::{Effort, Followed, follow_light};
use crate::mesh::{ElementMesh, Resolution};
use crate::run::run;
use crate::scene::{Contacts, Scene};
use crate::solvers::Progress;
use crate::solvers::budget::{self, RAYS_PER_ELEMENT};
use crate::solvers::monte_carlo::{Budget, LightPart, MonteCarlo};
use crate::{Error, Problem};
use std::ops::ControlFlow;

/// Seed of what finds the mesh: it does not depend on that of the solve, so that solves of several seeds can be merged.
const SEED: u64 = 0x6d65_7368;
/// Share of the time for a solve that what is watched of [`Wish::cut`] should take at most; all of it takes some four times as long.
pub const PATIENCE: f64 = 0.04;

/// How elements are spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spread {
    /// Small where the light changes.
    Adaptive,
    /// Equal, as far as triangles let them.
    Uniform,
}

impl Spread {
    pub const ALL: [Spread; 2] = [Spread::Adaptive, Spread::Uniform];

    pub fn name(self) -> &'static str {
        match self {
            Spread::Adaptive => "adaptive",
            Spread::Uniform => "uniform",
        }
    }
}

/// What a solve is asked for, as far as its mesh is concerned.
#[derive(Clone, Copy, Debug)]
pub struct Wish {
    pub resolution: Resolution,
    /// If nobody says how, elements follow the light wherever they may be clusters.
    pub spread: Option<Spread>,
    /// Whether elements are cut along what stands on them.
    pub along_contacts: bool,
    pub budget: Budget,
    pub light: LightPart,
}

/// A scene that is cut into elements, and what is left of the budget.
pub struct Meshed {
    pub problem: Problem,
    pub budget: Budget,
}

impl Wish {
    /// Cuts `scene`. What `check` refuses is refused before the first ray; `watch` ends what finds the mesh, and elements are equal then.
    ///
    /// # Errors
    /// Those of [`Problem::new`], of [`follow_light`] and of `check`; [`Error::Parameter`] for a longest edge of adaptive elements.
    pub fn cut<E: From<Error>>(
        self,
        scene: Scene,
        check: impl Fn(&Problem) -> Result<(), E>,
        mut watch: impl FnMut(&Progress) -> ControlFlow<()>,
    ) -> Result<Meshed, E> {
        let elements = self.adaptive_elements(&scene)?;
        let contacts = match self.along_contacts {
            true => Contacts::of(&scene, self.resolution.typical_edge(&scene)),
            false => Contacts::NONE,
        };
        let Some(elements) = elements else {
            let cut = self.resolution.cut_along(&scene, &contacts)?;
            let problem = Problem::with_cut(scene, &cut)?;
            return Ok(Meshed { problem, budget: self.budget });
        };
        // As many rays as equal elements would get.
        let budget = match self.budget {
            Budget::Heuristic => Budget::Rays(budget::rays(&ElementMesh::new(&scene, self.resolution)?)),
            budget => budget,
        };
        let enough = RAYS_PER_ELEMENT.saturating_mul(elements);
        let rays = budget.most_rays().filter(|&rays| rays < enough / 2).unwrap_or(enough);
        let effort = Effort { rays, seed: SEED, light: self.light };
        let Followed { problem, rays } = follow_light(scene, elements, &contacts, effort, |problem, settings| {
            check(problem)?;
            let mut goes_on = true;
            let solution = run(&mut MonteCarlo::new(problem, settings)?, problem, |progress| {
                let next = watch(progress);
                goes_on &= next.is_continue();
                next
            });
            Ok::<_, E>(Some(solution).filter(|_| goes_on))
        })?;
        Ok(Meshed { problem, budget: taken_off(budget, rays) })
    }

    /// Whether elements are to follow the light.
    pub fn is_adaptive(&self) -> bool {
        self.spread.map_or(matches!(self.resolution, Resolution::Clustered(_)), |spread| spread == Spread::Adaptive)
    }

    /// How many adaptive elements there shall be; `None` if they shall be equal.
    fn adaptive_elements(&self, scene: &Scene) -> Result<Option<u64>, Error> {
        match self.resolution {
            _ if !self.is_adaptive() => Ok(None),
            Resolution::MaxEdge(_) => Err(Error::Parameter {
                name: "mesh",
                value: "adaptive".into(),
                allowed: "a longest edge makes equal elements; ask for a number of elements, or for a uniform mesh",
            }),
            resolution => Ok(resolution.most(scene)),
        }
    }
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
