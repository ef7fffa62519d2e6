use super::*;
use crate::math::Rgb;
use crate::scene::Material;
use crate::scene::builtin::shapes::Builder;
use glam::{DVec2, Vec3};

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

/// Length of the segments in all triangles of object 0.
fn length(scene: &Scene, contacts: &Contacts) -> f64 {
    let floor = contacts.triangles.iter().filter(|touched| scene.triangles[touched.triangle as usize].object == 0);
    floor.flat_map(|touched| &touched.inner).map(|[p, q]| p.distance(*q)).sum()
}

#[test]
fn a_box_that_stands_on_a_floor_or_is_sunk_into_it_touches_it_along_its_outline() {
    for (sunk, two_sided) in [(0.0, false), (0.1, false), (0.0, true), (0.25, true)] {
        let scene = box_on_floor(sunk, two_sided);
        let contacts = Contacts::of(&scene, 0.02);
        assert!((length(&scene, &contacts) - 2.0 * (0.41 + 0.36)).abs() < 1e-3, "{sunk} {two_sided}");
        for touched in contacts.triangles.iter().filter(|touched| touched.triangle < 2) {
            let [a, b, c] = scene.corners(touched.triangle);
            let on_outline = |point: &DVec2| {
                let [p, q, r] = touched.plane.whole.0;
                let area = (q - p).perp_dot(r - p);
                let (u, v) = ((*point - p).perp_dot(r - p) / area, (q - p).perp_dot(*point - p) / area);
                let at = a + u as f32 * (b - a) + v as f32 * (c - a);
                [(at.x, 0.31), (at.x, 0.72), (at.y, 0.33), (at.y, 0.69)].iter().any(|(x, y)| (x - y).abs() < 1e-5)
            };
            assert!(touched.inner.iter().flatten().all(on_outline), "{sunk} {two_sided}");
        }
    }
}

#[test]
fn what_floats_hangs_behind_is_tiny_or_meets_at_a_border_touches_nothing_inside() {
    let found = |scene: Scene, detail| length(&scene, &Contacts::of(&scene, detail));
    assert_eq!(found(box_on_floor(-0.1, false), 0.02), 0.0, "it floats above");
    assert_eq!(found(box_on_floor(0.5, false), 0.02), 0.0, "it hangs below");
    assert_eq!(found(box_on_floor(0.0, false), 0.7), 0.0, "it is smaller than the detail");
    let room = Contacts::of(&crate::scene::builtin::builtin("box").unwrap(), 0.01);
    assert!(room.triangles.iter().all(|touched| touched.inner.is_empty()), "walls that meet at their borders");
}

#[test]
fn a_wall_on_the_seam_of_two_floors_stands_on_their_borders() {
    let mut builder = Builder::new("seam");
    let material = builder.material(Material { two_sided: true, ..Material::diffuse("", Rgb::grey(0.5)) });
    builder.object("floors", material);
    let floor =
        |from: f32, to: f32| [[from, 0.0], [to, 0.0], [to, 1.0], [from, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
    builder.polygon(&floor(0.0, 1.0));
    builder.polygon(&floor(1.0, 2.0));
    builder.polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[y, z]| Vec3::new(1.0, y, z)));
    let scene = builder.finish();
    let contacts = Contacts::of(&scene, 0.02);
    let mut touched_floors = 0;
    for touched in &contacts.triangles {
        assert!(touched.inner.is_empty());
        let corners = scene.corners(touched.triangle);
        for k in (0..3).filter(|&k| touched.borders[k]) {
            assert!(corners[k].x == 1.0 && corners[(k + 1) % 3].x == 1.0);
            touched_floors += usize::from(touched.triangle < 4);
        }
    }
    assert_eq!(touched_floors, 2);
}
