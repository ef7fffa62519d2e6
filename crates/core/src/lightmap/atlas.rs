//! Where every face lies in the map, and which faces hang together there: the charts.

use super::faces::{brighter_faces, lit_faces};
use super::{Face, existing, unwrap};
use crate::math::DisjointSets;
use crate::view::VertexField;
use crate::{Error, Problem};
use glam::{DVec2, Vec2};

/// Most texels along each side: as many as graphics cards take.
pub const MOST_SIZE: u32 = 8192;
/// Most texels between charts and around the map.
const MOST_PADDING: u32 = 64;

/// What map is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    pub density: Density,
    /// Texels around each chart that only continue it: neighbouring charts are twice as far apart. At least one, so
    /// that no lookup on a surface reads another chart; each level of mipmaps takes twice as many.
    pub padding: u32,
    /// Every chart with its padding has its own blocks of 4 x 4 texels, for formats that compress blocks.
    pub align_blocks: bool,
    /// Take the coordinates that the file has, if they can be taken.
    pub keep_existing: bool,
}

/// How fine it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Density {
    /// As fine as fits into so many texels across, and as many down at most.
    Size(u32),
    /// So many texels for a metre, everywhere.
    TexelsPerMetre(f32),
}

impl Default for Layout {
    fn default() -> Layout {
        Layout { density: Density::Size(1024), padding: 4, align_blocks: false, keep_existing: true }
    }
}

/// Where the coordinates come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// From the file: they are what they were, to the last bit. Both sides of a surface share their texels.
    File,
    /// Made; with the reason why those of the file are not taken, if it has any.
    Made { why_not_file: Option<String> },
}

/// The layout of a map.
#[derive(Clone, Debug)]
pub struct Atlas {
    /// Texels across and down.
    pub width: u32,
    pub height: u32,
    /// Texels for a metre, the mean over the area (root of the mean square).
    pub texels_per_metre: f64,
    pub origin: Origin,
    pub padding: u32,
    /// Object by object.
    pub faces: Vec<Face>,
    /// Of the corners of every face; (0, 0) is the upper left corner of the map, (1, 1) the lower right one.
    pub uv: Vec<[Vec2; 3]>,
    /// Chart of every face: faces of an object that share an edge in the map are on one.
    pub chart: Vec<u32>,
    pub chart_count: u32,
    /// The edges that a face has alone on its chart.
    pub borders: Vec<Border>,
}

/// An edge of a chart: that of `face` from its corner `edge` to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Border {
    pub face: u32,
    pub edge: u8,
}

impl Atlas {
    /// # Errors
    /// Those of [`super::bake`].
    pub fn new(problem: &Problem, field: &VertexField, layout: &Layout) -> Result<Atlas, Error> {
        check(layout)?;
        if problem.scene.triangles.is_empty() {
            return Err(Error::NoSurface);
        }
        let has_own = !problem.scene.lightmap_uvs.is_empty();
        let mut why_not_file = (has_own && !layout.keep_existing).then(|| "a new one was asked for".to_owned());
        if has_own && layout.keep_existing {
            let faces = brighter_faces(problem, field);
            let uv: Vec<[Vec2; 3]> = faces.iter().map(|face| existing::coordinates(problem, face)).collect();
            let size = existing::size(problem, &faces, &uv, layout)?;
            match existing::fault(problem, &faces, &uv, size) {
                None => return Ok(Atlas::laid_out(problem, faces, uv, (size, size), Origin::File, layout.padding)),
                fault => why_not_file = fault,
            }
        }
        let faces = lit_faces(problem, field);
        let unwrapped = unwrap::unwrap(problem, &faces, layout)?;
        let size = (unwrapped.width, unwrapped.height);
        Ok(Atlas::laid_out(problem, faces, unwrapped.uv, size, Origin::Made { why_not_file }, layout.padding))
    }

    fn laid_out(
        problem: &Problem,
        faces: Vec<Face>,
        uv: Vec<[Vec2; 3]>,
        (width, height): (u32, u32),
        origin: Origin,
        padding: u32,
    ) -> Atlas {
        let (chart, chart_count, borders) = charts(problem, &faces, &uv);
        let size = DVec2::new(f64::from(width), f64::from(height));
        let texels: f64 = uv.iter().map(|uv| area_in_texels(uv, size)).sum();
        let area: f64 = faces.iter().map(|face| area(problem, face)).sum();
        let texels_per_metre = (texels / area).sqrt();
        Atlas { width, height, texels_per_metre, origin, padding, faces, uv, chart, chart_count, borders }
    }

    /// Corners of face `f` in texels from the upper left corner of the map.
    pub fn in_texels(&self, f: u32) -> [DVec2; 3] {
        let size = DVec2::new(f64::from(self.width), f64::from(self.height));
        self.uv[f as usize].map(|uv| uv.as_dvec2() * size)
    }
}

fn check(layout: &Layout) -> Result<(), Error> {
    let wrong = |name, value: String, allowed| Err(Error::Parameter { name, value, allowed });
    if !(1..=MOST_PADDING).contains(&layout.padding) {
        return wrong("padding", layout.padding.to_string(), "1 to 64 texels");
    }
    match layout.density {
        Density::Size(size) if !(16..=MOST_SIZE).contains(&size) => {
            wrong("size", size.to_string(), "16 to 8192 texels")
        }
        Density::Size(size) if layout.align_blocks && size % 4 != 0 => {
            wrong("size", size.to_string(), "with aligned blocks it is a multiple of 4")
        }
        Density::TexelsPerMetre(d) if !(d > 0.0 && d.is_finite()) => {
            wrong("texels per metre", d.to_string(), "a positive number")
        }
        _ => Ok(()),
    }
}

/// Area [m²] of a face, as if it were flat.
pub fn area(problem: &Problem, face: &Face) -> f64 {
    let [a, b, c] = face.positions(problem).map(|p| p.as_dvec3());
    0.5 * (b - a).cross(c - a).length()
}

/// Area of a face in a map of so many texels.
pub fn area_in_texels(uv: &[Vec2; 3], size: DVec2) -> f64 {
    let [a, b, c] = uv.map(|uv| uv.as_dvec2() * size);
    0.5 * (b - a).perp_dot(c - a).abs()
}

/// Chart of every face, how many there are, and their borders.
fn charts(problem: &Problem, faces: &[Face], uv: &[[Vec2; 3]]) -> (Vec<u32>, u32, Vec<Border>) {
    // Negative zero is zero.
    let point = |p: Vec2| [p.x + 0.0, p.y + 0.0].map(f32::to_bits);
    let mut edges = Vec::with_capacity(3 * faces.len());
    for (f, (face, corners)) in (0..).zip(faces.iter().zip(uv)) {
        for edge in 0..3u8 {
            let [p, q] = [corners[edge as usize], corners[(edge as usize + 1) % 3]].map(point);
            edges.push(((face.object(problem), face.back, p.min(q), p.max(q)), Border { face: f, edge }));
        }
    }
    edges.sort_unstable_by_key(|(key, border)| (*key, border.face, border.edge));
    let mut groups = DisjointSets::new(faces.len());
    let mut borders = Vec::new();
    for same in edges.chunk_by(|a, b| a.0 == b.0) {
        if let [(_, border)] = same {
            borders.push(*border);
        }
        same.windows(2).for_each(|pair| groups.join(pair[0].1.face, pair[1].1.face));
    }
    borders.sort_unstable_by_key(|border| (border.face, border.edge));
    let (chart, count) = groups.numbered();
    (chart, count, borders)
}
