use super::*;
use crate::export::{ExportOptions, LitScene, Smoothing};
use crate::fixture;
use flate2::read::ZlibDecoder;
use isolux_core::math::Rgb;
use isolux_core::scene::Grouping;
use isolux_core::solution::GroupLight;
use isolux_core::superposition::mix;
use isolux_core::{Problem, Solution};
use std::io::Read;

/// A part, read as the page reads it.
struct Unpacked {
    header: Value,
    body: Vec<u8>,
}

impl Unpacked {
    fn new(packed: &[u8]) -> Unpacked {
        let mut bytes = Vec::new();
        ZlibDecoder::new(packed).read_to_end(&mut bytes).unwrap();
        assert_eq!(&bytes[..8], b"isoluxv1");
        let length = u32::from_le_bytes(bytes[8..12].try_into().unwrap()) as usize;
        let header = serde_json::from_slice(&bytes[12..12 + length]).unwrap();
        Unpacked { header, body: bytes[12 + length..].to_vec() }
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        let section = &self.header["sections"][name];
        let number = |key: &str| section[key].as_u64().unwrap() as usize;
        let stored = &self.body[number("offset")..][..number("bytes")];
        let (record, count) = (number("record"), number("bytes") / number("record"));
        (0..stored.len()).map(|k| stored[k % record * count + k / record]).collect()
    }

    fn floats(&self, name: &str) -> Vec<f32> {
        self.bytes(name).as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect()
    }

    fn halves(&self, name: &str) -> Vec<f32> {
        let scale = self.header["sections"][name]["scale"].as_f64().unwrap() as f32;
        let value = |b: &[u8; 2]| half::f16::from_le_bytes(*b).to_f32() * scale;
        self.bytes(name).as_chunks().0.iter().map(value).collect()
    }

    fn numbers(&self, name: &str) -> Vec<u32> {
        let mut sum = 0u32;
        let mut next = |b: &[u8; 4]| {
            sum = sum.wrapping_add(u32::from_le_bytes(*b));
            sum
        };
        self.bytes(name).as_chunks().0.iter().map(&mut next).collect()
    }
}

fn parts(problem: &Problem, solution: &Solution) -> (Unpacked, Unpacked) {
    let lit = LitScene::smoothed(problem, solution, Smoothing::None);
    let shown = Surfaces::new(problem, lit.field(), &solution.groups, true);
    let light = light_part(&lit, &shown, &ExportOptions::default()).unwrap();
    (Unpacked::new(&shown.part(problem).unwrap()), Unpacked::new(&light))
}

#[test]
fn triangles_cover_their_elements_and_have_their_light() {
    for (problem, solution) in [fixture::lit_box(), fixture::lit_ball()] {
        let (surfaces, light) = parts(&problem, &solution);
        let position = surfaces.floats("position");
        let corner = |v: u32| glam::Vec3::from_slice(&position[3 * v as usize..]);
        let (indices, elements) = (surfaces.numbers("index"), surfaces.numbers("triangle_element"));
        let mut areas = vec![0.0; problem.mesh.len()];
        for (corners, &e) in indices.chunks(3).zip(&elements) {
            let [a, b, c] = [0, 1, 2].map(|k| corner(corners[k]));
            let normal = (b - a).cross(c - a);
            areas[e as usize] += 0.5 * normal.length();
            if problem.mesh.cluster(e).is_none() {
                assert!(normal.normalize().dot(problem.mesh.normal(e)) > 0.999, "seen from the side it is on");
            }
        }
        for (e, (&drawn, stored)) in areas.iter().zip(surfaces.floats("area")).enumerate() {
            assert!((drawn / problem.mesh.area(e as u32) - 1.0).abs() < 2e-3 && stored == problem.mesh.area(e as u32));
        }
        let irradiance: Vec<f32> = solution.irradiance.iter().flat_map(|c| c.to_array()).collect();
        assert_eq!(light.floats("irradiance 0"), irradiance);
        let errors = light.halves("std_error 0");
        for (e, stored) in solution.std_error.iter().zip(errors.chunks(3)) {
            let close = |(a, b): (f32, &f32)| (a.is_nan() && b.is_nan()) || (a / b - 1.0).abs() < 1e-3;
            assert!(e.to_array().into_iter().zip(stored).all(close), "{e:?} {stored:?}");
        }
    }
}

#[test]
fn vertices_have_the_light_of_the_field() {
    let (problem, solution) = fixture::lit_box();
    let lit = LitScene::smoothed(&problem, &solution, Smoothing::None);
    let (surfaces, light) = parts(&problem, &solution);
    let (position, irradiance) = (surfaces.floats("position"), light.halves("vertex irradiance 0"));
    assert_eq!(position.len(), irradiance.len());
    let (indices, elements) = (surfaces.numbers("index"), surfaces.numbers("triangle_element"));
    for (corners, &e) in indices.chunks(3).zip(&elements) {
        let place = problem.mesh.place(e);
        let known =
            lit.field().vertices_at(&problem, place).map(|v| (lit.field().position(v), lit.field().irradiance(v)));
        for &v in corners {
            let at = |values: &[f32]| glam::Vec3::from_slice(&values[3 * v as usize..]);
            if let Some((_, light)) = known.iter().find(|(p, _)| p.distance(at(&position)) < 1e-6) {
                let found = Rgb::from(at(&irradiance).to_array());
                assert!((found.g / light.g - 1.0).abs() < 1e-3, "{found:?} {light:?}");
            }
        }
    }
}

/// The box with its two emitting objects as groups, the second of them dimmed.
fn grouped(factor: f32) -> (Problem, Solution) {
    let (problem, solution) = fixture::lit_box();
    let groups = Grouping::Objects.groups(&problem.scene).unwrap();
    let count = groups.len();
    let alone = |group| GroupLight { group, flux: [1.0; 3], factor: Rgb::WHITE, solution: solution.clone() };
    let solution = Solution { groups: groups.into_iter().map(alone).collect(), ..solution.clone() };
    let factors: Vec<Rgb> = (0..count).map(|k| Rgb::grey(if k == 1 { factor } else { 1.0 })).collect();
    mix(&problem, solution, &factors).unwrap()
}

#[test]
fn lamps_that_are_dimmed_change_no_surface() {
    let ((bright, light), (dim, dimmed)) = (grouped(1.0), grouped(0.25));
    let ((surfaces, light), (same, dimmed)) = (parts(&bright, &light), parts(&dim, &dimmed));
    assert_eq!(surfaces.header, same.header);
    assert!(surfaces.body == same.body);
    assert_eq!(dimmed.header["groups"][1]["factor"], json!([0.25, 0.25, 0.25]));
    assert_eq!(light.floats("irradiance 1"), dimmed.floats("irradiance 1"));
    let groups: Vec<&Value> = surfaces.header["batches"].as_array().unwrap().iter().map(|b| &b["group"]).collect();
    assert!(groups.contains(&&json!(0)) && groups.contains(&&json!(1)) && groups.contains(&&Value::Null));
}

#[test]
fn mixtures_of_the_same_light_have_it_once() {
    let ((bright, light), (dim, dimmed)) = (grouped(1.0), grouped(0.25));
    // An element without a known error is like no other, not even itself.
    let known = |solution: &Solution| {
        let mut solution = solution.clone();
        solution.groups.iter_mut().for_each(|part| part.solution.std_error[3] = Rgb::BLACK);
        solution
    };
    let (light, dimmed) = (known(&light), known(&dimmed));
    assert!(is_mixture_of_same(&light, &dimmed) && has_same_elements(&bright, &dim));
    let lit = LitScene::smoothed(&dim, &dimmed, Smoothing::None);
    let part = light::part(&lit, &surfaces(&lit), &ExportOptions::default(), true, Compression::fast()).unwrap();
    let read = Unpacked::new(&part);
    assert!(read.body.is_empty() && read.header["groups"][1]["factor"] == json!([0.25, 0.25, 0.25]));
    let mut other = dimmed.clone();
    other.groups[0].solution.irradiance[5] = Rgb::WHITE;
    assert!(!is_mixture_of_same(&light, &other));
}

#[test]
fn a_page_is_whole_or_says_why_there_is_none() {
    let (problem, solution) = fixture::lit_box();
    let lit = LitScene::new(&problem, &solution);
    let written = write(&lit, &ExportOptions::default());
    if PAGE.is_empty() {
        let message = written.unwrap_err().to_string();
        assert!(message.contains("without the viewer") && message.contains("make viewer"), "{message}");
        return;
    }
    let page = String::from_utf8(written.unwrap()).unwrap();
    assert!(page.starts_with("<!doctype html>") && page.ends_with("</html>\n"));
    assert!(["surfaces", "light"].iter().all(|id| page.contains(&format!("base64\" id=\"{id}\">eJ"))));
    let both = write_compared((&lit, "a</script>"), (&lit, "b"), &ExportOptions::default()).unwrap();
    let both = String::from_utf8(both).unwrap();
    assert!(both.contains("id=\"light-before\"") && !both.contains("id=\"surfaces-before\""));
    assert!(both.contains("a\\u003c/script>") && both.contains("\"same_elements\":true"));
}
