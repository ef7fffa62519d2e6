//! Everything that is fast: see [`auto`](crate::solvers::monte_carlo::auto).

use super::Entry;
use crate::Error;
use crate::sampling::address::Address;
use crate::solvers::monte_carlo::Method;
use crate::solvers::monte_carlo::auto::Auto;
use crate::solvers::monte_carlo::axes::Lines;

pub(super) const ENTRY: Entry = Entry {
    name: "auto",
    what: "shot once; then each element looks for the lights, and gathers along bundles or local lines",
    source: "isolux",
    pools: |_| true,
    natural_address: |_| Address::PerIteration,
    natural_replicates: 8,
    tells_light_apart: |_| true,
    check,
    make: |problem, settings| Box::new(Auto::new(problem, settings)),
};

fn check(method: &Method) -> Result<(), Error> {
    if method.lines != Lines::Local {
        let what = "the order auto chooses its lines itself";
        return Err(Error::Meaningless { what, nearest: "--lines local" });
    }
    if method.address != Address::PerIteration {
        let what = "the order auto gathers anew in each complete solution, so no counter runs on";
        return Err(Error::Meaningless { what, nearest: "--address per-iteration" });
    }
    Ok(())
}
