//! Who is measured.

use anyhow::Result;
use isolux_core::geometry::{Bvh, Geometry, Hit, Ray};
use isolux_core::scene::Scene;

/// A ray kernel with a scene in it.
pub trait Contestant {
    fn name(&self) -> &'static str;

    /// As [`Geometry::closest`].
    fn closest(&self, rays: &[Ray], hits: &mut [Hit]);

    /// As [`Geometry::any`].
    fn any(&self, rays: &[Ray], reach: &[f32], blocked: &mut [bool]);
}

/// Everybody, isolux first and Embree, if it is there, last.
pub fn contestants(scene: &Scene) -> Result<Vec<Box<dyn Contestant>>> {
    Ok(vec![
        Box::new(Isolux { name: "isolux", bvh: Bvh::new(scene) }),
        Box::new(Isolux { name: "isolux, portable", bvh: Bvh::portable(scene) }),
        #[cfg(feature = "embree")]
        Box::new(crate::embree::Embree::new(scene)?),
    ])
}

struct Isolux {
    name: &'static str,
    bvh: Bvh,
}

impl Contestant for Isolux {
    fn name(&self) -> &'static str {
        self.name
    }

    fn closest(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.bvh.closest(rays, hits);
    }

    fn any(&self, rays: &[Ray], reach: &[f32], blocked: &mut [bool]) {
        self.bvh.any(rays, reach, blocked);
    }
}
