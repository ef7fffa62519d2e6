//! One complete solution, by whatever order: what the estimate is the mean of.

use super::Experience;
use crate::Problem;
use crate::math::Rgb;
use crate::solution::Balance;
use crate::solvers::Part;
use std::fmt::Debug;
use std::ops::Range;

/// What every order can do. A complete solution starts again in the same memory. Its state is saved with the name of its type,
/// so it is loaded whatever type that is.
#[typetag::serde]
pub trait CompleteSolution: Debug + Send + Sync {
    /// Starts an independent complete solution of about `rays` rays.
    fn restart(&mut self, problem: &Problem, seed: u64, rays: u64, experience: &Experience);

    /// The independent pieces of the running step that have not been absorbed yet; none when the solution is complete.
    fn pieces(&self) -> Option<Range<u64>>;

    /// Computes one piece. Pure.
    fn part(&self, problem: &Problem, piece: u64) -> Part;

    /// Takes in the part of the next piece in order; after the last one, prepares the next step.
    fn absorb(&mut self, problem: &Problem, part: Part, experience: &Experience);

    /// Irradiance [lux] of element `e`: final if the solution is complete, else as far as it has come.
    fn irradiance(&self, problem: &Problem, e: u32) -> Rgb;

    fn rays(&self) -> u64;

    fn balance(&self) -> Balance;

    /// Gives the memory of the elements back, when the last complete solution is done and its irradiance has been taken.
    fn retire(&mut self) {}

    /// Whether a loaded state has a value for each element wherever it needs one. One that was retired has none.
    fn fits(&self, problem: &Problem) -> bool;

    /// What it teaches the next one.
    fn experience(&self) -> Experience;

    /// What is being done, for people.
    fn stage(&self) -> &'static str;
}
