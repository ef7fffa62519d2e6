use crate::math::Rgb;
use crate::mesh::{Cut, Division, ElementMesh, Resolution};
use crate::scene::builtin::builtin;
use crate::scene::builtin::shapes::Builder;
use crate::scene::{Contacts, Material, Scene};
use glam::{DVec2, DVec3, Vec2, Vec3};

const DETAIL: f32 = 0.02;

/// A floor of two triangles, and walls without thickness on it along these lines.
fn walls(lines: &[[[f32; 2]; 2]]) -> Scene {
    let mut builder = Builder::new("walls");
    let material = builder.material(Material { two_sided: true, ..Material::diffuse("", Rgb::grey(0.5)) });
    builder.object("floor", material);
    builder.polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0)));
    builder.object("walls", material);
    for [[x, y], [z, w]] in lines {
        builder.polygon(&[[*x, *y, -0.1], [*z, *w, -0.1], [*z, *w, 0.4], [*x, *y, 0.4]].map(Vec3::from));
    }
    builder.finish()
}

/// A box, a wall that crosses one of its faces, one that hangs from nothing, one that meets it and two that cross in one point.
fn furnished() -> Scene {
    let outline = [[0.31, 0.33], [0.72, 0.33], [0.72, 0.69], [0.31, 0.69]];
    let mut lines: Vec<[[f32; 2]; 2]> = (0..4).map(|k| [outline[k], outline[(k + 1) % 4]]).collect();
    lines.extend([[[0.1, 0.12], [0.2, 0.47]], [[0.5, 0.1], [0.5, 0.9]], [[0.61, 0.333], [0.66, 0.02]]]);
    lines.extend([[[0.8, 0.8], [0.95, 0.91]], [[0.8, 0.93], [0.93, 0.8]]]);
    walls(&lines)
}

/// Positions of the corners of all elements, with the number of the triangle.
fn corners(scene: &Scene, mesh: &ElementMesh) -> Vec<(u32, [DVec3; 3])> {
    let of_element = |e: u32| {
        let [a, b, c] = scene.corners(mesh.triangle(e)).map(Vec3::as_dvec3);
        let at = |uv: Vec2| a + f64::from(uv.x) * (b - a) + f64::from(uv.y) * (c - a);
        (mesh.triangle(e), mesh.corners(e).map(at))
    };
    mesh.elements().map(of_element).collect()
}

/// Number of elements of the floor that a segment enters by more than rounding.
fn crossed(scene: &Scene, cut: &Cut, contacts: &Contacts) -> usize {
    let mesh = ElementMesh::with_cut(scene, cut).unwrap();
    let is_crossed = |(triangle, corners): &(u32, [DVec3; 3])| {
        let Some(touched) = contacts.triangles.iter().find(|touched| touched.triangle == *triangle) else {
            return false;
        };
        let [a, b, c] = corners.map(|corner| touched.plane.flat(corner));
        let inside = |p: DVec2| {
            let off = |from: DVec2, to: DVec2| (to - from).normalize().perp_dot(p - from);
            off(a, b).min(off(b, c)).min(off(c, a)) > 8.0 * contacts.tolerance
        };
        touched.inner.iter().any(|[p, q]| (0..=2000).any(|k| inside(p.lerp(*q, f64::from(k) / 2000.0))))
    };
    corners(scene, &mesh).iter().filter(|corners| is_crossed(corners)).count()
}

#[test]
fn every_element_lies_on_one_side_of_all_contacts() {
    let scene = furnished();
    let contacts = Contacts::of(&scene, DETAIL);
    for resolution in [Resolution::Elements(2000), Resolution::Elements(10_000), Resolution::MaxEdge(0.03)] {
        let whole = resolution.cut(&scene).unwrap();
        assert!(crossed(&scene, &whole, &contacts) > 30, "{resolution:?}");
        assert_eq!(crossed(&scene, &resolution.cut_along(&scene, &contacts).unwrap(), &contacts), 0, "{resolution:?}");
    }
}

#[test]
fn a_mesh_that_was_bisected_before_is_cut_as_well_and_nothing_is_cut_twice() {
    let scene = furnished();
    let contacts = Contacts::of(&scene, DETAIL);
    let halves = |depth: u32| {
        let mut tree = vec![Division::Cells(2)];
        for _ in 0..depth {
            tree = [vec![Division::Bisected { from: 0, share: 0.5 }], tree.clone(), tree].concat();
        }
        tree
    };
    let plain = Resolution::Elements(1).cut(&scene).unwrap();
    let divisions = (0..plain.divisions.len()).flat_map(|t| halves(1 + t as u32 % 6)).collect();
    let bisected = Cut { divisions, ..plain };
    let once = bisected.along(&scene, &contacts, u64::MAX);
    assert!(crossed(&scene, &bisected, &contacts) > 20 && crossed(&scene, &once, &contacts) == 0);
    assert!(once.along(&scene, &contacts, u64::MAX) == once);
}

#[test]
fn areas_stay_and_elements_are_few() {
    let scene = furnished();
    let contacts = Contacts::of(&scene, DETAIL);
    let whole = Resolution::Elements(4000).cut(&scene).unwrap();
    let cut = whole.along(&scene, &contacts, u64::MAX);
    let area = |cut: &Cut| ElementMesh::with_cut(&scene, cut).unwrap().total_area();
    assert!((area(&cut) / area(&whole) - 1.0).abs() < 1e-6);
    // Three for one, and a little more where contacts end or meet.
    let met = crossed(&scene, &whole, &contacts) as f64;
    let more = (cut.element_count(&scene).unwrap() - whole.element_count(&scene).unwrap()) as f64;
    assert!(more > 1.4 * met && more < 2.4 * met, "{more} more for {met}");
}

#[test]
fn no_more_elements_are_made_than_may_be() {
    let scene = furnished();
    let contacts = Contacts::of(&scene, DETAIL);
    for asked in [12, 100, 3000, 50_000] {
        let cut = Resolution::Elements(asked).cut_along(&scene, &contacts).unwrap();
        let count = cut.element_count(&scene).unwrap() as u64;
        let least = Resolution::least(&scene);
        assert!(count <= asked.max(least), "{count} for {asked}");
        assert!(asked < 3000 || count * 10 > asked * 9, "{count} for {asked}");
    }
    let whole = Resolution::Elements(3000).cut(&scene).unwrap();
    let (few, all) = (whole.along(&scene, &contacts, 3200), whole.along(&scene, &contacts, u64::MAX));
    let count = |cut: &Cut| cut.element_count(&scene).unwrap();
    assert!(count(&few) > count(&whole) && count(&few) <= 3200 && count(&all) > 3200);
}

#[test]
fn contacts_are_marked_on_both_sides_and_only_there() {
    let scene = walls(&[[[0.37, 0.0], [0.37, 0.6]]]);
    let cut = Resolution::Elements(3000).cut_along(&scene, &Contacts::of(&scene, DETAIL)).unwrap();
    let mesh = ElementMesh::with_cut(&scene, &cut).unwrap();
    let mut length = 0.0;
    for patch in mesh.patches().filter(|&patch| mesh.triangle_of_patch(patch) < 2) {
        let [a, b, c] = scene.corners(mesh.triangle_of_patch(patch));
        let corners = [Vec2::ZERO, Vec2::X, Vec2::Y].map(|uv| mesh.on_triangle(patch, uv));
        let corners = corners.map(|uv| a + uv.x * (b - a) + uv.y * (c - a));
        for k in (0..3).filter(|&k| mesh.beside(patch)[k]) {
            let ends = [corners[k], corners[(k + 1) % 3]];
            assert!(ends.iter().all(|p| (p.x - 0.37).abs() < 1e-5 && p.y < 0.6001), "{ends:?}");
            length += ends[0].distance(ends[1]);
        }
    }
    assert!((length - 2.0 * 0.6).abs() < 1e-3, "{length}");
}

#[test]
fn clusters_and_triangles_without_contacts_stay_as_they_are() {
    let scene = builtin("office").unwrap();
    let contacts = Contacts::of(&scene, DETAIL);
    let whole = Resolution::Clustered(3000).cut(&scene).unwrap();
    let cut = whole.along(&scene, &contacts, u64::MAX);
    assert!(cut.leaders == whole.leaders && !whole.leaders.is_empty() && cut != whole);
    let (before, after) = (whole.first_divisions(), cut.first_divisions());
    let touched = |t: usize| contacts.triangles.binary_search_by_key(&t, |touched| touched.triangle as usize).is_ok();
    for t in (0..scene.triangles.len()).filter(|&t| whole.leaders[t] as usize != t || !touched(t)) {
        assert_eq!(whole.divisions[before[t]..before[t + 1]], cut.divisions[after[t]..after[t + 1]], "{t}");
    }
}

#[test]
fn lookups_lead_to_the_elements_and_back() {
    let scene = furnished();
    let cut = Resolution::Elements(3000).cut_along(&scene, &Contacts::of(&scene, DETAIL)).unwrap();
    let mesh = ElementMesh::with_cut(&scene, &cut).unwrap();
    assert!(mesh.cut() == cut);
    for e in mesh.elements() {
        let place = mesh.place(e);
        let middle = mesh.corners(e).iter().sum::<Vec2>() / 3.0;
        let lookup = mesh.lookup(place.triangle);
        let (front, further) = lookup.front(middle);
        assert_eq!(mesh.at(place.triangle, middle, place.back), Some(e));
        assert_eq!(front + if place.back { further } else { 0 }, e);
    }
}
