//! Triangles along a space-filling curve (Morton 1966): neighbours in the order are neighbours in space.

use crate::scene::Scene;
use glam::Vec3;

/// All triangle numbers, in the Morton order of their centroids; ties by number.
pub fn order(scene: &Scene) -> Vec<u32> {
    let mut triangles: Vec<u32> = (0..scene.triangles.len() as u32).collect();
    sort(scene, &mut triangles);
    triangles
}

/// Puts `triangles` into the Morton order of their centroids in the box around them; ties by number.
pub fn sort(scene: &Scene, triangles: &mut [u32]) {
    let corners = triangles.iter().flat_map(|&t| scene.corners(t));
    let (low, high) = corners.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let scale = Vec3::splat(1023.0) / (high - low).max(Vec3::splat(f32::MIN_POSITIVE));
    let code = |t: u32| {
        let [a, b, c] = scene.corners(t);
        let cell = (((a + b + c) / 3.0 - low) * scale).clamp(Vec3::ZERO, Vec3::splat(1023.0)).as_uvec3();
        spread(cell.x) << 2 | spread(cell.y) << 1 | spread(cell.z)
    };
    triangles.sort_by_cached_key(|&t| (code(t), t));
}

/// Puts two zero bits behind each of the ten low bits of `x`.
fn spread(x: u32) -> u32 {
    let x = (x | x << 16) & 0x0300_00ff;
    let x = (x | x << 8) & 0x0300_f00f;
    let x = (x | x << 4) & 0x030c_30c3;
    (x | x << 2) & 0x0924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreading_keeps_every_bit() {
        for bit in 0..10 {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
    }
}
