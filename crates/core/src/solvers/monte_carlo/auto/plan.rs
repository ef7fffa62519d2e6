//! How the rays of a complete solution are shared: so that the sum of `A^(1/2) V` over the elements is expected to be least.
//!
//! V is the variance of an element's irradiance, by the models of [`indirect`](super::indirect) and of
//! [`direct light`](crate::solvers::direct_light), whose parameters earlier complete solutions have measured. All shares that
//! are multiples of a tenth are compared, on a sample of the elements, so that no step downhill can lead astray. From the best one
//! it then goes downhill, in steps of a twentieth and of a fortieth.

use super::bundles::bundles_of;
use super::indirect::Indirect;
use super::spread::RayFlux;
use crate::Problem;
use crate::solvers::direct_light::Neighbours;
use crate::solvers::monte_carlo::Experience;
use crate::transport::bundle::crossings_per_area;

/// Parts into which the rays are shared; a tenth of them are [`COARSE`].
const PARTS: u32 = 40;
const COARSE: u32 = PARTS / 10;
/// Parts by which the best of all coarse ways is made better.
const STEPS: [u32; 2] = [COARSE / 2, COARSE / 4];
/// Elements that are looked at, about.
const SAMPLE: usize = 400;
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
        let mut least = |ways: &mut dyn Iterator<Item = Parts>| {
            ways.map(|parts| (expected(&parts), parts)).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::NAN, EQUAL))
        };
        let mut best = least(&mut coarse_shares());
        for step in STEPS {
            loop {
                let better = least(&mut neighbours(best.1, step));
                if better.0 >= best.0 || better.0.is_nan() {
                    break;
                }
                best = better;
            }
        }
        Plan::of_parts(rays, best.1)
    }
}

/// Some of everything.
const EQUAL: Parts = [2 * COARSE, 2 * COARSE, 2 * COARSE, 2 * COARSE, COARSE, COARSE];

/// Whether rays can be shared so: some for shooting of both kinds, and none for the surplus beyond what bundles gather if they do not.
fn is_possible([emission, reflection, _, bundles, surplus, _]: &Parts) -> bool {
    *emission > 0 && *reflection > 0 && (*bundles > 0 || *surplus == 0)
}

/// All possible ways to share tenths.
fn coarse_shares() -> impl Iterator<Item = Parts> {
    let up_to = |parts: u32| (0..=parts).step_by(COARSE as usize);
    up_to(PARTS)
        .flat_map(move |emission| {
            up_to(PARTS - emission).flat_map(move |reflection| {
                let rest = PARTS - emission - reflection;
                up_to(rest).flat_map(move |direct| {
                    let rest = rest - direct;
                    up_to(rest).flat_map(move |bundles| {
                        let rest = rest - bundles;
                        up_to(rest).map(move |surplus| [emission, reflection, direct, bundles, surplus, rest - surplus])
                    })
                })
            })
        })
        .filter(is_possible)
}

/// All possible ways in which `step` of the `parts` go from one purpose to another.
fn neighbours(parts: Parts, step: u32) -> impl Iterator<Item = Parts> {
    let pairs = (0..parts.len()).flat_map(move |from| (0..parts.len()).map(move |to| (from, to)));
    let moved = move |(from, to): (usize, usize)| {
        let mut moved = parts;
        moved[from] = moved[from].checked_sub(step)?;
        moved[to] += step;
        (from != to).then_some(moved)
    };
    pairs.filter_map(moved).filter(is_possible)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn are_whole_and_different(ways: &[Parts]) -> bool {
        let mut sorted = ways.to_vec();
        sorted.sort_unstable();
        sorted.dedup();
        let is_whole = |parts: &Parts| parts.iter().sum::<u32>() == PARTS && parts[0] > 0 && parts[1] > 0;
        sorted.len() == ways.len() && ways.iter().all(is_whole)
    }

    #[test]
    fn all_ways_to_share_are_tried_once_and_are_whole() {
        let all: Vec<Parts> = coarse_shares().collect();
        // With bundles: ten parts in six places, at least one in each of three, C(12, 5). Without: in four places, in two, C(11, 3).
        assert_eq!(all.len(), 792 + 165);
        assert!(are_whole_and_different(&all));
    }

    #[test]
    fn a_step_leads_from_any_purpose_to_any_other_if_it_can() {
        let everywhere: Vec<Parts> = neighbours(EQUAL, 1).collect();
        assert_eq!(everywhere.len(), 6 * 5);
        assert!(are_whole_and_different(&everywhere));
        // What shoots may not lose its last part, nor bundles where there is surplus; local lines have none to lose.
        let few: Vec<Parts> = neighbours([1, PARTS - 4, 0, 1, 2, 0], 1).collect();
        assert_eq!(few.len(), 2 * 5);
        assert!(are_whole_and_different(&few));
    }

    #[test]
    fn rays_that_take_longer_are_fewer() {
        let parts = [1, 2, 2, 3, 1, 1].map(|tenths| tenths * COARSE);
        let Plan { emission, reflection, direct, bundles, surplus, local } = Plan::of_parts(1000, parts);
        assert_eq!([emission, reflection, direct, bundles, surplus, local], [100, 200, 100, 300, 100, 50]);
    }
}
