//! Links between clusters, refined until none carries more power than allowed.
//!
//! A link exchanges `A_p F_pq`: between two elements that of the contour integrals, between larger clusters the mean of `cos
//! cos vis / (pi r²)` over 16 pairs of points. It is refined, by halving its larger end, if the power it would carry
//! unblocked, were all points as well placed as the best pair, is beyond the limit; where the view is partly blocked the
//! limit is a quarter.

use super::clusters::{Cluster, SAMPLES};
use crate::Problem;
use crate::form_factors::Contour;
use crate::geometry::Ray;
use std::f64::consts::PI;

/// Where the view is partly blocked, links may carry this share of the power.
const PARTLY_BLOCKED: f64 = 0.25;
/// A ray stops this share of its length before its target.
const SHORTER: f32 = 1e-4;

/// Two clusters that exchange light.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Link {
    pub ends: [u32; 2],
    /// Exchange area `A_p F_pq` [m²]; NaN while it is unknown.
    pub exchange: f64,
}

/// What refinement looks at.
pub struct Refinement<'a> {
    pub problem: &'a Problem,
    pub contour: &'a Contour,
    pub clusters: &'a [Cluster],
    /// Luminous radiosity [lm/m²] of each cluster.
    pub radiosity: &'a [f64],
    /// Most power [lm] of a link.
    pub limit: f64,
}

impl Refinement<'_> {
    /// `link`, or the links it is refined to, appended to `links`, which never get more than `most`.
    pub fn refine(&self, link: Link, most: usize, links: &mut Vec<Link>) {
        let [p, q] = link.ends.map(|end| &self.clusters[end as usize]);
        let unblocked = unblocked(p, q);
        if unblocked <= 0.0 && (p.halves, q.halves) != (None, None) {
            // Neither faces the other, or so little that no pair of points does.
            return;
        }
        let exchange = if link.exchange.is_nan() { self.exchange(p, q, unblocked) } else { link.exchange };
        let brighter = link.ends.iter().map(|&end| self.radiosity[end as usize]).fold(0.0, f64::max);
        let partly = exchange > 0.0 && exchange < (1.0 - 1e-6) * unblocked;
        let limit = if partly { PARTLY_BLOCKED * self.limit } else { self.limit };
        let divided = match (p.halves, q.halves) {
            _ if strongest(p, q) * brighter <= limit || links.len() + 2 > most => None,
            (Some(halves), None) => Some((halves, 1)),
            (None, Some(halves)) => Some((halves, 0)),
            (Some(of_p), Some(of_q)) => Some(if p.area >= q.area { (of_p, 1) } else { (of_q, 0) }),
            (None, None) => None,
        };
        match divided {
            None if exchange.is_nan() => {}
            None => links.push(Link { exchange, ..link }),
            Some((halves, other)) => {
                for half in halves {
                    self.refine(Link { ends: [half, link.ends[other]], exchange: f64::NAN }, most, links);
                }
            }
        }
    }

    /// Exchange area [m²] of two clusters.
    fn exchange(&self, p: &Cluster, q: &Cluster, unblocked: f64) -> f64 {
        if (p.halves, q.halves) == (None, None) {
            return self.contour.exchange(self.problem, p.element, q.element);
        }
        let lift = f64::from(self.problem.geometry.lift());
        let (mut rays, mut reach, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        for x in p.samples {
            for y in q.samples {
                let origin = x + p.normal * lift;
                let direction = (y - origin).normalize_or_zero().as_vec3().normalize_or_zero();
                rays.push(Ray { origin: origin.as_vec3(), direction, from: p.triangle });
                reach.push(y.distance(origin) as f32 * (1.0 - SHORTER));
                weights.push(kernel(p, x, q, y));
            }
        }
        let mut blocked = [false; SAMPLES * SAMPLES];
        self.problem.geometry.any(&rays, &reach, &mut blocked);
        let clear: f64 = weights.iter().zip(blocked).filter(|(_, blocked)| !blocked).map(|(weight, _)| weight).sum();
        unblocked * clear / weights.iter().sum::<f64>()
    }
}

/// Exchange area [m²] if nothing were between: no larger than either.
fn unblocked(p: &Cluster, q: &Cluster) -> f64 {
    let mean = kernels(p, q).sum::<f64>() / (SAMPLES * SAMPLES) as f64;
    (p.area * q.area * mean).min(p.area).min(q.area)
}

/// As [`unblocked`], were all points as well placed as the best pair of them.
fn strongest(p: &Cluster, q: &Cluster) -> f64 {
    (p.area * q.area * kernels(p, q).fold(0.0, f64::max)).min(p.area).min(q.area)
}

fn kernels<'a>(p: &'a Cluster, q: &'a Cluster) -> impl Iterator<Item = f64> + 'a {
    p.samples.iter().flat_map(move |&x| q.samples.iter().map(move |&y| kernel(p, x, q, y)))
}

/// `cos cos / (pi r²)` [1/m²] of two points.
fn kernel(p: &Cluster, x: glam::DVec3, q: &Cluster, y: glam::DVec3) -> f64 {
    let way = y - x;
    let (leaving, arriving) = (p.normal.dot(way).max(0.0), (-q.normal.dot(way)).max(0.0));
    if leaving * arriving > 0.0 { leaving * arriving / (PI * way.length_squared().powi(2)) } else { 0.0 }
}
