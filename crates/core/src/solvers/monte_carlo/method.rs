//! A method: a point in the space of the axes. Those that the literature names are in a table.

use super::axes::{Axis, Direction, Estimator, FirstShot, Lines, Survival, Walk};
use super::orders::OrderName;
use crate::Error;
use crate::sampling::SequenceName;
use crate::sampling::address::Address;

/// A choice on every axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Method {
    pub walk: Walk,
    pub lines: Lines,
    pub order: OrderName,
    pub sequence: SequenceName,
    pub address: Address,
    pub estimator: Estimator,
    pub direction: Direction,
    pub survival: Survival,
    pub first_shot: FirstShot,
}

/// A method of the literature.
#[derive(Clone, Copy, Debug)]
pub struct NamedMethod {
    pub name: &'static str,
    /// Two lines for people.
    pub what: [&'static str; 2],
    pub source: &'static str,
    pub method: Method,
}

/// Stochastic Jacobi radiosity, from which the others of the literature differ.
pub const STOCHASTIC_JACOBI: Method = Method {
    walk: Walk::Discrete,
    lines: Lines::Local,
    order: OrderName::STOCHASTIC_JACOBI,
    sequence: SequenceName::OWEN_SOBOL,
    address: Address::PerIteration,
    estimator: Estimator::Collision,
    direction: Direction::Shooting,
    survival: Survival::Random,
    first_shot: FirstShot::Local,
};

/// Everything that is fast, in one: the default.
pub const AUTO: Method = of_order(OrderName::AUTO);

const fn of_order(order: OrderName) -> Method {
    Method { order, ..STOCHASTIC_JACOBI }
}

const RANDOM_WALK: Method = Method { order: OrderName::DEPTH_FIRST, address: Address::PerElement, ..STOCHASTIC_JACOBI };
const PARTICLES: Method = Method { walk: Walk::Continuous, address: Address::PerParticle, ..RANDOM_WALK };

/// All methods with a name. The first is what a program should use unless told otherwise.
pub const METHODS: &[NamedMethod] = &[
    NamedMethod {
        name: "auto",
        what: [
            "shoots a part of the rays, then looks for the lights from each element and",
            "gathers along fast bundles of lines; bright surfaces shoot once more",
        ],
        source: "isolux",
        method: AUTO,
    },
    NamedMethod {
        name: "stochastic-jacobi",
        what: ["shoots light until none is left, shoots the whole once more, and gathers", "on small elements"],
        source: "Neumann et al. 1995; Bekaert 1999",
        method: STOCHASTIC_JACOBI,
    },
    NamedMethod {
        name: "stochastic-ray",
        what: ["shoots the whole power in each iteration and averages the iterations", "after a warm-up"],
        source: "Neumann et al. 1995",
        method: of_order(OrderName::STOCHASTIC_RAY),
    },
    NamedMethod {
        name: "shirley",
        what: ["one breadth-first sweep: all landed light is shot in the next step,", "until none is left"],
        source: "Shirley 1991",
        method: of_order(OrderName::BREADTH_FIRST),
    },
    NamedMethod {
        name: "feda",
        what: ["Shirley's sweep in stages of growing numbers of rays, each of them", "a whole solution, averaged"],
        source: "Feda & Purgathofer 1993",
        method: of_order(OrderName::STAGED),
    },
    NamedMethod {
        name: "wdrs",
        what: [
            "well distributed ray sets: every element shoots the rays of equal power",
            "that it lacks; no ray is wasted when the power of a ray is lowered",
        ],
        source: "Neumann, Neumann, Bekaert et al. 1997",
        method: Method { address: Address::PerElement, ..of_order(OrderName::WDRS) },
    },
    NamedMethod {
        name: "particle-tracing",
        what: [
            "particles leave from the point where they landed: a continuous walk,",
            "free of all errors of the mesh but those of the tally",
        ],
        source: "Pattanaik & Mudur 1992",
        method: PARTICLES,
    },
    NamedMethod {
        name: "random-walk",
        what: ["particles jump from element to element: a discrete walk;", "see --estimator and --direction"],
        source: "Sbert 1997; Bekaert, Cools & Willems 1999",
        method: RANDOM_WALK,
    },
    NamedMethod {
        name: "keller",
        what: [
            "quasi-random walks: the whole path from one point, and of the particles",
            "the first fraction goes on at each reflection",
        ],
        source: "Keller 1996",
        method: Method { survival: Survival::Fraction, sequence: SequenceName::HALTON, ..PARTICLES },
    },
    NamedMethod {
        name: "multipath",
        what: [
            "global lines, one after the other: what has landed on an element leaves",
            "with the next line that crosses it",
        ],
        source: "Sbert, Pueyo, Neumann & Purgathofer 1996",
        method: Method {
            lines: Lines::Global,
            address: Address::PerIteration,
            sequence: SequenceName::RANDOM,
            ..RANDOM_WALK
        },
    },
    NamedMethod {
        name: "global-jacobi",
        what: ["iterations in which every element sends its light along all global lines", "that cross it"],
        source: "Sbert 1993; Sbert 1997",
        method: Method { lines: Lines::Global, ..STOCHASTIC_JACOBI },
    },
    NamedMethod {
        name: "transillumination",
        what: [
            "bundles of parallel lines across the whole scene: in each direction all",
            "elements exchange their light",
        ],
        source: "Szirmay-Kalos & Purgathofer 1998; Sbert 1997",
        method: Method { lines: Lines::Bundle, ..of_order(OrderName::BREADTH_FIRST) },
    },
];

impl Method {
    /// The method called `name`.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn named(name: &str) -> Result<Method, Error> {
        let found = METHODS.iter().find(|method| method.name == name);
        found
            .map(|found| found.method)
            .ok_or_else(|| Error::unknown_name("method", name, METHODS.iter().map(|method| method.name)))
    }

    /// Its name in the literature, whatever numbers it draws and whichever visits score; or that of its order.
    pub fn name(&self) -> &'static str {
        let kind = |method: &Method| (method.walk, method.lines, method.order, method.survival);
        METHODS.iter().find(|named| kind(&named.method) == kind(self)).map_or(self.order.name(), |named| named.name)
    }

    /// The address that suits the other axes.
    pub fn natural_address(&self) -> Address {
        (self.order.entry().natural_address)(self)
    }

    /// Complete solutions in a round that suit its order.
    pub fn natural_replicates(&self) -> u32 {
        self.order.entry().natural_replicates
    }

    /// Why the mean over many runs is not the exact solution, if it is not: no error bar tells of that. Light that leaves with a later point
    /// of the sequence that brought it is a little off, for the points of one sequence avoid each other; with random numbers it is not.
    pub fn bias(&self) -> Option<&'static str> {
        let is_random = self.sequence == SequenceName::RANDOM;
        if self.order.name() == "regular" {
            Some("regular power shooting averages iterations that lack light")
        } else if self.survival == Survival::Fraction {
            Some("walks of Keller's kind end a particle's share too early")
        } else if self.address == Address::PerElement && !is_random {
            Some("streams of elements that run on over steps are biased by up to a hundredth; --sequence random is not")
        } else if self.order == OrderName::DEPTH_FIRST && self.lines == Lines::Global && !is_random {
            Some("light along one global line after the other is biased by up to a hundredth; --sequence random is not")
        } else {
            None
        }
    }

    /// Whether light of many lines is pooled on the elements before it leaves: everything but the random walk.
    pub fn pools(&self) -> bool {
        (self.order.entry().pools)(self.lines)
    }

    /// Whether [`crate::transport::Leaving`] means anything to it: a walk goes on as its kind says, and global lines cross all of an element.
    pub fn has_leaving(&self) -> bool {
        self.pools() && self.lines == Lines::Local
    }

    /// What is needed to name it again: parameter and value of each axis that matters to it.
    pub fn parameters(&self) -> Vec<(String, String)> {
        let mut parameters = vec![
            (Walk::NAME, self.walk.name()),
            (Lines::NAME, self.lines.name()),
            ("order", self.order.name()),
            ("sequence", self.sequence.name()),
            ("address", self.address.name()),
        ];
        if !self.pools() {
            parameters.push((Direction::NAME, self.direction.name()));
            parameters.push((Estimator::NAME, self.estimator.name()));
            parameters.push((Survival::NAME, self.survival.name()));
        }
        if self.lines != Lines::Local {
            parameters.push((FirstShot::NAME, self.first_shot.name()));
        }
        parameters.into_iter().map(|(name, value)| (name.to_owned(), value.to_owned())).collect()
    }
}
