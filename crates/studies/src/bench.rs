//! What measurements share: the scene that is on the bench, and its reference solution.

use crate::Error;
use crate::spec::{SceneSpec, Spec};
use isolux_core::mesh::Resolution;
use isolux_core::run::run;
use isolux_core::sampling::SequenceName;
use isolux_core::scene::builtin::builtin;
use isolux_core::solvers::monte_carlo::axes::Walk;
use isolux_core::solvers::monte_carlo::{Budget, Method, MonteCarlo, Settings};
use isolux_core::solvers::{Part, Solver};
use isolux_core::transport::Leaving;
use isolux_core::{Problem, Solution};
use isolux_io::{files, solution_file};
use rayon::prelude::*;
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The solution that errors are measured against.
#[derive(Debug)]
pub struct Reference {
    /// Irradiance [lux], luminance, of every element.
    irradiance: Vec<f64>,
    /// Its own relative error, to be taken off.
    error: f64,
}

/// Asked now and then whether to go on; told what is being done.
pub type Watch<'a> = dyn FnMut(&str) -> ControlFlow<()> + 'a;

pub struct Bench {
    /// Where references are kept between runs.
    folder: PathBuf,
    problem: Option<((String, u64), Arc<Problem>)>,
    references: Vec<(String, Arc<Reference>)>,
}

impl Bench {
    pub fn new(folder: &Path) -> Bench {
        Bench { folder: folder.to_owned(), problem: None, references: Vec::new() }
    }

    /// The problem of `scene`, cut into about `elements` elements.
    ///
    /// # Errors
    /// If there is no such scene.
    pub fn problem(&mut self, scene: &SceneSpec, elements: u64) -> Result<Arc<Problem>, Error> {
        let key = (scene.scene.clone(), elements);
        if let Some((_, problem)) = self.problem.as_ref().filter(|(name, _)| *name == key) {
            return Ok(Arc::clone(problem));
        }
        let problem = Arc::new(Problem::new(builtin(&scene.scene)?, Resolution::Elements(elements))?);
        self.problem = Some((key, Arc::clone(&problem)));
        Ok(problem)
    }

    /// The reference for methods of that walk; `None` if `watch` breaks off.
    ///
    /// The exact solution if the scene has one. Else that of a breadth-first sweep, or for continuous walks of particle tracing,
    /// with the study's number of rays; it is kept in a file.
    ///
    /// # Errors
    /// If the file cannot be read or written.
    pub fn reference(
        &mut self,
        spec: &Spec,
        scene: &SceneSpec,
        walk: Walk,
        watch: &mut Watch,
    ) -> Result<Option<Arc<Reference>>, Error> {
        let problem = self.problem(scene, scene.elements)?;
        let rays = spec.reference_rays.unwrap_or(1e8) as u64;
        let kind = if walk == Walk::Discrete { "shirley" } else { "particle-tracing" };
        let name = format!("reference-{}-{kind}-{rays}.isolux", scene.scene.replace([':', '='], "-"));
        if let Some((_, reference)) = self.references.iter().find(|(known, _)| *known == name) {
            return Ok(Some(Arc::clone(reference)));
        }
        let reference = match scene.exact {
            Some(exact) => Reference { irradiance: vec![exact; problem.mesh.len()], error: 0.0 },
            None => {
                let path = self.folder.join(&name);
                let method = Method { sequence: SequenceName::OWEN_SOBOL, ..Method::named(kind)? };
                let settings = Settings { replicates: 16, ..single(method, rays, 1_000_000) };
                let Some(solution) = reference_solution(&problem, &path, settings, watch)? else { return Ok(None) };
                let irradiance = solution.irradiance.iter().map(|lux| lux.luminance_f64()).collect();
                Reference { irradiance, error: solution.rms_error(&problem) }
            }
        };
        self.references.push((name, Arc::new(reference)));
        Ok(self.references.last().map(|(_, reference)| Arc::clone(reference)))
    }
}

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
    let mut solver = MonteCarlo::new(problem, settings)?;
    let Some(solution) = solve(&mut solver, problem, "reference", watch) else { return Ok(None) };
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

impl Reference {
    /// Area-weighted RMS error of luminance irradiance, relative to the reference's mean; the reference's own error is taken off.
    pub fn error(&self, problem: &Problem, solution: &Solution) -> f64 {
        let (mut area, mut sum, mut sum_sq) = (0.0, 0.0, 0.0);
        for e in problem.mesh.elements() {
            let (weight, exact) = (f64::from(problem.mesh.area(e)), self.on(e));
            area += weight;
            sum += weight * exact;
            sum_sq += weight * (solution.irradiance[e as usize].luminance_f64() - exact).powi(2);
        }
        let square = sum_sq / area / (sum / area).powi(2);
        (square - self.error.powi(2)).max(0.0).sqrt()
    }

    /// Irradiance [lux] of element `e`.
    pub fn on(&self, e: u32) -> f64 {
        self.irradiance[e as usize]
    }
}
