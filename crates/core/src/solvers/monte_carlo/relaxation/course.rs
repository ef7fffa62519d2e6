//! The course of a relaxation: what it does stage after stage, with which share of the rays. Every order states its own.

/// What a relaxation does, as an order wants it.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Course {
    /// The stages of a sweep, in their order.
    pub stages: Vec<Stage>,
    /// Share of the rays that shoot; the others gather.
    pub shooting: f64,
    /// Sweeps of a complete solution, each with twice the rays of the one before.
    pub sweeps: u32,
}

impl Course {
    /// A single sweep of `stages`, all of which shoot.
    pub fn new(stages: &[Stage]) -> Course {
        Course { stages: stages.to_vec(), shooting: 1.0, sweeps: 1 }
    }
}

/// A stage of one step or several. Lights shoot first; the `share` of a stage is that of the shooting rays that are left to
/// reflected light.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Stage {
    /// Lights without extent shoot what they emit.
    Lamps,
    /// Surfaces shoot what they emit.
    Emission,
    /// Light leaves with every global line that crosses the element on which it has landed.
    Multipath { share: f64 },
    /// Surfaces shoot what they have not shot yet, again and again. All steps have `share` together, each in proportion to what
    /// it shoots; or each of them has it, if `every_step`.
    Incremental { share: f64, every_step: bool },
    /// Surfaces shoot all they reflect, until hardly any light is missing; what lands takes the place of what had landed
    /// before.
    WarmUp { share: f64 },
    /// Surfaces shoot all they reflect, in so many iterations; what has landed is the mean over them.
    Averaged { share: f64, iterations: u32 },
    /// Surfaces shoot all they reflect once more, with the shooting rays that are left; what lands is averaged in by rays.
    Regular,
    /// Surfaces gather with all rays that are left.
    Gathering,
}

impl Stage {
    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Lamps | Stage::Emission => "shooting direct light",
            Stage::Multipath { .. } => "sending light along global lines",
            Stage::Incremental { .. } => "shooting reflected light",
            Stage::WarmUp { .. } => "warming up",
            Stage::Averaged { .. } | Stage::Regular => "shooting all light again",
            Stage::Gathering => "gathering",
        }
    }

    /// Whether what is shot was reflected.
    pub fn reflects(self) -> bool {
        self.repeats() || self == Stage::Regular
    }

    /// Whether it has several steps, until there is nothing to do.
    pub fn repeats(self) -> bool {
        matches!(self, Stage::Incremental { .. } | Stage::WarmUp { .. } | Stage::Averaged { .. })
    }

    pub fn is_multipath(self) -> bool {
        matches!(self, Stage::Multipath { .. })
    }
}
