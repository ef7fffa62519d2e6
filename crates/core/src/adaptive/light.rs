//! What is known of the light anywhere on the surface, before the mesh is there that it is to be solved on.
//!
//! Direct light changes within centimetres and costs little: it is computed for every element of a uniform mesh, with the *same* random numbers in
//! all of them. What an estimate is wrong by is then nearly the same next door, so light changes from element to element where it really
//! does, and not because of noise. Indirect light changes slowly: it is that of a *pilot*, a quick solution on large elements, after noise was
//! taken out as far as its error bars allow. Both are interpolated between vertices ([`VertexField`]), so it is known which way light changes
//! within an element, too.

use super::samples::Samples;
use crate::math::Rgb;
use crate::mesh::surface_area;
use crate::sampling::{Sample, Sequence, SequenceName};
use crate::transport::LightSampler;
use crate::transport::direct_light::{DirectEstimator, Rays, STREAMS};
use crate::view::{VertexField, smooth};
use crate::{Problem, Solution};
use glam::Vec2;
use rayon::prelude::*;

/// Elements that are computed in turn.
const PIECE: usize = 256;
/// Light below this share of the mean counts as it is, above by its logarithm.
const DIM: f64 = 0.06;

/// Light that changes slowly, of a pilot.
pub struct Indirect {
    problem: Problem,
    field: VertexField,
}

impl Indirect {
    pub fn new(problem: Problem, solution: &Solution) -> Indirect {
        let field = VertexField::draft(&problem, &smooth(&problem, solution).irradiance, None);
        Indirect { problem, field }
    }

    /// Irradiance [lux] in the middle of element `e` of another mesh of the same scene.
    pub fn on(&self, other: &Problem, e: u32) -> Rgb {
        let place = other.mesh.place(e);
        let middle = other.mesh.corners_at(place).iter().sum::<Vec2>() / 3.0;
        self.field.irradiance_at(&self.problem, place.triangle, middle, place.back)
    }
}

/// Direct irradiance [lux] of the elements of `problem`, each of which sends so many `rays`, and the number of rays traced. The numbers are those of
/// `seed`.
pub fn direct(problem: &Problem, rays: Rays, seed: u64) -> (Vec<Rgb>, u64) {
    let sequence = Same(SequenceName::default().make(seed));
    let sampler = LightSampler::new(problem);
    let elements: Vec<u32> = problem.mesh.elements().collect();
    let piece = |elements: &[u32]| {
        let mut estimator = DirectEstimator::new(problem, &sampler, &sequence);
        elements.iter().map(|&e| estimator.irradiance(e, rays)).collect::<Vec<(Rgb, u64)>>()
    };
    let pieces: Vec<Vec<(Rgb, u64)>> = elements.par_chunks(PIECE).map(piece).collect();
    let traced = pieces.iter().flatten().map(|(_, rays)| rays).sum();
    (pieces.into_iter().flatten().map(|(light, _)| light).collect(), traced)
}

/// How much light counts: `E₀ ln (1 + E / E₀)`, where E₀ is [`DIM`] of the mean. So it is with brightness (Fechner 1860), and so it pays: in a lamp light is a
/// thousand times what it is in the room, and elements without end would go there, each with noise of its own.
#[derive(Clone, Copy, Debug)]
pub struct Brightness {
    /// E₀ [lux].
    dim: f32,
}

impl Brightness {
    /// Where there is this `irradiance` [lux] on the elements of `problem`.
    pub fn among(problem: &Problem, irradiance: &[Rgb]) -> Brightness {
        let mesh = &problem.mesh;
        let flux = |e: u32| f64::from(mesh.area(e)) * irradiance[e as usize].luminance_f64();
        Brightness { dim: (DIM * mesh.elements().map(flux).sum::<f64>() / mesh.total_area()) as f32 }
    }

    /// That of so many `lux`.
    pub fn of(self, lux: f32) -> f32 {
        if self.dim > 0.0 { self.dim * (lux.max(0.0) / self.dim).ln_1p() } else { 0.0 }
    }
}

/// The same numbers for every element.
struct Same(Box<dyn Sequence>);

impl Sequence for Same {
    fn fill(&self, stream: u64, first: u64, points: &mut [Sample]) {
        self.0.fill(stream % STREAMS, first, points);
    }

    fn number(&self, stream: u64, index: u64, dimension: u32) -> f32 {
        self.0.number(stream % STREAMS, index, dimension)
    }
}

/// Light that is known for the elements of a mesh.
pub struct Light<'a> {
    problem: &'a Problem,
    field: VertexField,
    /// Number of elements that a side of each triangle has, or a part in.
    elements: Vec<u32>,
    triangles: Vec<OnTriangle>,
}

/// The light on a whole triangle.
#[derive(Clone, Copy, Debug)]
pub struct OnTriangle {
    /// Mean irradiance [lux] on the front and on the back.
    pub mean: [f32; 2],
    /// Error [lux² m²] of a single element.
    pub error: f32,
}

impl Light<'_> {
    /// Of the `irradiance` [lux] of its elements.
    pub fn new<'a>(problem: &'a Problem, irradiance: &[Rgb]) -> Light<'a> {
        let mut elements = vec![0; problem.scene.triangles.len()];
        for e in problem.mesh.elements().filter(|&e| !problem.mesh.place(e).back) {
            problem.mesh.pieces(e).for_each(|piece| elements[piece.triangle as usize] += 1);
        }
        let field = VertexField::draft(problem, irradiance, None);
        let mut light = Light { problem, field, elements, triangles: Vec::new() };
        let on = |t: u32| {
            let (mean, variance) = Samples::for_moments(&light, t).mean_and_variance();
            OnTriangle { mean, error: surface_area(&problem.scene, t) as f32 * variance }
        };
        // A wall has as many samples as thousands of small triangles.
        light.triangles = (0..light.elements.len() as u32).into_par_iter().with_max_len(1).map(on).collect();
        light
    }

    /// Irradiance [lux] on the front and on the back at barycentric coordinates `uv` of `triangle`.
    pub fn at(&self, triangle: u32, uv: Vec2) -> [f32; 2] {
        self.field.irradiance_on_sides(self.problem, triangle, uv).map(Rgb::luminance)
    }

    /// The light on the whole of `triangle`.
    pub fn on(&self, triangle: u32) -> OnTriangle {
        self.triangles[triangle as usize]
    }

    /// Number of triangles.
    pub fn triangles(&self) -> u32 {
        self.triangles.len() as u32
    }

    /// Number of elements that a side of `triangle` has, or a part in; at least one.
    pub fn elements_on(&self, triangle: u32) -> u32 {
        self.elements[triangle as usize]
    }
}
