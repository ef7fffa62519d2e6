//! Embree 3.13 in robust mode, one ray a call (Wald et al., Embree, ACM Trans. Graph. 33, 2014).

use crate::contestant::Contestant;
use anyhow::{Result, anyhow};
use embree3::{BufferUsage, Device, Format, IntersectContext, SceneFlags, TriangleMeshBuilder};
use glam::Vec2;
use isolux_core::geometry::{Hit, NONE, Ray};
use isolux_core::scene::Scene;

pub struct Embree {
    scene: embree3::Scene<'static>,
}

impl Embree {
    /// Builds Embree's structure over the triangles of `scene`, on all cores, with its default quality.
    pub fn new(scene: &Scene) -> Result<Embree> {
        let error = |e: embree3::Error| anyhow!("Embree: {e}");
        let device = Device::new().map_err(error)?;
        let mut mesh = TriangleMeshBuilder::new(&device).map_err(error)?;
        let vertices = scene.vertices.len();
        let mut positions = mesh
            .set_new_buffer::<[f32; 3]>(BufferUsage::VERTEX, 0, Format::FLOAT3, size_of::<[f32; 3]>(), vertices)
            .map_err(error)?;
        for (to, vertex) in positions.iter_mut().zip(&scene.vertices) {
            *to = vertex.position.to_array();
        }
        let triangles = scene.triangles.len();
        let mut indices = mesh
            .set_new_buffer::<[u32; 3]>(BufferUsage::INDEX, 0, Format::UINT3, size_of::<[u32; 3]>(), triangles)
            .map_err(error)?;
        for (to, triangle) in indices.iter_mut().zip(&scene.triangles) {
            *to = triangle.vertices;
        }
        let mut robust = device.create_scene().map_err(error)?;
        robust.set_flags(SceneFlags::ROBUST);
        robust.attach_geometry(&mesh.commit());
        robust.commit();
        Ok(Embree { scene: robust })
    }
}

fn segment(ray: &Ray, reach: f32) -> embree3::Ray {
    embree3::Ray::segment(ray.origin.to_array(), ray.direction.to_array(), 0.0, reach)
}

impl Contestant for Embree {
    fn name(&self) -> &'static str {
        "Embree"
    }

    fn closest(&self, rays: &[Ray], hits: &mut [Hit]) {
        let mut context = IntersectContext::incoherent();
        for (ray, hit) in rays.iter().zip(hits) {
            let mut found = embree3::RayHit::from_ray(segment(ray, f32::INFINITY));
            self.scene.intersect(&mut context, &mut found);
            *hit = if found.hit.primID == NONE {
                Hit::MISS
            } else {
                let uv = Vec2::new(found.hit.u, found.hit.v);
                Hit { t: found.ray.tfar, triangle: found.hit.primID, uv, back: false }
            };
        }
    }

    fn any(&self, rays: &[Ray], reach: &[f32], blocked: &mut [bool]) {
        let mut context = IntersectContext::incoherent();
        for ((ray, reach), blocked) in rays.iter().zip(reach).zip(blocked) {
            *blocked = self.scene.occluded(&mut context, &mut segment(ray, *reach));
        }
    }
}
