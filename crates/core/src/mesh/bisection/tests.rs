use super::{Division, bisected, bisected_at, halved, halves};
use crate::math::hash;
use crate::mesh::cells;
use crate::mesh::{Cut, ElementMesh, Point, Resolution, TOGETHER};
use crate::scene::Scene;
use crate::scene::builtin::builtin;
use glam::{Vec2, Vec3};

/// Needles among its triangles, two-sided by turns, deeply and unevenly divided.
fn divided() -> (Scene, Cut) {
    let mut scene = builtin("office").unwrap();
    (0..).zip(&mut scene.materials).for_each(|(k, material)| material.two_sided = k % 2 == 0);
    let Cut { slices, divisions, leaders } = Resolution::Elements(2000).cut(&scene).unwrap();
    let mut state = 1;
    let roots = 0..divisions.len();
    let divisions = roots.flat_map(|root| tree(if root % 50 == 0 { 16 } else { 4 }, &mut state)).collect();
    (scene, Cut { slices, divisions, leaders })
}

/// Divisions of a patch that is divided at random, `depth` times at most.
fn tree(depth: usize, state: &mut u64) -> Vec<Division> {
    *state = hash::mix(*state);
    let random = *state % 16;
    if depth == 0 || random < 4 {
        let beside = Division::Beside((*state >> 32 & 7) as u8);
        let marked = random == 1 && beside != Division::Beside(0);
        return [vec![beside; usize::from(marked)], vec![Division::Cells(1 + (random % 3) as u16)]].concat();
    }
    // Nine parts take the place of about three bisections.
    let (division, parts, below) = match (random % 3) as u8 {
        _ if random == 15 => (Division::Split(3), cells::count(3), depth.saturating_sub(4)),
        from if random < 8 => (Division::Bisected { from, share: 0.5 }, 2, depth - 1),
        from => (Division::Bisected { from, share: (*state >> 32) as f32 / (1u64 << 33) as f32 + 0.25 }, 2, depth - 1),
    };
    let parts: Vec<Division> = (0..parts).flat_map(|_| tree(below, state)).collect();
    [vec![division], parts].concat()
}

fn points() -> impl Iterator<Item = Vec2> {
    let edges = [Vec2::X, Vec2::Y, Vec2::ZERO, Vec2::splat(0.5), Vec2::splat(0.25), Vec2::new(-1e-3, 1.001)];
    let inner = (0..40).map(|k| {
        let u = (k as f32 * 0.618_034).fract();
        Vec2::new(u, (k as f32 * 0.414_214).fract() * (1.0 - u))
    });
    edges.into_iter().chain(inner)
}

#[test]
fn both_parts_make_the_whole_wherever_it_is_bisected() {
    let whole = [Vec2::ZERO, Vec2::X, Vec2::Y];
    for (from, share) in (0..3).flat_map(|from| [0.01, 0.3, 0.5, 0.999].map(|share| (from, share))) {
        for uv in points().skip(6) {
            let (part, within) = bisected_at(uv, from, share);
            let [a, b, c] = bisected(whole, from, share)[part as usize];
            assert!((a + within.x * (b - a) + within.y * (c - a)).abs_diff_eq(uv, 1e-6), "{from} {share} {uv}");
            assert!(within.min_element() >= -1e-5 && within.element_sum() < 1.00001, "{from} {share} {uv} {within}");
            let area = if part == 0 { share } else { 1.0 - share };
            assert!(((b - a).perp_dot(c - a) - area).abs() < 1e-6);
        }
    }
}

#[test]
fn halves_make_the_whole() {
    let whole = [Vec2::ZERO, Vec2::X, Vec2::Y];
    for from in 0..3 {
        for uv in points().skip(6) {
            let (half, within) = halved(uv, from);
            let [a, b, c] = halves(whole, from)[half as usize];
            assert!((a + within.x * (b - a) + within.y * (c - a)).abs_diff_eq(uv, 1e-6), "{from} {uv}");
            assert!(within.min_element() >= 0.0 && within.element_sum() < 1.0 + 1e-6, "{from} {uv} {within}");
            assert!(a == whole[usize::from(from)] && ((b - a).perp_dot(c - a) - 0.5).abs() < 1e-6);
        }
    }
}

#[test]
fn points_lead_to_the_element_they_lie_on_and_back() {
    let (scene, cut) = divided();
    let mesh = ElementMesh::with_cut(&scene, &cut).unwrap();
    assert!(mesh.parts.len() > 10_000, "{}", mesh.parts.len());
    for triangle in 0..scene.triangles.len() as u32 {
        for uv in points().skip(6) {
            let (e, within) = mesh.locate(triangle, uv, false).unwrap();
            let [a, b, c] = mesh.corners(e);
            let back = a + within.x * (b - a) + within.y * (c - a);
            assert!(back.distance(uv) < 1e-5 && mesh.triangle(e) == triangle, "{triangle} {uv} is {back}");
            let (patch, on_patch) = mesh.patch_at(triangle, uv);
            assert!(patch == mesh.place(e).patch && mesh.on_triangle(patch, on_patch).distance(uv) < 1e-5);
        }
    }
    for e in mesh.elements() {
        let place = mesh.place(e);
        let centroid = mesh.corners(e).iter().sum::<Vec2>() / 3.0;
        assert_eq!(mesh.at(place.triangle, centroid, place.back), Some(e));
        let (same, [corner, along, across]) = mesh.place_and_edges(e);
        let [a, b, c] = mesh.corners(e);
        let close = |p: Vec2, q: Vec2| p.abs_diff_eq(q, 1e-6);
        assert!(same == place && close(a, corner) && close(b - a, along) && close(c - a, across));
    }
}

#[test]
fn areas_are_exact_and_add_up() {
    let (scene, cut) = divided();
    let mesh = ElementMesh::with_cut(&scene, &cut).unwrap();
    let whole = ElementMesh::new(&scene, Resolution::Elements(1)).unwrap();
    assert_eq!(mesh.len(), cut.element_count(&scene).unwrap());
    assert!((mesh.total_area() / whole.total_area() - 1.0).abs() < 1e-6);
    let counted: u32 = mesh.areas().map(|(_, count)| count).sum();
    assert!(counted as usize == mesh.len() && mesh.areas().all(|(area, _)| area >= 0.0));
    for e in mesh.elements() {
        let [p, q, r] = scene.corners(mesh.triangle(e)).map(Vec3::as_dvec3);
        let at = |uv: Vec2| p + (q - p) * f64::from(uv.x) + (r - p) * f64::from(uv.y);
        let [a, b, c] = mesh.corners(e).map(at);
        let area = 0.5 * (b - a).cross(c - a).length();
        // Corners are rounded to the digits of their coordinates on the triangle.
        let rounding = f64::from(f32::EPSILON) * (q.distance(p) + r.distance(p));
        let close = 1e-3 * area + rounding * (b.distance(a) + c.distance(a)) + 1e-12;
        assert!((f64::from(mesh.area(e)) - area).abs() < close, "{e}: {} {area}", mesh.area(e));
    }
}

#[test]
fn cuts_come_back() {
    let (scene, cut) = divided();
    assert!(ElementMesh::with_cut(&scene, &cut).unwrap().cut() == cut);
}

#[test]
fn only_patches_with_elements_are_counted_and_together_they_are_the_mesh() {
    let (scene, cut) = divided();
    let mesh = ElementMesh::with_cut(&scene, &cut).unwrap();
    let of_patch = |patch| {
        let sides = 1 + u32::from(mesh.is_two_sided(mesh.triangle_of_patch(patch)));
        sides * u32::from(mesh.divisions(patch)).pow(2)
    };
    assert_eq!(mesh.patches().map(of_patch).sum::<u32>() as usize, mesh.len());
}

#[test]
fn all_lookups_agree() {
    let (scene, cut) = divided();
    let mesh = ElementMesh::with_cut(&scene, &cut).unwrap();
    let all: Vec<Vec2> = points().chain(points()).take(40).collect();
    for triangle in 0..scene.triangles.len() as u32 {
        let lookup = mesh.lookup(triangle);
        let [u, v]: [Vec<f32>; 2] = [all.iter().map(|p| p.x).collect(), all.iter().map(|p| p.y).collect()];
        let ([mut patch, mut front, mut further], [mut x, mut y]) = ([[0; 40]; 3], [[0.0; 40]; 2]);
        mesh.patches_at(triangle, [&u, &v], &mut patch, [&mut x, &mut y]);
        mesh.fronts_at(&mut patch, [&mut x, &mut y], &mut front, &mut further);
        for (k, &uv) in all.iter().enumerate() {
            let (first, more) = lookup.front(uv);
            assert_eq!((front[k], further[k]), (first, more));
            assert_eq!(Some(first), mesh.at(triangle, uv, false));
            assert_eq!(mesh.is_two_sided(triangle).then_some(first + more), mesh.at(triangle, uv, true));
        }
        let point = |k: usize| Point { triangle, uv: all[k], back: k.is_multiple_of(3) };
        mesh.locate_together(all.len().min(TOGETHER), point, |k, found| {
            assert_eq!(found, mesh.locate(triangle, all[k], point(k).back));
        });
    }
}

#[test]
fn bad_trees_are_refused() {
    let (scene, cut) = divided();
    let divisions = |divisions: Vec<Division>| Cut { divisions, ..cut.clone() };
    let endless = divisions(vec![Division::Bisected { from: 0, share: 0.5 }; 1_000_000]);
    let endlessly_beside = divisions(vec![Division::Beside(1); 1_000_000]);
    let short = divisions(cut.divisions[..cut.divisions.len() - 1].to_vec());
    let long = divisions([&cut.divisions[..], &[Division::Cells(1)]].concat());
    let changed = |change: &dyn Fn(Division) -> Division| divisions(cut.divisions.iter().map(|d| change(*d)).collect());
    let bisected = |wrong: Division| {
        changed(&move |division| if matches!(division, Division::Bisected { .. }) { wrong } else { division })
    };
    let cells = |wrong: Division| {
        changed(&move |division| if matches!(division, Division::Cells(_)) { wrong } else { division })
    };
    let of_no_corner = bisected(Division::Bisected { from: 3, share: 0.5 });
    let shares = [0.0, 1.0, -1.0, f32::NAN].map(|share| bisected(Division::Bisected { from: 0, share }));
    let no_edge =
        changed(&|division| if matches!(division, Division::Beside(_)) { Division::Beside(8) } else { division });
    let split = changed(&|division| if matches!(division, Division::Split(_)) { Division::Split(0) } else { division });
    let bad = [
        endless,
        endlessly_beside,
        short,
        long,
        of_no_corner,
        no_edge,
        split,
        cells(Division::Cells(0)),
        divisions(Vec::new()),
    ];
    for bad in bad.into_iter().chain(shares) {
        assert!(ElementMesh::with_cut(&scene, &bad).unwrap_err().to_string().contains("cut"));
    }
}
