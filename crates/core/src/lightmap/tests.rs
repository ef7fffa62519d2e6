//! Maps whose every texel is known.

use super::*;
use crate::Solution;
use crate::mesh::{Resolution, cells};
use crate::scene::builtin::builtin;
use crate::scene::builtin::shapes::Builder;
use crate::scene::{Material, Scene};
use crate::view::tests::solution;
use glam::Vec3;

/// The field of light that is `light(position, normal)` [lux] in the middle of every element.
fn lit(scene: Scene, elements: u64, light: impl Fn(Vec3, Vec3) -> f32) -> (Problem, Solution, VertexField) {
    let problem = Problem::new(scene, Resolution::Elements(elements)).unwrap();
    let middle = |e: u32| {
        let place = problem.mesh.place(e);
        let at = problem.mesh.corners_at(place).iter().sum::<Vec2>() / 3.0;
        let (position, front) = problem.geometry.surface(place.triangle, at);
        Rgb::grey(light(position, if place.back { -front } else { front }))
    };
    let solution = solution(problem.mesh.elements().map(middle).collect());
    let field = VertexField::as_computed(&problem, &solution);
    (problem, solution, field)
}

fn size(size: u32) -> Layout {
    Layout { density: Density::Size(size), ..Layout::default() }
}

/// A ball of facets, one-sided, smooth all over.
fn ball() -> Scene {
    let mut builder = Builder::new("ball");
    let white = builder.material(Material::diffuse("white", Rgb::grey(0.5)));
    builder.object("ball", white);
    builder.ball(Vec3::ZERO, 1.0, 24);
    builder.finish()
}

/// Middles of cells all over face `f`: where they are on the face, and in the map.
fn points(lightmap: &Lightmap, f: usize) -> impl Iterator<Item = (Vec2, Vec2)> {
    let [a, b, c] = lightmap.atlas.uv[f];
    (0..cells::count(8)).map(move |cell| {
        let at = cells::corners(cell, 8).iter().sum::<Vec2>() / 3.0;
        (at, a + at.x * (b - a) + at.y * (c - a))
    })
}

#[test]
fn a_furnace_is_constant_everywhere_between_charts_too() {
    for name in ["cornell-box", "cubes", "sphere", "office"] {
        let (problem, _, field) = lit(builtin(name).unwrap(), 3000, |_, _| 0.1);
        let lightmap =
            bake(&problem, &field, &size(256)).unwrap_or_else(|_| bake(&problem, &field, &size(2048)).unwrap());
        assert!(lightmap.irradiance.iter().all(|light| *light == Rgb::grey(0.1)), "{name}");
    }
}

#[test]
fn every_lookup_on_a_surface_reads_texels_of_its_own_chart() {
    for (name, texels) in [("cornell-box", 256), ("cubes", 128), ("labyrinth", 512), ("office", 2048)] {
        let (problem, _, field) = lit(builtin(name).unwrap(), 3000, |_, _| 1.0);
        let lightmap = bake(&problem, &field, &size(texels)).unwrap();
        let atlas = &lightmap.atlas;
        let mut looked = 0;
        for f in 0..atlas.faces.len() {
            // Needles thinner than single precision share the texels of a corner.
            if atlas::area_in_texels(&atlas.uv[f], glam::DVec2::splat(f64::from(texels))) < 1e-9 {
                continue;
            }
            for (_, uv) in points(&lightmap, f) {
                for (texel, weight) in texels::stencil(uv, atlas.width, atlas.height) {
                    let Some(shown) = lightmap.texels.list[texel] else {
                        panic!("{name}: face {f} has no texel at {uv}")
                    };
                    let is_own = atlas.chart[shown.face as usize] == atlas.chart[f];
                    assert!(is_own || weight < 1e-3, "{name}: face {f} reads another chart at {uv}");
                    looked += 1;
                }
            }
        }
        assert!(looked > 1000, "{name}");
    }
}

/// The least distance between texels on different charts, by columns and rows.
fn least_distance(lightmap: &Lightmap, most: usize) -> usize {
    let (width, height) = (lightmap.atlas.width as usize, lightmap.atlas.height as usize);
    let chart = |texel: usize| {
        let shown = lightmap.texels.list[texel].filter(|shown| shown.inside);
        shown.map(|shown| lightmap.atlas.chart[shown.face as usize])
    };
    let mut least = most;
    for texel in (0..width * height).filter(|&texel| chart(texel).is_some()) {
        let (x, y) = (texel % width, texel / width);
        for row in y..(y + most).min(height) {
            for column in x.saturating_sub(most)..(x + most).min(width) {
                let other = row * width + column;
                if chart(other).is_some_and(|other| Some(other) != chart(texel)) {
                    least = least.min((row - y).max(column.abs_diff(x)));
                }
            }
        }
    }
    least
}

#[test]
fn charts_are_twice_the_padding_apart() {
    for (padding, align_blocks) in [(1, false), (3, false), (4, true)] {
        let (problem, _, field) = lit(builtin("cubes").unwrap(), 500, |_, _| 1.0);
        let layout = Layout { padding, align_blocks, ..size(160) };
        let lightmap = bake(&problem, &field, &layout).unwrap();
        assert!(least_distance(&lightmap, 12) >= 2 * padding as usize, "{padding}");
    }
}

#[test]
fn a_straight_gradient_is_found_at_every_point_of_a_wall() {
    let (problem, _, field) = lit(builtin("box").unwrap(), 6000, |p, _| 10.0 + 3.0 * p.x - p.y + 2.0 * p.z);
    let lightmap = bake(&problem, &field, &size(512)).unwrap();
    for (f, face) in lightmap.atlas.faces.iter().enumerate() {
        for (at, uv) in points(&lightmap, f) {
            let expected = face.irradiance(&problem, &field, at).g;
            assert!((lightmap.lookup(uv).g - expected).abs() < 0.02, "{} {expected}", lightmap.lookup(uv).g);
        }
    }
}

/// The largest difference of lookups from either side of borders that two charts of a smooth surface share.
fn largest_seam(problem: &Problem, lightmap: &Lightmap) -> f32 {
    let key = |p: Vec3| p.to_array().map(|v| (v * 1e4).round() as i64);
    let mut edges = Vec::new();
    for border in &lightmap.atlas.borders {
        let (f, k) = (border.face as usize, usize::from(border.edge));
        let (positions, uv) = (lightmap.atlas.faces[f].positions(problem), lightmap.atlas.uv[f]);
        let mut ends = [(key(positions[k]), uv[k]), (key(positions[(k + 1) % 3]), uv[(k + 1) % 3])];
        ends.sort_by_key(|(key, _)| *key);
        edges.push((ends.map(|(key, _)| key), ends.map(|(_, uv)| uv)));
    }
    edges.sort_by_key(|(key, _)| *key);
    let mut largest: f32 = 0.0;
    let mut shared = 0;
    for pair in edges.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        shared += 1;
        for j in 0..=32 {
            let t = j as f32 / 32.0;
            let [one, other] = [&pair[0].1, &pair[1].1].map(|uv| lightmap.lookup(uv[0].lerp(uv[1], t)).g);
            largest = largest.max((one - other).abs());
        }
    }
    assert!(shared > 10, "{shared} edges are shared");
    largest
}

#[test]
fn no_seam_shows_where_charts_of_a_smooth_surface_meet() {
    let light = |p: Vec3, _: Vec3| 10.0 + 3.0 * (2.0 * p.x).sin() + 2.0 * (3.0 * p.y).cos() * p.z;
    let (problem, _, field) = lit(ball(), 20_000, light);
    let lightmap = bake(&problem, &field, &size(256)).unwrap();
    let seam = largest_seam(&problem, &lightmap);
    // The planted fault: texels beyond the border have the light of the nearest point.
    let mut unfitted = lightmap.clone();
    for (texel, light) in unfitted.texels.list.iter().zip(&mut unfitted.irradiance) {
        if let Some(texel) = texel {
            *light = unfitted.atlas.faces[texel.face as usize].irradiance(&problem, &field, texel.at);
        }
    }
    let fault = largest_seam(&problem, &unfitted);
    assert!(seam < 0.03 && fault > 3.0 * seam, "{seam} of about 10 lux, without fitting {fault}");
}

#[test]
fn lookups_have_the_mean_of_the_solution() {
    let (problem, solution, field) = lit(builtin("cubes").unwrap(), 20_000, |p, n| 5.0 + p.x + n.y);
    let lightmap = bake(&problem, &field, &size(512)).unwrap();
    let objects = per_object(&problem, &solution, &lightmap);
    assert_eq!(objects.iter().map(|object| object.charts).sum::<u32>(), lightmap.atlas.chart_count);
    for object in &objects {
        assert!((object.mean / object.mean_of_solution - 1.0).abs() < 2e-3, "{object:?}");
    }
    let read = lightmap.texels.list.iter().flatten().count() as u64;
    assert_eq!(objects.iter().map(|object| object.texels).sum::<u64>(), read);
}

/// A closed box on a floor that is lit where it lies open: elements hold the share of theirs that is.
fn box_on_floor() -> (Problem, VertexField) {
    let mut builder = Builder::new("floor");
    let white = builder.material(Material::diffuse("white", Rgb::grey(0.5)));
    builder.object("floor", white);
    builder.polygon(&[[0.0, 0.0, 0.0], [0.0, 0.0, 2.0], [2.0, 0.0, 2.0], [2.0, 0.0, 0.0]].map(Vec3::from));
    builder.object("box", white);
    builder.cuboid(Vec3::new(LOW, 0.0, LOW), Vec3::new(HIGH, 0.5, HIGH));
    let problem = Problem::new(builder.finish(), Resolution::Elements(12_000)).unwrap();
    let share = |e: u32| {
        let point = |k: u32| {
            let square = Vec2::new((k % 16) as f32 + 0.5, (k / 16) as f32 + 0.5) / 16.0;
            let (triangle, uv) = problem.mesh.point(e, square);
            problem.geometry.surface(triangle, uv).0
        };
        let open = |k: &u32| !is_below(point(*k));
        (0..256).filter(open).count() as f32 / 256.0
    };
    let light = problem.mesh.elements().map(|e| Rgb::grey(if problem.object(e) == 0 { share(e) } else { 1.0 }));
    let field = VertexField::as_computed(&problem, &solution(light.collect()));
    (problem, field)
}

const LOW: f32 = 0.73;
const HIGH: f32 = 1.41;

fn is_below(p: Vec3) -> bool {
    p.y < 1e-4 && (LOW..HIGH).contains(&p.x) && (LOW..HIGH).contains(&p.z)
}

/// How much darker than the field lookups are at most, on the open floor close to the box.
fn darkening_beside_box(problem: &Problem, field: &VertexField, lightmap: &Lightmap) -> f32 {
    let mut most: f32 = 0.0;
    for (f, face) in lightmap.atlas.faces.iter().enumerate().filter(|(_, face)| face.object(problem) == 0) {
        let [a, b, c] = lightmap.atlas.uv[f];
        for cell in 0..cells::count(200) {
            let at = cells::corners(cell, 200).iter().sum::<Vec2>() / 3.0;
            if !is_below(face.surface(problem, at).0) {
                let found = lightmap.lookup(a + at.x * (b - a) + at.y * (c - a)).g;
                most = most.max(face.irradiance(problem, field, at).g - found);
            }
        }
    }
    most
}

#[test]
fn a_box_on_a_floor_has_no_dark_fringe() {
    let (problem, field) = box_on_floor();
    for padding in [1, 4] {
        let lightmap = bake(&problem, &field, &Layout { padding, ..size(64) }).unwrap();
        let darker = darkening_beside_box(&problem, &field, &lightmap);
        assert!(darker < 0.05 && lightmap.covered > 0, "{darker}, {} texels covered", lightmap.covered);
        // The planted fault: texels below the box keep what they have.
        let mut unmended = lightmap.clone();
        for (texel, light) in unmended.texels.list.iter().zip(&mut unmended.irradiance) {
            if let Some(texel) = texel.filter(|texel| texel.inside) {
                *light = unmended.atlas.faces[texel.face as usize].irradiance(&problem, &field, texel.at);
            }
        }
        let fault = darkening_beside_box(&problem, &field, &unmended);
        assert!(fault > 0.2, "{fault}, mended {darker}");
    }
}

/// Two triangles of a square in the upper half of the map, and the same below it.
fn with_coordinates() -> Scene {
    let mut builder = Builder::new("squares");
    let white = builder.material(Material::diffuse("white", Rgb::grey(0.5)));
    for z in [0.0, 1.0] {
        builder.object(if z > 0.0 { "far" } else { "near" }, white);
        builder.polygon(&[[0.0, 0.0, z], [2.0, 0.0, z], [2.0, 1.0, z], [0.0, 1.0, z]].map(Vec3::from));
    }
    let mut scene = builder.finish();
    let at =
        |v: &crate::scene::Vertex| Vec2::new(0.1 + 0.4 * v.position.x, 0.05 + 0.4 * v.position.y + 0.5 * v.position.z);
    scene.lightmap_uvs = scene.vertices.iter().map(at).collect();
    scene
}

#[test]
fn coordinates_of_the_file_are_kept_to_the_last_bit() {
    let scene = with_coordinates();
    let (problem, _, field) = lit(scene.clone(), 1000, |p, _| 1.0 + p.x);
    let lightmap = bake(&problem, &field, &size(64)).unwrap();
    assert_eq!((lightmap.atlas.origin, lightmap.atlas.chart_count), (Origin::File, 2));
    for (face, uv) in lightmap.atlas.faces.iter().zip(&lightmap.atlas.uv) {
        let own = scene.triangles[face.triangle as usize].vertices.map(|v| scene.lightmap_uvs[v as usize]);
        assert_eq!(uv.map(|uv| uv.to_array().map(f32::to_bits)), own.map(|uv| uv.to_array().map(f32::to_bits)));
    }
    // As many texels as 25 a metre take: 0.4 of the map are a metre.
    let layout = Layout { density: Density::TexelsPerMetre(25.0), ..Layout::default() };
    let lightmap = bake(&problem, &field, &layout).unwrap();
    assert_eq!(lightmap.atlas.width, 64);
    let new = bake(&problem, &field, &Layout { keep_existing: false, ..size(64) }).unwrap();
    assert!(matches!(new.atlas.origin, Origin::Made { why_not_file: Some(_) }));
}

#[test]
fn coordinates_that_are_no_lightmap_are_not_kept_and_it_is_said_why() {
    let why = |change: &dyn Fn(&mut Vec2)| {
        let mut scene = with_coordinates();
        scene.lightmap_uvs.iter_mut().for_each(change);
        let (problem, _, field) = lit(scene, 100, |_, _| 1.0);
        match bake(&problem, &field, &size(64)).unwrap().atlas.origin {
            Origin::Made { why_not_file: Some(why) } => why,
            other => panic!("{other:?}"),
        }
    };
    assert!(why(&|uv| uv.x *= 2.0).contains("leave the range"));
    assert!(why(&|uv| uv.y = (uv.y - 0.05) % 0.5).contains("'near' and 'far' overlap"));
    assert!(why(&|uv| *uv = Vec2::ZERO).contains("no area"));
}

#[test]
fn both_sides_of_a_sheet_have_charts_and_dark_insides_have_none() {
    let mut scene = with_coordinates();
    scene.lightmap_uvs.clear();
    scene.materials[0].two_sided = true;
    let light = |_: Vec3, n: Vec3| if n.z > 0.0 { 5.0 } else { 2.0 };
    let (problem, _, field) = lit(scene.clone(), 400, light);
    let lightmap = bake(&problem, &field, &size(64)).unwrap();
    assert_eq!((lightmap.atlas.faces.len(), lightmap.atlas.chart_count), (8, 4));
    for (f, face) in lightmap.atlas.faces.iter().enumerate() {
        let expected = if face.surface(&problem, Vec2::splat(0.3)).1.z > 0.0 { 5.0 } else { 2.0 };
        assert!(points(&lightmap, f).all(|(_, uv)| (lightmap.lookup(uv).g - expected).abs() < 1e-5));
    }
    let (problem, _, field) = lit(scene, 400, |_, n| if n.z > 0.0 { 0.0 } else { 2.0 });
    let lightmap = bake(&problem, &field, &size(64)).unwrap();
    assert!(lightmap.atlas.faces.len() == 4 && lightmap.atlas.faces.iter().all(|face| face.back));
}

#[test]
fn the_bits_do_not_depend_on_the_threads() {
    let (problem, _, field) = lit(builtin("cubes").unwrap(), 3000, |p, n| 5.0 + p.x + n.y);
    let baked = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let map = pool.install(|| bake(&problem, &field, &size(256)).unwrap());
        map.irradiance.iter().flat_map(|light| light.to_array().map(f32::to_bits)).collect::<Vec<_>>()
    };
    assert!(baked(1) == baked(3));
}

#[test]
fn density_is_what_was_asked_for_or_an_error_says_what_fits() {
    let (problem, _, field) = lit(builtin("cubes").unwrap(), 300, |_, _| 1.0);
    let with = |density| bake(&problem, &field, &Layout { density, ..Layout::default() });
    let lightmap = with(Density::TexelsPerMetre(40.0)).unwrap();
    assert!((lightmap.atlas.texels_per_metre - 40.0).abs() < 0.1, "{}", lightmap.atlas.texels_per_metre);
    let message = with(Density::TexelsPerMetre(1e5)).unwrap_err().to_string();
    assert!(message.contains("8192 are the most; about "), "{message}");
    let fits: f32 = message.split("about ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!(fits > 100.0 && fits < 1e5);
    for wrong in [Density::Size(0), Density::Size(1 << 20), Density::TexelsPerMetre(f32::NAN)] {
        assert!(matches!(with(wrong), Err(Error::Parameter { .. })), "{wrong:?}");
    }
    let unpadded = bake(&problem, &field, &Layout { padding: 0, ..size(64) });
    assert!(matches!(unpadded, Err(Error::Parameter { name: "padding", .. })));
}

#[test]
fn triangles_without_area_and_vertices_without_triangles_do_no_harm() {
    let mut scene = with_coordinates();
    scene.lightmap_uvs.clear();
    let last = scene.triangles[0];
    scene.triangles.push(crate::scene::Triangle { vertices: [0, 1, 1], ..last });
    scene.vertices.push(crate::scene::Vertex::at(Vec3::splat(99.0)));
    scene.vertices.push(crate::scene::Vertex::at(Vec3::new(1.0, 1e-9, 0.0)));
    let needle = scene.vertices.len() as u32 - 1;
    scene.triangles.push(crate::scene::Triangle { vertices: [0, 1, needle], ..last });
    let (problem, _, field) = lit(scene, 100, |_, _| 3.0);
    let lightmap = bake(&problem, &field, &size(64)).unwrap();
    assert!(lightmap.irradiance.iter().all(|light| light.g == 3.0));
}
