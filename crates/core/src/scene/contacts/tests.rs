use super::*;
use crate::math::Rgb;
use crate::scene::Material;
use crate::scene::builtin::shapes::Builder;

/// A floor of one square, one-sided or not, on which a box without a bottom stands, `sunk` into it.
fn box_on_floor(sunk: f32, two_sided: bool) -> Scene {
    let mut builder = Builder::new("contacts");
    let floor = builder.material(Material { two_sided, ..Material::diffuse("floor", Rgb::grey(0.5)) });
    let side = builder.material(Material { two_sided: true, ..Material::diffuse("side", Rgb::grey(0.5)) });
    builder.object("floor", floor);
    builder.polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0)));
    builder.object("box", side);
    let cuts: [&[f32]; 3] = [&[0.31, 0.72], &[0.33, 0.69], &[-sunk, 0.5 - sunk]];
    builder.cut_box(cuts, |p| p, |axis, greater, _, _| (axis, greater) != (2, false));
    builder.finish()
}

fn area(scene: &Scene, keep: impl Fn(Vec3) -> bool) -> f64 {
    let of = |t: u32| {
        let [a, b, c] = scene.corners(t).map(|p| p.as_dvec3());
        let middle = ((a + b + c) / 3.0).as_vec3();
        if middle.z.abs() < 1e-6 && keep(middle) { 0.5 * (b - a).cross(c - a).length() } else { 0.0 }
    };
    (0..scene.triangles.len() as u32).map(of).sum()
}

fn is_under(p: Vec3) -> bool {
    p.x > 0.31 && p.x < 0.72 && p.y > 0.33 && p.y < 0.69
}

#[test]
fn a_floor_is_cut_where_a_box_stands_on_it_or_is_sunk_into_it() {
    for (sunk, two_sided) in [(0.0, false), (0.1, false), (0.0, true), (0.25, true)] {
        let whole = box_on_floor(sunk, two_sided);
        let scene = cut_at_contacts(whole.clone(), 0.02);
        assert!(scene.triangles.len() > whole.triangles.len() + 4, "{sunk}");
        assert!((area(&scene, |_| true) - 1.0).abs() < 1e-6, "{sunk}: the floor stays whole");
        assert!(
            (area(&scene, is_under) - 0.41 * 0.36).abs() < 1e-6,
            "{sunk}: each piece is under the box or beside it"
        );
        let up = |t: u32| Plane::new(scene.corners(t)).unwrap().normal.z > 0.9;
        let on_floor = |t: &u32| scene.triangles[*t as usize].object == 0;
        assert!((0..scene.triangles.len() as u32).filter(on_floor).all(up), "{sunk}: the orientation is kept");
        assert!(scene.triangles.iter().filter(|t| t.object == 0).all(|t| t.source < 2));
        // The remembered edges are the outline of the box, once.
        let on_outline = |v: u32| {
            let p = scene.vertices[v as usize].position;
            let near = |a: f32, b: f32| (a - b).abs() < 1e-5;
            p.z.abs() < 1e-5 && (near(p.x, 0.31) || near(p.x, 0.72) || near(p.y, 0.33) || near(p.y, 0.69))
        };
        // Those of its upright edges are remembered, too, and of no consequence.
        let length = |&[a, b]: &[u32; 2]| {
            let [p, q] = [a, b].map(|v| scene.vertices[v as usize].position);
            let is_low = p.z.abs() < 1e-5 && q.z.abs() < 1e-5;
            assert!(!is_low || on_outline(a) && on_outline(b));
            if is_low { p.distance(q) } else { 0.0 }
        };
        let outline: f32 = scene.contacts.iter().map(length).sum();
        let times = outline / (2.0 * (0.41 + 0.36));
        assert!((times - 1.0).abs() < 1e-4 || (times - 2.0).abs() < 1e-4, "{sunk} {two_sided}: {times}");
    }
}

#[test]
fn pieces_are_not_thin_and_hang_together() {
    let scene = cut_at_contacts(box_on_floor(0.0, false), 0.02);
    let thinnest = (0..scene.triangles.len() as u32)
        .filter(|&t| scene.triangles[t as usize].object == 0)
        .map(|t| {
            let [a, b, c] = scene.corners(t);
            let angle = |p: Vec3, q: Vec3, r: Vec3| (q - p).angle_between(r - p).to_degrees();
            angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b))
        })
        .fold(180.0, f32::min);
    assert!(thinnest > 10.0, "{thinnest} degrees");
}

#[test]
fn what_touches_nothing_is_behind_or_is_tiny_cuts_nothing() {
    let count = |scene: Scene, detail| cut_at_contacts(scene, detail).triangles.len();
    let whole = box_on_floor(0.0, false).triangles.len();
    assert_eq!(count(box_on_floor(-0.1, false), 0.02), whole, "it floats above");
    assert_eq!(count(box_on_floor(0.5, false), 0.02), whole, "it hangs below");
    assert_eq!(count(box_on_floor(0.0, false), 0.7), whole, "it is smaller than the detail");
    let room = crate::scene::builtin::builtin("box").unwrap();
    assert_eq!(count(room.clone(), 0.01), room.triangles.len(), "walls that meet at their borders");
}

#[test]
fn a_wall_on_the_seam_of_two_floors_is_remembered_there() {
    let mut builder = Builder::new("seam");
    let material = builder.material(Material { two_sided: true, ..Material::diffuse("", Rgb::grey(0.5)) });
    builder.object("floors", material);
    let floor =
        |from: f32, to: f32| [[from, 0.0], [to, 0.0], [to, 1.0], [from, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
    builder.polygon(&floor(0.0, 1.0));
    builder.polygon(&floor(1.0, 2.0));
    builder.polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[y, z]| Vec3::new(1.0, y, z)));
    let whole = builder.finish();
    let scene = cut_at_contacts(whole.clone(), 0.02);
    assert_eq!(scene.triangles, whole.triangles);
    let on_seam = |v: u32| scene.vertices[v as usize].position.x == 1.0;
    assert!(scene.contacts.len() >= 2 && scene.contacts.iter().all(|edge| edge.iter().all(|&v| on_seam(v))));
}

#[test]
fn what_was_cut_is_not_cut_again_and_textures_stay_where_they_were() {
    let mut whole = box_on_floor(0.0, false);
    for vertex in &mut whole.vertices {
        vertex.uv = vertex.position.truncate() * 3.0;
    }
    let once = cut_at_contacts(whole, 0.02);
    assert!(once.vertices.iter().all(|v| v.uv.abs_diff_eq(v.position.truncate() * 3.0, 1e-5)));
    let again = cut_at_contacts(once.clone(), 0.02);
    assert_eq!(again.triangles, once.triangles);
}
