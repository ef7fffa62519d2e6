//! Hierarchical radiosity (Hanrahan, Salzman & Aupperle 1991): light is exchanged between clusters of elements, coarse where it
//! matters little.
//!
//! ```text
//! link     p - q, with exchange area A_p F_pq, refined until A_p F_pq max(B_p, B_q) is below a share of the emitted power
//! gather   E_p += F_pq B_q,  E_q += F_qp B_p,         for all links
//! push     E of a cluster falls on its halves;        B_i = Be_i + rho_i E_i on the elements
//! pull     B of a cluster is the mean over its halves, weighted by area
//! ```
//!
//! Gathering, push and pull are repeated until nothing changes; then links are refined again for the light that is there now,
//! and so on until none needs to be. Clusters are those of [`clusters`], links those of [`links`]. Biased: a link takes its
//! ends for a few points of even radiosity, so an error remains that falls with [`Settings::link_power`]: in rooms of 1000
//! elements 2 to 4 % of the irradiance (RMS) at the default of 10^-5, 5 to 7 % at 10^-4. No light is made or lost between
//! clusters; what the links of an element lack to one, or have beyond it, counts as escaped. Cost: links, whose
//! number depends on the limit and hardly on n once elements are finer than it asks for, beside one for each pair of triangles
//! that face each other.

mod clusters;
mod links;

use self::clusters::Clusters;
use self::links::{Link, Refinement};
use super::matrix_solver::{MOST_SWEEPS, landing, light_of};
use super::system::{Light, Surfaces, luminance, minus, plus, to_rgb};
use super::{Settings, check, provenance};
use crate::form_factors::{Contour, Row};
use crate::math::Rgb;
use crate::solution::{Balance, Solution, Work};
use crate::solvers::{Landing, Part, Progress, Solver};
use crate::{Error, Problem};
use std::ops::Range;

/// The name of the method.
pub const NAME: &str = "hierarchical";
/// Links of a piece.
const LINKS_PER_PIECE: usize = 4096;
/// Most links, half a gigabyte; when they are used up no link is refined any more.
const MOST_LINKS: usize = 20_000_000;
/// Most sides of triangles: twenty million pairs of them.
const MOST_ROOTS: usize = 6000;
/// Rounds of refinement.
const MOST_ROUNDS: u32 = 10;

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
enum Stage {
    Refining,
    Gathering,
    Done,
}

/// The state of the iteration.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Hierarchical {
    settings: Settings,
    contour: Contour,
    surfaces: Surfaces,
    clusters: Clusters,
    links: Vec<Link>,
    /// Links of the round of refinement that is running.
    refined: Vec<Link>,
    /// Radiosity [lm/m²], and what has arrived in the running iteration [lux], of every cluster.
    radiosity: Vec<Light>,
    arrived: Vec<Light>,
    /// Irradiance [lux] of every element.
    irradiance: Vec<Light>,
    stage: Stage,
    round: u32,
    iterations: u64,
    absorbed_pieces: usize,
    emitted: f64,
    /// Luminous flux [lm] by which the last iteration changed the radiosities.
    unshot: f64,
}

impl Hierarchical {
    /// # Errors
    /// [`Error::Parameter`] for settings that are refused, curved surfaces, or more than 6000 triangles.
    pub fn new(problem: &Problem, settings: &Settings) -> Result<Hierarchical, Error> {
        check(problem, settings)?;
        let contour = Contour::new(problem, &settings.factors)?;
        let clusters = Clusters::of(problem);
        if clusters.roots.len() > MOST_ROOTS {
            let allowed = "the hierarchical method takes scenes of 6000 triangles at most, both sides counted";
            return Err(Error::Parameter { name: "triangles", value: clusters.roots.len().to_string(), allowed });
        }
        let surfaces = Surfaces::of(problem);
        let emitted = surfaces.emitted();
        let dark = vec![[0.0; 3]; clusters.all.len()];
        let mut solver = Hierarchical {
            settings: settings.clone(),
            contour,
            links: pairs(problem, &clusters),
            refined: Vec::new(),
            radiosity: dark.clone(),
            arrived: dark,
            irradiance: vec![[0.0; 3]; problem.mesh.len()],
            stage: if emitted > 0.0 { Stage::Refining } else { Stage::Done },
            round: 0,
            iterations: 0,
            absorbed_pieces: 0,
            emitted,
            unshot: emitted,
            surfaces,
            clusters,
        };
        solver.push_pull();
        Ok(solver)
    }

    fn pieces(&self) -> usize {
        self.links.len().div_ceil(LINKS_PER_PIECE).max(1)
    }

    /// Refines the links of `piece`: one row for each run of links with the same first end.
    fn refine(&self, problem: &Problem, links: &[Link]) -> Vec<Row> {
        let radiosity: Vec<f64> = self.radiosity.iter().map(|&b| luminance(b)).collect();
        let limit = self.settings.link_power * self.emitted;
        let refinement =
            Refinement { problem, contour: &self.contour, clusters: &self.clusters.all, radiosity: &radiosity, limit };
        let most = links.len() + (MOST_LINKS - self.links.len().min(MOST_LINKS)) / self.pieces();
        let mut refined = Vec::new();
        links.iter().for_each(|&link| refinement.refine(link, most, &mut refined));
        let runs = refined.chunk_by(|a, b| a.ends[0] == b.ends[0]);
        runs.map(|run| Row {
            element: run[0].ends[0],
            entries: run.iter().map(|link| (link.ends[1], link.exchange)).collect(),
            ..Row::default()
        })
        .collect()
    }

    /// What arrives [lux] on both ends of `links`.
    fn gather(&self, links: &[Link]) -> Vec<Landing> {
        let arriving = |link: &Link| {
            let [p, q] = link.ends.map(|end| end as usize);
            let on = |to: usize, from: usize| {
                let factor = link.exchange / self.clusters.all[to].area;
                landing(to, self.radiosity[from].map(|b| b * factor))
            };
            [on(p, q), on(q, p)]
        };
        links.iter().filter(|link| link.exchange > 0.0).flat_map(arriving).collect()
    }

    /// Carries what has arrived on clusters down to the elements, and their radiosities up again.
    fn push_pull(&mut self) {
        let mut falling = std::mem::replace(&mut self.arrived, vec![[0.0; 3]; self.radiosity.len()]);
        self.unshot = 0.0;
        for (k, cluster) in self.clusters.all.iter().enumerate() {
            let e = falling[k];
            if let Some(halves) = cluster.halves {
                halves.iter().for_each(|&half| falling[half as usize] = plus(falling[half as usize], e));
            } else {
                let i = cluster.element as usize;
                let new = self.surfaces.radiosity(i, e);
                self.unshot += cluster.area * luminance(minus(new, self.radiosity[k])).abs();
                (self.irradiance[i], self.radiosity[k]) = (e, new);
            }
        }
        for (k, cluster) in self.clusters.all.iter().enumerate().rev() {
            let Some([a, b]) = cluster.halves.map(|halves| halves.map(|half| half as usize)) else { continue };
            let [of_a, of_b] = [a, b].map(|half| self.clusters.all[half].area / cluster.area);
            self.radiosity[k] = std::array::from_fn(|c| of_a * self.radiosity[a][c] + of_b * self.radiosity[b][c]);
        }
    }

    fn end_step(&mut self) {
        match self.stage {
            Stage::Refining => {
                let refined = std::mem::take(&mut self.refined);
                let as_before = self.round > 0 && refined.len() == self.links.len();
                self.links = refined;
                self.round += 1;
                self.stage = if as_before { Stage::Done } else { Stage::Gathering };
            }
            Stage::Gathering => {
                self.push_pull();
                self.iterations += 1;
                let goes_on = self.unshot > self.settings.unshot * self.emitted && self.unshot <= 1e6 * self.emitted;
                if !goes_on || self.iterations == MOST_SWEEPS {
                    let last = self.round == MOST_ROUNDS || self.iterations == MOST_SWEEPS;
                    self.stage = if last { Stage::Done } else { Stage::Refining };
                }
            }
            Stage::Done => {}
        }
    }

    /// Unshot is what arrives beyond E from the radiosities Be + rho E.
    fn balance(&self) -> Balance {
        let both = |link: &Link| {
            let [p, q] = link.ends.map(|end| luminance(self.radiosity[end as usize]));
            link.exchange * (p + q)
        };
        let arriving: f64 = self.links.iter().filter(|link| link.exchange > 0.0).map(both).sum();
        let radiosity = |(i, &e): (usize, &Light)| self.surfaces.radiosity(i, e);
        Balance {
            emitted: self.emitted,
            absorbed: self.surfaces.absorbed(&self.irradiance),
            escaped: self.surfaces.flux(self.irradiance.iter().enumerate().map(radiosity)) - arriving,
            back_face: 0.0,
            unshot: arriving - self.surfaces.flux(self.irradiance.iter().copied()),
        }
    }
}

/// Links, not yet measured, between all pairs of roots that may see each other.
fn pairs(problem: &Problem, clusters: &Clusters) -> Vec<Link> {
    let tolerance = f64::from(problem.geometry.lift());
    let in_front = |of: u32, other: u32| {
        let [of, other] = [of, other].map(|root| &clusters.all[root as usize]);
        let height = |p: glam::Vec3| of.normal.dot(p.as_dvec3() - of.samples[0]);
        problem.scene.corners(other.triangle).into_iter().any(|p| height(p) > tolerance)
    };
    let roots = &clusters.roots;
    let all = roots.iter().enumerate().flat_map(|(k, &p)| roots[k + 1..].iter().map(move |&q| (p, q)));
    let facing = all.filter(|&(p, q)| in_front(p, q) && in_front(q, p));
    facing.map(|(p, q)| Link { ends: [p, q], exchange: f64::NAN }).collect()
}

#[typetag::serde]
impl Solver for Hierarchical {
    fn step(&self) -> Option<Range<u64>> {
        (self.stage != Stage::Done).then(|| self.absorbed_pieces as u64..self.pieces() as u64)
    }

    fn part(&self, problem: &Problem, piece: u64) -> Part {
        let first = piece as usize * LINKS_PER_PIECE;
        let links = &self.links[first.min(self.links.len())..(first + LINKS_PER_PIECE).min(self.links.len())];
        match self.stage {
            Stage::Refining => Part { rows: self.refine(problem, links), ..Part::default() },
            Stage::Gathering => Part { landings: self.gather(links), ..Part::default() },
            Stage::Done => Part::default(),
        }
    }

    fn absorb(&mut self, _: &Problem, part: Part) {
        for row in part.rows {
            let link = |(other, exchange)| Link { ends: [row.element, other], exchange };
            self.refined.extend(row.entries.into_iter().map(link));
        }
        for landing in &part.landings {
            let arrived = &mut self.arrived[landing.element as usize];
            *arrived = plus(*arrived, light_of(landing));
        }
        self.absorbed_pieces += 1;
        if self.absorbed_pieces == self.pieces() {
            self.absorbed_pieces = 0;
            self.end_step();
        }
    }

    fn solution(&self, problem: &Problem) -> Solution {
        let Settings { factors, unshot, link_power, .. } = &self.settings;
        let parameters = vec![
            ("link power", link_power.to_string()),
            ("visibility", factors.visibility.to_string()),
            ("unshot", unshot.to_string()),
            ("links", self.links.len().to_string()),
        ];
        Solution {
            irradiance: self.irradiance.iter().map(|&e| to_rgb(e)).collect(),
            std_error: vec![Rgb::grey(f32::NAN); self.irradiance.len()],
            certainty: None,
            work: Work::default(),
            balance: self.balance(),
            provenance: provenance(problem, NAME, parameters, factors.seed),
            groups: Vec::new(),
        }
    }

    fn fits(&self, problem: &Problem) -> bool {
        let (elements, clusters) = (problem.mesh.len(), self.clusters.all.len());
        let ends = self.links.iter().chain(&self.refined).flat_map(|link| link.ends);
        [self.radiosity.len(), self.arrived.len()] == [clusters; 2]
            && self.irradiance.len() == elements
            && self.surfaces.fits(elements)
            && { ends }.all(|end| (end as usize) < clusters)
    }

    fn progress(&self) -> Progress {
        let stage = if self.stage == Stage::Refining { "refining links" } else { "gathering over links" };
        let unshot = self.unshot / self.emitted.max(f64::MIN_POSITIVE);
        Progress { stage, rays: 0, rays_in_all: None, unshot, rms_error: None, asked: None, bias: None, excess: None }
    }
}
