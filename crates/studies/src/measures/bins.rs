//! Means over elements of like area.

use isolux_core::Problem;

/// Elements whose areas lie within a factor of two.
#[derive(Clone, Debug)]
pub struct Bin {
    pub elements: Vec<u32>,
    /// Geometric mean of their areas [m²].
    pub area: f64,
}

/// Fewer elements than this make no mean.
const LEAST: usize = 12;

/// The elements of `problem` by area, the smallest first; at most `most` of each bin, evenly chosen.
pub fn by_area(problem: &Problem, most: usize) -> Vec<Bin> {
    let mut bins: Vec<(i32, Vec<u32>)> = Vec::new();
    for e in problem.mesh.elements() {
        let octave = problem.mesh.area(e).log2().floor() as i32;
        match bins.iter_mut().find(|(known, _)| *known == octave) {
            Some((_, elements)) => elements.push(e),
            None => bins.push((octave, vec![e])),
        }
    }
    bins.sort_by_key(|(octave, _)| *octave);
    let full = bins.into_iter().map(|(_, elements)| elements).filter(|elements| elements.len() >= LEAST);
    full.map(|elements| {
        let step = elements.len().div_ceil(most);
        let elements: Vec<u32> = elements.into_iter().step_by(step).collect();
        let logarithms = elements.iter().map(|&e| f64::from(problem.mesh.area(e)).ln());
        let area = (logarithms.sum::<f64>() / elements.len() as f64).exp();
        Bin { elements, area }
    })
    .collect()
}

impl Bin {
    /// Mean of `value` over its elements.
    pub fn mean(&self, value: impl Fn(u32) -> f64) -> f64 {
        self.elements.iter().map(|&e| value(e)).sum::<f64>() / self.elements.len() as f64
    }
}
