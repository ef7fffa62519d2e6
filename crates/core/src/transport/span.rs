//! Spans: what a line that crosses the whole scene says about who sees whom.
//!
//! Consecutive crossings of a line see each other along it: the side of the first that looks forward, and the side of the
//! second that looks back. Each such span is one local line from either end to the other, so counts of spans are reciprocal,
//! `N_ij = N_ji`, by construction. Spans into the open and to black back faces are spans too: what leaves an element along
//! them is lost, and the balance must know.
//!
//! *Coincident faces.* Crossings of a line that follow each other within [`lift`](crate::geometry::Geometry::lift), the
//! distance by which rays are lifted off their surface, are one crossing. From either side the line meets the one that a ray
//! would: the nearest, of equally near ones that with the lowest number. The others are covered: nothing sees them, and they
//! see nothing. So faces that coincide do not see each other, and an edge that two triangles share is met once.

use super::{Crossing, End};

/// Two ends that see each other, at least one of them an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Span {
    /// Whence the line comes.
    pub from: End,
    /// Where it goes.
    pub to: End,
}

/// Hands the spans of a line to `each`, in order. `crossings` are all its crossings, in order, those at equal distance in the
/// order of their triangles. The line comes from the open and goes to the open.
#[inline]
pub fn spans(lift: f32, crossings: impl IntoIterator<Item = Crossing>, mut each: impl FnMut(Span)) {
    let mut hand = |from: End, to: End| {
        if from.is_element() || to.is_element() {
            each(Span { from, to });
        }
    };
    // The crossing last met, and which of those within the lift of each other a line from the other side would meet.
    let mut last = f32::NEG_INFINITY;
    let mut seen_from_beyond = Crossing { t: last, near: End::ESCAPED, far: End::ESCAPED };
    for next in crossings {
        if next.t - last > lift {
            hand(seen_from_beyond.far, next.near);
            seen_from_beyond = next;
        } else if next.t > seen_from_beyond.t {
            seen_from_beyond = next;
        }
        last = next.t;
    }
    hand(seen_from_beyond.far, End::ESCAPED);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Problem;
    use crate::geometry::Hit;
    use crate::math::Rgb;
    use crate::mesh::Resolution;
    use crate::scene::Material;
    use crate::scene::builtin::shapes::Builder;
    use glam::{Vec2, Vec3};

    /// Triangles 0 and 1 one-sided, 2 and 3 two-sided (elements 2, 3 on their fronts and backs in some order).
    fn problem() -> Problem {
        let mut builder = Builder::new("four");
        let one_sided = builder.material(Material::diffuse("one", Rgb::grey(0.5)));
        let two_sided = Material { two_sided: true, ..Material::diffuse("two", Rgb::grey(0.5)) };
        let two_sided = builder.material(two_sided);
        for (k, material) in [one_sided, one_sided, two_sided, two_sided].into_iter().enumerate() {
            builder.object("triangle", material);
            builder.polygon(&[Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| p + Vec3::Z * k as f32));
        }
        Problem::new(builder.finish(), Resolution::Elements(1)).unwrap()
    }

    fn hit(t: f32, triangle: u32, back: bool) -> Hit {
        Hit { t, triangle, uv: Vec2::splat(0.25), back }
    }

    /// The ends of all spans: a triangle and whether its back, or why there is none.
    fn found(problem: &Problem, crossings: &[Hit]) -> Vec<[Result<(u32, bool), &'static str>; 2]> {
        let end = |end: End| match end.element() {
            Some(element) => {
                let place = problem.mesh.place(element);
                Ok((place.triangle, place.back))
            }
            None => Err(if end == End::ESCAPED { "open" } else { "black" }),
        };
        let mut found = Vec::new();
        let crossings = crossings.iter().map(|hit| Crossing::of(problem, hit));
        spans(problem.geometry.lift(), crossings, |span| found.push([end(span.from), end(span.to)]));
        found
    }

    #[test]
    fn consecutive_sides_see_each_other() {
        let problem = problem();
        // From the open onto a front, out of its back onto a two-sided back, out of its front, out of a one-sided front.
        let crossings = [hit(1.0, 0, false), hit(2.0, 2, true), hit(3.0, 1, true)];
        let expected = vec![
            [Err("open"), Ok((0, false))],
            [Err("black"), Ok((2, true))],
            [Ok((2, false)), Err("black")],
            [Ok((1, false)), Err("open")],
        ];
        assert_eq!(found(&problem, &crossings), expected);
        assert!(found(&problem, &[]).is_empty());
        // The inside of a solid, and the space behind a wall, concern nobody.
        assert!(found(&problem, &[hit(1.0, 0, true)])[..] == [[Ok((0, false)), Err("open")]]);
    }

    #[test]
    fn coincident_faces_are_met_as_rays_meet_them() {
        let problem = problem();
        // Both two-sided: the lower number is met from both sides, and neither sees the other.
        let expected = vec![[Err("open"), Ok((2, false))], [Ok((2, true)), Err("open")]];
        assert_eq!(found(&problem, &[hit(1.0, 2, false), hit(1.0, 3, false)]), expected);
        // Not quite coincident: each is met from its side.
        let lift = problem.geometry.lift();
        let expected = vec![[Err("open"), Ok((3, false))], [Ok((2, true)), Err("open")]];
        assert_eq!(found(&problem, &[hit(1.0, 3, false), hit(1.0 + 0.5 * lift, 2, false)]), expected);
        // Farther apart than the lift they see each other.
        assert_eq!(found(&problem, &[hit(1.0, 3, false), hit(1.0 + 3.0 * lift, 2, false)]).len(), 3);
    }

    #[test]
    fn the_line_back_has_the_same_spans() {
        let problem = problem();
        let crossings = [
            hit(1.0, 2, true),
            hit(1.0, 3, false),
            hit(2.0, 0, true),
            hit(3.5, 1, false),
            hit(5.0, 0, false),
            hit(5.0, 2, true),
            hit(6.0, 1, true),
        ];
        let mut back: Vec<Hit> = crossings.iter().map(|h| Hit { t: 9.0 - h.t, back: !h.back, ..*h }).collect();
        back.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.triangle.cmp(&b.triangle)));
        let mut reversed = found(&problem, &back);
        reversed.reverse();
        reversed.iter_mut().for_each(|span| span.reverse());
        assert_eq!(reversed, found(&problem, &crossings));
    }
}
