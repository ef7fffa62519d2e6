//! One solution of several: runs with different seeds, on whatever machines, are replicates of each other.
//!
//! ```text
//! E = Σ w_k E_k,    V = Σ w_k² V_k
//! ```
//!
//! with one weight for each solution, what it is worth as a whole ([`crate::precision`]), or its number of rays where there are few
//! elements. Unbiased if the solutions are: weights depend on the noise of all elements together only. Light groups are merged one by one,
//! with the weights of the sums. Cost: a look at each element.

use crate::math::Rgb;
use crate::precision::{Known, precision};
use crate::solution::{Balance, GroupLight, Provenance, Work};
use crate::superposition::sum;
use crate::{Certainty, Error, Problem, Solution};

/// Parameters that say how much was done, and may differ.
const AMOUNT: [&str; 10] =
    ["rays", "rounds", "error", "confidence", "error of", "most rays", "replicates", "stopped", "extended from", SEEDS];
/// The parameter of a merged solution that has the seeds of its parts.
const SEEDS: &str = "merged seeds";

/// The mean of `solutions` of one problem, weighted by what they are worth. Its provenance has the first seed, and all of them as a
/// parameter.
///
/// # Errors
/// [`Error::NotMergeable`] for none, for solutions of other problems or methods than the first, without error bars, or of equal seeds.
pub fn merge(problem: &Problem, solutions: &[Solution]) -> Result<Solution, Error> {
    let not = |what: &str| Error::NotMergeable { what: what.to_owned() };
    let first = solutions.first().ok_or_else(|| not("there is none"))?;
    for (k, solution) in solutions.iter().enumerate() {
        check(problem, first, solution).map_err(|what| not(&format!("number {} {what}", k + 1)))?;
    }
    check_seeds(solutions)?;

    let worth = worth(problem, solutions);
    let merged = mean(problem, &solutions.iter().collect::<Vec<_>>(), &worth);
    if first.groups.is_empty() {
        return Ok(merged);
    }
    let group = |(k, part): (usize, &GroupLight)| {
        let parts: Vec<&Solution> = solutions.iter().map(|solution| &solution.groups[k].solution).collect();
        GroupLight { solution: mean(problem, &parts, &worth), group: part.group.clone(), ..*part }
    };
    let groups: Vec<GroupLight> = first.groups.iter().enumerate().map(group).collect();
    // Whoever mixes them again as they are gets the same bits.
    let sum = sum(problem, &groups, merged.provenance);
    Ok(Solution { groups, ..sum })
}

/// The mean of `parts`, weighted by what they are worth.
fn mean(problem: &Problem, parts: &[&Solution], worth: &[f64]) -> Solution {
    let all: f64 = worth.iter().sum();
    let weighted = || parts.iter().zip(worth.iter().map(|worth| worth / all));
    let mean = |e: u32| weighted().fold(Rgb::BLACK, |sum, (part, w)| sum + part.irradiance[e as usize] * w as f32);
    let variance = |e: u32| {
        let of_part = |(part, w): (&&Solution, f64)| part.std_error[e as usize].map(|error| (error * w as f32).powi(2));
        weighted().map(of_part).fold(Rgb::BLACK, |sum, variance| sum + variance)
    };
    Solution {
        irradiance: problem.mesh.elements().map(mean).collect(),
        std_error: problem.mesh.elements().map(|e| variance(e).map(f32::sqrt)).collect(),
        certainty: certainty(parts, worth),
        work: Work {
            rays: parts.iter().map(|part| part.work.rays).sum(),
            replicates: parts.iter().map(|part| part.work.replicates).sum(),
        },
        balance: weighted().fold(Balance::default(), |sum, (part, w)| sum + part.balance / (1.0 / w)),
        provenance: provenance(parts),
        groups: Vec::new(),
    }
}

/// Whether a solution can be merged with the `first`; if not, what it has or lacks.
fn check(problem: &Problem, first: &Solution, solution: &Solution) -> Result<(), String> {
    let elements = problem.mesh.len();
    let (one, other) = (&first.provenance, &solution.provenance);
    if other.scene_hash != problem.scene.hash() || solution.irradiance.len() != elements {
        return Err("is of another scene, or of other elements".to_owned());
    }
    if solution.std_error.len() != elements || !solution.std_error.iter().all(|error| error.is_finite()) {
        return Err("has no error bars: it takes two complete solutions of Monte Carlo".to_owned());
    }
    let asked = |provenance: &Provenance| {
        let kept = provenance.parameters.iter().filter(|(name, _)| !AMOUNT.contains(&name.as_str()));
        kept.cloned().collect::<Vec<_>>()
    };
    if (&one.method, asked(one)) != (&other.method, asked(other)) {
        return Err("was solved by another method, or with other parameters than its rays".to_owned());
    }
    let lamps = |solution: &Solution| -> Vec<_> {
        solution.groups.iter().map(|part| (part.group.clone(), part.factor)).collect()
    };
    if lamps(first) != lamps(solution) {
        return Err("has other light groups".to_owned());
    }
    Ok(())
}

/// Whether no two solutions have the same seed.
fn check_seeds(solutions: &[Solution]) -> Result<(), Error> {
    let mut seeds = Vec::new();
    for (k, solution) in solutions.iter().enumerate() {
        for seed in seeds_of(solution) {
            if seeds.contains(&seed) {
                let what = format!("number {} has seed {seed}, as one before it: they are not independent", k + 1);
                return Err(Error::NotMergeable { what });
            }
            seeds.push(seed);
        }
    }
    Ok(())
}

fn seeds_of(solution: &Solution) -> Vec<u64> {
    let merged = solution.provenance.parameter(SEEDS);
    merged.map_or(vec![solution.provenance.seed], |seeds| {
        seeds.split(", ").filter_map(|seed| seed.parse().ok()).collect()
    })
}

/// What each solution is worth.
fn worth(problem: &Problem, solutions: &[Solution]) -> Vec<f64> {
    let of_element = |solution: &Solution, e: u32| Known {
        area: f64::from(problem.mesh.area(e)),
        mean: solution.irradiance[e as usize].luminance_f64(),
        variance: solution.std_error[e as usize].map(|error| error * error).luminance_f64(),
    };
    let of = |solution: &Solution| precision((0..problem.mesh.len() as u32).map(|e| of_element(solution, e)));
    let known: Option<Vec<f64>> = solutions.iter().map(|s| of(s).filter(|precision| precision.is_finite())).collect();
    known.unwrap_or_else(|| solutions.iter().map(|solution| solution.work.rays.max(1) as f64).collect())
}

/// How sure the sums are, if all know it.
fn certainty(parts: &[&Solution], worth: &[f64]) -> Option<Certainty> {
    let mut parts = parts.iter().zip(worth);
    let (first, &worth) = parts.next()?;
    let start = (first.certainty.clone()?, worth);
    let merged = parts.try_fold(start, |(merged, before), (part, worth)| {
        let all = before + worth;
        Some((merged.merged(part.certainty.as_ref()?, worth / all), all))
    });
    merged.map(|(certainty, _)| certainty)
}

/// That of the first, with the seeds of all.
fn provenance(parts: &[&Solution]) -> Provenance {
    let mut provenance = Provenance { version: crate::VERSION.to_owned(), ..parts[0].provenance.clone() };
    provenance.parameters.retain(|(name, _)| !AMOUNT.contains(&name.as_str()));
    let seeds: Vec<String> = parts.iter().flat_map(|part| seeds_of(part)).map(|seed| seed.to_string()).collect();
    provenance.parameters.push((SEEDS.to_owned(), seeds.join(", ")));
    provenance
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Resolution;
    use crate::scene::builtin::builtin;

    fn problem(elements: u64) -> Problem {
        Problem::new(builtin("box").unwrap(), Resolution::Elements(elements)).unwrap()
    }

    /// A solution of constant irradiance and standard error.
    fn flat(problem: &Problem, seed: u64, irradiance: f32, std_error: f32, rays: u64) -> Solution {
        let parameters = vec![("rays".to_owned(), rays.to_string()), ("order".to_owned(), "auto".to_owned())];
        Solution {
            irradiance: vec![Rgb::grey(irradiance); problem.mesh.len()],
            std_error: vec![Rgb::grey(std_error); problem.mesh.len()],
            certainty: None,
            work: Work { rays, replicates: 8 },
            balance: Balance { emitted: 10.0, absorbed: f64::from(irradiance), ..Balance::default() },
            provenance: Provenance {
                scene: "box".to_owned(),
                scene_hash: problem.scene.hash(),
                method: "auto".to_owned(),
                parameters,
                seed,
                version: crate::VERSION.to_owned(),
            },
            groups: Vec::new(),
        }
    }

    fn near(a: f32, b: f32) -> bool {
        (a - b).abs() < 1e-5 * b
    }

    #[test]
    fn solutions_that_are_worth_the_same_are_averaged() {
        let problem = problem(300);
        // The same relative to their means.
        let [a, b] = [flat(&problem, 1, 4.0, 0.4, 100), flat(&problem, 2, 6.0, 0.6, 900)];
        let merged = merge(&problem, &[a, b]).unwrap();
        assert!(merged.irradiance.iter().all(|e| near(e.r, 5.0) && near(e.b, 5.0)));
        assert!(merged.std_error.iter().all(|error| near(error.g, (0.25f32 * 0.16 + 0.25 * 0.36).sqrt())));
        assert_eq!(merged.work, Work { rays: 1000, replicates: 16 });
        assert!((merged.balance.emitted - 10.0).abs() < 1e-9 && (merged.balance.absorbed - 5.0).abs() < 1e-5);
    }

    #[test]
    fn a_solution_counts_by_its_variance_and_by_its_rays_among_few_elements() {
        let of = |problem: &Problem| {
            let parts = [flat(problem, 1, 10.0, 2.0, 100), flat(problem, 2, 10.0, 1.0, 300)];
            merge(problem, &parts).unwrap().std_error[0].r
        };
        let variance = |w: f32| (w * w * 4.0 + (1.0 - w) * (1.0 - w)).sqrt();
        assert!(near(of(&problem(300)), variance(0.2)));
        assert!(near(of(&problem(12)), variance(0.25)));
    }

    #[test]
    fn the_provenance_names_all_seeds_and_merged_solutions_are_merged_again() {
        let problem = problem(300);
        let [a, b, c] = [5, 6, 7].map(|seed| flat(&problem, seed, 10.0, 1.0, 100));
        let ab = merge(&problem, &[a.clone(), b.clone()]).unwrap();
        let abc = merge(&problem, &[ab.clone(), c.clone()]).unwrap();
        let seeds = |s: &Solution| s.provenance.parameter(SEEDS).unwrap().to_owned();
        assert_eq!((seeds(&ab).as_str(), seeds(&abc).as_str()), ("5, 6", "5, 6, 7"));
        // It is worth twice as much as one of its parts.
        let at_once = merge(&problem, &[a, b.clone(), c]).unwrap();
        assert!(near(abc.std_error[0].r, at_once.std_error[0].r));
        assert!(merge(&problem, &[ab, b]).unwrap_err().to_string().contains("number 2 has seed 6"));
    }

    #[test]
    fn what_does_not_belong_together_is_refused() {
        let problem = problem(300);
        let refused = |other: &dyn Fn(&mut Solution)| {
            let mut solutions = [flat(&problem, 1, 1.0, 0.1, 100), flat(&problem, 2, 1.0, 0.1, 100)];
            other(&mut solutions[1]);
            merge(&problem, &solutions).unwrap_err().to_string()
        };
        assert!(refused(&|s| s.provenance.seed = 1).contains("not independent"));
        assert!(refused(&|s| s.provenance.scene_hash += 1).contains("another scene"));
        assert!(refused(&|s| s.irradiance.truncate(3)).contains("other elements"));
        assert!(refused(&|s| s.std_error[7].g = f32::NAN).contains("no error bars"));
        assert!(refused(&|s| s.provenance.method = "wdrs".to_owned()).contains("another method"));
        assert!(refused(&|s| s.provenance.parameters[1].1 = "staged".to_owned()).contains("other parameters"));
        assert!(merge(&problem, &[]).is_err());
    }
}
