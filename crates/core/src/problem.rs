//! What every solver is given: immutable, shared between threads.

use crate::Error;
use crate::geometry::{self, Geometry};
use crate::mesh::{Cut, ElementMesh, Resolution};
use crate::scene::Scene;

/// A scene, cut into elements, ready to be traced.
pub struct Problem {
    pub scene: Scene,
    pub mesh: ElementMesh,
    pub geometry: Box<dyn Geometry>,
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

    /// Why solutions of this problem and of the `other` have nothing in common; `None` if they are of the same scene, cut into the same
    /// elements.
    pub fn difference(&self, other: &Problem) -> Option<&'static str> {
        if self.scene.hash() != other.scene.hash() {
            Some("they are of different scenes (geometry, materials or lights)")
        } else if self.mesh.cut() != other.mesh.cut() {
            Some("the scene is cut into different elements")
        } else {
            None
        }
    }
}

impl std::fmt::Debug for Problem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Problem({}, {} elements)", self.scene.name, self.mesh.len())
    }
}
