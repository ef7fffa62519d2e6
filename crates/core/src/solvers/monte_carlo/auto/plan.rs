//! How the rays of a complete solution are shared: so that the sum of `sqrt(A) V` over the elements is expected to be least.
//!
//! V is the variance of an element's irradiance, by the models of [`indirect`](super::indirect) and of
//! [`direct light`](crate::solvers::direct_light), whose parameters earlier complete solutions have measured. All shares that
//! are multiples of a tenth are compared, on a sample of the elements: no step downhill can lead astray.

use super::bundles::bundles_of;
use super::indirect::Indirect;
use crate::Problem;
use crate::solvers::direct_light::Neighbours;
use crate::transport::bundle::crossings_per_area;

/// Parts into which the rays are shared.
const PARTS: u32 = 10;
/// Elements that are looked at, about.
const SAMPLE: usize = 400;
/// A ray that looks for a light, and one that gathers, take as long as so many that shoot.
const COST_OF_LOOKING: f64 = 2.0;
const COST_OF_GATHERING: f64 = 2.0;

/// Rays of each phase, or for bundles what costs as much.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Plan {
    pub shooting: u64,
    pub direct: u64,
    pub bundles: u64,
    pub local: u64,
}

impl Plan {
    pub fn only_shooting(rays: u64) -> Plan {
        Plan { shooting: rays, ..Plan::default() }
    }

    /// Some of everything.
    pub fn careful(rays: u64) -> Plan {
        Plan::of_parts(rays, [4, 3, 2, 1])
    }

    /// So many parts for shooting, direct light, bundles and local lines.
    fn of_parts(rays: u64, parts: [u32; 4]) -> Plan {
        let [shooting, direct, bundles, local] = parts.map(|part| rays as f64 * f64::from(part) / f64::from(PARTS));
        Plan {
            shooting: shooting as u64,
            direct: (direct / COST_OF_LOOKING) as u64,
            bundles: bundles as u64,
            local: (local / COST_OF_GATHERING) as u64,
        }
    }

    /// The best plan for `rays` rays, where all light that is shot is `power` [lm]; without `direct`, if only indirect light is wanted.
    pub fn best(problem: &Problem, rays: u64, power: f64, direct: Option<&Neighbours>, indirect: &Indirect) -> Plan {
        let mesh = &problem.mesh;
        let every = mesh.len().div_ceil(SAMPLE);
        let sample = mesh.elements().step_by(every);
        let areas = sample.clone().map(|e| f64::from(mesh.area(e)));
        let share = 1.0 / every as f64;
        let variance_of_direct = |plan: &Plan, ray_flux: f64| {
            direct.map_or(0.0, |direct| {
                direct.expected_variance(mesh, sample.clone(), plan.direct as f64 * share, ray_flux)
            })
        };
        let variance_of_indirect = |plan: &Plan, ray_flux: f64| {
            let (bundles, cells) = bundles_of(problem, plan.bundles as f64);
            let crossings = bundles as f64 * crossings_per_area(problem, cells);
            let precision = indirect.precision(ray_flux, bundles as f64, crossings);
            precision.expected_variance(areas.clone(), plan.local as f64 * share)
        };
        let expected = |parts: &[u32; 4]| {
            let plan = Plan::of_parts(rays, *parts);
            let ray_flux = power / plan.shooting as f64;
            variance_of_direct(&plan, ray_flux) + variance_of_indirect(&plan, ray_flux)
        };
        let best = shares().map(|parts| (expected(&parts), parts)).min_by(|a, b| a.0.total_cmp(&b.0));
        best.map_or_else(|| Plan::careful(rays), |(_, parts)| Plan::of_parts(rays, parts))
    }
}

/// All ways to share the parts, with at least one for shooting.
fn shares() -> impl Iterator<Item = [u32; 4]> {
    let rest = |shooting: u32| PARTS - shooting;
    (1..=PARTS).flat_map(move |shooting| {
        (0..=rest(shooting)).flat_map(move |direct| {
            (0..=rest(shooting) - direct)
                .map(move |bundles| [shooting, direct, bundles, rest(shooting) - direct - bundles])
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_ways_to_share_are_tried_once_and_are_whole() {
        let all: Vec<[u32; 4]> = shares().collect();
        assert!(all.iter().all(|parts| parts.iter().sum::<u32>() == PARTS && parts[0] > 0));
        let mut sorted = all.clone();
        sorted.sort_unstable();
        sorted.dedup();
        // Ten parts in four places, but for those without shooting: C(13, 3) - C(12, 2).
        assert_eq!((all.len(), sorted.len()), (220, 220));
        let Plan { shooting, direct, bundles, local } = Plan::of_parts(1000, [4, 3, 2, 1]);
        assert_eq!([shooting, direct, bundles, local], [400, 150, 200, 50]);
    }
}
