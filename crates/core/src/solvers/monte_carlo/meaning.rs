//! Which combinations of the axes have a meaning. What has none with a certain order, the order refuses itself.

use super::axes::{Direction, Estimator, FirstShot, Lines, Survival, Walk};
use super::{LightPart, Method};
use crate::Error;
use crate::sampling::address::Address;
use crate::scene::Scene;

impl Method {
    /// Refuses what has no meaning.
    ///
    /// # Errors
    /// [`Error::Meaningless`] says why, and what is nearest.
    pub fn check(&self) -> Result<(), Error> {
        let refuse = |what, nearest| Err(Error::Meaningless { what, nearest });
        let local = self.lines == Lines::Local;
        if self.walk == Walk::Continuous && !local {
            return refuse(
                "a global line is chosen without regard to where light has landed, so light cannot go on from there",
                "--walk discrete",
            );
        }
        if self.walk == Walk::Continuous && self.pools() {
            return refuse(
                "light of many lines is pooled on an element, so it has no point from which to go on",
                "--order depth-first, or --leaving where-landed",
            );
        }
        (self.order.entry().check)(self)?;
        if local && self.first_shot == FirstShot::Same {
            return refuse(
                "local lines shoot emitted light by themselves, so there is no first shot",
                "--lines global",
            );
        }
        if self.direction == Direction::Gathering && self.pools() {
            return refuse("only a random walk along local lines has a direction", "--order depth-first --lines local");
        }
        if self.estimator != Estimator::Collision && self.pools() {
            return refuse("only a random walk along local lines has estimators", "--order depth-first --lines local");
        }
        self.check_survival()?;
        self.check_address()
    }

    fn check_survival(&self) -> Result<(), Error> {
        let refuse = |what, nearest| Err(Error::Meaningless { what, nearest });
        if self.survival == Survival::Fraction {
            if self.pools() || self.direction == Direction::Gathering {
                return refuse("only particles that shoot can go on in a fraction", "--method keller");
            }
            if self.address != Address::PerParticle {
                return refuse(
                    "the first fraction of the particles goes on, so a path belongs to its particle",
                    "--address per-particle",
                );
            }
            if self.estimator != Estimator::Collision {
                return refuse(
                    "without a random end there is nothing to survive or to be absorbed by",
                    "--estimator collision",
                );
            }
        }
        Ok(())
    }

    fn check_address(&self) -> Result<(), Error> {
        let refuse = |what, nearest| Err(Error::Meaningless { what, nearest });
        match self.address {
            Address::PerParticle if self.pools() => refuse(
                "rays of pooled light belong to elements or iterations, not to particles",
                "--address per-iteration",
            ),
            Address::PerIteration if !self.pools() => {
                refuse("a random walk has no iterations", "--address per-particle, or per-element if it is discrete")
            }
            Address::PerElement if self.lines != Lines::Local => {
                refuse("a global line belongs to no element", "--address per-iteration")
            }
            Address::PerElement if self.walk == Walk::Continuous => {
                refuse("a continuous walk goes on from points, which own no sequence", "--address per-particle")
            }
            _ => Ok(()),
        }
    }

    /// Refuses a part of the light that the method cannot tell from the rest.
    ///
    /// # Errors
    /// [`Error::Meaningless`].
    pub fn check_light(&self, light: LightPart) -> Result<(), Error> {
        if light == LightPart::Indirect && !(self.order.entry().tells_light_apart)(self) {
            let what = "direct and reflected light are added up as they land, and cannot be told apart afterwards";
            return Err(Error::Meaningless { what, nearest: "--method stochastic-jacobi" });
        }
        Ok(())
    }

    /// Refuses what has no meaning in `scene`.
    ///
    /// # Errors
    /// [`Error::Meaningless`].
    pub fn check_scene(&self, scene: &Scene) -> Result<(), Error> {
        if self.direction == Direction::Gathering && !scene.lights.is_empty() {
            let what = "no line that is gathered meets a light without extent";
            return Err(Error::Meaningless { what, nearest: "--direction shooting" });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solvers::monte_carlo::METHODS;
    use crate::solvers::monte_carlo::axes::Axis;
    use crate::solvers::monte_carlo::method::STOCHASTIC_JACOBI;
    use crate::solvers::monte_carlo::orders::OrderName;

    #[test]
    fn every_named_method_has_a_meaning_and_its_natural_address() {
        for named in METHODS {
            assert_eq!(named.method.check(), Ok(()), "{}", named.name);
            assert_eq!(named.method.address, named.method.natural_address(), "{}", named.name);
            assert_eq!(named.method.name(), named.name);
        }
    }

    #[test]
    fn whoever_adds_all_light_up_is_not_asked_for_a_part_of_it() {
        let refused: Vec<_> =
            METHODS.iter().filter(|named| named.method.check_light(LightPart::Indirect).is_err()).collect();
        let names: Vec<_> = refused.iter().map(|named| named.name).collect();
        assert_eq!(names, ["wdrs", "particle-tracing", "random-walk", "keller"]);
        let multipath = Method::named("multipath").unwrap();
        let same = Method { first_shot: FirstShot::Same, ..multipath };
        assert_eq!(multipath.check_light(LightPart::Indirect), Ok(()));
        let text = same.check_light(LightPart::Indirect).unwrap_err().to_string();
        assert!(text.contains("cannot be told apart") && text.contains("nearest is --method"), "{text}");
        assert!(METHODS.iter().all(|named| named.method.check_light(LightPart::All).is_ok()));
    }

    #[test]
    fn what_is_refused_says_why_and_what_is_nearest() {
        for &walk in Walk::ALL {
            for &lines in Lines::ALL {
                for order in OrderName::all() {
                    let method = Method { walk, lines, order, ..STOCHASTIC_JACOBI };
                    let method = Method { address: method.natural_address(), ..method };
                    let refused = method.check().map_err(|error| error.to_string()).err();
                    if let Some(text) = &refused {
                        assert!(text.contains("has no meaning") && text.contains("nearest is --"), "{text}");
                    }
                    // A continuous walk goes along local lines, particle by particle; what else is refused, the orders refuse.
                    let meaningless = walk == Walk::Continuous && (method.pools() || lines != Lines::Local);
                    let by_order = (order.entry().check)(&method).is_err();
                    assert_eq!(refused.is_some(), meaningless || by_order, "{method:?}");
                }
            }
        }
    }
}
