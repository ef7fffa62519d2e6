//! Whether a scene can be computed with at all: every index leads somewhere and every number is finite.
//!
//! Readers of files guarantee this; [`Scene::validate`] is for scenes that come from elsewhere. What is merely unwise (no
//! emitter, reflectivities of one) is the business of [`super::check`].

use super::{Image, Light, LightKind, Material, Projection, Scene, Shape};

/// The first thing that is wrong with a scene.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {what}")]
pub struct Fault {
    /// A path like `triangles/7`.
    pub place: String,
    pub what: String,
}

impl Scene {
    /// Checks all indices and numbers.
    ///
    /// # Errors
    /// The first [`Fault`], in the order in which [`Scene`] lists its parts.
    pub fn validate(&self) -> Result<(), Fault> {
        each("vertices", &self.vertices, |v| {
            finite(&v.position.to_array(), "position")?;
            finite(&v.color.to_array(), "colour")?;
            finite(&[v.uv.x, v.uv.y, v.emission_uv.x, v.emission_uv.y], "texture coordinate")
        })?;
        self.validate_lightmap_uvs()?;
        each("triangles", &self.triangles, |t| {
            t.vertices.iter().try_for_each(|&v| index(v, &self.vertices, "vertex"))?;
            index(t.object, &self.objects, "object")
        })?;
        each("objects", &self.objects, |o| index(o.material, &self.materials, "material"))?;
        each("materials", &self.materials, |m| material(m, &self.images))?;
        each("images", &self.images, image)?;
        each("lights", &self.lights, light)?;
        each("cameras", &self.cameras, |c| {
            let (Projection::Perspective { vertical_angle: size } | Projection::Orthographic { height: size }) =
                c.projection;
            finite(&[c.position, c.forward, c.up].map(|v| v.to_array()).concat(), "direction or position")?;
            finite(&[size, c.aspect.unwrap_or(1.0)], "field of view")
        })?;
        let (backs, triangles) = (self.hidden_backs.len(), self.triangles.len());
        if backs != 0 && backs != triangles {
            let what = format!("there are {backs} for {triangles} triangles");
            return Err(Fault { place: "hidden_backs".into(), what });
        }
        self.validate_shape().map_err(|what| Fault { place: "shape".into(), what })
    }

    fn validate_lightmap_uvs(&self) -> Result<(), Fault> {
        let (count, vertices) = (self.lightmap_uvs.len(), self.vertices.len());
        if count != 0 && count != vertices {
            return Err(Fault {
                place: "lightmap_uvs".into(),
                what: format!("there are {count} for {vertices} vertices"),
            });
        }
        each("lightmap_uvs", &self.lightmap_uvs, |uv| finite(&uv.to_array(), "lightmap coordinate"))
    }

    fn validate_shape(&self) -> Result<(), String> {
        let Shape::Sphere { center, radius } = self.shape else { return Ok(()) };
        finite(&center.to_array(), "centre")?;
        finite(&[radius], "radius")?;
        if radius <= 0.0 {
            return Err(format!("the radius is {radius}, which is not positive"));
        }
        if self.triangles.len() != 8 {
            return Err(format!(
                "a sphere stands on the 8 triangles of an octahedron, not on {}",
                self.triangles.len()
            ));
        }
        Ok(())
    }
}

fn material(material: &Material, images: &[Image]) -> Result<(), String> {
    finite(&material.reflectivity.to_array(), "reflectivity")?;
    finite(&material.emission.to_array(), "emission")?;
    let textures = [material.reflectivity_texture, material.emission_texture];
    textures.iter().flatten().try_for_each(|texture| index(texture.image, images, "image"))
}

fn image(image: &Image) -> Result<(), String> {
    let (width, height, texels) = (image.width, image.height, image.texels.len());
    let described = u64::from(width) * u64::from(height);
    if texels as u64 != described || described == 0 || described > u64::from(u32::MAX) {
        return Err(format!("{texels} texels do not make an image of {width} x {height}"));
    }
    Ok(())
}

fn light(light: &Light) -> Result<(), String> {
    finite(&light.intensity.to_array(), "intensity")?;
    match light.kind {
        LightKind::Point { position } => finite(&position.to_array(), "position"),
        LightKind::Spot { position, direction, inner_angle, outer_angle } => {
            finite(&position.to_array(), "position")?;
            finite(&direction.to_array(), "direction")?;
            finite(&[inner_angle, outer_angle], "angle")
        }
        LightKind::Directional { direction } => finite(&direction.to_array(), "direction"),
    }
}

/// Runs `check` over a list; an error is given its place in it.
fn each<T>(list: &str, items: &[T], check: impl Fn(&T) -> Result<(), String>) -> Result<(), Fault> {
    items
        .iter()
        .enumerate()
        .try_for_each(|(k, item)| check(item).map_err(|what| Fault { place: format!("{list}/{k}"), what }))
}

fn index<T>(index: u32, list: &[T], what: &str) -> Result<(), String> {
    if (index as usize) < list.len() {
        return Ok(());
    }
    Err(format!("it uses {what} {index}, but there are only {}", list.len()))
}

fn finite(values: &[f32], what: &str) -> Result<(), String> {
    match values.iter().find(|v| !v.is_finite()) {
        Some(value) => Err(format!("its {what} is {value}, which is not a finite number")),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;
    use crate::scene::{Object, Texture, Triangle, Vertex, Wrap};
    use glam::Vec3;

    fn triangle() -> Scene {
        Scene {
            vertices: [Vec3::ZERO, Vec3::X, Vec3::Y].map(Vertex::at).to_vec(),
            triangles: vec![Triangle { vertices: [0, 1, 2], object: 0, source: 0 }],
            objects: vec![Object { name: "wall".into(), material: 0 }],
            materials: vec![Material::diffuse("grey", Rgb::grey(0.5))],
            ..Scene::default()
        }
    }

    fn place_of_fault(damage: impl FnOnce(&mut Scene)) -> String {
        let mut scene = triangle();
        assert_eq!(scene.validate(), Ok(()));
        damage(&mut scene);
        scene.validate().expect_err("damaged").place
    }

    #[test]
    fn every_dangling_index_is_found() {
        assert_eq!(place_of_fault(|s| s.triangles[0].vertices[2] = 3), "triangles/0");
        assert_eq!(place_of_fault(|s| s.triangles[0].object = 1), "triangles/0");
        assert_eq!(place_of_fault(|s| s.objects[0].material = 9), "objects/0");
        let texture = Texture { image: 0, wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat };
        assert_eq!(place_of_fault(|s| s.materials[0].emission_texture = Some(texture)), "materials/0");
    }

    #[test]
    fn numbers_and_sizes_must_make_sense() {
        assert_eq!(place_of_fault(|s| s.vertices[1].position.y = f32::NAN), "vertices/1");
        assert_eq!(place_of_fault(|s| s.materials[0].emission.g = f32::INFINITY), "materials/0");
        let image = Image { name: "one".into(), width: 2, height: 2, texels: vec![[0; 3]; 3] };
        assert_eq!(place_of_fault(|s| s.images.push(image)), "images/0");
        assert_eq!(place_of_fault(|s| s.shape = Shape::Sphere { center: Vec3::ZERO, radius: 1.0 }), "shape");
    }
}
