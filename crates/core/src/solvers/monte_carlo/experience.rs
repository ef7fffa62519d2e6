//! What one complete solution teaches the next about where rays are best spent. It never touches an expected value.

use crate::Problem;

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Experience {
    /// Reflected over emitted power.
    pub reflected_share: f64,
}

impl Experience {
    /// What to expect before anything is known: the closed room of mean reflectivity `rho` reflects `rho / (1 - rho)`
    /// of what is emitted.
    pub fn expected(problem: &Problem) -> Experience {
        let mesh = &problem.mesh;
        let weighted = |e| f64::from(mesh.area(e)) * mesh.reflectivity(e).luminance_f64();
        let rho = (mesh.elements().map(weighted).sum::<f64>() / mesh.total_area()).clamp(0.0, 0.95);
        Experience { reflected_share: rho / (1.0 - rho) }
    }

    /// Mean reflectivity that the light meets: `R / (Pe + R)`.
    pub fn mean_reflectivity(self) -> f64 {
        self.reflected_share / (1.0 + self.reflected_share)
    }
}
