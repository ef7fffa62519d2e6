//! What measurements share: the scene that is on the bench, its reference solutions, and who drives a solver.

use crate::Error;
use crate::reference::{Errors, Kind, Reference};
use crate::results::short;
use crate::spec::{SceneSpec, Spec};
use isolux_core::mesh::Resolution;
use isolux_core::run::run;
use isolux_core::scene::builtin::builtin;
use isolux_core::solvers::monte_carlo::{Budget, Method, MonteCarlo, Settings};
use isolux_core::solvers::{Part, Solver};
use isolux_core::transport::Leaving;
use isolux_core::{Problem, Solution};
use isolux_io::import::{ImportOptions, read_scene};
use isolux_io::{files, solution_file};
use rayon::prelude::*;
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// What is known of the references.
const REFERENCES: &str = "references.csv";

/// Asked now and then whether to go on; told what is being done.
pub type Watch<'a> = dyn FnMut(&str) -> ControlFlow<()> + 'a;

pub struct Bench {
    /// Where references are kept between runs.
    folder: PathBuf,
    /// Where scenes are that are files.
    scenes: PathBuf,
    problem: Option<((String, u64), Arc<Problem>)>,
    references: Vec<(String, Arc<Reference>)>,
}

impl Bench {
    pub fn new(folder: &Path, scenes: &Path) -> Bench {
        Bench { folder: folder.to_owned(), scenes: scenes.to_owned(), problem: None, references: Vec::new() }
    }

    /// The problem of `scene`, cut into about `elements` elements.
    ///
    /// # Errors
    /// If there is no such scene.
    pub fn problem(&mut self, scene: &SceneSpec, elements: u64) -> Result<Arc<Problem>, Error> {
        let key = (scene.source().to_owned(), elements);
        if let Some((_, problem)) = self.problem.as_ref().filter(|(name, _)| *name == key) {
            return Ok(Arc::clone(problem));
        }
        let geometry = match &scene.file {
            Some(file) => read_scene(&self.scenes.join(file), &ImportOptions::default())?,
            None => builtin(scene.source())?,
        };
        let problem = Arc::new(Problem::new(geometry, Resolution::Elements(elements))?);
        self.problem = Some((key, Arc::clone(&problem)));
        Ok(problem)
    }

    /// A reference of `scene`; `None` if `watch` breaks off.
    ///
    /// The exact solution if the scene has one. Else it is computed with the study's number of rays, and kept in a file.
    ///
    /// # Errors
    /// If the file cannot be read or written.
    pub fn reference(
        &mut self,
        spec: &Spec,
        scene: &SceneSpec,
        kind: Kind,
        watch: &mut Watch,
    ) -> Result<Option<Arc<Reference>>, Error> {
        let problem = self.problem(scene, scene.elements)?;
        let rays = spec.reference_rays.unwrap_or(1e8) as u64;
        let (source, kind_name) = (scene.source().replace([':', '=', '.'], "-"), kind.name());
        let name = format!("reference-{source}-{kind_name}-{rays}.isolux");
        if let Some((_, reference)) = self.references.iter().find(|(known, _)| *known == name) {
            return Ok(Some(Arc::clone(reference)));
        }
        let reference = match scene.exact {
            Some(exact) => Reference::exact(exact, problem.mesh.len()),
            None => {
                let path = self.folder.join(&name);
                let Some(solution) = reference_solution(&problem, &path, kind.settings(rays)?, watch)? else {
                    return Ok(None);
                };
                let reference = Reference::new(&solution);
                self.note(&name, &problem, &solution, &reference)?;
                reference
            }
        };
        self.references.push((name, Arc::new(reference)));
        Ok(self.references.last().map(|(_, reference)| Arc::clone(reference)))
    }

    /// Notes in a table what is known of the reference called `name`.
    fn note(&self, name: &str, problem: &Problem, solution: &Solution, reference: &Reference) -> Result<(), Error> {
        let path = self.folder.join(REFERENCES);
        let known = if path.exists() { files::read(&path)? } else { Vec::new() };
        let known = String::from_utf8_lossy(&known).into_owned();
        let others: Vec<&str> = known.lines().skip(1).filter(|line| line.split(',').next() != Some(name)).collect();
        let Errors { weighted, unweighted, median } = reference.own(&problem.mesh);
        let seconds = solution.provenance.parameter(SECONDS).unwrap_or_default();
        let numbers = [weighted, unweighted, median, reference.unknown(&problem.mesh)].map(short).join(",");
        let own = format!("{name},{},{},{seconds},{numbers}", problem.mesh.len(), solution.work.rays);
        let lines = [&["reference,elements,rays,seconds,weighted,unweighted,median,unknown"][..], &others, &[&own]];
        Ok(files::OutputFile::create(&path)?.finish((lines.concat().join("\n") + "\n").as_bytes())?)
    }
}

/// The parameter of a reference that says how long it took.
const SECONDS: &str = "seconds";

/// Reads the reference solution, or computes and keeps it.
fn reference_solution(
    problem: &Problem,
    path: &Path,
    settings: Settings,
    watch: &mut Watch,
) -> Result<Option<Solution>, Error> {
    if path.exists() {
        return Ok(Some(solution_file::read(&path.to_string_lossy(), &files::read(path)?)?.1));
    }
    let start = Instant::now();
    let mut solver = MonteCarlo::new(problem, settings)?;
    let Some(mut solution) = solve(&mut solver, problem, "reference", watch) else { return Ok(None) };
    solution.provenance.parameters.push((SECONDS.to_owned(), short(start.elapsed().as_secs_f64().round())));
    files::OutputFile::create(path)?.finish(&solution_file::write(problem, &solution)?)?;
    Ok(Some(solution))
}

/// One complete solution of `rays` rays, with elements of constant radiosity to the letter.
pub fn single(method: Method, rays: u64, seed: u64) -> Settings {
    let budget = Budget::Rays(rays);
    Settings { method, seed, budget, replicates: 1, leaving: Leaving::WholeElement, ..Settings::default() }
}

/// Runs `solver` to its end; `None` if `watch` breaks off.
pub fn solve(solver: &mut dyn Solver, problem: &Problem, what: &str, watch: &mut Watch) -> Option<Solution> {
    let mut stopped = false;
    let solution = run(solver, problem, |_| {
        let flow = watch(what);
        stopped |= flow.is_break();
        flow
    });
    (!stopped).then_some(solution)
}

/// Drives a solver some pieces at a time, so that its solution can be looked at on the way.
#[derive(Debug)]
pub struct Drive {
    /// The pieces of the running step that are left.
    left: Range<u64>,
}

impl Drive {
    /// Pieces computed at once.
    const PIECES: u64 = 16;

    pub fn new() -> Drive {
        Drive { left: 0..0 }
    }

    /// Computes the next pieces; whether there were any.
    pub fn go_on(&mut self, solver: &mut dyn Solver, problem: &Problem) -> bool {
        if self.left.is_empty() {
            let Some(pieces) = solver.step() else { return false };
            self.left = pieces;
        }
        let now = self.left.start..(self.left.start + Drive::PIECES).min(self.left.end);
        self.left.start = now.end;
        let parts: Vec<Part> = now.into_par_iter().map(|piece| solver.part(problem, piece)).collect();
        parts.into_iter().for_each(|part| solver.absorb(problem, part));
        true
    }

    /// Whether a step has just ended.
    pub fn is_between_steps(&self) -> bool {
        self.left.is_empty()
    }
}
