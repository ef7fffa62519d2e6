//! The axes of Monte Carlo radiosity: every algorithm of the survey is a choice on each (Bekaert, Cools & Willems 1999).
//!
//! Two axes are open and have tables of their own: the sample numbers, [`crate::sampling::SEQUENCES`], and the order in which
//! landed light is shot again, [`super::orders::ORDERS`]. The address is in [`crate::sampling::address`].

/// An axis with its members.
pub trait Axis: Copy + Sized + 'static {
    /// As the command line calls it.
    const NAME: &'static str;
    const ALL: &'static [Self];

    fn name(self) -> &'static str;

    /// The member called `name`.
    fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|member| member.name() == name)
    }
}

macro_rules! axis {
    ($(#[$doc:meta])* $type:ident, $axis:literal: $($(#[$of_member:meta])* $member:ident = $name:literal),+ $(,)?) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        pub enum $type { $($(#[$of_member])* $member),+ }

        impl Axis for $type {
            const NAME: &'static str = $axis;
            const ALL: &'static [$type] = &[$($type::$member),+];

            fn name(self) -> &'static str {
                match self { $($type::$member => $name),+ }
            }
        }
    };
}

axis! {
    /// Light landed at a point: where does it leave?
    Walk, "walk":
    /// From anywhere on the element: the radiosity system with constant elements.
    Discrete = "discrete",
    /// From the point where it landed: the radiosity equation (Pattanaik & Mudur 1992); only the tally is discrete.
    Continuous = "continuous",
}

axis! {
    /// Which lines join surfaces?
    Lines, "lines":
    /// Lines from a point of an element in a cosine-distributed direction, to the nearest surface.
    Local = "local",
    /// Lines across the whole scene, chosen without regard to any surface (Sbert 1993).
    Global = "global",
    /// Parallel global lines on a regular grid (Sbert 1997; Szirmay-Kalos & Purgathofer 1998).
    Bundle = "bundle",
}

axis! {
    /// Which visits of a random walk score?
    Estimator, "estimator":
    /// All.
    Collision = "collision",
    /// Those that the walk survives.
    Survival = "survival",
    /// The one where it ends.
    Absorption = "absorption",
}

axis! {
    /// In which direction does a random walk follow the light?
    Direction, "direction":
    /// From the lights, scoring on the elements visited.
    Shooting = "shooting",
    /// From the element to be measured, scoring what the elements visited emit.
    Gathering = "gathering",
}

axis! {
    /// Which particles of a random walk survive a reflection?
    Survival, "survival":
    /// Each by a random number, with the probability of the reflectivity.
    Random = "random",
    /// The first of them: a fraction of the mean reflectivity (Keller 1996).
    Fraction = "fraction",
}

axis! {
    /// How does the emitted light start where lines are global?
    FirstShot, "first-shot":
    /// By local lines, which can be aimed at small lights; what they light is what global lines take up.
    Local = "local",
    /// By the lines of the method.
    Same = "same",
}
