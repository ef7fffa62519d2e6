//! What is in a scene, and what is wrong with it: everything that can be said before light is computed.

mod topology;

use super::{Image, Material, Scene, Shape};
use crate::math::Rgb;
use glam::{Vec2, Vec3};
use std::f64::consts::PI;
use topology::Topology;

/// The result of [`check`].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SceneReport {
    pub triangles: usize,
    pub objects: usize,
    pub materials: usize,
    pub images: usize,
    pub lights: usize,
    pub cameras: usize,
    /// Edges of the box around all triangles [m].
    pub size: Vec3,
    /// Area of all surfaces [m²]; a two-sided surface counts twice.
    pub area: f64,
    /// Emitted flux of every object and light that sends out any, in the order of the scene. Directional lights fill the
    /// sphere around the scene.
    pub emitters: Vec<EmitterFlux>,
    /// What is noteworthy, gravest first.
    pub findings: Vec<Finding>,
}

/// What an object or a light emits.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct EmitterFlux {
    pub name: String,
    /// [lm] per channel; [`Rgb::luminance`] is the flux a luxmeter knows.
    pub flux: Rgb,
}

/// Something to know or to mend.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Finding {
    pub severity: Severity,
    /// What it is and what to do about it, a sentence or two.
    pub what: String,
    /// Where: objects, materials, positions.
    pub place: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub enum Severity {
    /// The result would be meaningless.
    Error,
    /// The result may not be what is meant.
    Warning,
    /// Good to know.
    Note,
}

/// How many places a finding names before it says "and more".
const PLACES: usize = 4;

/// Looks at everything in `scene`. Time and memory are proportional to its triangles and texels.
pub fn check(scene: &Scene) -> SceneReport {
    let (low, high) = scene.bounds();
    let emitters = emitters(scene);
    let topology = Topology::of(scene);
    let mut findings: Vec<Finding> = [
        no_surface(scene),
        no_emitter(scene, &emitters),
        strange_scale(scene, low.distance(high)),
        impossible_reflectivity(scene),
        topology.open_edges(scene),
        topology.flipped_normals(scene),
        topology.coincident_triangles(scene),
        thin_triangles(scene),
        no_camera(scene),
    ]
    .into_iter()
    .flatten()
    .collect();
    findings.sort_by_key(|finding| finding.severity);
    SceneReport {
        triangles: scene.triangles.len(),
        objects: scene.objects.len(),
        materials: scene.materials.len(),
        images: scene.images.len(),
        lights: scene.lights.len(),
        cameras: scene.cameras.len(),
        size: high - low,
        area: (0..scene.triangles.len() as u32).map(|t| area(scene, t)).sum(),
        emitters,
        findings,
    }
}

/// Area of the surface of triangle `t` [m²], both sides if it has two.
fn area(scene: &Scene, t: u32) -> f64 {
    let one_side = match scene.shape {
        Shape::Triangles => 0.5 * topology::cross(scene, t).length(),
        Shape::Sphere { radius, .. } => 4.0 * PI * f64::from(radius).powi(2) / 8.0,
    };
    if scene.is_two_sided(t) { 2.0 * one_side } else { one_side }
}

fn emitters(scene: &Scene) -> Vec<EmitterFlux> {
    let mut of_objects = vec![Rgb::BLACK; scene.objects.len()];
    for t in (0..scene.triangles.len() as u32).filter(|&t| scene.material_of(t).is_emitter()) {
        of_objects[scene.triangles[t as usize].object as usize] += mean_emission(scene, t) * area(scene, t) as f32;
    }
    let objects = scene.objects.iter().map(|object| &object.name).zip(of_objects);
    let (low, high) = scene.bounds();
    let lights = scene.lights.iter().map(|light| (&light.name, light.flux(0.5 * low.distance(high))));
    let shining = objects.chain(lights).filter(|(_, flux)| !flux.is_black());
    shining.map(|(name, flux)| EmitterFlux { name: name.clone(), flux }).collect()
}

/// Emitted exitance [lm/m²] averaged over triangle `t`; a texture is looked up at 64 points.
fn mean_emission(scene: &Scene, t: u32) -> Rgb {
    let material = scene.material_of(t);
    let Some(texture) = material.emission_texture else { return material.emission };
    let [a, b, c] = scene.triangles[t as usize].vertices.map(|v| scene.vertices[v as usize].emission_uv);
    let image = &scene.images[texture.image as usize];
    let middle = |k: u32| (k as f32 + 0.5) / 8.0;
    let points = (0..64).map(|k| crate::math::warp::square_to_triangle(Vec2::new(middle(k % 8), middle(k / 8))));
    let texel = |p: Vec2| image.sample(a + p.x * (b - a) + p.y * (c - a), texture.wrap_u, texture.wrap_v);
    material.emission * (points.map(texel).sum::<Rgb>() / 64.0)
}

fn finding(severity: Severity, what: impl Into<String>, place: impl Into<String>) -> Option<Finding> {
    Some(Finding { severity, what: what.into(), place: place.into() })
}

/// The first few places, each once, and whether there are more.
fn places(all: impl IntoIterator<Item = String>) -> String {
    let mut named: Vec<String> = Vec::new();
    for place in all {
        if named.len() == PLACES {
            return format!("{} and more", named.join(", "));
        }
        if !named.contains(&place) {
            named.push(place);
        }
    }
    named.join(", ")
}

fn no_surface(scene: &Scene) -> Option<Finding> {
    let what = "The scene has no surface: there is nothing to light. Check that the file contains triangles.";
    if scene.triangles.is_empty() { finding(Severity::Error, what, "scene") } else { None }
}

fn no_emitter(scene: &Scene, emitters: &[EmitterFlux]) -> Option<Finding> {
    let what = "Nothing emits light: everything will be black. Give a material an emission or add a light.";
    if emitters.is_empty() && !scene.triangles.is_empty() { finding(Severity::Error, what, "scene") } else { None }
}

fn strange_scale(scene: &Scene, diagonal: f32) -> Option<Finding> {
    let place = format!("bounding box, diagonal {diagonal} m");
    let what =
        |unit| format!("The scene is {unit}: is its unit really the metre? Scale it if not; flux depends on it.");
    match diagonal {
        _ if scene.triangles.is_empty() => None,
        d if d > 1000.0 => finding(Severity::Warning, what("larger than a kilometre"), place),
        d if d < 0.01 => finding(Severity::Warning, what("smaller than a centimetre"), place),
        _ => None,
    }
}

fn no_camera(scene: &Scene) -> Option<Finding> {
    let what = "There is no camera: pictures are taken from a default view unless a camera is given.";
    if scene.cameras.is_empty() { finding(Severity::Note, what, "scene") } else { None }
}

/// Materials that reflect all light or more, by the brightest texel and vertex colour they are used with.
fn impossible_reflectivity(scene: &Scene) -> Option<Finding> {
    let brightest = |a: Rgb, b: Rgb| Rgb::new(a.r.max(b.r), a.g.max(b.g), a.b.max(b.b));
    let of_images: Vec<Rgb> = scene.images.iter().map(Image::brightest).collect();
    let of_material = |m: &Material| match m.reflectivity_texture {
        Some(texture) => m.reflectivity * of_images[texture.image as usize],
        None => m.reflectivity,
    };
    let mut of_objects = vec![Rgb::BLACK; scene.objects.len()];
    for triangle in &scene.triangles {
        let slot = &mut of_objects[triangle.object as usize];
        *slot = triangle.vertices.iter().fold(*slot, |most, &v| brightest(most, scene.vertices[v as usize].color));
    }
    let most =
        |k: usize| (of_material(&scene.materials[scene.objects[k].material as usize]) * of_objects[k]).max_channel();
    let guilty: Vec<(usize, f32)> = (0..scene.objects.len()).map(|k| (k, most(k))).filter(|(_, m)| *m >= 1.0).collect();
    let greatest = guilty.iter().map(|(_, m)| *m).reduce(f32::max)?;
    let place = places(guilty.iter().map(|(k, m)| format!("object '{}' ({m})", scene.objects[*k].name)));
    if greatest > 1.0 {
        let what = "Surfaces reflect more light than they receive. Bring the reflectivity (base colour) below 1.";
        finding(Severity::Error, what, place)
    } else {
        let what = "Surfaces reflect all light they receive; real ones absorb at least a tenth, and light that is never \
                    absorbed is slow to compute. Bring the reflectivity (base colour) below 0.9.";
        finding(Severity::Warning, what, place)
    }
}

/// Triangles without area, or ten thousand times as long as they are wide.
fn thin_triangles(scene: &Scene) -> Option<Finding> {
    let thin = |t: &u32| {
        let [a, b, c] = scene.corners(*t).map(Vec3::as_dvec3);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        topology::cross(scene, *t).length() <= 1e-4 * longest * longest
    };
    let thin: Vec<u32> = (0..scene.triangles.len() as u32).filter(thin).collect();
    let what = format!("{} triangles are so thin that they are almost lines; they carry no visible light.", thin.len());
    let place = places(thin.iter().map(|&t| topology::object_name(scene, t)));
    if thin.is_empty() { None } else { finding(Severity::Note, what, place) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin::{builtin, shapes::Builder};
    use crate::scene::{Texture, Wrap};

    /// A closed room that looks inwards, with a light; each test spoils something.
    fn room() -> Scene {
        let mut builder = Builder::new("room");
        let emission = Rgb::new(1.0, 2.0, 3.0);
        let white = builder.material(Material { emission, ..Material::diffuse("white", Rgb::grey(0.5)) });
        builder.object("room", white);
        builder.look_inwards(true);
        builder.cuboid(Vec3::ZERO, Vec3::new(2.0, 1.0, 3.0));
        builder.finish()
    }

    fn graver_than_note(scene: &Scene) -> Vec<Finding> {
        check(scene).findings.into_iter().filter(|f| f.severity != Severity::Note).collect()
    }

    /// The only finding of `scene` that is more than a note, its text and place in one.
    fn only(scene: &Scene) -> String {
        let findings = graver_than_note(scene);
        assert_eq!(findings.len(), 1, "{findings:?}");
        format!("{:?}: {} {}", findings[0].severity, findings[0].what, findings[0].place)
    }

    #[test]
    fn a_good_room_has_its_totals_and_no_findings() {
        let report = check(&room());
        assert_eq!((report.triangles, report.objects, report.size), (12, 1, Vec3::new(2.0, 1.0, 3.0)));
        assert!((report.area - 22.0).abs() < 1e-6);
        assert!((report.emitters[0].flux.b - 66.0).abs() < 1e-4);
        assert!(graver_than_note(&room()).is_empty());
        assert!((check(&builtin("sphere").unwrap()).area - 4.0 * PI).abs() < 1e-9);
    }

    #[test]
    fn a_missing_triangle_leaves_three_open_edges() {
        let mut scene = room();
        scene.triangles.pop();
        assert!(only(&scene).starts_with("Warning: 3 edges"));
        scene.materials[0].two_sided = true;
        assert!(graver_than_note(&scene).is_empty(), "a two-sided surface may end anywhere");
    }

    #[test]
    fn a_flipped_triangle_disagrees_with_its_three_neighbours() {
        let mut scene = room();
        scene.triangles[5].vertices.swap(0, 1);
        assert!(only(&scene).starts_with("Warning: 3 edges") && only(&scene).contains("flipped"));
    }

    #[test]
    fn a_triangle_given_twice_is_found() {
        let mut scene = room();
        let [a, b, c] = scene.triangles[5].vertices;
        scene.triangles.push(scene.triangles[5]);
        scene.triangles[12].vertices = [b, c, a];
        assert!(graver_than_note(&scene).iter().any(|f| f.what.starts_with("1 triangle")));
    }

    #[test]
    fn reflectivity_of_one_and_more_is_found_even_in_texels_and_vertex_colours() {
        let mut scene = room();
        scene.materials[0].reflectivity = Rgb::new(0.2, 1.0, 0.2);
        assert!(only(&scene).starts_with("Warning") && only(&scene).contains("object 'room' (1)"));
        scene.vertices[3].color = Rgb::grey(1.5);
        assert!(only(&scene).starts_with("Error") && only(&scene).contains("object 'room' (1.5)"));
        scene.images = vec![Image { name: String::new(), width: 2, height: 1, texels: vec![[10; 3], [100; 3]] }];
        let texture = Texture { image: 0, wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat };
        scene.materials[0].reflectivity_texture = Some(texture);
        assert!(graver_than_note(&scene).is_empty());
        scene.images[0].texels[1] = [255; 3];
        assert!(only(&scene).starts_with("Error"));
    }

    #[test]
    fn darkness_emptiness_and_wrong_units_are_found() {
        let mut scene = room();
        scene.vertices.iter_mut().for_each(|v| v.position *= 1000.0);
        assert!(only(&scene).contains("kilometre"));
        scene.vertices.iter_mut().for_each(|v| v.position *= 1e-6);
        assert!(only(&scene).contains("centimetre"));
        let mut scene = room();
        scene.materials[0].emission = Rgb::BLACK;
        assert!(only(&scene).starts_with("Error: Nothing emits"));
        assert!(only(&Scene::default()).starts_with("Error: The scene has no surface"));
    }

    #[test]
    fn emission_textures_are_averaged() {
        let mut scene = room();
        scene.images = vec![Image { name: String::new(), width: 1, height: 1, texels: vec![[255, 0, 255]] }];
        let texture = Texture { image: 0, wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat };
        scene.materials[0].emission_texture = Some(texture);
        let flux = check(&scene).emitters[0].flux;
        assert!((flux.r - 22.0).abs() < 1e-4 && flux.g == 0.0);
    }
}
