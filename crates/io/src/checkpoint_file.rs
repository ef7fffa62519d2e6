//! The `.checkpoint` file: a run in the middle of its work, so that it can go on after whatever has stopped it, to the same bits as
//! if nothing had.
//!
//! The payload of a [`Container`]: scene, cut, clock, state of the solver, which holds what was asked of it. It is not
//! packed: it is written again and again while somebody waits for the result.
//!
//! Loaded, the state is known to have a value for each element ([`Solver::fits`]). Numbers of elements inside are
//! taken as they are: a state that somebody has forged may end the command, but no more than that.

use crate::Error;
use crate::container::{Container, element_count, invalid};
use crate::files::LARGEST_INPUT;
use isolux_core::Problem;
use isolux_core::mesh::Cut;
use isolux_core::scene::Scene;
use isolux_core::solvers::Solver;
use std::time::Duration;

const FILE: Container = Container { magic: b"ISOCHK", version: 5, what: "a checkpoint of isolux", packing: 0 };

/// How long a run has solved, and how long it may in all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Clock {
    pub solved: Duration,
    pub limit: Option<Duration>,
}

/// A run that can go on.
pub struct Checkpoint {
    pub problem: Problem,
    pub solver: Box<dyn Solver>,
    pub clock: Clock,
}

#[derive(serde::Serialize)]
struct Written<'a> {
    scene: &'a Scene,
    cut: Cut,
    clock: Clock,
    solver: &'a dyn Solver,
}

#[derive(serde::Deserialize)]
struct Loaded {
    scene: Scene,
    cut: Cut,
    clock: Clock,
    solver: Box<dyn Solver>,
}

/// The bytes of the file.
///
/// # Errors
/// [`Error::Invalid`] if the state cannot be encoded, or is so large that it would not be read again.
pub fn write(problem: &Problem, solver: &dyn Solver, clock: Clock) -> Result<Vec<u8>, Error> {
    let file = FILE.write(&Written { scene: &problem.scene, cut: problem.mesh.cut(), clock, solver })?;
    if file.len() as u64 > LARGEST_INPUT {
        return Err(invalid(FILE.what, "solver", "the state is larger than the 4 GiB that are read again"));
    }
    Ok(file)
}

/// The run in the bytes of a file; `name` is for messages.
///
/// # Errors
/// [`Error::Invalid`] if the bytes are not what [`write`] made, [`Error::Core`] if the scene cannot be cut into elements.
pub fn read(name: &str, bytes: &[u8]) -> Result<Checkpoint, Error> {
    let Loaded { scene, cut, clock, solver } = FILE.read(name, bytes)?;
    element_count(name, &scene, &cut)?;
    let problem = Problem::with_cut(scene, &cut)?;
    if solver.fits(&problem) {
        Ok(Checkpoint { problem, solver, clock })
    } else {
        Err(invalid(name, "solver", "its state is not one of this scene"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{self, random};
    use isolux_core::mesh::Resolution;
    use isolux_core::solvers::deterministic;
    use isolux_core::solvers::monte_carlo::{METHODS, MonteCarlo, Settings};

    const CLOCK: Clock = Clock { solved: Duration::from_millis(1500), limit: Some(Duration::from_secs(60)) };

    /// Without lamps, which deterministic methods do not know.
    fn problem(elements: u64) -> Problem {
        let scene = Scene { lights: Vec::new(), ..fixture::scene() };
        Problem::new(scene, Resolution::Elements(elements)).unwrap()
    }

    /// Absorbs so many pieces at most.
    fn advance(problem: &Problem, solver: &mut dyn Solver, pieces: usize) {
        for _ in 0..pieces {
            let Some(range) = solver.step() else { return };
            let part = solver.part(problem, range.start);
            solver.absorb(problem, part);
        }
    }

    /// Solvers of every kind, in the middle of their work.
    fn running(problem: &Problem) -> Vec<Box<dyn Solver>> {
        let mut solvers: Vec<Box<dyn Solver>> = Vec::new();
        for named in METHODS {
            let settings = Settings { method: named.method, ..Settings::default() };
            solvers.push(Box::new(MonteCarlo::new(problem, settings).unwrap()));
        }
        for entry in deterministic::DETERMINISTIC {
            solvers.push((entry.make)(problem, &deterministic::Settings::default()).unwrap());
        }
        solvers.iter_mut().for_each(|solver| advance(problem, solver.as_mut(), 5));
        solvers
    }

    #[test]
    fn every_solver_comes_back_as_it_was() {
        let problem = problem(60);
        for mut solver in running(&problem) {
            let file = write(&problem, solver.as_ref(), CLOCK).unwrap();
            let mut read = read("a.checkpoint", &file).unwrap();
            assert_eq!(read.clock, CLOCK);
            assert!(write(&read.problem, read.solver.as_ref(), CLOCK).unwrap() == file);
            advance(&problem, solver.as_mut(), 7);
            advance(&read.problem, read.solver.as_mut(), 7);
            let state = |problem: &Problem, solver: &dyn Solver| write(problem, solver, CLOCK).unwrap();
            assert!(state(&read.problem, read.solver.as_ref()) == state(&problem, solver.as_ref()));
        }
    }

    #[test]
    fn a_state_of_another_scene_is_refused() {
        let problem = problem(60);
        for solver in running(&self::problem(500)) {
            let file = write(&problem, solver.as_ref(), CLOCK).unwrap();
            let message = read("a.checkpoint", &file).map(|_| ()).unwrap_err().to_string();
            assert!(message.contains("a.checkpoint: solver"), "{message}");
        }
    }

    /// The decoder must not rely on the checksum: whoever can change a file can sign it again.
    #[test]
    fn mutated_and_signed_payloads_never_panic_when_read() {
        let problem = problem(60);
        let (mut state, mut refused) = (3, 0);
        for solver in running(&problem) {
            let unpacked = FILE.unpack("a", &write(&problem, solver.as_ref(), CLOCK).unwrap()).unwrap();
            for k in 0..100 {
                let mut bytes = unpacked.clone();
                for _ in 0..1 + k % 4 {
                    let at = random(&mut state) % bytes.len();
                    bytes[at] = random(&mut state) as u8;
                }
                if k % 10 == 0 {
                    bytes.truncate(random(&mut state) % bytes.len());
                }
                refused += usize::from(read("a.checkpoint", &FILE.pack(&bytes).unwrap()).is_err());
            }
        }
        assert!(refused > 200, "{refused}");
    }
}
