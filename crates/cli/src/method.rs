//! The method of `isolux solve`: a name, and the axes by which it may differ from what has that name.

use crate::failure::Failure;
use isolux_core::Error;
use isolux_core::choice::{Choice, TableEntry};
use isolux_core::form_factors::{self, WAYS};
use isolux_core::sampling::address::Address;
use isolux_core::sampling::{self, SequenceName};
use isolux_core::solvers::deterministic::{self, DETERMINISTIC};
use isolux_core::solvers::monte_carlo::axes::{Axis, Direction, Estimator, FirstShot, Lines, Survival, Walk};
use isolux_core::solvers::monte_carlo::orders::{self, OrderName};
use isolux_core::solvers::monte_carlo::{METHODS, Method};

#[derive(Clone, Debug, clap::Args)]
#[command(next_help_heading = "Method")]
pub struct MethodArguments {
    /// Algorithm, by its name in the literature: see 'isolux list methods'. The axes below change it [default: auto, or
    /// stochastic-jacobi if one of them but --sequence is given]
    #[arg(long, value_name = "NAME")]
    method: Option<String>,

    /// Sample numbers: see 'isolux list sequences'
    #[arg(long, value_name = "NAME", value_parser = parse_choice::<sampling::Entry>)]
    sequence: Option<SequenceName>,

    /// When landed light is shot again: see 'isolux list orders'
    #[arg(long, value_name = "NAME", value_parser = parse_choice::<orders::Entry>)]
    order: Option<OrderName>,

    /// Which lines join surfaces: local, global or bundle
    #[arg(long, value_parser = parse_axis::<Lines>)]
    lines: Option<Lines>,

    /// Where landed light leaves: discrete (anywhere on the element) or continuous (where it landed)
    #[arg(long, value_parser = parse_axis::<Walk>)]
    walk: Option<Walk>,

    /// Which random numbers a line draws: per-iteration, per-element or per-particle [default: what suits the method]
    #[arg(long, value_parser = parse_address)]
    address: Option<Address>,

    /// Which visits of a random walk score: collision, survival or absorption
    #[arg(long, value_parser = parse_axis::<Estimator>)]
    estimator: Option<Estimator>,

    /// Where random walks start: shooting (on the lights) or gathering (on the element to be measured)
    #[arg(long, value_parser = parse_axis::<Direction>)]
    direction: Option<Direction>,

    /// Which particles go on: random (by the reflectivity) or fraction (the first of them, as Keller's)
    #[arg(long, value_parser = parse_axis::<Survival>)]
    survival: Option<Survival>,

    /// How emitted light starts where lines are global: local (lines aimed from the lights) or same
    #[arg(long, value_parser = parse_axis::<FirstShot>)]
    first_shot: Option<FirstShot>,

    /// Deterministic methods on a matrix: form factors by contour, hemicube, local-lines or global-lines [default: contour]
    #[arg(long, value_name = "WAY", value_parser = parse_way)]
    factors: Option<&'static str>,

    /// Deterministic methods that iterate: until less than this share of the emitted power is unshot [default: 0.00001]
    #[arg(long, value_name = "SHARE")]
    unshot: Option<f64>,

    /// southwell: add what the unshot light will do on average, for display
    #[arg(long)]
    ambient: bool,

    /// hierarchical: most power, as a share of the emitted, that a link carries without being refined [default: 0.00001]
    #[arg(long, value_name = "SHARE")]
    link_power: Option<f64>,
}

impl MethodArguments {
    /// The name of the method from which the axes differ. Sample numbers suit all.
    fn name(&self) -> &str {
        let other = self.moves_another_axis();
        self.method.as_deref().unwrap_or(if other { "stochastic-jacobi" } else { METHODS[0].name })
    }

    /// The deterministic method that is asked for, if it is one.
    pub fn deterministic(&self) -> Option<&'static deterministic::Entry> {
        DETERMINISTIC.iter().find(|entry| entry.name == self.name())
    }

    /// What a deterministic method is told.
    ///
    /// # Errors
    /// A failure if an axis of Monte Carlo is asked for as well, or a setting that does not concern this method.
    pub fn deterministic_settings(
        &self,
        entry: &deterministic::Entry,
        seed: u64,
    ) -> Result<deterministic::Settings, Failure> {
        if self.moves_an_axis() {
            let what =
                format!("{} draws no random numbers: it has none of the axes --sequence to --first-shot", entry.name);
            return Err(Failure::usage(what).with_help("leave them out, or choose a method of Monte Carlo"));
        }
        self.refuse_settings_but(entry.uses)?;
        let default = deterministic::Settings::default();
        Ok(deterministic::Settings {
            way: self.factors.map_or(default.way, str::to_owned),
            factors: form_factors::Settings { seed, ..default.factors },
            ambient: self.ambient,
            unshot: self.unshot.unwrap_or(default.unshot),
            link_power: self.link_power.unwrap_or(default.link_power),
            ..default
        })
    }

    /// An option that would be ignored is an error.
    fn refuse_settings_but(&self, used: &[&str]) -> Result<(), Failure> {
        let asked = [
            ("factors", self.factors.is_some()),
            ("unshot", self.unshot.is_some()),
            ("ambient", self.ambient),
            ("link-power", self.link_power.is_some()),
        ];
        match asked.into_iter().find(|(name, is_asked)| *is_asked && !used.contains(name)) {
            Some((name, _)) => Err(Failure::usage(format!("{} has no use for --{name}", self.name()))
                .with_help("leave it out; 'isolux solve --help' says whose it is")),
            None => Ok(()),
        }
    }

    fn moves_an_axis(&self) -> bool {
        self.sequence.is_some() || self.moves_another_axis()
    }

    /// Another axis than that of sample numbers.
    fn moves_another_axis(&self) -> bool {
        let axes = [self.walk.is_some(), self.lines.is_some(), self.order.is_some(), self.address.is_some()];
        let more = [self.estimator.is_some(), self.direction.is_some(), self.survival.is_some()];
        axes.contains(&true) || more.contains(&true) || self.first_shot.is_some()
    }

    /// The method of Monte Carlo with the axes that were asked for.
    ///
    /// # Errors
    /// A failure for a name that is in no table, for a combination without meaning, and for a setting of other methods.
    pub fn method(&self) -> Result<Method, Failure> {
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
        self.refuse_settings_but(&[])?;
        Ok(method)
    }
}

fn parse_axis<A: Axis>(text: &str) -> Result<A, String> {
    A::named(text).ok_or_else(|| one_of(A::ALL.iter().map(|member| member.name())))
}

fn parse_address(text: &str) -> Result<Address, String> {
    let found = Address::ALL.into_iter().find(|address| address.name() == text);
    found.ok_or_else(|| one_of(Address::ALL.into_iter().map(Address::name)))
}

fn parse_way(text: &str) -> Result<&'static str, String> {
    let found = WAYS.iter().find(|way| way.name == text);
    found.map(|way| way.name).ok_or_else(|| one_of(WAYS.iter().map(|way| way.name)))
}

fn parse_choice<E: TableEntry>(text: &str) -> Result<Choice<E>, String> {
    text.parse().map_err(|_| one_of(E::TABLE.iter().map(E::name)))
}

fn one_of<'a>(names: impl Iterator<Item = &'a str>) -> String {
    format!("it is one of {}", names.collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Command {
        #[command(flatten)]
        method: MethodArguments,
    }

    fn arguments(text: &str) -> MethodArguments {
        Command::try_parse_from(text.split(' ')).map(|command| command.method).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn an_axis_changes_the_named_method_and_brings_the_address_that_suits_it() {
        let method = arguments("solve --order depth-first --sequence halton").method().unwrap();
        assert_eq!((method.order, method.address), (OrderName::DEPTH_FIRST, Address::PerElement));
        assert_eq!(method.sequence.name(), "halton");
        let method = arguments("solve --order depth-first --walk continuous").method().unwrap();
        assert_eq!(method, Method::named("particle-tracing").unwrap());
        assert_eq!(
            arguments("solve --lines bundle").method().unwrap(),
            arguments("solve --method stochastic-jacobi --lines bundle").method().unwrap()
        );
        assert_eq!(arguments("solve --sequence sobol").method().unwrap().order, OrderName::AUTO);
        let method = arguments("solve --method random-walk --address per-particle").method().unwrap();
        assert_eq!(method.address, Address::PerParticle);
    }

    #[test]
    fn what_has_no_meaning_is_refused_with_what_is_nearest() {
        let refused = |text: &str| arguments(text).method().unwrap_err().to_string();
        assert!(refused("solve --walk continuous --lines bundle").contains("nearest is --walk discrete"));
        assert!(refused("solve --method jacobi-gathe").contains("did you mean 'jacobi-gather'"));
        assert!(refused("solve --first-shot same").contains("no first shot"));
    }

    #[test]
    fn settings_that_would_be_ignored_are_refused() {
        let refused = |text: &str| {
            let arguments = arguments(text);
            match arguments.deterministic() {
                Some(entry) => arguments.deterministic_settings(entry, 1).unwrap_err().to_string(),
                None => arguments.method().unwrap_err().to_string(),
            }
        };
        assert!(refused("solve --method direct --order wdrs").contains("no random numbers"));
        assert!(refused("solve --method direct --unshot 0.1").contains("no use for --unshot"));
        assert!(refused("solve --method southwell --factors contour").contains("no use for --factors"));
        assert!(refused("solve --method gauss-seidel --ambient").contains("no use for --ambient"));
        assert!(refused("solve --method shirley --link-power 0.1").contains("no use for --link-power"));
        let hemicube = arguments("solve --method gauss-seidel --factors hemicube --unshot 0.01");
        let settings = hemicube.deterministic_settings(hemicube.deterministic().unwrap(), 7).unwrap();
        assert_eq!((settings.way.as_str(), settings.unshot, settings.factors.seed), ("hemicube", 0.01, 7));
    }
}
