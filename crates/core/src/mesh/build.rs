//! Cutting a scene into elements.

use super::average::Averages;
use super::bisection::Division;
use super::clusters::{Cluster, Clusters};
use super::cut::Cut;
use super::descent::Step;
use super::slices::Slices;
use super::sparse::SparseColors;
use super::{ElementMesh, Patch, Resolution, Surface, cells, morton, triangle};
use crate::Error;
use crate::math::Rgb;
use crate::scene::Scene;
use glam::Vec2;

impl ElementMesh {
    /// Cuts `scene` into elements as `resolution` asks.
    ///
    /// # Errors
    /// [`Error::NoSurface`] without triangles, [`Error::TooManyElements`], [`Error::NotFinite`] for a material or texture that is not.
    pub fn new(scene: &Scene, resolution: Resolution) -> Result<ElementMesh, Error> {
        if scene.triangles.is_empty() {
            return Err(Error::NoSurface);
        }
        ElementMesh::with_cut(scene, &resolution.cut(scene)?)
    }

    /// Cuts `scene` as it was cut before: what a saved solution remembers of its mesh.
    ///
    /// # Errors
    /// As [`ElementMesh::new`]; [`Error::Parameter`] if `cut` is of another scene.
    pub fn with_cut(scene: &Scene, cut: &Cut) -> Result<ElementMesh, Error> {
        if scene.triangles.is_empty() {
            return Err(Error::NoSurface);
        }
        let total = cut.element_count(scene)?;
        let mut mesh = ElementMesh {
            surfaces: Vec::with_capacity(cut.slices.len()),
            patches: Vec::with_capacity(cut.divisions.len()),
            parts: Vec::new(),
            steps: Vec::new(),
            clusters: Clusters::default(),
            patch: Vec::with_capacity(total),
            reflectivity: Vec::with_capacity(total),
            emission: SparseColors::default(),
        };
        (0..).zip(&cut.slices).for_each(|(t, &slices)| mesh.push_triangle(scene, t, slices));
        let mut divisions = cut.divisions.iter().copied();
        for t in 0..mesh.surfaces.len() {
            mesh.divide_triangle(triangle::surface_area(scene, t as u32), t, &mut divisions);
        }
        let (averages, clusters) = (Averages::new(scene), Clusters::new(scene, &cut.leaders));
        for t in morton::order(scene) {
            match clusters.with(t) {
                None => mesh.push_triangle_elements(&averages, t),
                Some(cluster) if cluster.largest() == t => mesh.push_cluster(&averages, cluster),
                Some(_) => {}
            }
        }
        mesh.steps = Step::from_all(&mesh.patches);
        mesh.clusters = clusters;
        mesh.check_finite()?;
        Ok(mesh)
    }

    /// A triangle and its patches, in the order of the scene.
    fn push_triangle(&mut self, scene: &Scene, t: u32, slices: Slices) {
        let first_patch = self.patches.len() as u32;
        self.patches.extend((0..slices.patch_count()).map(|_| Patch { triangle: t, ..Patch::NONE }));
        let (two_sided, normal) = (scene.is_two_sided(t), triangle::normal(scene.corners(t)));
        self.surfaces.push(Surface { first_patch, slices, two_sided, normal });
    }

    /// Divides the patches of triangle `t` of `area` [m²].
    fn divide_triangle(&mut self, area: f64, t: usize, divisions: &mut impl Iterator<Item = Division>) {
        let Surface { first_patch, slices, .. } = self.surfaces[t];
        for k in 0..slices.patch_count() {
            self.divide(first_patch + k, area * slices.area_share(k), divisions);
        }
    }

    /// The element that a cluster is on its front, and the one on its back if it has two sides.
    fn push_cluster(&mut self, averages: &Averages, cluster: Cluster) {
        const WHOLE: [Vec2; 3] = [Vec2::ZERO, Vec2::X, Vec2::Y];
        let first_element = self.patch.len() as u32;
        let patches: Vec<u32> = cluster.triangles().map(|t| self.surfaces[t as usize].first_patch).collect();
        let area: f64 = patches.iter().map(|&patch| f64::from(self.patches[patch as usize].measure)).sum();
        let (mut reflectivity, mut emission) = (Rgb::BLACK, Rgb::BLACK);
        for (piece, &patch) in cluster.pieces().iter().zip(&patches) {
            let patch = &mut self.patches[patch as usize];
            (patch.first, patch.measure) = (first_element, area as f32);
            let (reflects, emits) = averages.over_cell(piece.triangle, WHOLE);
            reflectivity += reflects * piece.share();
            emission += emits * piece.share();
        }
        let largest = cluster.largest();
        for _ in 0..1 + u32::from(self.is_two_sided(largest)) {
            self.patch.push(self.surfaces[largest as usize].first_patch);
            self.reflectivity.push(reflectivity);
            self.emission.push(emission);
        }
    }

    /// The elements of all patches of a triangle.
    fn push_triangle_elements(&mut self, averages: &Averages, t: u32) {
        self.surfaces[t as usize].patches().for_each(|patch| self.push_elements(averages, patch));
    }

    /// The elements of a patch, in the order of their numbers.
    fn push_elements(&mut self, averages: &Averages, patch: u32) {
        let first = self.patch.len();
        let whole = &mut self.patches[patch as usize];
        if whole.is_divided() {
            return whole.parts().for_each(|part| self.push_elements(averages, part));
        }
        whole.first = first as u32;
        let Patch { triangle, divisions, .. } = *whole;
        for cell in 0..cells::count(divisions) {
            let corners = cells::corners(cell, divisions).map(|uv| self.on_triangle(patch, uv));
            let (reflectivity, emission) = averages.over_cell(triangle, corners);
            self.patch.push(patch);
            self.reflectivity.push(reflectivity);
            self.emission.push(emission);
        }
        if self.is_two_sided(triangle) {
            self.patch.extend_from_within(first..);
            self.reflectivity.extend_from_within(first..);
            let front = first as u32..first as u32 + cells::count(divisions);
            front.for_each(|e| self.emission.push(self.emission.get(e)));
        }
    }

    fn check_finite(&self) -> Result<(), Error> {
        for e in self.elements() {
            for (what, color) in [("reflectivity", self.reflectivity(e)), ("emission", self.emission(e))] {
                if let Some(value) = color.to_array().into_iter().find(|v| !v.is_finite()) {
                    return Err(Error::NotFinite { element: e, what, value });
                }
            }
        }
        Ok(())
    }
}
