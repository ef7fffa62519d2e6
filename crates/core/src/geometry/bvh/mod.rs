//! The ray kernel: what a ray hits first, all that it hits, and whether anything lies in its way.
//!
//! Triangles lie in a tree of boxes with eight children a node (a bounding volume hierarchy: Wald, Benthin & Boulos,
//! Getting Rid of Packets, 2008). One ray is tested against the eight boxes of a node at once, and against the four
//! triangles of a leaf at once.
//!
//! * Boxes: the slab test with its far side widened by the rounding error (Ize, Robust BVH Ray Traversal, JCGT 2013);
//!   the boxes themselves are padded by a few rounding errors of the scene's size.
//! * Triangles: the edge test of Woop, Benthin & Wald (Watertight Ray/Triangle Intersection, JCGT 2013). The corners are
//!   brought into the ray's own space, where the ray is the axis z, and the three edge functions `U = Cx By - Cy Bx`, ...
//!   (the Plücker products of ray and edges, in that space) tell on which side of each edge it passes. Two neighbours
//!   compute the same number for their shared edge but for its sign, and that sign is never wrong because a difference of
//!   two rounded products is negative only if the exact one is. A closed mesh therefore leaks no ray, through edges or
//!   through corners.
//!
//! The hit is the least by distance, then by triangle number, of all triangles that pass the test: where surfaces coincide
//! neither the tree nor the order of traversal decides. All arithmetic is plain IEEE single precision without fused
//! operations, so both paths, AVX2 and portable, give the same bits. (Fused products would also spoil the argument above.)
//!
//! Cost: about log8(triangles) nodes and a few leaves a ray; about 70 bytes a triangle, and 36 for its corners. Distances are
//! exact to a few roundings of the distance between origin and triangle over the cosine at which it is met. Cubes of
//! distances must fit a float, so scenes may be from 1e-7 to 1e11 metres wide.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod binary;
mod build;
mod intersect;
mod lanes;
mod node;
mod plan;
mod portable;
mod split;
#[cfg(test)]
mod tests;
mod traverse;

use super::{Corners, Facet, Geometry, Hit, HitLists, Ray};
use crate::scene::Scene;
use glam::{Vec2, Vec3};
use node::Tree;
use portable::Portable;

/// Triangles in a tree of boxes.
#[derive(Clone, Debug)]
pub struct Bvh {
    corners: Corners,
    tree: Tree,
    path: Path,
}

/// The instructions the kernel runs on.
#[derive(Clone, Copy, Debug)]
enum Path {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2(avx2::Avx2),
}

impl Bvh {
    /// Builds the tree over the triangles of `scene`, O(n log n), and chooses the fastest instructions this machine has.
    /// Triangles with a coordinate that is not finite are never hit.
    pub fn new(scene: &Scene) -> Bvh {
        Bvh { path: Path::fastest(), ..Bvh::portable(scene) }
    }

    /// The same without any special instructions: same hits, for comparison.
    pub fn portable(scene: &Scene) -> Bvh {
        let corners = Corners::of(scene);
        let tree = build::tree(&corners.triangles);
        Bvh { corners, tree, path: Path::Portable }
    }

    /// Memory of the tree and the corner positions [bytes].
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + size_of_val(self.corners.triangles.as_slice())
    }
}

impl Path {
    #[cfg(target_arch = "x86_64")]
    fn fastest() -> Path {
        avx2::Avx2::detect().map_or(Path::Portable, Path::Avx2)
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn fastest() -> Path {
        Path::Portable
    }
}

impl Geometry for Bvh {
    fn closest(&self, rays: &[Ray], hits: &mut [Hit]) {
        match self.path {
            Path::Portable => traverse::closest::<Portable>(&self.tree, rays, hits),
            #[cfg(target_arch = "x86_64")]
            Path::Avx2(avx2) => avx2.closest(&self.tree, rays, hits),
        }
    }

    fn all(&self, rays: &[Ray], lists: &mut HitLists) {
        match self.path {
            Path::Portable => traverse::all::<Portable>(&self.tree, rays, lists),
            #[cfg(target_arch = "x86_64")]
            Path::Avx2(avx2) => avx2.all(&self.tree, rays, lists),
        }
    }

    fn any(&self, rays: &[Ray], reach: &[f32], blocked: &mut [bool]) {
        match self.path {
            Path::Portable => traverse::any::<Portable>(&self.tree, rays, reach, blocked),
            #[cfg(target_arch = "x86_64")]
            Path::Avx2(avx2) => avx2.any(&self.tree, rays, reach, blocked),
        }
    }

    fn surface(&self, triangle: u32, uv: Vec2) -> (Vec3, Vec3) {
        self.corners.surface(triangle, uv)
    }

    fn facet(&self, triangle: u32) -> Option<Facet> {
        Some(self.corners.facet(triangle))
    }

    fn lift(&self) -> f32 {
        self.corners.lift
    }

    fn bounding_sphere(&self) -> (Vec3, f32) {
        (self.corners.center, self.corners.radius)
    }
}
