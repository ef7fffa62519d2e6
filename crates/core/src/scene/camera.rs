//! Where a picture is taken from.

use glam::Vec3;

/// A camera looks along `forward` with `up` upwards; both are unit vectors at right angles.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Camera {
    pub name: String,
    /// World position [m].
    pub position: Vec3,
    pub forward: Vec3,
    pub up: Vec3,
    pub projection: Projection,
    /// Width over height, if the file says.
    pub aspect: Option<f32>,
}

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Projection {
    /// Full vertical opening angle [rad].
    Perspective { vertical_angle: f32 },
    /// Full height of the picture in the world [m].
    Orthographic { height: f32 },
}

impl Camera {
    /// A perspective camera at `position` that looks at `target`; y (or z, when looking along y) is upwards.
    pub fn looking_at(name: &str, position: Vec3, target: Vec3, vertical_angle: f32) -> Camera {
        let forward = (target - position).normalize_or(Vec3::NEG_Z);
        let reference = if forward.y.abs() > 0.999 { Vec3::Z } else { Vec3::Y };
        let right = forward.cross(reference).normalize();
        Camera {
            name: name.to_owned(),
            position,
            forward,
            up: right.cross(forward),
            projection: Projection::Perspective { vertical_angle },
            aspect: None,
        }
    }
}
