//! What the axes of a series mean.

use crate::Error;
use crate::spec::Series;
use isolux_core::sampling::address::Address;
use isolux_core::solvers::monte_carlo::Method;
use isolux_core::solvers::monte_carlo::axes::{Axis, Direction, Estimator, FirstShot, Lines, Survival, Walk};

/// What a series may tell its measure besides.
const OF_MEASURES: [&str; 5] = ["estimate", "rays", "factors", "worst-tenth", "of"];

impl Series {
    /// What it says of `axis`, if anything.
    pub fn axis(&self, axis: &str) -> Option<&str> {
        self.axes.get(axis).map(String::as_str)
    }

    /// Whether it says `value` of `axis`, the only thing that can be said.
    ///
    /// # Errors
    /// If it says something else.
    pub fn says(&self, axis: &str, value: &str) -> Result<bool, Error> {
        match self.axis(axis) {
            Some(other) if other != value => Err(self.unknown(axis, other)),
            said => Ok(said.is_some()),
        }
    }

    /// The number that it says of `axis`.
    ///
    /// # Errors
    /// If it says none.
    pub fn number(&self, axis: &str) -> Result<u32, Error> {
        let text = self.axis(axis).unwrap_or_default();
        text.parse().map_err(|_| self.unknown(axis, text))
    }

    /// The method of Monte Carlo that it names: `method`, changed by the axes.
    ///
    /// # Errors
    /// For a name or a combination without meaning.
    pub fn method(&self) -> Result<Method, Error> {
        let mut method = Method::named(self.axis("method").unwrap_or_default())?;
        for (axis, value) in &self.axes {
            match axis.as_str() {
                "method" | "address" => {}
                axis if OF_MEASURES.contains(&axis) => {}
                "sequence" => method.sequence = value.parse()?,
                "order" => method.order = value.parse()?,
                Lines::NAME => method.lines = self.member(value)?,
                Walk::NAME => method.walk = self.member(value)?,
                Estimator::NAME => method.estimator = self.member(value)?,
                Direction::NAME => method.direction = self.member(value)?,
                Survival::NAME => method.survival = self.member(value)?,
                FirstShot::NAME => method.first_shot = self.member(value)?,
                _ => return Err(self.unknown("axis", axis)),
            }
        }
        method.address = match self.axis("address") {
            Some(name) => Address::ALL
                .into_iter()
                .find(|address| address.name() == name)
                .ok_or_else(|| self.unknown("address", name))?,
            None => method.natural_address(),
        };
        method.check()?;
        Ok(method)
    }

    fn member<A: Axis>(&self, name: &str) -> Result<A, Error> {
        A::named(name).ok_or_else(|| self.unknown(A::NAME, name))
    }

    fn unknown(&self, what: &str, name: &str) -> Error {
        Error::Spec { study: self.name.clone(), what: format!("there is no {what} '{name}'") }
    }
}
