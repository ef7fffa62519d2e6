//! Where a line crosses a surface, and what it meets there from either side.

use crate::Problem;
use crate::geometry::Hit;
use crate::geometry::raster::{Cross, Points};
use crate::mesh::{ElementMesh, Lookup};
use glam::Vec2;

/// What lies at the end of a line, 4 bytes: an element, or a reason why there is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct End(u32);

impl End {
    /// The back of a one-sided surface, which is black.
    pub const BACK_FACE: End = End(u32::MAX);
    /// Nothing: the line leaves the scene.
    pub const ESCAPED: End = End(u32::MAX - 1);

    /// The element, if there is one.
    #[inline]
    pub fn element(self) -> Option<u32> {
        self.is_element().then_some(self.0)
    }

    #[inline]
    pub fn is_element(self) -> bool {
        self.0 < End::ESCAPED.0
    }

    /// Number of the element, or `nobody`, a number beyond those of all elements.
    #[inline]
    pub fn or(self, nobody: u32) -> u32 {
        self.0.min(nobody)
    }
}

/// A crossing of a line with a surface, 12 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Distance along the line [m].
    pub t: f32,
    /// What the line meets there, coming from before.
    pub near: End,
    /// What a line would meet that comes the other way.
    pub far: End,
}

impl Crossing {
    /// The crossing that belongs to `hit`.
    pub fn of(problem: &Problem, hit: &Hit) -> Crossing {
        Met::new(&problem.mesh, hit.triangle, hit.back).crossing(hit.t, hit.uv)
    }
}

/// A triangle as parallel lines meet it.
#[derive(Clone, Copy, Debug)]
pub struct Met<'a> {
    lookup: Lookup<'a>,
    /// For the side that lines meet and the one beyond: all bits if it is the back of two, otherwise none ...
    behind: [u32; 2],
    /// ... and all bits if it is black, otherwise none.
    black: [u32; 2],
}

impl<'a> Met<'a> {
    /// `triangle`, met from behind or from the front.
    #[inline(always)]
    pub fn new(mesh: &'a ElementMesh, triangle: u32, back: bool) -> Met<'a> {
        let lookup = mesh.lookup(triangle);
        let bits = |all: bool| if all { u32::MAX } else { 0 };
        let two_sided = lookup.is_two_sided();
        Met { lookup, behind: [back, !back].map(bits), black: [back && !two_sided, !back && !two_sided].map(bits) }
    }

    /// Its crossing at distance `t` [m] and barycentric coordinates `uv`.
    #[inline]
    pub fn crossing(&self, t: f32, uv: Vec2) -> Crossing {
        self.at(t, self.lookup.front(uv))
    }

    #[inline(always)]
    fn at(&self, t: f32, (front, further): (u32, u32)) -> Crossing {
        let end = |side: usize| End((front + (further & self.behind[side])) | self.black[side]);
        Crossing { t, near: end(0), far: end(1) }
    }
}

impl Cross for ElementMesh {
    type Crossing = Crossing;
    const NONE: Crossing = Crossing { t: 0.0, near: End::ESCAPED, far: End::ESCAPED };

    #[inline(always)]
    fn cross(&self, points: &mut Points, crossings: &mut [Crossing]) {
        let Points { triangles, t, u, v, x, y, patch, front, further } = points;
        for met in *triangles {
            let at = met.chunks();
            let within = [&mut x[at.clone()], &mut y[at.clone()]];
            self.patches_at(met.triangle, [&u[at.clone()], &v[at.clone()]], &mut patch[at], within);
        }
        self.fronts_at(patch, [&mut **x, &mut **y], front, further);
        for met in *triangles {
            let at = met.points.clone();
            let ends = front[at.clone()].iter().zip(&further[at.clone()]);
            let met = Met::new(self, met.triangle, met.back);
            for ((crossing, &t), (&front, &further)) in crossings[at.clone()].iter_mut().zip(&t[at]).zip(ends) {
                *crossing = met.at(t, (front, further));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Resolution;
    use crate::scene::builtin::builtin;

    #[test]
    fn a_crossing_has_the_elements_of_both_sides() {
        for two_sided in [true, false] {
            let mut scene = builtin("cubes").unwrap();
            scene.materials.iter_mut().for_each(|material| material.two_sided = two_sided);
            let problem = Problem::new(scene, Resolution::Elements(1000)).unwrap();
            for (triangle, back) in (0..12).flat_map(|triangle| [(triangle, false), (triangle, true)]) {
                let uv = Vec2::new(0.3, 0.5);
                let crossing = Crossing::of(&problem, &Hit { t: 2.0, triangle, uv, back });
                let on = |back| problem.mesh.at(triangle, uv, back);
                assert_eq!((crossing.t, crossing.near.element(), crossing.far.element()), (2.0, on(back), on(!back)));
                assert_eq!([crossing.near, crossing.far].contains(&End::BACK_FACE), !two_sided);
            }
        }
        assert!(!End::ESCAPED.is_element() && !End::BACK_FACE.is_element());
        assert_eq!([End::ESCAPED, End::BACK_FACE, End(7)].map(|end| end.or(9)), [9, 9, 7]);
    }
}
