//! The `.isolux` file: a whole solution with its provenance, the scene, and how the scene was cut into elements, so that
//! it can be looked at, compared and gone on with where the scene's own file is not.
//!
//! The payload of a [`Container`]: scene, cut, solution, and the light of each group of sources, if they were solved apart: a solution
//! for each.
//!
//! Elements are not stored: the same scene, cut the same way, has the same ones ([`Problem::with_cut`]).

use crate::Error;
use crate::container::{Container, element_count, invalid};
use isolux_core::mesh::Cut;
use isolux_core::scene::{MOST_GROUPS, Scene};
use isolux_core::solution::GroupLight;
use isolux_core::{Problem, Solution};
use std::borrow::Cow;

const FILE: Container = Container { magic: b"ISOLUX", version: 7, what: "an isolux file", packing: 1 };

#[derive(serde::Serialize, serde::Deserialize)]
struct Payload<'a> {
    scene: Cow<'a, Scene>,
    cut: Cow<'a, Cut>,
    solution: Cow<'a, Solution>,
    groups: Cow<'a, [GroupLight]>,
}

/// The bytes of the file.
///
/// # Errors
/// [`Error::Invalid`] if `problem` and `solution` do not belong together or are not fit to be read again.
pub fn write(problem: &Problem, solution: &Solution) -> Result<Vec<u8>, Error> {
    let payload = Payload {
        scene: Cow::Borrowed(&problem.scene),
        cut: Cow::Owned(problem.mesh.cut()),
        solution: Cow::Borrowed(solution),
        groups: Cow::Borrowed(&solution.groups),
    };
    check(".isolux output", &payload)?;
    FILE.write(&payload)
}

/// The problem and the solution in the bytes of a file; `name` is for messages.
///
/// # Errors
/// [`Error::Invalid`] if the bytes are not what [`write`] made, [`Error::Core`] if the scene cannot be cut into elements.
pub fn read(name: &str, bytes: &[u8]) -> Result<(Problem, Solution), Error> {
    let payload: Payload = FILE.read(name, bytes)?;
    check(name, &payload)?;
    let problem = Problem::with_cut(payload.scene.into_owned(), &payload.cut)?;
    let (solution, groups) = (payload.solution.into_owned(), payload.groups.into_owned());
    Ok((problem, Solution { groups, ..solution }))
}

/// Whether scene, cut, solution and groups can be used, and used together.
fn check(name: &str, payload: &Payload) -> Result<(), Error> {
    let Payload { scene, cut, solution, groups } = payload;
    let elements = element_count(name, scene, cut)?;
    check_solution(name, "solution", solution, elements)?;
    if groups.len() > MOST_GROUPS {
        return Err(invalid(name, "groups", format!("{} of them, and {MOST_GROUPS} are the most", groups.len())));
    }
    for (k, part) in groups.iter().enumerate() {
        let place = format!("groups/{k}");
        if !part.group.fits(scene) {
            return Err(invalid(name, &place, "a source is not in the scene, or its emission is not a finite number"));
        }
        if !part.factor.is_finite() || !part.flux.iter().all(|flux| flux.is_finite()) {
            return Err(invalid(name, &place, "factor or flux is not a finite number"));
        }
        check_solution(name, &place, &part.solution, elements)?;
    }
    Ok(())
}

/// Whether there is a value for each of so many elements.
fn check_solution(name: &str, place: &str, solution: &Solution, elements: usize) -> Result<(), Error> {
    for (what, values) in [("irradiance", &solution.irradiance), ("std_error", &solution.std_error)] {
        if values.len() != elements {
            let fault = format!("{} values for {elements} elements", values.len());
            return Err(invalid(name, &format!("{place}/{what}"), fault));
        }
    }
    match solution.irradiance.iter().position(|value| !value.is_finite()) {
        Some(e) => Err(invalid(name, &format!("{place}/irradiance/{e}"), "not a finite number")),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{self, random};
    use isolux_core::math::Rgb;
    use isolux_core::scene::{Emitter, Grouping};

    fn bits(values: &[Rgb]) -> Vec<[u32; 3]> {
        values.iter().map(|c| c.to_array().map(f32::to_bits)).collect()
    }

    fn message(bytes: &[u8]) -> String {
        read("a.isolux", bytes).map(|_| ()).unwrap_err().to_string()
    }

    #[test]
    fn everything_comes_back_bit_for_bit() {
        [fixture::lit_box(), fixture::lit_ball()].iter().for_each(|(problem, solution)| comes_back(problem, solution));
    }

    fn comes_back(problem: &Problem, solution: &Solution) {
        let file = write(problem, solution).unwrap();
        let (read_problem, read) = read("a.isolux", &file).unwrap();
        assert_eq!(bits(&read.irradiance), bits(&solution.irradiance));
        assert_eq!(bits(&read.std_error), bits(&solution.std_error));
        assert_eq!(
            (read.balance, read.work, &read.provenance),
            (solution.balance, solution.work, &solution.provenance)
        );
        assert_eq!(read_problem.scene.hash(), problem.scene.hash());
        assert_eq!(read_problem.scene.cameras, problem.scene.cameras);
        assert!(problem.mesh.elements().all(|e| read_problem.mesh.pieces(e).eq(problem.mesh.pieces(e))));
        assert_eq!(write(&read_problem, &read).unwrap(), file);
    }

    /// [`fixture::lit_box`] with a group for each of its sources: a lamp, a wall, and three lights.
    fn lit_by_groups() -> (Problem, Solution) {
        let (problem, solution) = fixture::lit_box();
        let groups = Grouping::Objects.groups(&problem.scene).unwrap();
        let part = |group| GroupLight { group, flux: [1.0, 2.0, 3.0], factor: Rgb::WHITE, solution: solution.clone() };
        let groups = groups.into_iter().map(part).collect();
        (problem, Solution { groups, ..solution })
    }

    #[test]
    fn groups_come_back_as_they_were() {
        let (problem, mut solution) = lit_by_groups();
        // What is not a number is not equal to itself.
        let known = |solution: &mut Solution| solution.std_error[3] = Rgb::BLACK;
        known(&mut solution);
        solution.groups.iter_mut().for_each(|part| known(&mut part.solution));
        let (_, read) = read("a.isolux", &write(&problem, &solution).unwrap()).unwrap();
        assert_eq!((read.groups.len(), read.groups == solution.groups), (5, true));
    }

    #[test]
    fn what_does_not_belong_together_is_not_written() {
        let refused = |change: &dyn Fn(&mut Solution)| {
            let (problem, mut solution) = lit_by_groups();
            change(&mut solution);
            write(&problem, &solution).unwrap_err().to_string()
        };
        assert!(refused(&|s| s.irradiance.truncate(3)).contains("solution/irradiance"));
        assert!(refused(&|s| s.groups[1].solution.std_error.truncate(3)).contains("groups/1/std_error"));
        assert!(refused(&|s| s.groups[2].flux[1] = f64::NAN).contains("groups/2: factor or flux"));
        assert!(refused(&|s| s.groups[0].group.sources[0].emitter = Emitter::Object(6)).contains("not in the scene"));
        assert!(refused(&|s| s.groups = vec![s.groups[0].clone(); 65]).contains("64 are the most"));
    }

    /// The decoder must not rely on the checksum: whoever can change a file can sign it again.
    #[test]
    fn mutated_and_signed_payloads_never_panic() {
        let (problem, solution) = lit_by_groups();
        let file = write(&problem, &solution).unwrap();
        let unpacked = FILE.unpack("a.isolux", &file).unwrap();
        let (mut state, mut refused) = (2, 0);
        for k in 0..2000 {
            let mut bytes = unpacked.clone();
            for _ in 0..1 + k % 4 {
                // Half of the mutations near the start, where lengths are.
                let within = if k % 2 == 0 { bytes.len() } else { 64 };
                let at = random(&mut state) % within;
                bytes[at] = random(&mut state) as u8;
            }
            if k % 10 == 0 {
                bytes.truncate(random(&mut state) % bytes.len());
            }
            refused += usize::from(read("a.isolux", &FILE.pack(&bytes).unwrap()).is_err());
        }
        assert!(refused > 200, "{refused}");
    }

    #[test]
    fn false_cuts_are_refused_before_a_mesh_is_made() {
        let (problem, solution) = fixture::lit_box();
        let cut = Cow::Owned(Cut::regular(&vec![30_000; problem.scene.triangles.len()]));
        let groups = Cow::Owned(Vec::new());
        let payload = Payload { scene: Cow::Owned(problem.scene), cut, solution: Cow::Owned(solution), groups };
        let file = FILE.write(&payload).unwrap();
        assert!(message(&file).contains("elements"));
    }
}
