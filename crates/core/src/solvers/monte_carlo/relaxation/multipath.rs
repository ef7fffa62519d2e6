//! Global multipath: light waits on an element for the next global line that crosses it (Sbert, Pueyo, Neumann & Purgathofer 1996).
//!
//! Each span of a line joins two ends; what waits at one leaves for the other, and so the other way round: with one line light takes
//! many paths at once. The light that is there before the first line, emitted or reflected after a first shot, is the source: it
//! leaves in equal shares, `P_i / N_i` with each of the `N_i = N A_i / (2 pi R²)` expected crossings. (All of it with the first
//! crossing would not get better with more lines.) Lines are traced in parallel; what they carry is booked one after the other, in
//! their order. What still waits when the lines are used up is shot by further lines.
//!
//! Unbiased with random numbers. The lines of a low-discrepancy sequence avoid one another, so the line with which light leaves is not
//! independent of the one that brought it, and the estimate is biased (a test has seen it with Niederreiter's).

use super::{Draw, Relaxation};
use crate::Problem;
use crate::math::Rgb;
use crate::solvers::Part;
use crate::solvers::monte_carlo::axes::FirstShot;
use crate::transport::{End, Span};

impl Relaxation {
    /// Lets light walk along the spans of `part`.
    pub(super) fn walk_along(&mut self, problem: &Problem, part: &Part) {
        let Draw::Lines(lines) = &self.draw else { return };
        let crossings_per_area = lines.crossings_per_area() as f32;
        for &Span { from, to } in &part.spans {
            let leaving = [from, to].map(|end| self.leave(problem, end, crossings_per_area));
            self.arrive(problem, to, leaving[0]);
            self.arrive(problem, from, leaving[1]);
        }
    }

    /// Takes the light [lm] that leaves `end` with this line.
    fn leave(&mut self, problem: &Problem, end: End, crossings_per_area: f32) -> Rgb {
        let Some(element) = end.element() else { return Rgb::BLACK };
        let share = self.source(problem, element) / crossings_per_area;
        self.adrift -= share.luminance_f64();
        self.light.take_unshot(element) + share
    }

    /// Radiosity [lm/m²] that element `e` had before the first line.
    fn source(&self, problem: &Problem, e: u32) -> Rgb {
        let reflected = problem.mesh.reflectivity(e) * self.light.shot_first(e) / problem.mesh.area(e);
        match self.method.first_shot {
            FirstShot::Local => reflected,
            FirstShot::Same => reflected + problem.mesh.emission(e),
        }
    }

    fn arrive(&mut self, problem: &Problem, end: End, light: Rgb) {
        match end.element() {
            Some(element) => {
                let landed = self.light.land_and_wait(&problem.mesh, element, light);
                self.balance.absorbed += landed.absorbed;
                self.reflected += landed.reflected;
            }
            None if end == End::BACK_FACE => self.lost[1] += light.luminance_f64(),
            None => self.lost[0] += light.luminance_f64(),
        }
    }
}
