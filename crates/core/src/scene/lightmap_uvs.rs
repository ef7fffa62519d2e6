//! Coordinates in a lightmap, corner by corner.
//!
//! A scene has them by vertices, as glTF has them; where two charts meet, a place has as many vertices as charts.

use super::{Fault, Scene};
use glam::Vec2;
use rustc_hash::FxHashMap;

impl Scene {
    /// Coordinates in the lightmap of the corners of every triangle; `None` if the scene has none.
    pub fn lightmap_corners(&self) -> Option<Vec<[Vec2; 3]>> {
        let of_triangle = |vertices: [u32; 3]| vertices.map(|v| self.lightmap_uvs[v as usize]);
        let corners = || self.triangles.iter().map(|triangle| of_triangle(triangle.vertices)).collect();
        (!self.lightmap_uvs.is_empty()).then(corners)
    }

    /// Gives the corners of every triangle coordinates in a lightmap. A vertex that is the corner of several triangles becomes
    /// several where their coordinates differ, alike in all else: the first keeps its number, the others come behind all
    /// vertices there were.
    ///
    /// # Errors
    /// A [`Fault`] if there are not as many as triangles, or one is not finite; then nothing is changed.
    pub fn set_lightmap_corners(&mut self, corners: &[[Vec2; 3]]) -> Result<(), Fault> {
        let (count, triangles) = (corners.len(), self.triangles.len());
        if count != triangles {
            let what = format!("there are {count} for {triangles} triangles");
            return Err(Fault { place: "lightmap_uvs".into(), what });
        }
        if let Some(t) = corners.iter().position(|uvs| !uvs.iter().all(|uv| uv.is_finite())) {
            let what =
                format!("its coordinates are {:?}, not all of them finite numbers", corners[t].map(|uv| uv.to_array()));
            return Err(Fault { place: format!("lightmap_uvs/{t}"), what });
        }
        let mut uvs: Vec<Option<Vec2>> = vec![None; self.vertices.len()];
        let mut copies: FxHashMap<(u32, [u32; 2]), u32> = FxHashMap::default();
        for (triangle, corners) in self.triangles.iter_mut().zip(corners) {
            for (v, &uv) in triangle.vertices.iter_mut().zip(corners) {
                let known = *uvs[*v as usize].get_or_insert(uv);
                if known != uv {
                    *v = *copies.entry((*v, uv.to_array().map(f32::to_bits))).or_insert_with(|| {
                        self.vertices.push(self.vertices[*v as usize]);
                        uvs.push(Some(uv));
                        self.vertices.len() as u32 - 1
                    });
                }
            }
        }
        self.lightmap_uvs = uvs.into_iter().map(Option::unwrap_or_default).collect();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin::builtin;

    #[test]
    fn a_vertex_is_split_where_its_corners_differ_and_only_there() {
        let before = builtin("cornell-box").unwrap();
        let mut scene = before.clone();
        let of_vertex = |v: u32| Vec2::new(v as f32, 0.5) / before.vertices.len() as f32;
        let smooth: Vec<[Vec2; 3]> = before.triangles.iter().map(|t| t.vertices.map(of_vertex)).collect();
        scene.set_lightmap_corners(&smooth).unwrap();
        assert_eq!((&scene.vertices, &scene.triangles), (&before.vertices, &before.triangles));
        assert_eq!(scene.lightmap_corners().unwrap(), smooth);

        let apart: Vec<[Vec2; 3]> = (0..smooth.len()).map(|t| smooth[t].map(|uv| uv + Vec2::Y * t as f32)).collect();
        scene.set_lightmap_corners(&apart).unwrap();
        assert_eq!(scene.lightmap_corners().unwrap(), apart);
        assert_eq!(scene.vertices.len(), 3 * scene.triangles.len());
        for (own, old) in scene.triangles.iter().zip(&before.triangles) {
            assert_eq!((own.object, own.source), (old.object, old.source));
            assert_eq!(
                own.vertices.map(|v| scene.vertices[v as usize]),
                old.vertices.map(|v| before.vertices[v as usize])
            );
        }
        assert_eq!(scene.validate(), Ok(()));
    }

    #[test]
    fn what_makes_no_sense_is_refused_with_its_place_and_changes_nothing() {
        let mut scene = builtin("cornell-box").unwrap();
        let mut corners = vec![[Vec2::ZERO; 3]; scene.triangles.len()];
        corners[7][2].y = f32::NAN;
        assert_eq!(scene.set_lightmap_corners(&corners).unwrap_err().place, "lightmap_uvs/7");
        assert_eq!(scene.set_lightmap_corners(&corners[..7]).unwrap_err().place, "lightmap_uvs");
        assert!(scene.lightmap_corners().is_none());
    }
}
