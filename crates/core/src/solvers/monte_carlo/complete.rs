//! One complete solution, by whatever order: what the estimate is the mean of.

use super::axes::{Lines, Order};
use super::relaxation::Relaxation;
use super::walks::Walks;
use super::wdrs::Wdrs;
use super::{Experience, Settings};
use crate::Problem;
use crate::math::Rgb;
use crate::solution::Balance;
use crate::solvers::Part;
use std::ops::Range;

/// What every order can do. A complete solution starts again in the same memory.
pub trait CompleteSolution {
    /// Starts an independent complete solution of about `rays` rays.
    fn restart(&mut self, problem: &Problem, seed: u64, rays: u64, experience: &Experience);

    /// The independent pieces of the running step; none when the solution is complete.
    fn pieces(&self) -> Option<Range<u64>>;

    /// Computes one piece. Pure.
    fn part(&self, problem: &Problem, piece: u64) -> Part;

    /// Takes in the part of the next piece in order; after the last one, prepares the next step.
    fn absorb(&mut self, problem: &Problem, part: Part, experience: &Experience);

    /// Irradiance [lux] of element `e`: final if the solution is complete, else as far as it has come.
    fn irradiance(&self, problem: &Problem, e: u32) -> Rgb;

    fn rays(&self) -> u64;

    fn balance(&self) -> Balance;

    /// What it teaches the next one.
    fn experience(&self) -> Experience;

    /// What is being done, for people.
    fn stage(&self) -> &'static str;
}

/// The orders, each with its state.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub enum Complete {
    Relaxation(Box<Relaxation>),
    Wdrs(Box<Wdrs>),
    Walks(Box<Walks>),
}

impl Complete {
    /// The order that `settings` ask for, ready to be started.
    pub fn new(problem: &Problem, settings: &Settings) -> Complete {
        let method = settings.method;
        match (method.order, method.lines) {
            (Order::DepthFirst, Lines::Local) => Complete::Walks(Box::new(Walks::new(problem, method))),
            (Order::Wdrs, _) => Complete::Wdrs(Box::new(Wdrs::new(problem, settings))),
            _ => Complete::Relaxation(Box::new(Relaxation::new(problem, settings))),
        }
    }

    pub fn as_ref(&self) -> &dyn CompleteSolution {
        match self {
            Complete::Relaxation(relaxation) => relaxation.as_ref(),
            Complete::Wdrs(wdrs) => wdrs.as_ref(),
            Complete::Walks(walks) => walks.as_ref(),
        }
    }

    pub fn as_mut(&mut self) -> &mut dyn CompleteSolution {
        match self {
            Complete::Relaxation(relaxation) => relaxation.as_mut(),
            Complete::Wdrs(wdrs) => wdrs.as_mut(),
            Complete::Walks(walks) => walks.as_mut(),
        }
    }
}
