//! The method of `isolux solve`: a name, and the axes by which it may differ from what has that name.

use crate::failure::Failure;
use isolux_core::Error;
use isolux_core::form_factors::{self, WAYS};
use isolux_core::sampling::address::Address;
use isolux_core::sampling::{SEQUENCES, SequenceName};
use isolux_core::solvers::deterministic::{self, DETERMINISTIC};
use isolux_core::solvers::monte_carlo::axes::{Axis, Direction, Estimator, FirstShot, Lines, Order, Survival, Walk};
use isolux_core::solvers::monte_carlo::{METHODS, Method};

#[derive(Clone, Debug, clap::Args)]
#[command(next_help_heading = "Method")]
pub struct MethodArguments {
    /// Algorithm, by its name in the literature: see 'isolux list methods'. The axes below change it
    #[arg(long, value_name = "NAME", default_value = METHODS[0].name)]
    method: String,

    /// Sample numbers: see 'isolux list sequences'
    #[arg(long, value_name = "NAME", value_parser = parse_sequence)]
    sequence: Option<SequenceName>,

    /// When landed light is shot again: depth-first, breadth-first, staged, stochastic-ray, wdrs or stochastic-jacobi
    #[arg(long, value_parser = parse_axis::<Order>)]
    order: Option<Order>,

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

    /// Deterministic methods: form factors by contour, hemicube, local-lines or global-lines
    #[arg(long, value_name = "WAY", default_value = WAYS[0].name, value_parser = parse_way)]
    factors: &'static str,

    /// Deterministic methods: iterate until less than this share of the emitted power is unshot
    #[arg(long, value_name = "SHARE", default_value_t = deterministic::Settings::default().unshot)]
    unshot: f64,

    /// southwell: add what the unshot light will do on average, for display
    #[arg(long)]
    ambient: bool,

    /// hierarchical: most power, as a share of the emitted, that a link carries without being refined
    #[arg(long, value_name = "SHARE", default_value_t = deterministic::Settings::default().link_power)]
    link_power: f64,
}

impl MethodArguments {
    /// The name that was asked for.
    pub fn name(&self) -> &str {
        &self.method
    }

    /// Whether a deterministic method is asked for.
    pub fn is_deterministic(&self) -> bool {
        DETERMINISTIC.iter().any(|entry| entry.name == self.method)
    }

    /// What a deterministic method is told.
    ///
    /// # Errors
    /// A failure if an axis of Monte Carlo is asked for as well.
    pub fn deterministic(&self, seed: u64) -> Result<deterministic::Settings, Failure> {
        if self.moves_an_axis() {
            let what =
                format!("{} draws no random numbers: it has none of the axes --walk to --first-shot", self.method);
            return Err(Failure::usage(what).with_help("leave them out, or choose a method of Monte Carlo"));
        }
        let default = deterministic::Settings::default();
        Ok(deterministic::Settings {
            way: self.factors.to_owned(),
            factors: form_factors::Settings { seed, ..default.factors },
            ambient: self.ambient,
            unshot: self.unshot,
            link_power: self.link_power,
            ..default
        })
    }

    fn moves_an_axis(&self) -> bool {
        let axes = [self.walk.is_some(), self.lines.is_some(), self.order.is_some(), self.sequence.is_some()];
        let more = [self.address.is_some(), self.estimator.is_some(), self.direction.is_some()];
        axes.contains(&true) || more.contains(&true) || self.survival.is_some() || self.first_shot.is_some()
    }

    /// The method of Monte Carlo with the axes that were asked for.
    ///
    /// # Errors
    /// A failure for a name that is in no table, and for a combination without meaning.
    pub fn method(&self) -> Result<Method, Failure> {
        let names = METHODS.iter().map(|method| method.name).chain(DETERMINISTIC.iter().map(|entry| entry.name));
        let named = Method::named(&self.method).map_err(|_| Error::unknown_name("method", &self.method, names))?;
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

fn parse_sequence(text: &str) -> Result<SequenceName, String> {
    text.parse().map_err(|_| one_of(SEQUENCES.iter().map(|entry| entry.name)))
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
        assert_eq!((method.order, method.address), (Order::DepthFirst, Address::PerElement));
        assert_eq!(method.sequence.entry().name, "halton");
        let method = arguments("solve --order depth-first --walk continuous").method().unwrap();
        assert_eq!(method, Method::named("particle-tracing").unwrap());
        let method = arguments("solve --method random-walk --address per-particle").method().unwrap();
        assert_eq!(method.address, Address::PerParticle);
    }

    #[test]
    fn what_has_no_meaning_is_refused_with_what_is_nearest() {
        let refused = |text: &str| arguments(text).method().unwrap_err().to_string();
        assert!(refused("solve --walk continuous --lines bundle").contains("nearest is --walk discrete"));
        assert!(refused("solve --method jacobi-gathe").contains("did you mean 'jacobi-gather'"));
        let direct = arguments("solve --method direct --order wdrs");
        assert!(direct.is_deterministic() && direct.deterministic(1).is_err());
        let hemicube = arguments("solve --method direct --factors hemicube --unshot 0.01").deterministic(7).unwrap();
        assert_eq!((hemicube.way.as_str(), hemicube.unshot, hemicube.factors.seed), ("hemicube", 0.01, 7));
    }
}
