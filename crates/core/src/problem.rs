//! What every solver is given: immutable, shared between threads.

use crate::Error;
use crate::geometry::{self, Geometry};
use crate::math::Rgb;
use crate::mesh::{Cut, ElementMesh, Place, Resolution};
use crate::scene::{Contacts, Emitter, LightGroup, Scene};
use glam::Vec3;
use std::sync::Arc;

/// A scene, cut into elements, ready to be traced. Clones share the geometry.
#[derive(Clone)]
pub struct Problem {
    pub scene: Scene,
    pub mesh: ElementMesh,
    pub geometry: Arc<dyn Geometry>,
}

impl Problem {
    /// Cuts `scene` as `resolution` asks and builds its ray structure.
    ///
    /// # Errors
    /// Those of [`ElementMesh::new`].
    pub fn new(scene: Scene, resolution: Resolution) -> Result<Problem, Error> {
        let mesh = ElementMesh::new(&scene, resolution)?;
        let geometry = geometry::for_scene(&scene);
        Ok(Problem { scene, mesh, geometry })
    }

    /// Cuts `scene` as `resolution` asks, and along [`Contacts`] that are longer than `detail` [m].
    ///
    /// # Errors
    /// Those of [`ElementMesh::new`].
    pub fn cut_along_contacts(scene: Scene, resolution: Resolution, detail: f32) -> Result<Problem, Error> {
        let cut = resolution.cut_along(&scene, &Contacts::of(&scene, detail))?;
        Problem::with_cut(scene, &cut)
    }

    /// The same cut a solution was computed with, see [`ElementMesh::with_cut`].
    ///
    /// # Errors
    /// Those of [`ElementMesh::with_cut`].
    pub fn with_cut(scene: Scene, cut: &Cut) -> Result<Problem, Error> {
        let mesh = ElementMesh::with_cut(&scene, cut)?;
        let geometry = geometry::for_scene(&scene);
        Ok(Problem { scene, mesh, geometry })
    }

    /// The same scene, cut as `cut` says.
    ///
    /// # Errors
    /// Those of [`ElementMesh::with_cut`].
    pub fn cut_anew(self, cut: &Cut) -> Result<Problem, Error> {
        let mesh = ElementMesh::with_cut(&self.scene, cut)?;
        Ok(Problem { mesh, ..self })
    }

    /// Number of the object of the scene on which element `e` lies.
    pub fn object(&self, e: u32) -> u32 {
        self.scene.triangles[self.mesh.triangle(e) as usize].object
    }

    /// World position [m] in the middle of element `e`, and the unit normal of its side there; the means over a cluster.
    pub fn centre(&self, e: u32) -> (Vec3, Vec3) {
        let middle = |place: Place| {
            let [a, b, c] = self.mesh.corners_at(place);
            let (position, normal) = self.geometry.surface(place.triangle, (a + b + c) / 3.0);
            (position, if place.back { -normal } else { normal })
        };
        let first = middle(self.mesh.place(e));
        let Some(cluster) = self.mesh.cluster(e) else { return first };
        let shares = cluster.pieces().iter().map(|piece| piece.share());
        let add = |(position, normal): (Vec3, Vec3), ((p, n), share): ((Vec3, Vec3), f32)| {
            (position + share * p, normal + share * n)
        };
        let means = self.mesh.pieces(e).map(middle).zip(shares).fold((Vec3::ZERO, Vec3::ZERO), add);
        (means.0, means.1.normalize_or(first.1))
    }

    /// Number of the face on which element `e` lies: twice its object's, and one more on the back of two-sided surfaces. What falls on the two sides of
    /// a wall has nothing in common, so it is told apart wherever light on objects is summed.
    pub fn face(&self, e: u32) -> u32 {
        2 * self.object(e) + u32::from(self.mesh.place(e).back)
    }

    /// How many numbers of faces there are.
    pub fn faces(&self) -> usize {
        2 * self.scene.objects.len()
    }

    /// For each face, whether it has elements.
    pub fn has_faces(&self) -> Vec<bool> {
        let mut is_there = vec![false; self.faces()];
        self.mesh.elements().for_each(|e| is_there[self.face(e) as usize] = true);
        is_there
    }

    /// For each face, which side of its object it is, if that has elements on both.
    pub fn sides(&self) -> Vec<Option<Side>> {
        let of_object = |pair: &[bool]| match pair {
            [true, true] => [Some(Side::Front), Some(Side::Back)],
            _ => [None, None],
        };
        self.has_faces().chunks(2).flat_map(of_object).collect()
    }

    /// Flux [lm] per channel that the sources of `group` emit.
    pub fn flux_of(&self, group: &LightGroup) -> [f64; 3] {
        let objects = group.objects(&self.scene);
        let surfaces = self.mesh.elements().filter(|&e| objects[self.object(e) as usize]);
        let radius = self.geometry.bounding_sphere().1;
        let lights = group.sources.iter().filter_map(|source| match source.emitter {
            Emitter::Object(_) => None,
            Emitter::Light(k) => Some(self.scene.lights[k as usize].flux(radius)),
        });
        surfaces.map(|e| self.mesh.emitted_flux(e)).chain(lights).fold([0.0; 3], |sum, flux: Rgb| {
            let flux = flux.to_array();
            std::array::from_fn(|c| sum[c] + f64::from(flux[c]))
        })
    }

    /// Lets nothing shine but number `lit` of the `groups`, each of whose sources emits what it does in `whole`, a problem of the same
    /// elements and geometry.
    pub fn light_only(&mut self, whole: &Problem, groups: &[LightGroup], lit: usize) {
        self.scene.objects.clone_from(&whole.scene.objects);
        self.scene.materials.clone_from(&whole.scene.materials);
        self.scene.lights.clone_from(&whole.scene.lights);
        let factor = |k: usize| if k == lit { Rgb::WHITE } else { Rgb::BLACK };
        self.scene.relight(groups.iter().enumerate().map(|(k, group)| (group, factor(k))));
        self.scene.lights.retain(|light| !light.intensity.is_black());
        let objects = groups[lit].objects(&whole.scene);
        let shines = |triangle: u32| objects[whole.scene.triangles[triangle as usize].object as usize];
        self.mesh.take_emission(&whole.mesh, shines);
    }

    /// Why solutions of this problem and of the `other` have nothing in common; `None` if they are of the same scene, cut into the same
    /// elements.
    pub fn difference(&self, other: &Problem) -> Option<&'static str> {
        let elements = || (!self.has_elements_of(other)).then_some("the scene is cut into different elements");
        self.difference_of_scene(other).or_else(elements)
    }

    /// Why their scenes have nothing in common; `None` if they are the same.
    pub fn difference_of_scene(&self, other: &Problem) -> Option<&'static str> {
        let is_other = self.scene.hash() != other.scene.hash();
        is_other.then_some("they are of different scenes (geometry, materials or lights)")
    }

    /// Whether the `other` problem of the same scene is cut into the same elements.
    pub fn has_elements_of(&self, other: &Problem) -> bool {
        self.mesh.cut() == other.mesh.cut()
    }
}

/// A side of two-sided surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    Front,
    Back,
}

/// `Floor`, or `Floor, back` if it has two sides.
pub fn name_of_side(name: &str, side: Option<Side>) -> String {
    match side {
        None => name.to_owned(),
        Some(Side::Front) => format!("{name}, front"),
        Some(Side::Back) => format!("{name}, back"),
    }
}

impl std::fmt::Debug for Problem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Problem({}, {} elements)", self.scene.name, self.mesh.len())
    }
}
