//! The orders: when is landed light shot again, and how much of it? One a file.
//!
//! An order makes what computes a complete solution: its own struct (`wdrs`), or the random walk (`depth_first` along local
//! lines), or, where light is pooled on the elements and shot in stages, a [`Relaxation`](super::relaxation) that follows the
//! course that the order states.

mod auto;
mod breadth_first;
mod depth_first;
mod regular;
mod staged;
mod stochastic_jacobi;
mod stochastic_ray;
mod wdrs;

use super::axes::Lines;
use super::complete::CompleteSolution;
use super::{Method, Settings};
use crate::choice::{Choice, TableEntry};
use crate::sampling::address::Address;
use crate::{Error, Problem};

/// An order that can be asked for by name.
#[derive(Debug)]
pub struct Entry {
    pub name: &'static str,
    /// When landed light is shot again, in a few words for people.
    pub what: &'static str,
    /// Where it was published.
    pub source: &'static str,
    /// Whether light of many lines is pooled on the elements before it leaves them: if not, it is a random walk.
    pub(super) pools: fn(Lines) -> bool,
    /// The address that suits a method of this order.
    pub(super) natural_address: fn(&Method) -> Address,
    /// Complete solutions in a round: more tell the error better, fewer are better themselves.
    pub(super) natural_replicates: u32,
    /// Whether it knows direct from reflected light to the end.
    pub(super) tells_light_apart: fn(&Method) -> bool,
    /// Refuses what has no meaning with this order, with [`Error::Meaningless`].
    pub(super) check: fn(&Method) -> Result<(), Error>,
    /// A complete solution, ready to be started.
    pub(super) make: fn(&Problem, &Settings) -> Box<dyn CompleteSolution>,
}

/// All orders; the first is the default.
pub const ORDERS: &[Entry] = &[
    stochastic_jacobi::ENTRY,
    stochastic_ray::ENTRY,
    regular::ENTRY,
    breadth_first::ENTRY,
    staged::ENTRY,
    wdrs::ENTRY,
    depth_first::ENTRY,
    auto::ENTRY,
];

impl TableEntry for Entry {
    const KIND: &'static str = "order";
    const TABLE: &'static [Entry] = ORDERS;

    fn name(&self) -> &'static str {
        self.name
    }
}

/// A choice from [`ORDERS`].
pub type OrderName = Choice<Entry>;

impl OrderName {
    pub const AUTO: OrderName = Choice(&auto::ENTRY);
    pub const STOCHASTIC_JACOBI: OrderName = Choice(&stochastic_jacobi::ENTRY);
    pub const STOCHASTIC_RAY: OrderName = Choice(&stochastic_ray::ENTRY);
    pub const BREADTH_FIRST: OrderName = Choice(&breadth_first::ENTRY);
    pub const STAGED: OrderName = Choice(&staged::ENTRY);
    pub const WDRS: OrderName = Choice(&wdrs::ENTRY);
    pub const DEPTH_FIRST: OrderName = Choice(&depth_first::ENTRY);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choice::tests::{assert_every_file_is_in_the_table, assert_named};

    #[test]
    fn every_file_is_in_the_table_and_has_its_name() {
        assert_every_file_is_in_the_table::<Entry>("solvers/monte_carlo/orders", &["mod"]);
        assert_named::<Entry>();
        assert_eq!(OrderName::default(), OrderName::STOCHASTIC_JACOBI);
    }
}
