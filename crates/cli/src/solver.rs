//! The solver that is asked for: a method, and what it is told.

use crate::budget::BudgetArguments;
use crate::failure::Failure;
use crate::light_groups::parse_grouping;
use crate::method::MethodArguments;
use isolux_core::Problem;
use isolux_core::scene::Grouping;
use isolux_core::solvers::monte_carlo::{Budget, LightPart, MonteCarlo, Settings};
use isolux_core::solvers::{LightGroups, Solver, deterministic};
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

/// A method with what it is told.
pub enum Chosen {
    MonteCarlo(Settings),
    Deterministic(&'static deterministic::Entry, deterministic::Settings),
}

impl Chosen {
    pub fn is_deterministic(&self) -> bool {
        matches!(self, Chosen::Deterministic(..))
    }

    /// The same with other random numbers, if it draws any.
    fn with_seed(&self, seed: u64) -> Chosen {
        match self {
            Chosen::MonteCarlo(settings) => Chosen::MonteCarlo(Settings { seed, ..*settings }),
            Chosen::Deterministic(entry, settings) => Chosen::Deterministic(entry, settings.clone()),
        }
    }

    /// A solver of `problem`, as far as `budget` reaches.
    ///
    /// # Errors
    /// Those of [`MonteCarlo::new`], and of the makers of deterministic solvers.
    fn solver(&self, problem: &Problem, budget: Budget) -> Result<Box<dyn Solver>, Failure> {
        match self {
            Chosen::MonteCarlo(settings) => {
                let settings = Settings { budget, ..*settings };
                Ok(Box::new(MonteCarlo::new(problem, settings)?))
            }
            Chosen::Deterministic(entry, settings) => Ok((entry.make)(problem, settings)?),
        }
    }
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
        let Some(entry) = self.method.deterministic() else { return Ok(Chosen::MonteCarlo(self.settings()?)) };
        let asked = [
            ("error", budget.accuracy.is_asked()),
            ("rays", budget.rays.is_some()),
            ("replicates", self.replicates.is_some()),
            ("leaving", self.leaving.is_some()),
        ];
        if let Some((name, _)) = asked.into_iter().find(|(_, is_asked)| *is_asked) {
            let what = format!("{} draws no random numbers: it has no --{name}", entry.name);
            return Err(Failure::usage(what).with_help("leave it out; --time limits every method"));
        }
        if self.light == Some(LightPart::Indirect) {
            let what = format!("{} solves for all light together: it has no --light indirect", entry.name);
            return Err(Failure::usage(what).with_help("choose a method of Monte Carlo, like stochastic-jacobi"));
        }
        Ok(Chosen::Deterministic(entry, self.method.deterministic_settings(entry, self.seed)?))
    }

    /// A solver of `problem` by the `chosen` method, as far as `budget` reaches; of each light group for itself, if that is asked for.
    ///
    /// # Errors
    /// Those of [`MonteCarlo::new`], of the makers of deterministic solvers, and of [`LightGroups::new`].
    pub fn solver(&self, chosen: &Chosen, problem: &Problem, budget: Budget) -> Result<Box<dyn Solver>, Failure> {
        let Some(grouping) = &self.light_groups else { return chosen.solver(problem, budget) };
        let make = |problem: &Problem, budget: Budget, seed: u64| chosen.with_seed(seed).solver(problem, budget);
        Ok(Box::new(LightGroups::new(problem, grouping, budget, self.seed, make)?))
    }

    /// All of them but the budget, which may depend on the scene.
    fn settings(&self) -> Result<Settings, Failure> {
        let method = self.method.method()?;
        if self.leaving.is_some() && !method.has_leaving() {
            let what = format!("{} has no use for --leaving", method.name());
            return Err(
                Failure::usage(what).with_help("it is for light that is pooled on elements and shot along local lines")
            );
        }
        let default = Settings::default();
        let light = self.light.unwrap_or(default.light);
        method.check_light(light)?;
        Ok(Settings {
            method,
            seed: self.seed,
            budget: default.budget,
            replicates: self.replicates.unwrap_or(method.natural_replicates()),
            leaving: self.leaving.unwrap_or(default.leaving),
            light,
        })
    }
}
