//! The solver that somebody asks for: a method by its name, the axes in which it shall differ, and what it is told.
//!
//! Whatever would be ignored is refused. The command line and the Python package both ask here, so they mean the same.

use super::deterministic::{self, DETERMINISTIC};
use super::monte_carlo::axes::{Direction, Estimator, FirstShot, Lines, Survival, Walk};
use super::monte_carlo::orders::OrderName;
use super::monte_carlo::{Budget, LightPart, METHODS, Method, MonteCarlo, Settings};
use super::{LightGroups, Solver};
use crate::form_factors;
use crate::mesh::Resolution;
use crate::sampling::SequenceName;
use crate::sampling::address::Address;
use crate::scene::Grouping;
use crate::transport::Leaving;
use crate::{Error, Problem};

/// Elements that deterministic methods and matrices aim at unless said otherwise: their cost grows with the square.
pub const DETERMINISTIC_ELEMENTS: u64 = 2000;

/// What is asked for. Whatever is `None` is as the method has it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Asked {
    /// A name of [`METHODS`] or of [`DETERMINISTIC`]; the first of all, or stochastic Jacobi if another axis is moved than that of sample
    /// numbers.
    pub method: Option<String>,
    pub sequence: Option<SequenceName>,
    pub order: Option<OrderName>,
    pub lines: Option<Lines>,
    pub walk: Option<Walk>,
    pub address: Option<Address>,
    pub estimator: Option<Estimator>,
    pub direction: Option<Direction>,
    pub survival: Option<Survival>,
    pub first_shot: Option<FirstShot>,
    /// See [`Settings`].
    pub seed: Option<u64>,
    pub replicates: Option<u32>,
    pub leaving: Option<Leaving>,
    pub light: Option<LightPart>,
    /// See [`deterministic::Settings`]: `way`, `unshot`, `ambient` and `link_power`.
    pub factors: Option<String>,
    pub unshot: Option<f64>,
    pub ambient: bool,
    pub link_power: Option<f64>,
}

/// A method with what it is told, but for the budget.
#[derive(Clone, Debug)]
pub enum Chosen {
    MonteCarlo(Settings),
    Deterministic(&'static deterministic::Entry, deterministic::Settings),
}

const NO_RANDOM_NUMBERS: &str = "it draws no random numbers; leave this out, a limit of time suits every method";

impl Asked {
    /// The method that is asked for.
    ///
    /// # Errors
    /// [`Error::UnknownName`], [`Error::Meaningless`] for a combination without meaning, and [`Error::Unused`] for what the method would
    /// ignore.
    pub fn chosen(&self) -> Result<Chosen, Error> {
        match DETERMINISTIC.iter().find(|entry| entry.name == self.name()) {
            Some(entry) => Ok(Chosen::Deterministic(entry, self.deterministic_settings(entry)?)),
            None => Ok(Chosen::MonteCarlo(self.settings()?)),
        }
    }

    /// The name of the method from which the axes differ. Sample numbers suit all.
    fn name(&self) -> &str {
        let is_moved = self.moved_axis().is_some_and(|axis| axis != "sequence");
        self.method.as_deref().unwrap_or(if is_moved { "stochastic-jacobi" } else { METHODS[0].name })
    }

    /// The first axis that is moved, that of sample numbers last.
    fn moved_axis(&self) -> Option<&'static str> {
        let axes = [
            ("order", self.order.is_some()),
            ("lines", self.lines.is_some()),
            ("walk", self.walk.is_some()),
            ("address", self.address.is_some()),
            ("estimator", self.estimator.is_some()),
            ("direction", self.direction.is_some()),
            ("survival", self.survival.is_some()),
            ("first-shot", self.first_shot.is_some()),
            ("sequence", self.sequence.is_some()),
        ];
        first(axes)
    }

    fn settings(&self) -> Result<Settings, Error> {
        let method = self.method()?;
        if self.leaving.is_some() && !method.has_leaving() {
            let why = "it is for light that is pooled on elements and shot along local lines";
            return Err(Error::Unused { method: method.name(), option: "leaving", why });
        }
        let default = Settings::default();
        let light = self.light.unwrap_or(default.light);
        method.check_light(light)?;
        Ok(Settings {
            method,
            seed: self.seed.unwrap_or(default.seed),
            budget: default.budget,
            replicates: self.replicates.unwrap_or(method.natural_replicates()),
            leaving: self.leaving.unwrap_or(default.leaving),
            light,
        })
    }

    /// The method of Monte Carlo with the axes that are asked for.
    ///
    /// # Errors
    /// As [`Asked::chosen`], and for a name that is not of Monte Carlo.
    pub fn method(&self) -> Result<Method, Error> {
        let names = METHODS.iter().map(|method| method.name).chain(DETERMINISTIC.iter().map(|entry| entry.name));
        let named = Method::named(self.name()).map_err(|_| Error::unknown_name("method", self.name(), names))?;
        let mut method = Method {
            walk: self.walk.unwrap_or(named.walk),
            lines: self.lines.unwrap_or(named.lines),
            order: self.order.unwrap_or(named.order),
            sequence: self.sequence.unwrap_or(named.sequence),
            estimator: self.estimator.unwrap_or(named.estimator),
            direction: self.direction.unwrap_or(named.direction),
            survival: self.survival.unwrap_or(named.survival),
            first_shot: self.first_shot.unwrap_or(named.first_shot),
            ..named
        };
        let moved = [method.walk != named.walk, method.lines != named.lines, method.order != named.order];
        let natural = if moved.contains(&true) { method.natural_address() } else { named.address };
        method.address = self.address.unwrap_or(natural);
        method.check()?;
        self.refuse_all_but(&[], method.name())?;
        Ok(method)
    }

    fn deterministic_settings(&self, entry: &deterministic::Entry) -> Result<deterministic::Settings, Error> {
        let random = [("replicates", self.replicates.is_some()), ("leaving", self.leaving.is_some())];
        if let Some(option) = self.moved_axis().or(first(random)) {
            return Err(Error::Unused { method: entry.name, option, why: NO_RANDOM_NUMBERS });
        }
        if self.light == Some(LightPart::Indirect) {
            let why = "it solves for all light together; choose a method of Monte Carlo, like stochastic-jacobi";
            return Err(Error::Unused { method: entry.name, option: "light indirect", why });
        }
        self.refuse_all_but(entry.uses, entry.name)?;
        let default = deterministic::Settings::default();
        let seed = self.seed.unwrap_or(default.factors.seed);
        Ok(deterministic::Settings {
            way: self.factors.clone().unwrap_or(default.way),
            factors: form_factors::Settings { seed, ..default.factors },
            ambient: self.ambient,
            unshot: self.unshot.unwrap_or(default.unshot),
            link_power: self.link_power.unwrap_or(default.link_power),
            ..default
        })
    }

    /// Refuses the settings of deterministic methods but for those that are `used`.
    fn refuse_all_but(&self, used: &[&str], method: &'static str) -> Result<(), Error> {
        let asked = [
            ("factors", self.factors.is_some()),
            ("unshot", self.unshot.is_some()),
            ("ambient", self.ambient),
            ("link-power", self.link_power.is_some()),
        ];
        match first(asked.map(|(name, is_asked)| (name, is_asked && !used.contains(&name)))) {
            Some(option) => Err(Error::Unused { method, option, why: "leave it out; other methods have a use for it" }),
            None => Ok(()),
        }
    }
}

/// The first that is asked for.
fn first<const N: usize>(asked: [(&'static str, bool); N]) -> Option<&'static str> {
    asked.into_iter().find(|(_, is_asked)| *is_asked).map(|(name, _)| name)
}

impl Chosen {
    pub fn is_deterministic(&self) -> bool {
        matches!(self, Chosen::Deterministic(..))
    }

    /// How finely a scene is cut: into so many `elements`, or with edges of at most `max_edge` [m]; as suits the method if neither is said.
    pub fn resolution(&self, elements: Option<u64>, max_edge: Option<f32>) -> Resolution {
        match (elements, max_edge) {
            (Some(elements), _) if self.is_deterministic() => Resolution::Elements(elements),
            (Some(elements), _) => Resolution::Clustered(elements),
            (None, Some(edge)) => Resolution::MaxEdge(edge),
            (None, None) if self.is_deterministic() => Resolution::Elements(DETERMINISTIC_ELEMENTS),
            (None, None) => Resolution::default(),
        }
    }

    /// Whether an error or a number of rays can be asked for.
    ///
    /// # Errors
    /// [`Error::Unused`] by a deterministic method.
    pub fn check_limits(&self, has_error: bool, has_rays: bool) -> Result<(), Error> {
        let Chosen::Deterministic(entry, _) = self else { return Ok(()) };
        match first([("error", has_error), ("rays", has_rays)]) {
            Some(option) => Err(Error::Unused { method: entry.name, option, why: NO_RANDOM_NUMBERS }),
            None => Ok(()),
        }
    }

    /// A solver of `problem`, as far as `budget` reaches; of each of the light `groups` for itself, if there are any.
    ///
    /// # Errors
    /// Those of [`MonteCarlo::new`], of the makers of deterministic solvers, and of [`LightGroups::new`].
    pub fn solver(
        &self,
        problem: &Problem,
        budget: Budget,
        groups: Option<&Grouping>,
    ) -> Result<Box<dyn Solver>, Error> {
        let Some(groups) = groups else { return self.solver_of_all(problem, budget) };
        let make = |problem: &Problem, budget, seed| self.with_seed(seed).solver_of_all(problem, budget);
        Ok(Box::new(LightGroups::new(problem, groups, budget, self.seed(), make)?))
    }

    fn solver_of_all(&self, problem: &Problem, budget: Budget) -> Result<Box<dyn Solver>, Error> {
        match self {
            Chosen::MonteCarlo(settings) => Ok(Box::new(MonteCarlo::new(problem, Settings { budget, ..*settings })?)),
            Chosen::Deterministic(entry, settings) => (entry.make)(problem, settings),
        }
    }

    fn seed(&self) -> u64 {
        match self {
            Chosen::MonteCarlo(settings) => settings.seed,
            Chosen::Deterministic(_, settings) => settings.factors.seed,
        }
    }

    /// The same with other random numbers, if it draws any.
    fn with_seed(&self, seed: u64) -> Chosen {
        match self {
            Chosen::MonteCarlo(settings) => Chosen::MonteCarlo(Settings { seed, ..*settings }),
            Chosen::Deterministic(entry, settings) => Chosen::Deterministic(entry, settings.clone()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(asked: Asked) -> String {
        asked.chosen().map(|_| ()).unwrap_err().to_string()
    }

    fn named(name: &str) -> Asked {
        Asked { method: Some(name.to_owned()), ..Asked::default() }
    }

    #[test]
    fn what_would_be_ignored_is_refused() {
        let wdrs = Some(OrderName::WDRS);
        assert!(refused(Asked { order: wdrs, ..named("direct") }).contains("draws no random numbers"));
        assert!(refused(Asked { replicates: Some(9), ..named("direct") }).contains("no use for replicates"));
        assert!(refused(Asked { light: Some(LightPart::Indirect), ..named("direct") }).contains("all light together"));
        assert!(refused(Asked { unshot: Some(0.1), ..named("direct") }).contains("direct has no use for unshot"));
        assert!(refused(Asked { ambient: true, ..named("wdrs") }).contains("wdrs has no use for ambient"));
        let whole = Some(Leaving::WholeElement);
        assert!(refused(Asked { leaving: whole, ..named("random-walk") }).contains("pooled on elements"));
        let direct = named("direct").chosen().unwrap();
        assert_eq!(direct.check_limits(false, false), Ok(()));
        assert!(direct.check_limits(false, true).unwrap_err().to_string().contains("no use for rays"));
        assert!(refused(named("dirct")).contains("did you mean 'direct'"));
    }

    #[test]
    fn the_mesh_suits_the_method() {
        let (auto, direct) = (Asked::default().chosen().unwrap(), named("direct").chosen().unwrap());
        assert_eq!(auto.resolution(None, None), Resolution::default());
        assert_eq!(auto.resolution(Some(9), None), Resolution::Clustered(9));
        assert_eq!(direct.resolution(None, None), Resolution::Elements(DETERMINISTIC_ELEMENTS));
        assert_eq!(direct.resolution(Some(9), None), Resolution::Elements(9));
        assert_eq!(direct.resolution(None, Some(0.5)), Resolution::MaxEdge(0.5));
    }
}
