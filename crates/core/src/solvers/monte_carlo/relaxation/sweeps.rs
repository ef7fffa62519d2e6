//! The sweeps of one complete solution: one, or several.
//!
//! Each sweep has twice the rays of the one before and is a solution of its own; the estimate is their mean, weighted with
//! their rays (Feda & Purgathofer 1993).

use crate::math::Rgb;
use crate::solution::Balance;

/// What the finished sweeps of a complete solution gave.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Sweeps {
    count: u32,
    done: u32,
    /// Rays of the finished sweeps.
    pub rays_before: u64,
    /// Flux [lm] on every element, weighted with the sweeps' shares of the rays; empty if there is one sweep only.
    flux: Vec<Rgb>,
    /// The balances, so weighted.
    balance: Balance,
}

impl Sweeps {
    /// So many sweeps over so many elements.
    pub fn new(count: u32, elements: usize) -> Sweeps {
        let flux = vec![Rgb::BLACK; if count > 1 { elements } else { 0 }];
        Sweeps { count, done: 0, rays_before: 0, flux, balance: Balance::default() }
    }

    pub fn reset(&mut self) {
        (self.done, self.rays_before) = (0, 0);
        self.flux.fill(Rgb::BLACK);
        self.balance = Balance::default();
    }

    /// Whether there are sums for so many elements, if any are needed.
    pub fn fits(&self, elements: usize) -> bool {
        self.count > 0 && self.flux.len() == if self.count > 1 { elements } else { 0 }
    }

    /// Share of the complete solution's rays that the running sweep has.
    pub fn share(&self) -> f64 {
        f64::from(1u32 << self.done.min(self.count - 1)) / f64::from((1u32 << self.count) - 1)
    }

    /// Takes in a finished sweep, which brought `flux(e)` [lm] to element e; whether another one follows.
    pub fn close(&mut self, flux: impl Fn(u32) -> Rgb, balance: Balance, rays: u64) -> bool {
        if self.count == 1 {
            return false;
        }
        let share = self.share();
        self.flux.iter_mut().zip(0..).for_each(|(sum, e)| *sum += flux(e) * share as f32);
        self.balance = self.balance + balance / (1.0 / share);
        self.rays_before = rays;
        self.done += 1;
        self.done < self.count
    }

    /// Flux [lm] on element `e`, on which the running sweep has brought `now`: of all sweeps if they are `complete`, else of the
    /// finished ones, or of the running one if it is the first.
    pub fn flux(&self, e: u32, now: Rgb, complete: bool) -> Rgb {
        match self.flux.get(e as usize) {
            Some(&flux) if complete => flux,
            Some(&flux) if self.done > 0 => flux / self.share_done(),
            _ => now,
        }
    }

    /// The balance that belongs to [`Sweeps::flux`].
    pub fn balance(&self, now: Balance) -> Balance {
        if self.done == 0 { now } else { self.balance / f64::from(self.share_done()) }
    }

    fn share_done(&self) -> f32 {
        ((1u32 << self.done) - 1) as f32 / ((1u32 << self.count) - 1) as f32
    }
}
