//! How the rays of a complete solution are shared: so that the sum of `A^(3/4) V` over the elements is expected to be least.
//!
//! V is the variance of an element's irradiance, by the models of [`indirect`](super::indirect) and of
//! [`direct light`](crate::solvers::direct_light), whose parameters earlier complete solutions have measured. All shares that
//! are multiples of a tenth are compared, on a sample of the elements: no step downhill can lead astray.

use super::bundles::bundles_of;
use super::indirect::Indirect;
use super::spread::RayFlux;
use crate::Problem;
use crate::solvers::direct_light::Neighbours;
use crate::solvers::monte_carlo::Experience;
use crate::transport::bundle::crossings_per_area;

/// Parts into which the rays are shared.
const PARTS: u32 = 10;
/// Elements that are looked at, about.
const SAMPLE: usize = 100;
/// A ray that looks for a light, and one that gathers, take as long as so many that shoot.
const COST_OF_LOOKING: f64 = 2.0;
const COST_OF_GATHERING: f64 = 2.0;

/// Rays of each phase, or for bundles what costs as much.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Plan {
    /// Shooting direct light, and reflected light.
    pub emission: u64,
    pub reflection: u64,
    pub direct: u64,
    pub bundles: u64,
    pub surplus: u64,
    pub local: u64,
}

/// Parts of the rays, for all of these in turn.
type Parts = [u32; 6];

impl Plan {
    /// All rays shoot, and carry about the same if surfaces reflect `reflected_share` of what is emitted.
    pub fn only_shooting(rays: u64, reflected_share: f64) -> Plan {
        let emission = ((rays as f64 / (1.0 + reflected_share)) as u64).max(1);
        Plan { emission, reflection: rays.saturating_sub(emission), ..Plan::default() }
    }

    /// Some of everything.
    pub fn careful(rays: u64) -> Plan {
        Plan::of_parts(rays, [2, 2, 2, 2, 1, 1])
    }

    fn of_parts(rays: u64, parts: Parts) -> Plan {
        let part = |parts: u32, cost: f64| (rays as f64 * f64::from(parts) / f64::from(PARTS) / cost) as u64;
        let [emission, reflection, direct, bundles, surplus, local] = parts;
        Plan {
            emission: part(emission, 1.0),
            reflection: part(reflection, 1.0),
            direct: part(direct, COST_OF_LOOKING),
            bundles: part(bundles, 1.0),
            surplus: part(surplus, 1.0),
            local: part(local, COST_OF_GATHERING),
        }
    }

    /// What would share the rays that shoot as this plan does.
    pub fn experience(&self) -> Experience {
        Experience { reflected_share: self.reflection as f64 / self.emission.max(1) as f64 }
    }

    /// Flux of the rays that shoot direct and reflected light, of which there is so much `power` [lm].
    pub fn ray_flux(&self, power: [f64; 2]) -> RayFlux {
        [power[0] / self.emission.max(1) as f64, power[1] / self.reflection.max(1) as f64]
    }

    /// The best plan for `rays` rays, where `power` [lm] are emitted and reflected; without `direct`, if only indirect light is
    /// wanted.
    pub fn best(
        problem: &Problem,
        rays: u64,
        power: [f64; 2],
        direct: Option<&Neighbours>,
        indirect: &Indirect,
    ) -> Plan {
        let mesh = &problem.mesh;
        let total_area = mesh.total_area();
        let every = mesh.len().div_ceil(SAMPLE);
        let sample = mesh.elements().step_by(every);
        let areas: Vec<f64> = sample.clone().map(|e| f64::from(mesh.area(e))).collect();
        let share = 1.0 / every as f64;
        let variance_of_direct = |plan: &Plan| {
            let ray_flux = plan.ray_flux(power)[0];
            direct.map_or(0.0, |direct| {
                direct.expected_variance(mesh, sample.clone(), plan.direct as f64 * share, ray_flux)
            })
        };
        // Bundles, and their crossings of a square metre, for each number of parts.
        let along_bundles = |parts| {
            let (bundles, cells) = bundles_of(problem, Plan::of_parts(rays, [0, 0, 0, parts, 0, 0]).bundles as f64);
            (bundles as f64, bundles as f64 * crossings_per_area(problem, cells))
        };
        let along_bundles: Vec<(f64, f64)> = (0..=PARTS).map(along_bundles).collect();
        let variance_of_indirect = |plan: &Plan, (bundles, crossings): (f64, f64)| {
            let surplus = plan.surplus as f64 / total_area;
            let precision = indirect.precision(plan.ray_flux(power), bundles, crossings, surplus);
            precision.expected_variance(areas.iter().copied(), plan.local as f64 * share)
        };
        // Direct light depends on two of the parts only.
        let mut of_direct = vec![None; ((PARTS + 1) * (PARTS + 1)) as usize];
        let mut expected = |parts: &Parts| {
            let plan = Plan::of_parts(rays, *parts);
            let known = &mut of_direct[(parts[0] * (PARTS + 1) + parts[2]) as usize];
            *known.get_or_insert_with(|| variance_of_direct(&plan))
                + variance_of_indirect(&plan, along_bundles[parts[3] as usize])
        };
        let best = shares().map(|parts| (expected(&parts), parts)).min_by(|a, b| a.0.total_cmp(&b.0));
        best.map_or_else(|| Plan::careful(rays), |(_, parts)| Plan::of_parts(rays, parts))
    }
}

/// All ways to share the parts: some for shooting of both kinds, and none for the surplus beyond what bundles gather if they do not.
fn shares() -> impl Iterator<Item = Parts> {
    let up_to = |parts: u32| 0..=parts;
    (1..PARTS).flat_map(move |emission| {
        (1..=PARTS - emission).flat_map(move |reflection| {
            let rest = PARTS - emission - reflection;
            up_to(rest).flat_map(move |direct| {
                let rest = rest - direct;
                up_to(rest).flat_map(move |bundles| {
                    up_to(if bundles > 0 { rest - bundles } else { 0 })
                        .map(move |surplus| [emission, reflection, direct, bundles, surplus, rest - bundles - surplus])
                })
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_ways_to_share_are_tried_once_and_are_whole() {
        let all: Vec<Parts> = shares().collect();
        let is_whole = |parts: &Parts| parts.iter().sum::<u32>() == PARTS && parts[0] > 0 && parts[1] > 0;
        assert!(all.iter().all(is_whole));
        let mut sorted = all.clone();
        sorted.sort_unstable();
        sorted.dedup();
        // With bundles: ten parts in six places, at least one in each of three, C(12, 5). Without: in four places, in two, C(11, 3).
        assert_eq!((all.len(), sorted.len()), (792 + 165, 957));
        let Plan { emission, reflection, direct, bundles, surplus, local } = Plan::of_parts(1000, [1, 2, 2, 3, 1, 1]);
        assert_eq!([emission, reflection, direct, bundles, surplus, local], [100, 200, 100, 300, 100, 50]);
    }
}
