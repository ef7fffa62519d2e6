//! The solver that is asked for: a method, and what it is told.

use crate::budget::BudgetArguments;
use crate::failure::Failure;
use crate::light_groups::parse_grouping;
use crate::method::MethodArguments;
use isolux_core::Problem;
use isolux_core::scene::Grouping;
use isolux_core::solvers::monte_carlo::{Budget, LightPart, Settings};
use isolux_core::solvers::{Asked, Chosen, Solver};
use isolux_core::transport::Leaving;

#[derive(Clone, Debug, clap::Args)]
pub struct SolverArguments {
    /// Seed of the random numbers
    #[arg(long, value_name = "S", default_value_t = Settings::default().seed)]
    seed: u64,

    /// Independent solutions that the error is estimated from, at least 8 [default: 16, and 8 for auto]
    #[arg(long, value_name = "R")]
    replicates: Option<u32>,

    /// From where on an element reflected light leaves: where-landed hardly leaks under walls and behind
    /// frames, whole-element is the radiosity system to the letter [default: where-landed]
    #[arg(long, value_parser = parse_leaving)]
    leaving: Option<Leaving>,

    /// Which light on each element: all, or indirect, what was reflected at least once, for those who add direct light by
    /// themselves. The balance is that of all light either way [default: all]
    #[arg(long, value_name = "PART", value_parser = parse_light)]
    light: Option<LightPart>,

    /// Solve each group of lamps for itself, all at once, so that 'isolux mix' can dim and colour them afterwards: objects (each emitting
    /// object and each lamp by its name), materials, or a list like 'Ceiling=Lamp 1,Lamp 2;Windows=Window*'. At most 64, each of which takes
    /// as much memory and space in .isolux files as a solve without groups
    #[arg(long, value_name = "GROUPS", value_parser = parse_grouping)]
    light_groups: Option<Grouping>,

    #[command(flatten)]
    method: MethodArguments,
}

fn parse_leaving(text: &str) -> Result<Leaving, String> {
    let found = Leaving::ALL.into_iter().find(|leaving| leaving.name() == text);
    found.ok_or_else(|| format!("it is one of {}", Leaving::ALL.map(Leaving::name).join(", ")))
}

fn parse_light(text: &str) -> Result<LightPart, String> {
    let found = LightPart::ALL.into_iter().find(|part| part.name() == text);
    found.ok_or_else(|| format!("it is one of {}", LightPart::ALL.map(LightPart::name).join(", ")))
}

impl SolverArguments {
    /// Which light is asked for.
    pub fn light(&self) -> LightPart {
        self.light.unwrap_or_default()
    }

    /// The method that was asked for, before there is anything to solve.
    ///
    /// # Errors
    /// A failure for a combination without meaning, and for an option that would be ignored, as some of `budget` by a deterministic method.
    pub fn chosen(&self, budget: &BudgetArguments) -> Result<Chosen, Failure> {
        let SolverArguments { replicates, leaving, light, .. } = *self;
        let asked = Asked { seed: Some(self.seed), replicates, leaving, light, ..self.method.asked() };
        let chosen = asked.chosen()?;
        chosen.check_limits(budget.accuracy.is_asked(), budget.rays.is_some())?;
        Ok(chosen)
    }

    /// A solver of `problem` by the `chosen` method, as far as `budget` reaches; of each light group for itself, if that is asked for.
    ///
    /// # Errors
    /// Those of [`Chosen::solver`].
    pub fn solver(&self, chosen: &Chosen, problem: &Problem, budget: Budget) -> Result<Box<dyn Solver>, Failure> {
        Ok(chosen.solver(problem, budget, self.light_groups.as_ref())?)
    }
}
