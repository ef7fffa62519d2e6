//! The method of `isolux solve`: a name, and the axes by which it may differ from what has that name.

use isolux_core::choice::{Choice, TableEntry};
use isolux_core::form_factors::WAYS;
use isolux_core::sampling::address::Address;
use isolux_core::sampling::{self, SequenceName};
use isolux_core::solvers::Asked;
use isolux_core::solvers::monte_carlo::axes::{Axis, Direction, Estimator, FirstShot, Lines, Survival, Walk};
use isolux_core::solvers::monte_carlo::orders::{self, OrderName};

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
    /// What is asked for, of the method.
    pub fn asked(&self) -> Asked {
        Asked {
            method: self.method.clone(),
            sequence: self.sequence,
            order: self.order,
            lines: self.lines,
            walk: self.walk,
            address: self.address,
            estimator: self.estimator,
            direction: self.direction,
            survival: self.survival,
            first_shot: self.first_shot,
            factors: self.factors.map(str::to_owned),
            unshot: self.unshot,
            ambient: self.ambient,
            link_power: self.link_power,
            ..Asked::default()
        }
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
    use crate::failure::Failure;
    use clap::Parser;
    use isolux_core::solvers::Chosen;
    use isolux_core::solvers::monte_carlo::Method;

    #[derive(Parser)]
    struct Command {
        #[command(flatten)]
        method: MethodArguments,
    }

    fn arguments(text: &str) -> Asked {
        let parsed = Command::try_parse_from(text.split(' '));
        parsed.map(|command| command.method.asked()).unwrap_or_else(|error| panic!("{error}"))
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
        let refused = |text: &str| Failure::from(arguments(text).chosen().unwrap_err()).to_string();
        assert!(refused("solve --method direct --order wdrs").contains("no random numbers"));
        assert!(refused("solve --method direct --unshot 0.1").contains("no use for --unshot"));
        assert!(refused("solve --method southwell --factors contour").contains("no use for --factors"));
        assert!(refused("solve --method gauss-seidel --ambient").contains("no use for --ambient"));
        assert!(refused("solve --method shirley --link-power 0.1").contains("no use for --link-power"));
        let hemicube = arguments("solve --method gauss-seidel --factors hemicube --unshot 0.01");
        let Ok(Chosen::Deterministic(_, settings)) = (Asked { seed: Some(7), ..hemicube }).chosen() else {
            panic!("gauss-seidel is deterministic")
        };
        assert_eq!((settings.way.as_str(), settings.unshot, settings.factors.seed), ("hemicube", 0.01, 7));
    }
}
