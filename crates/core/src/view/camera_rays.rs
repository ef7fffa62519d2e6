//! The rays of a camera: perspective or orthographic, pixels counted from the upper left corner.

use crate::Error;
use crate::geometry::{NONE, Ray};
use crate::scene::{Camera, Projection, Scene};
use glam::Vec3;

/// Turns points of a picture into rays.
#[derive(Clone, Copy, Debug)]
pub struct CameraRays {
    projection: Projection,
    position: Vec3,
    forward: Vec3,
    /// From the picture's centre to the middle of its right and upper border, at distance 1 (perspective) or in the world.
    right: Vec3,
    up: Vec3,
    width: f32,
    height: f32,
}

impl CameraRays {
    /// Rays of `camera` for a picture of `width` x `height` square pixels. The camera's vertical angle is kept, whatever
    /// the shape of the picture.
    pub fn new(camera: &Camera, width: u32, height: u32) -> CameraRays {
        let half_height = match camera.projection {
            Projection::Perspective { vertical_angle } => (0.5 * vertical_angle).tan(),
            Projection::Orthographic { height } => 0.5 * height,
        };
        let half_width = half_height * width as f32 / height as f32;
        CameraRays {
            projection: camera.projection,
            position: camera.position,
            forward: camera.forward,
            right: camera.forward.cross(camera.up) * half_width,
            up: camera.up * half_height,
            width: width as f32,
            height: height as f32,
        }
    }

    /// The ray through the point (x, y) of the picture; (0.5, 0.5) is the centre of the first pixel.
    pub fn ray(&self, x: f32, y: f32) -> Ray {
        let sideways = self.right * (2.0 * x / self.width - 1.0) + self.up * (1.0 - 2.0 * y / self.height);
        match self.projection {
            Projection::Perspective { .. } => {
                Ray { origin: self.position, direction: (self.forward + sideways).normalize(), from: NONE }
            }
            Projection::Orthographic { .. } => {
                Ray { origin: self.position + sideways, direction: self.forward, from: NONE }
            }
        }
    }
}

/// The camera of `scene` called `name`, or with that number, counted from 0; without a name the first one, or `None` if
/// the scene has none.
///
/// # Errors
/// [`Error::UnknownName`] with the most similar name.
pub fn find<'a>(scene: &'a Scene, name: Option<&str>) -> Result<Option<&'a Camera>, Error> {
    let Some(name) = name else { return Ok(scene.cameras.first()) };
    let named = scene.cameras.iter().find(|camera| camera.name == name);
    let numbered = || name.parse().ok().and_then(|number: usize| scene.cameras.get(number));
    named.or_else(numbered).map(Some).ok_or_else(|| {
        let common =
            |other: &str| other.chars().zip(name.chars()).take_while(|(a, b)| a.eq_ignore_ascii_case(b)).count();
        let nearest = scene.cameras.iter().map(|c| c.name.as_str()).max_by_key(|other| common(other));
        Error::UnknownName { kind: "camera", name: name.to_owned(), nearest: nearest.unwrap_or("(none)").to_owned() }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_border_of_the_picture_is_half_the_angle_away() {
        let camera = Camera::looking_at("", Vec3::ZERO, Vec3::NEG_Z, 1.0);
        let rays = CameraRays::new(&camera, 200, 100);
        assert!((rays.ray(100.0, 50.0).direction - Vec3::NEG_Z).length() < 1e-6);
        let top = rays.ray(100.0, 0.0).direction;
        assert!(top.y > 0.0 && (top.angle_between(Vec3::NEG_Z) - 0.5).abs() < 1e-5);
        assert!(rays.ray(200.0, 50.0).direction.x > 0.0);
    }
}
