//! A picture of a solution through a camera.

use super::camera_rays::{self, CameraRays};
use super::surface_light::{Seen, seen};
use super::{Exposure, VertexField, default_view, tone};
use crate::geometry::{Hit, NONE, Ray};
use crate::math::Rgb;
use crate::{Error, Problem, Solution};
use rayon::prelude::*;

/// What picture to take.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewOptions {
    /// Name of a camera of the scene, or its number from 0; without one the first, or a default view if the scene has no camera.
    pub camera: Option<String>,
    /// Width and height in pixels; without a height that of the camera's shape, or 16:9.
    pub width: u32,
    pub height: Option<u32>,
    /// Rays a pixel.
    pub samples: u32,
    /// Stops, see [`tone`]; metered from the picture if not given.
    pub exposure: Option<Exposure>,
}

impl Default for ViewOptions {
    fn default() -> ViewOptions {
        ViewOptions { camera: None, width: 1280, height: None, samples: 16, exposure: None }
    }
}

/// A picture, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    /// Luminance [cd/m²] of every pixel, linear; black where there is no surface.
    pub luminance: Vec<Rgb>,
    /// Its standard error [cd/m²], that of [`VertexField::std_error_at`]; `None` if it is not known.
    pub std_error: Option<Vec<Rgb>>,
    /// Linear display colour in [0, 1] of every pixel. Tone-mapped ray by ray and then averaged, so the edge of a lamp a
    /// thousand times brighter than white is as smooth as any other.
    pub display: Vec<Rgb>,
    pub exposure: Exposure,
}

impl Picture {
    /// The picture for a screen: 8-bit sRGB, dithered against banding.
    pub fn to_srgb8(&self) -> Vec<[u8; 3]> {
        let pixels = (0u32..).zip(&self.display);
        pixels.map(|(k, color)| tone::to_srgb8(*color, k % self.width, k / self.width)).collect()
    }
}

/// Most pixels of a picture, and rays a pixel.
const MOST_PIXELS: u64 = 1 << 28;
const MOST_SAMPLES: u32 = 1 << 16;
/// Pixels of a picture's width from which the exposure is metered.
const METERED_WIDTH: u32 = 160;
/// Surfaces seen from behind that one ray looks through.
const MOST_LAYERS: usize = 64;
/// Neighbouring pixels whose rays are traced together.
const RUN: usize = 64;

/// Takes a picture of `solution`, which must be one of `problem`.
///
/// # Errors
/// [`Error::UnknownName`] for a camera that is not there; [`Error::Parameter`] for a picture without pixels or rays, or
/// with more than 2^28 pixels or 2^16 rays a pixel.
pub fn render(problem: &Problem, solution: &Solution, options: &ViewOptions) -> Result<Picture, Error> {
    render_field(problem, &VertexField::new(problem, solution), options)
}

/// Takes a picture of a field: several pictures need to make it once only.
///
/// # Errors
/// Those of [`render`].
pub fn render_field(problem: &Problem, field: &VertexField, options: &ViewOptions) -> Result<Picture, Error> {
    let view = View::new(problem, options)?;
    let exposure = options.exposure.unwrap_or_else(|| view.meter(field));
    let pixels = view.pixels(field, options.samples, exposure);
    Ok(Picture {
        width: view.width,
        height: view.height,
        luminance: pixels.iter().map(|pixel| pixel.luminance).collect(),
        std_error: field.is_error_known().then(|| pixels.iter().map(|pixel| pixel.std_error).collect()),
        display: pixels.iter().map(|pixel| pixel.display).collect(),
        exposure,
    })
}

/// The exposure that [`render`] would choose for the camera in `options`: for whatever else shall look like the picture.
///
/// # Errors
/// Those of [`render`].
pub fn exposure(problem: &Problem, field: &VertexField, options: &ViewOptions) -> Result<Exposure, Error> {
    let view = View::new(problem, options)?;
    Ok(options.exposure.unwrap_or_else(|| view.meter(field)))
}

/// The element that the middle of every pixel shows, rows from the top; [`NONE`] where there is no surface. For pictures of whatever is known
/// of elements.
///
/// # Errors
/// Those of [`render`].
pub fn elements(problem: &Problem, options: &ViewOptions) -> Result<ElementPicture, Error> {
    let view = View::new(problem, options)?;
    let element = |hit: &Hit| problem.mesh.at(hit.triangle, hit.uv, hit.back).unwrap_or(NONE);
    let mut elements = vec![NONE; (view.width * view.height) as usize];
    elements.par_chunks_mut(RUN).enumerate().for_each(|(chunk, run)| {
        let pixels = (chunk * RUN) as u32..;
        let rays = pixels.take(run.len()).map(|p| view.rays.ray_in_pixel(p, view.width, 0, 1)).collect();
        run.iter_mut().zip(view.look(rays)).for_each(|(pixel, hit)| *pixel = hit.as_ref().map_or(NONE, element));
    });
    Ok(ElementPicture { width: view.width, height: view.height, elements })
}

/// See [`elements`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ElementPicture {
    pub width: u32,
    pub height: u32,
    pub elements: Vec<u32>,
}

fn check(name: &'static str, value: u32, fine: bool, allowed: &'static str) -> Result<(), Error> {
    if fine { Ok(()) } else { Err(Error::Parameter { name, value: value.to_string(), allowed }) }
}

/// What [`Picture`] has of each pixel.
#[derive(Clone, Copy, Default)]
struct Pixel {
    luminance: Rgb,
    std_error: Rgb,
    display: Rgb,
}

struct View<'a> {
    problem: &'a Problem,
    rays: CameraRays,
    width: u32,
    height: u32,
}

impl<'a> View<'a> {
    fn new(problem: &'a Problem, options: &ViewOptions) -> Result<View<'a>, Error> {
        let camera = match camera_rays::find(&problem.scene, options.camera.as_deref())? {
            Some(camera) => camera.clone(),
            None => default_view::camera(problem),
        };
        let width = options.width;
        let height = options.height.unwrap_or_else(|| {
            let aspect = camera.aspect.filter(|a| a.is_finite() && *a > 0.0).unwrap_or(16.0 / 9.0);
            ((width as f32 / aspect).round() as u32).max(1)
        });
        let pixels = u64::from(width) * u64::from(height);
        check("width", width, width > 0 && pixels <= MOST_PIXELS, "1 to 2^28 pixels in all")?;
        check("height", height, height > 0, "at least one pixel")?;
        check("samples", options.samples, (1..=MOST_SAMPLES).contains(&options.samples), "1 to 65536 rays a pixel")?;
        Ok(View { problem, rays: CameraRays::new(&camera, width, height), width, height })
    }

    /// What [`Picture`] has of every pixel.
    fn pixels(&self, field: &VertexField, samples: u32, exposure: Exposure) -> Vec<Pixel> {
        let mut pixels = vec![Pixel::default(); (self.width * self.height) as usize];
        pixels.par_chunks_mut(RUN).enumerate().for_each(|(chunk, run)| {
            let first = (chunk * RUN) as u32;
            let one = |p: u32| (0..samples).map(move |k| self.rays.ray_in_pixel(p, self.width, k, samples));
            let rays = (first..first + run.len() as u32).flat_map(one).collect();
            let seen = self.seen(field, rays);
            for (pixel, seen) in run.iter_mut().zip(seen.chunks(samples as usize)) {
                let luminances = seen.iter().map(|s| s.unwrap_or_default().luminance());
                let displays = luminances.clone().map(|l| exposure.display(l));
                let errors = seen.iter().map(|s| s.unwrap_or_default().std_error);
                let mean = |sum: Rgb| sum / samples as f32;
                *pixel = Pixel {
                    luminance: mean(luminances.sum()),
                    std_error: mean(errors.sum()),
                    display: mean(displays.sum()),
                };
            }
        });
        pixels
    }

    /// Exposure for the surfaces in the picture that are no lamps.
    fn meter(&self, field: &VertexField) -> Exposure {
        let step = (self.width as f32 / METERED_WIDTH as f32).max(1.0);
        let (columns, rows) = ((self.width as f32 / step) as u32, (self.height as f32 / step) as u32);
        let at = |k: u32| ((k % columns) as f32 + 0.5, (k / columns) as f32 + 0.5);
        let rays = (0..columns * rows.max(1)).map(|k| self.rays.ray(at(k).0 * step, at(k).1 * step)).collect();
        let lit = self.seen(field, rays).into_iter().flatten().filter(|seen| seen.emitted.is_black());
        Exposure::metered(lit.map(|seen| seen.reflected.luminance()).collect())
    }

    /// What each ray sees, if anything.
    fn seen(&self, field: &VertexField, rays: Vec<Ray>) -> Vec<Option<Seen>> {
        let light = |hit: Hit| seen(self.problem, field, hit.triangle, hit.uv, hit.back);
        self.look(rays).into_iter().map(|hit| hit.map(light)).collect()
    }

    /// Where each ray meets a surface, if it does. The back of a one-sided surface is looked through, so a room can be
    /// seen from outside.
    fn look(&self, mut rays: Vec<Ray>) -> Vec<Option<Hit>> {
        let problem = self.problem;
        let mut met = vec![None; rays.len()];
        let mut waiting: Vec<usize> = (0..rays.len()).collect();
        for _ in 0..MOST_LAYERS {
            let current: Vec<Ray> = waiting.iter().map(|&k| rays[k]).collect();
            let mut hits = vec![Hit::MISS; current.len()];
            problem.geometry.closest(&current, &mut hits);
            let mut through = Vec::new();
            for (&k, hit) in waiting.iter().zip(&hits).filter(|(_, hit)| !hit.is_miss()) {
                if hit.back && !problem.mesh.is_two_sided(hit.triangle) {
                    let ray = rays[k];
                    let origin = ray.origin + (hit.t + problem.geometry.lift()) * ray.direction;
                    rays[k] = Ray { origin, from: hit.triangle, ..ray };
                    through.push(k);
                } else {
                    met[k] = Some(*hit);
                }
            }
            waiting = through;
            if waiting.is_empty() {
                break;
            }
        }
        met
    }
}

impl CameraRays {
    /// Ray `k` of `samples` through pixel number `pixel`. The rays are spread by a tent filter two pixels wide (filter
    /// importance sampling, Ernst et al. 2006): denser in the middle, so all of them count alike. All pixels have the same
    /// pattern, the Hammersley points: an edge that crosses them is then as even as it is long.
    fn ray_in_pixel(&self, pixel: u32, width: u32, k: u32, samples: u32) -> Ray {
        let tent = |u: f32| if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * u).sqrt() };
        let across = (k as f32 + 0.5) / samples as f32;
        let down = k.reverse_bits() as f32 / 2f32.powi(32) + 0.5 / samples as f32;
        let (x, y) = (pixel % width, pixel / width);
        self.ray(x as f32 + 0.5 + tent(across), y as f32 + 0.5 + tent(down.min(1.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Resolution;
    use crate::scene::{Material, Object, Scene, Triangle, Vertex};
    use crate::view::tests::solution;
    use glam::Vec3;

    /// The inside of a cube, two-sided, with `rho = 1/2`, and a camera in it.
    fn room() -> Scene {
        let mut scene = Scene::default();
        let material = Material { emission: Rgb::grey(0.5), ..Material::diffuse("", Rgb::grey(0.5)) };
        scene.materials.push(material);
        scene.objects.push(Object { name: String::new(), material: 0 });
        scene.vertices =
            (0..8u32).map(|k| Vertex::at(Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32))).collect();
        let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
        let halves = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        scene.triangles =
            (0..).zip(halves).map(|(source, vertices)| Triangle { vertices, object: 0, source }).collect();
        scene
    }

    /// `E = 1` and `Be = 1/2` everywhere, times `factor`: `B = 1`, the furnace.
    fn furnace(factor: f32, options: &ViewOptions) -> Picture {
        let mut scene = room();
        scene.materials[0].emission = Rgb::grey(0.5 * factor);
        let problem = Problem::new(scene, Resolution::Elements(200)).unwrap();
        let light = vec![Rgb::grey(factor); problem.mesh.len()];
        render(&problem, &solution(light), options).unwrap()
    }

    fn small() -> ViewOptions {
        ViewOptions { width: 40, samples: 4, ..ViewOptions::default() }
    }

    #[test]
    fn a_furnace_looks_the_same_everywhere() {
        let picture = furnace(1.0, &small());
        assert_eq!((picture.width, picture.height), (40, 23));
        let expected = std::f32::consts::FRAC_1_PI;
        assert!(picture.luminance.iter().all(|l| (l.g - expected).abs() < 1e-6 && l.r == l.g));
        assert!(picture.display.iter().all(|d| (d.g - picture.display[0].g).abs() < 1e-6));
    }

    #[test]
    fn every_pixel_knows_how_sure_it_is() {
        let problem = Problem::new(room(), Resolution::Elements(200)).unwrap();
        let light = vec![Rgb::WHITE; problem.mesh.len()];
        let unknown = solution(light.clone());
        assert!(render(&problem, &unknown, &small()).unwrap().std_error.is_none());
        let known = Solution { std_error: vec![Rgb::new(0.1, 0.2, 0.3); light.len()], ..unknown };
        let errors = render(&problem, &known, &small()).unwrap().std_error.unwrap();
        let expected = Rgb::new(0.1, 0.2, 0.3) * 0.5 * std::f32::consts::FRAC_1_PI;
        assert!(errors.len() == 40 * 23 && errors.iter().all(|e| (*e - expected).luminance().abs() < 1e-6));
    }

    #[test]
    fn twice_the_light_and_a_stop_less_give_the_same_picture() {
        let with = |stops| ViewOptions { exposure: Some(Exposure { stops }), ..small() };
        assert_eq!(furnace(1.0, &with(0.5)).to_srgb8(), furnace(2.0, &with(-0.5)).to_srgb8());
    }

    #[test]
    fn every_pixel_shows_the_element_that_its_middle_meets() {
        let problem = Problem::new(room(), Resolution::Elements(200)).unwrap();
        let shown = elements(&problem, &small()).unwrap();
        assert_eq!((shown.width, shown.height, shown.elements.len()), (40, 23, 40 * 23));
        // From inside of the cube, every pixel shows a wall; and lamps of one element are where that element is.
        assert!(shown.elements.iter().all(|&e| (e as usize) < problem.mesh.len()));
        let one = shown.elements[40 * 11 + 20];
        let light = (0..problem.mesh.len() as u32).map(|e| if e == one { Rgb::WHITE } else { Rgb::BLACK }).collect();
        let as_computed = VertexField::as_computed(&problem, &solution(light));
        let picture = render_field(&problem, &as_computed, &small()).unwrap();
        assert!(picture.luminance[40 * 11 + 20].g > picture.luminance[0].g);
    }

    #[test]
    fn unknown_cameras_and_empty_pictures_are_refused() {
        let problem = Problem::new(room(), Resolution::Elements(1)).unwrap();
        let solution = solution(vec![Rgb::WHITE; problem.mesh.len()]);
        let unknown = ViewOptions { camera: Some("door".to_owned()), ..small() };
        assert!(matches!(render(&problem, &solution, &unknown), Err(Error::UnknownName { .. })));
        for bad in [
            ViewOptions { width: 0, ..small() },
            ViewOptions { samples: 0, ..small() },
            ViewOptions { height: Some(0), ..small() },
        ] {
            assert!(matches!(render(&problem, &solution, &bad), Err(Error::Parameter { .. })));
        }
    }
}
