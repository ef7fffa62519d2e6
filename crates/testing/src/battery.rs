//! What every method must do, with any sample sequence: the list, and what it is tried on.

use isolux_core::sampling::SequenceName;
use isolux_core::sampling::address::Address;
use isolux_core::solvers::monte_carlo::axes::{Axis, Direction, Estimator, FirstShot, Lines};
use isolux_core::solvers::monte_carlo::method::STOCHASTIC_JACOBI;
use isolux_core::solvers::monte_carlo::orders::OrderName;
use isolux_core::solvers::monte_carlo::{METHODS, Method, Settings};
use isolux_core::transport::Leaving;

/// A method to be tried, and what to call it.
#[derive(Clone, Debug)]
pub struct Trial {
    pub name: String,
    pub method: Method,
}

/// All methods of the table, and those of their variants that have ways of their own.
pub fn methods() -> Vec<Trial> {
    let named = METHODS.iter().map(|named| Trial { name: named.name.to_owned(), method: named.method });
    let walk = Method::named("random-walk").expect("a method of the table");
    let multipath = Method::named("multipath").expect("a method of the table");
    let variants = [
        ("random-walk, survival", Method { estimator: Estimator::Survival, ..walk }),
        ("random-walk, absorption", Method { estimator: Estimator::Absorption, ..walk }),
        ("random-walk, per particle", Method { address: Address::PerParticle, ..walk }),
        ("random-walk, gathering", Method { direction: Direction::Gathering, ..walk }),
        (
            "random-walk, gathering, survival",
            Method { direction: Direction::Gathering, estimator: Estimator::Survival, ..walk },
        ),
        (
            "random-walk, gathering, absorption",
            Method { direction: Direction::Gathering, estimator: Estimator::Absorption, ..walk },
        ),
        ("multipath, first shot by the same lines", Method { first_shot: FirstShot::Same, ..multipath }),
        (
            "transillumination, first shot by the same lines",
            Method {
                first_shot: FirstShot::Same,
                ..Method::named("transillumination").expect("a method of the table")
            },
        ),
    ];
    named.chain(variants.map(|(name, method)| Trial { name: name.to_owned(), method })).collect()
}

/// What is no method, for its mean is not the solution: regular power shooting, which averages iterations that lack light. It
/// keeps its books, repeats its bits and comes to an end as all others do.
pub fn regular() -> Vec<Trial> {
    let order = "regular".parse().expect("an order of the table");
    let of = |lines: Lines| Trial {
        name: format!("regular, {} lines", lines.name()),
        method: Method { order, lines, ..STOCHASTIC_JACOBI },
    };
    Lines::ALL.iter().copied().map(of).collect()
}

/// All methods with all sequences.
pub fn methods_and_sequences() -> impl Iterator<Item = Trial> {
    with_sequences(methods())
}

/// Each of `trials` with all sequences.
pub fn with_sequences(trials: Vec<Trial>) -> impl Iterator<Item = Trial> {
    trials.into_iter().flat_map(|Trial { name, method }| {
        SequenceName::all().map(move |sequence| Trial {
            name: format!("{name}, {}", sequence.entry().name),
            method: Method { sequence, ..method },
        })
    })
}

/// Whether the mean over many runs is the exact solution, as [`Method::bias`] says.
pub fn is_unbiased(method: &Method) -> bool {
    method.bias().is_none()
}

/// `settings` with another method, and elements of constant radiosity to the letter.
pub fn with_method(method: Method, settings: Settings) -> Settings {
    Settings { method, leaving: Leaving::WholeElement, ..settings }
}

/// Whether the balance of every run closes to rounding. Lines that cross an element as chance will send off more or less of its
/// light, and iterations are noisy: there it is the unshot light that closes it.
pub fn leaves_nothing(method: &Method) -> bool {
    method.lines == Lines::Local
        && ![OrderName::STOCHASTIC_RAY, OrderName::WDRS].contains(&method.order)
        && !is_regular(method)
        && method.direction == Direction::Shooting
}

fn is_regular(method: &Method) -> bool {
    method.order.name() == "regular"
}
