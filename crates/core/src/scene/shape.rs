//! What the triangles of a scene stand for.

use glam::Vec3;

/// What the triangles stand for.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Shape {
    /// The triangles are the surface.
    #[default]
    Triangles,
    /// The inside of an exact sphere: the eight triangles of a regular octahedron, mapped to it with equal areas. The
    /// scene's triangles are those of [`octahedron`], in its order.
    Sphere { center: Vec3, radius: f32 },
}

/// Corners of the eight faces of the regular octahedron with unit radius, fronts inwards. Face k covers the octant whose
/// x, y and z are negative where bits 0, 1 and 2 of k are set; its first corner lies on the x axis.
pub fn octahedron() -> [[Vec3; 3]; 8] {
    std::array::from_fn(|k| {
        let sign = |bit: usize| if k >> bit & 1 == 1 { -1.0 } else { 1.0 };
        let [x, y, z] = [Vec3::X * sign(0), Vec3::Y * sign(1), Vec3::Z * sign(2)];
        if sign(0) * sign(1) * sign(2) > 0.0 { [x, z, y] } else { [x, y, z] }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_look_inwards_and_lie_in_their_octant() {
        for (k, [a, b, c]) in octahedron().into_iter().enumerate() {
            let middle = a + b + c;
            assert!((b - a).cross(c - a).dot(middle) < 0.0, "face {k}");
            assert_eq!(middle.to_array().map(|v| v < 0.0), [k & 1 == 1, k & 2 == 2, k & 4 == 4], "face {k}");
        }
    }
}
