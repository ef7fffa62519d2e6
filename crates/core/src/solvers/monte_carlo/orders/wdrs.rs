//! Radiosity with well distributed ray sets (Neumann, Neumann, Bekaert et al., Eurographics 1997).
//!
//! All rays carry the same luminous flux w. An element of power `P_i = Pe_i + rho_i (what has landed)` shall have shot
//! `n_i = floor(P_i / w + u_i)` rays, the first n_i of its own sequence; it shoots those that it lacks, until none lacks any: a
//! complete solution. Then w is halved, and with it all that has landed, and again each element shoots what it lacks. No ray is
//! ever wasted or stored: the counters n_i say which rays there are. With the offset `u_i`, drawn once for each element, an
//! element shoots its power on average, where the paper rounds up.
//!
//! The new rays of an element carry what makes the colour of all its rays that of its power. Unbiased but for the address: points of
//! one sequence avoid each other, and how many an element shoots depends on where earlier ones went (with `--sequence random` there
//! is no such bias). Memory: 20 bytes a source beside its light ([`Light`]). Cost: one ray a sample.

use super::Entry;
use crate::math::Rgb;
use crate::math::hash::{derive, unit_f64};
use crate::sampling::address::{Address, Counters};
use crate::solution::Balance;
use crate::solvers::allocation::Allocation;
use crate::solvers::monte_carlo::axes::Lines;
use crate::solvers::monte_carlo::complete::CompleteSolution;
use crate::solvers::monte_carlo::light::{Light, Origin};
use crate::solvers::monte_carlo::{Experience, Method, Settings, patience, sources};
use crate::solvers::{Part, shooting};
use crate::transport::Footprint;
use crate::{Error, Problem};
use std::ops::Range;

pub(super) const ENTRY: Entry = Entry {
    name: "wdrs",
    what: "when an element lacks rays of the common power: well distributed ray sets",
    source: "Neumann, Neumann, Bekaert et al. 1997",
    pools: |_| true,
    natural_address: |_| Address::PerElement,
    natural_replicates: 16,
    tells_light_apart: |_| false,
    check,
    make: |problem, settings| Box::new(Wdrs::new(problem, settings)),
};

/// How often the flux of a ray is halved in a complete solution.
const REFINEMENTS: i32 = 3;

#[derive(Debug, serde::Serialize, serde::Deserialize)]
struct Wdrs {
    method: Method,
    seed: u64,
    rays_done: u64,
    /// Rays after which it gives up.
    patience: u64,
    step: u64,
    /// Luminous flux [lm] of every ray.
    ray_flux: f64,
    halvings_left: i32,
    /// For every source: rays that it has shot, and the flux [lm] they carry now.
    counters: Counters,
    shot: Vec<u32>,
    sent: Vec<Rgb>,
    light: Light,
    /// The running step.
    allocation: Allocation,
    pieces_absorbed: u64,
    complete: bool,
    /// Flux [lm] that was lost into the open and to backs.
    lost: [f64; 2],
    emitted: f64,
    /// Flux [lm] that the elements have absorbed and reflected.
    absorbed: f64,
    reflected: f64,
}

fn check(method: &Method) -> Result<(), Error> {
    if method.lines != Lines::Local {
        let what = "an element cannot be given the rays that it lacks, for global lines cannot be aimed";
        return Err(Error::Meaningless { what, nearest: "--order stochastic-jacobi" });
    }
    Ok(())
}

impl Wdrs {
    fn new(problem: &Problem, settings: &Settings) -> Wdrs {
        let sources = sources::count(problem);
        Wdrs {
            method: settings.method,
            seed: 0,
            rays_done: 0,
            patience: 0,
            step: 0,
            ray_flux: 0.0,
            halvings_left: 0,
            counters: settings.method.address.counters(sources),
            shot: vec![0; sources],
            sent: vec![Rgb::BLACK; sources],
            light: Light::new(problem.mesh.len(), false, settings.leaving),
            allocation: Allocation::default(),
            pieces_absorbed: 0,
            complete: true,
            lost: [0.0; 2],
            emitted: 0.0,
            absorbed: 0.0,
            reflected: 0.0,
        }
    }

    /// Starts with rays that are to be halved so often until each carries `ray_flux` [lm].
    fn start(&mut self, problem: &Problem, ray_flux: f64, halvings: i32) {
        self.halvings_left = halvings;
        self.ray_flux = ray_flux * 2f64.powi(halvings);
        self.enter(problem);
    }

    /// Power [lm] of source `i`: what it emits and reflects.
    fn power(&self, problem: &Problem, i: u32) -> Rgb {
        let is_element = (i as usize) < problem.mesh.len();
        let reflected = if is_element { problem.mesh.reflectivity(i) * self.light.on(i) } else { Rgb::BLACK };
        sources::flux(problem, i) + reflected
    }

    /// Rays that source `i` of power `power` [lm] shall have shot.
    fn wanted(&self, i: u32, power: Rgb) -> u32 {
        (power.luminance_f64() / self.ray_flux + unit_f64(derive(self.seed, u64::from(i)))) as u32
    }

    /// Prepares the shooting of all rays that are lacking; if none is, halves the flux of a ray and looks again.
    fn enter(&mut self, problem: &Problem) {
        loop {
            let lack = |i: u32| {
                let wanted = self.wanted(i, self.power(problem, i));
                (i, wanted.saturating_sub(self.shot[i as usize]))
            };
            self.allocation = Allocation::of_counts((0..self.shot.len() as u32).map(lack));
            self.step += 1;
            self.pieces_absorbed = 0;
            let lacking = self.allocation.rays() > 0 && self.rays_done < self.patience;
            self.complete = !lacking && self.halvings_left == 0;
            if lacking || self.complete {
                return;
            }
            self.halve();
        }
    }

    fn halve(&mut self) {
        self.halvings_left -= 1;
        self.ray_flux *= 0.5;
        self.lost = self.lost.map(|lost| 0.5 * lost);
        self.sent.iter_mut().for_each(|sent| *sent = *sent * 0.5);
        self.light.scale(0.5);
        (self.absorbed, self.reflected) = (0.5 * self.absorbed, 0.5 * self.reflected);
    }

    /// What each of the `count` new rays of source `i` carries [lm]: together with the others the colour of its power.
    fn ray(&self, problem: &Problem, i: u32, count: u32) -> Rgb {
        let power = self.power(problem, i);
        let rays = f64::from(self.shot[i as usize] + count);
        let all = power * (rays * self.ray_flux / power.luminance_f64()) as f32;
        (all - self.sent[i as usize]) / count as f32
    }
}

#[typetag::serde]
impl CompleteSolution for Wdrs {
    fn restart(&mut self, problem: &Problem, seed: u64, rays: u64, experience: &Experience) {
        (self.seed, self.rays_done, self.step) = (seed, 0, 0);
        self.counters.reset();
        self.shot.fill(0);
        self.sent.fill(Rgb::BLACK);
        self.light.clear();
        self.lost = [0.0; 2];
        (self.absorbed, self.reflected) = (0.0, 0.0);
        self.patience = patience(rays);
        self.emitted = sources::total(problem);
        let power = self.emitted * (1.0 + experience.reflected_share);
        self.start(problem, power / rays as f64, REFINEMENTS);
    }

    fn pieces(&self) -> Option<Range<u64>> {
        (!self.complete).then(|| self.pieces_absorbed..shooting::pieces(self.allocation.rays()))
    }

    fn part(&self, problem: &Problem, piece: u64) -> Part {
        let sequence = self.method.sequence.make(self.method.address.sequence_seed(self.seed, self.step));
        let sweep = shooting::Sweep {
            problem,
            sequence: sequence.as_ref(),
            counters: &self.counters,
            allocation: &self.allocation,
            total: self.ray_flux * self.allocation.rays() as f64,
        };
        sweep.shoot_each(piece, |share| {
            // Light of its own leaves all of an element, and rays do not tell which light they carry.
            let emits = sources::flux(problem, share.source) != Rgb::BLACK;
            let footprint = if emits { Footprint::WHOLE } else { self.light.footprint(share.source) };
            (self.ray(problem, share.source, share.rays), footprint)
        })
    }

    fn absorb(&mut self, problem: &Problem, part: Part, _: &Experience) {
        self.pieces_absorbed += 1;
        self.rays_done += part.rays;
        self.lost[0] += part.escaped;
        self.lost[1] += part.back_face;
        self.light.land(&part);
        self.light.mark(&part, 1.0);
        if self.pieces_absorbed == shooting::pieces(self.allocation.rays()) {
            let sent = |(i, n)| (i, n, self.ray(problem, i, n) * n as f32);
            let sent: Vec<(u32, u32, Rgb)> = self.allocation.counts().map(sent).collect();
            for (i, n, flux) in sent {
                self.sent[i as usize] += flux;
                self.shot[i as usize] += n;
                self.counters.advance(i, n);
            }
            let landed = self.light.reflect(&problem.mesh, Origin::Reflection);
            self.absorbed += landed.absorbed;
            self.reflected += landed.reflected;
            self.light.spend_unshot();
            self.enter(problem);
        }
    }

    fn irradiance(&self, problem: &Problem, e: u32) -> Rgb {
        self.light.on(e) / problem.mesh.area(e)
    }

    fn fits(&self, problem: &Problem) -> bool {
        let sources = sources::count(problem);
        [self.shot.len(), self.sent.len()] == [sources; 2] && self.light.fits(problem.mesh.len(), false)
    }

    fn rays(&self) -> u64 {
        self.rays_done
    }

    /// Unshot is what the offsets have rounded away, negative if they have added to it, and what a running step has yet to shoot.
    fn balance(&self) -> Balance {
        let [escaped, back_face] = self.lost;
        let sent = self.ray_flux * self.shot.iter().map(|&rays| f64::from(rays)).sum::<f64>();
        let unshot = self.emitted + self.reflected - sent;
        Balance { emitted: self.emitted, absorbed: self.absorbed, escaped, back_face, unshot }
    }

    fn experience(&self) -> Experience {
        Experience { reflected_share: self.reflected / self.emitted.max(f64::MIN_POSITIVE) }
    }

    fn stage(&self) -> &'static str {
        "shooting the rays that are lacking"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Resolution;
    use crate::scene::builtin::builtin;
    use crate::transport::Leaving;

    /// A grey box: nothing but the counters is left of how the rays came about.
    fn grey_box() -> Problem {
        let mut scene = builtin("box").unwrap();
        for material in &mut scene.materials {
            material.reflectivity = Rgb::grey(material.reflectivity.luminance());
            material.emission = Rgb::grey(material.emission.luminance());
        }
        Problem::new(scene, Resolution::Elements(200)).unwrap()
    }

    fn started(problem: &Problem) -> Wdrs {
        let settings =
            Settings { method: Method::named("wdrs").unwrap(), leaving: Leaving::WholeElement, ..Settings::default() };
        let mut wdrs = Wdrs::new(problem, &settings);
        wdrs.restart(problem, 7, 1000, &Experience::expected(problem));
        wdrs.patience = u64::MAX;
        wdrs
    }

    /// A complete solution with some four thousand rays, reached in `halvings` refinements.
    fn solved(problem: &Problem, halvings: i32) -> Wdrs {
        let mut wdrs = started(problem);
        wdrs.start(problem, 5e-4 * wdrs.emitted, halvings);
        while let Some(pieces) = wdrs.pieces() {
            for piece in pieces {
                let part = wdrs.part(problem, piece);
                wdrs.absorb(problem, part, &Experience::expected(problem));
            }
        }
        wdrs
    }

    #[test]
    fn refinements_shoot_the_same_rays_as_one_go() {
        let problem = grey_box();
        for halvings in 0..=5 {
            let refined = solved(&problem, halvings);
            assert!(refined.rays_done > 1000, "{}", refined.rays_done);
            // All rays that the counters stand for, shot in a single sweep.
            let allocation = Allocation::of_counts((0..).zip(refined.shot.iter().copied()));
            assert_eq!(allocation.rays(), refined.rays_done, "no ray was wasted");
            let sequence = refined.method.sequence.make(refined.method.address.sequence_seed(refined.seed, 0));
            let counters = &refined.method.address.counters(refined.shot.len());
            let (sequence, total) = (sequence.as_ref(), refined.ray_flux * allocation.rays() as f64);
            let sweep = shooting::Sweep { problem: &problem, sequence, counters, allocation: &allocation, total };
            let mut landed = vec![0.0; problem.mesh.len()];
            for piece in 0..shooting::pieces(allocation.rays()) {
                let part = sweep.shoot_each(piece, |_| (Rgb::grey(refined.ray_flux as f32), Footprint::WHOLE));
                part.landings.iter().for_each(|landing| landed[landing.element as usize] += landing.light[1]);
            }
            for e in problem.mesh.elements() {
                let [a, b] = [landed[e as usize] / problem.mesh.area(e), refined.irradiance(&problem, e).g];
                assert!((a - b).abs() <= 1e-4 * a, "element {e}: {a} {b} after {halvings} halvings");
            }
        }
    }

    #[test]
    fn global_lines_are_refused() {
        for lines in [Lines::Global, Lines::Bundle] {
            let error = Method { lines, ..Method::named("wdrs").unwrap() }.check().unwrap_err();
            assert!(error.to_string().contains("global lines cannot be aimed"), "{error}");
        }
    }

    #[test]
    fn refinements_end_where_one_go_does_but_for_rounding() {
        let problem = grey_box();
        let rays = |halvings| solved(&problem, halvings).rays_done as f64;
        for halvings in 1..=5 {
            assert!((rays(halvings) / rays(0) - 1.0).abs() < 0.01, "{} {}", rays(halvings), rays(0));
        }
    }
}
