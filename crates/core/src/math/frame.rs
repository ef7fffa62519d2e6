//! An orthonormal frame about a normal (Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017).

use glam::Vec3;

/// Right-handed orthonormal frame whose z axis is a given unit normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    pub x: Vec3,
    pub y: Vec3,
    pub z: Vec3,
}

impl Frame {
    /// A frame about the unit vector `normal`; continuous except where the normal crosses z = 0.
    pub fn about(normal: Vec3) -> Frame {
        let sign = 1.0f32.copysign(normal.z);
        let a = -1.0 / (sign + normal.z);
        let b = normal.x * normal.y * a;
        Frame {
            x: Vec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
            y: Vec3::new(b, sign + normal.y * normal.y * a, -normal.y),
            z: normal,
        }
    }

    /// World direction of `local`, given in this frame.
    pub fn to_world(&self, local: Vec3) -> Vec3 {
        self.x * local.x + self.y * local.y + self.z * local.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_orthonormal_and_right_handed() {
        for k in 0..1000u32 {
            let t = k as f32 * 0.37;
            let z = 1.0 - 2.0 * (k as f32 + 0.5) / 1000.0;
            let r = (1.0 - z * z).sqrt();
            let normal = Vec3::new(r * t.cos(), r * t.sin(), z);
            let f = Frame::about(normal);
            assert!((f.x.cross(f.y) - f.z).length() < 1e-5, "{normal}");
            assert!(f.x.dot(f.z).abs() < 1e-5 && f.y.dot(f.z).abs() < 1e-5);
        }
    }
}
