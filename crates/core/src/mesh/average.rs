//! Reflectivity and emission of an element: the average over it of factor, vertex colour and texture, in linear light.
//!
//! A texel is a small square of one colour. The share of each texel in an element is computed exactly, by cutting the
//! element along the texels' borders, so the elements of a surface have the mean of its texture however finely it is
//! cut. Elements that cover very many texels use a smaller version of the image, the same one for all of a triangle.

use super::cells;
use super::clip::Polygon;
use super::mip::Mips;
use crate::math::Rgb;
use crate::scene::{Scene, Texture, Vertex, Wrap};
use glam::{DMat2, DVec2, Vec2};

/// Most texels that one average looks at.
const MOST_TEXELS: f64 = 256.0;
/// A smaller footprint [texels] counts as a point or a line.
const LEAST_FOOTPRINT: f64 = 1e-9;

/// A scene with what averages over its surfaces need.
pub struct Averages<'a> {
    scene: &'a Scene,
    /// For each image; `None` for one that no material uses.
    mips: Vec<Option<Mips<'a>>>,
}

impl<'a> Averages<'a> {
    pub fn new(scene: &'a Scene) -> Averages<'a> {
        let textures = scene.materials.iter().flat_map(|m| [m.reflectivity_texture, m.emission_texture]).flatten();
        let used: Vec<u32> = textures.map(|texture| texture.image).collect();
        let mips = |(k, image)| used.contains(&(k as u32)).then(|| Mips::new(image));
        Averages { scene, mips: scene.images.iter().enumerate().map(mips).collect() }
    }

    /// Mean reflectivity and emitted exitance [lm/m²] over the cell with the given barycentric corners on triangle `t`.
    pub fn over_cell(&self, t: u32, corners: [Vec2; 3]) -> (Rgb, Rgb) {
        let material = self.scene.material_of(t);
        let vertices = self.scene.triangles[t as usize].vertices.map(|v| &self.scene.vertices[v as usize]);
        let colors = at_corners(vertices, corners, |v| v.color);
        let reflectivity = match material.reflectivity_texture {
            None => (colors[0] + colors[1] + colors[2]) / 3.0,
            Some(texture) => self.textured(texture, at_corners(vertices, corners, |v| v.uv), colors),
        };
        let emission = match material.emission_texture {
            None => Rgb::WHITE,
            Some(texture) => self.textured(texture, at_corners(vertices, corners, |v| v.emission_uv), [Rgb::WHITE; 3]),
        };
        (material.reflectivity * reflectivity, material.emission * emission)
    }

    /// Mean over a triangle in texture space of the texture times a colour that varies linearly.
    fn textured(&self, texture: Texture, uv: [Vec2; 3], colors: [Rgb; 3]) -> Rgb {
        let Some(mips) = &self.mips[texture.image as usize] else { return Rgb::WHITE };
        let wraps = [texture.wrap_u, texture.wrap_v];
        let uv = folded(uv, wraps);
        let footprint = |size: [u32; 2]| uv.map(|p| p * DVec2::new(f64::from(size[0]), f64::from(size[1])));
        let [a, b, c] = footprint(mips.size(0));
        let area = (b - a).perp_dot(c - a).abs();
        if area.is_nan() || area < LEAST_FOOTPRINT {
            return self.along(texture, uv, colors);
        }
        for level in 0..=mips.last() {
            let size = mips.size(level);
            let corners = footprint(size);
            let strips = [0, 1].map(|axis| Strips::new(corners, axis, size[axis], wraps[axis]));
            if strips[0].count() * strips[1].count() <= MOST_TEXELS {
                let mean = weighted(mips, level, corners, strips, colors);
                return mean.unwrap_or_else(|| self.along(texture, uv, colors));
            }
        }
        // So many repetitions that the mean of the image is all there is to see.
        mips.texel(mips.last(), 0, 0) * ((colors[0] + colors[1] + colors[2]) / 3.0)
    }

    /// Mean along what is a line or a point in texture space.
    fn along(&self, texture: Texture, uv: [DVec2; 3], colors: [Rgb; 3]) -> Rgb {
        let image = &self.scene.images[texture.image as usize];
        let points = (0..cells::count(4)).map(|cell| cells::corners(cell, 4).into_iter().sum::<Vec2>() / 3.0);
        let value = |p: Vec2| {
            let uv = uv[0] + (uv[1] - uv[0]) * f64::from(p.x) + (uv[2] - uv[0]) * f64::from(p.y);
            let color = colors[0] + (colors[1] - colors[0]) * p.x + (colors[2] - colors[0]) * p.y;
            image.sample(uv.as_vec2(), texture.wrap_u, texture.wrap_v) * color
        };
        points.map(value).sum::<Rgb>() / cells::count(4) as f32
    }
}

/// An attribute, linear over the triangle, at the corners of a cell.
fn at_corners<T>(vertices: [&Vertex; 3], corners: [Vec2; 3], attribute: impl Fn(&Vertex) -> T) -> [T; 3]
where
    T: Copy + std::ops::Add<Output = T> + std::ops::Sub<Output = T> + std::ops::Mul<f32, Output = T>,
{
    let [a, b, c] = vertices.map(attribute);
    corners.map(|p| a + (b - a) * p.x + (c - a) * p.y)
}

/// Brings coordinates near zero by whole periods, where they have all their digits.
fn folded(uv: [Vec2; 3], wraps: [Wrap; 2]) -> [DVec2; 3] {
    let uv = uv.map(|p| p.as_dvec2());
    let low = uv[0].min(uv[1]).min(uv[2]);
    let period = |axis: usize| if wraps[axis] == Wrap::ClampToEdge { 0.0 } else { 2.0 * (0.5 * low[axis]).floor() };
    let shift = DVec2::new(period(0), period(1));
    uv.map(|p| p - shift)
}

/// Mean of the texels of a level under the triangle `corners`, weighted by how much of each it covers; `None` if rounding
/// leaves nothing of a thin triangle.
fn weighted(
    mips: &Mips,
    level: usize,
    corners: [DVec2; 3],
    [columns, rows]: [Strips; 2],
    colors: [Rgb; 3],
) -> Option<Rgb> {
    let is_plain = colors[0] == colors[1] && colors[1] == colors[2];
    let to_barycentric = DMat2::from_cols(corners[1] - corners[0], corners[2] - corners[0]).inverse();
    let color_at = |p: DVec2| {
        let b = (to_barycentric * (p - corners[0])).as_vec2();
        colors[0] + (colors[1] - colors[0]) * b.x + (colors[2] - colors[0]) * b.y
    };
    let triangle = Polygon::triangle(corners);
    let (mut sum, mut total) = (Rgb::BLACK, 0.0);
    for (y, [low, high]) in rows.iter() {
        let row = triangle.between(1, low, high);
        for (x, [low, high]) in columns.iter() {
            let (area, centroid) = row.between(0, low, high).area_and_centroid();
            if area > 0.0 {
                let color = if is_plain { colors[0] } else { color_at(centroid) };
                sum += mips.texel(level, x, y) * color * area as f32;
                total += area;
            }
        }
    }
    (total > 0.0).then(|| sum / total as f32)
}

/// The columns or rows of texels that a footprint meets.
struct Strips {
    first: f64,
    last: f64,
    size: u32,
    wrap: Wrap,
}

impl Strips {
    fn new(corners: [DVec2; 3], axis: usize, size: u32, wrap: Wrap) -> Strips {
        let [a, b, c] = corners.map(|p| p[axis]);
        let (mut first, mut last) = (a.min(b).min(c).floor(), a.max(b).max(c).floor());
        if wrap == Wrap::ClampToEdge {
            let edge = f64::from(size - 1);
            (first, last) = (first.clamp(0.0, edge), last.clamp(0.0, edge));
        }
        Strips { first, last, size, wrap }
    }

    fn count(&self) -> f64 {
        self.last - self.first + 1.0
    }

    /// Each strip's texel, and where it begins and ends; the edge texels of a clamped image have no end.
    fn iter(&self) -> impl Iterator<Item = (u32, [f64; 2])> {
        let clamped = self.wrap == Wrap::ClampToEdge;
        (self.first as i64..=self.last as i64).map(move |k| {
            let low = if clamped && k == 0 { f64::NEG_INFINITY } else { k as f64 };
            let high = if clamped && k == i64::from(self.size) - 1 { f64::INFINITY } else { k as f64 + 1.0 };
            (self.wrap.texel_index(k, self.size), [low, high])
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::math::Rgb;
    use crate::mesh::{ElementMesh, Resolution};
    use crate::scene::{Image, Material, Object, Scene, Texture, Triangle, Vertex, Wrap};
    use glam::{Vec2, Vec3};

    fn noise(width: u32, height: u32) -> Image {
        let texels = (0..width * height).map(|k| [(k * 7919 % 251) as u8, (k * 104_729 % 241) as u8, (k % 256) as u8]);
        Image { name: String::new(), width, height, texels: texels.collect() }
    }

    fn mean(image: &Image) -> Rgb {
        let count = image.width * image.height;
        (0..count).map(|k| image.texel(k % image.width, k / image.width)).sum::<Rgb>() / count as f32
    }

    /// A unit square whose texture coordinates run from `low` to `high`, cut into elements no longer than `edge`.
    fn square(image: Image, wrap: Wrap, low: Vec2, high: Vec2, edge: f32) -> ElementMesh {
        let corner =
            |x: f32, y: f32| Vertex { uv: low + (high - low) * Vec2::new(x, y), ..Vertex::at(Vec3::new(x, y, 0.0)) };
        let texture = Texture { image: 0, wrap_u: wrap, wrap_v: wrap };
        let material = Material { reflectivity_texture: Some(texture), ..Material::diffuse("", Rgb::grey(0.5)) };
        let scene = Scene {
            vertices: vec![corner(0., 0.), corner(1., 0.), corner(1., 1.), corner(0., 1.)],
            triangles: [[0, 1, 2], [0, 2, 3]].map(|vertices| Triangle { vertices, object: 0, source: 0 }).to_vec(),
            objects: vec![Object { name: String::new(), material: 0 }],
            materials: vec![material],
            images: vec![image],
            ..Scene::default()
        };
        ElementMesh::new(&scene, Resolution::MaxEdge(edge)).unwrap()
    }

    fn area_weighted(mesh: &ElementMesh) -> Rgb {
        mesh.elements().map(|e| mesh.reflectivity(e) * mesh.area(e)).sum::<Rgb>() / mesh.total_area() as f32
    }

    fn assert_close(a: Rgb, b: Rgb, what: &str) {
        assert!((a - b).map(f32::abs).max_channel() < 1e-4, "{a:?} is not {b:?}: {what}");
    }

    #[test]
    fn elements_have_the_mean_of_the_texture_however_they_are_cut() {
        for (width, height) in [(2, 2), (37, 23), (64, 64), (200, 3)] {
            let expected = mean(&noise(width, height)) * 0.5;
            for edge in [2.0, 0.5, 0.11, 0.03] {
                for wrap in [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge] {
                    let mesh = square(noise(width, height), wrap, Vec2::ZERO, Vec2::ONE, edge);
                    assert_close(area_weighted(&mesh), expected, &format!("{width} x {height}, {edge}, {wrap:?}"));
                }
                for (wrap, low) in [(Wrap::Repeat, -3.3), (Wrap::MirroredRepeat, 41.0)] {
                    let mesh = square(noise(width, height), wrap, Vec2::splat(low), Vec2::splat(low + 10.0), edge);
                    assert_close(
                        area_weighted(&mesh),
                        expected,
                        &format!("ten times {width} x {height}, {edge}, {wrap:?}"),
                    );
                }
            }
        }
    }

    #[test]
    fn outside_a_clamped_image_its_edge_goes_on() {
        let image = Image { name: String::new(), width: 2, height: 1, texels: vec![[0; 3], [255; 3]] };
        for edge in [2.0, 0.1] {
            let mesh = square(image.clone(), Wrap::ClampToEdge, Vec2::new(-1.0, -5.0), Vec2::new(3.0, 5.0), edge);
            assert_close(area_weighted(&mesh), Rgb::grey(0.5 * 2.5 / 4.0), "clamped");
        }
    }

    #[test]
    fn footprints_without_area_see_the_texels_under_them() {
        let point = square(noise(8, 8), Wrap::Repeat, Vec2::splat(3.0 / 16.0), Vec2::splat(3.0 / 16.0), 1.0);
        assert_close(point.reflectivity(0), noise(8, 8).texel(1, 1) * 0.5, "point");
        let huge = square(noise(8, 8), Wrap::Repeat, Vec2::splat(-1e30), Vec2::splat(1e30), 1.0);
        assert_close(huge.reflectivity(0), mean(&noise(8, 8)) * 0.5, "huge");
    }

    #[test]
    fn vertex_colours_are_averaged_linearly_with_and_without_a_texture() {
        let white = Image { name: String::new(), width: 3, height: 3, texels: vec![[255; 3]; 9] };
        let corner = |x: f32, y: f32, color| Vertex { color, uv: Vec2::new(x, y), ..Vertex::at(Vec3::new(x, y, 0.0)) };
        for texture in [None, Some(Texture { image: 0, wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat })] {
            let scene = Scene {
                vertices: vec![
                    corner(0., 0., Rgb::new(0.9, 0.0, 0.3)),
                    corner(1., 0., Rgb::new(0.0, 0.6, 0.3)),
                    corner(0., 1., Rgb::BLACK),
                ],
                triangles: vec![Triangle { vertices: [0, 1, 2], object: 0, source: 0 }],
                objects: vec![Object { name: String::new(), material: 0 }],
                materials: vec![Material { reflectivity_texture: texture, ..Material::diffuse("", Rgb::WHITE) }],
                images: vec![white.clone()],
                ..Scene::default()
            };
            for edge in [2.0, 0.2] {
                let mesh = ElementMesh::new(&scene, Resolution::MaxEdge(edge)).unwrap();
                assert_close(area_weighted(&mesh), Rgb::new(0.3, 0.2, 0.2), "colours");
            }
            let mesh = ElementMesh::new(&scene, Resolution::MaxEdge(0.75)).unwrap();
            assert_close(mesh.reflectivity(0), Rgb::new(0.6, 0.1, 0.25), "the quarter at the first corner");
        }
    }
}
