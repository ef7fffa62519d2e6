//! The kernel against brute force, against itself, and against closed meshes.

use super::*;
use crate::geometry::{Brute, NONE};
use crate::math::warp::square_to_sphere;
use crate::scene::{Triangle, Vertex};

struct Random(u64);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }

    fn point(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }

    fn direction(&mut self) -> Vec3 {
        square_to_sphere(Vec2::new(self.next(), self.next()))
    }

    fn rays(&mut self, count: usize) -> Vec<Ray> {
        (0..count).map(|_| Ray { origin: self.point(), direction: self.direction(), from: NONE }).collect()
    }

    /// Triangles of all sizes in the unit cube.
    fn soup(&mut self, count: usize) -> Vec<[Vec3; 3]> {
        let mut triangle = || {
            let (center, size) = (self.point(), self.next().powi(2));
            [0; 3].map(|_| center + size * (self.point() - 0.5))
        };
        (0..count).map(|_| triangle()).collect()
    }
}

fn scene(triangles: &[[Vec3; 3]]) -> Scene {
    let triangle = |k: u32| Triangle { vertices: [3 * k, 3 * k + 1, 3 * k + 2], object: 0, source: k };
    Scene {
        vertices: triangles.iter().flatten().map(|&v| Vertex::at(v)).collect(),
        triangles: (0..triangles.len() as u32).map(triangle).collect(),
        ..Scene::default()
    }
}

fn closest(geometry: &dyn Geometry, rays: &[Ray]) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; rays.len()];
    geometry.closest(rays, &mut hits);
    hits
}

fn any(geometry: &dyn Geometry, rays: &[Ray], reach: &[f32]) -> Vec<bool> {
    let mut blocked = vec![false; rays.len()];
    geometry.any(rays, reach, &mut blocked);
    blocked
}

fn all(geometry: &dyn Geometry, rays: &[Ray]) -> HitLists {
    let mut lists = HitLists::default();
    geometry.all(rays, &mut lists);
    lists
}

/// Asserts that both geometries see the same.
fn assert_agree(triangles: &[[Vec3; 3]], rays: &[Ray]) {
    let scene = scene(triangles);
    let (bvh, brute) = (Bvh::new(&scene), Brute::new(&scene));
    for ((ray, ours), exact) in rays.iter().zip(closest(&bvh, rays)).zip(closest(&brute, rays)) {
        if ours.is_miss() && exact.is_miss() {
            continue;
        }
        assert!((ours.t - exact.t).abs() < 2e-6, "{ray:?}\n{ours:?}\n{exact:?}");
        assert_eq!((ours.triangle, ours.back), (exact.triangle, exact.back), "{ray:?}");
        let (point, _) = bvh.surface(ours.triangle, ours.uv);
        assert!(point.distance(ray.origin + ours.t * ray.direction) < 2e-6, "{ray:?}\n{ours:?}");
    }
}

#[test]
fn hits_are_those_of_brute_force() {
    let mut random = Random(1);
    for count in [1, 2, 4, 5, 9, 40, 1000] {
        assert_agree(&random.soup(count), &random.rays(2000));
    }
}

#[test]
fn a_ray_never_hits_the_triangle_it_leaves() {
    let mut random = Random(2);
    let triangles = random.soup(300);
    let mut rays = random.rays(2000);
    let hits = closest(&Brute::new(&scene(&triangles)), &rays);
    for (ray, hit) in rays.iter_mut().zip(hits) {
        ray.from = hit.triangle;
    }
    assert_agree(&triangles, &rays);
}

#[test]
fn all_hits_are_those_of_brute_force_and_begin_with_the_closest() {
    let mut random = Random(12);
    for count in [1, 5, 40, 1000] {
        let (scene, mut rays) = (scene(&random.soup(count)), random.rays(1000));
        let (bvh, brute) = (Bvh::new(&scene), Brute::new(&scene));
        rays.iter_mut().zip(closest(&brute, &random.rays(1000))).for_each(|(ray, hit)| ray.from = hit.triangle);
        let (ours, exact) = (all(&bvh, &rays), all(&brute, &rays));
        assert_eq!((ours.len(), exact.len()), (rays.len(), rays.len()));
        for ((ours, exact), first) in ours.iter().zip(exact.iter()).zip(closest(&bvh, &rays)) {
            assert_eq!(ours.first().copied().unwrap_or(Hit::MISS), first);
            let sides = |hits: &[Hit]| hits.iter().map(|hit| (hit.triangle, hit.back)).collect::<Vec<_>>();
            assert_eq!(sides(ours), sides(exact));
            assert!(ours.iter().zip(exact).all(|(a, b)| (a.t - b.t).abs() < 2e-6));
        }
    }
}

#[test]
fn large_scenes_agree_with_brute_force() {
    // More triangles than are clustered together.
    let mut random = Random(12);
    let scene = scene(&random.soup(70_000));
    let rays = random.rays(200);
    let (ours, exact) = (closest(&Bvh::new(&scene), &rays), closest(&Brute::new(&scene), &rays));
    assert!(ours.iter().zip(&exact).all(|(a, b)| a.t == b.t || (a.t - b.t).abs() < 2e-6));
}

#[test]
fn something_is_in_the_way_exactly_within_the_closest_distance() {
    let mut random = Random(3);
    let (bvh, rays) = (Bvh::new(&scene(&random.soup(300))), random.rays(2000));
    let hits = closest(&bvh, &rays);
    let reach = |next: fn(f32) -> f32| hits.iter().map(|hit| next(hit.t)).collect::<Vec<_>>();
    assert_eq!(any(&bvh, &rays, &reach(|t| t)), vec![false; rays.len()], "a hit at the very reach is none");
    let beyond = any(&bvh, &rays, &reach(f32::next_up));
    assert!(beyond.iter().zip(&hits).all(|(&blocked, hit)| blocked != hit.is_miss()));
}

#[test]
fn both_paths_give_the_same_bits() {
    let mut random = Random(4);
    let (mut triangles, mut rays) = (random.soup(3000), random.rays(20_000));
    // On a grid, where comparisons meet equal numbers.
    let snap = |v: Vec3| (8.0 * v).round() / 8.0;
    triangles.extend(random.soup(200).into_iter().map(|triangle| triangle.map(snap)));
    rays.extend((0..20_000).map(|_| {
        let origin = snap(random.point());
        Ray { origin, direction: (snap(random.point()) - origin).normalize_or_zero(), from: NONE }
    }));
    let scene = scene(&triangles);
    let (fastest, portable) = (Bvh::new(&scene), Bvh::portable(&scene));
    let reach: Vec<f32> = rays.iter().map(|_| random.next()).collect();
    for (a, b) in closest(&fastest, &rays).iter().zip(closest(&portable, &rays)) {
        let bits = |hit: &Hit| (hit.t.to_bits(), hit.triangle, hit.uv.to_array().map(f32::to_bits), hit.back);
        assert_eq!(bits(a), bits(&b));
    }
    assert_eq!(any(&fastest, &rays, &reach), any(&portable, &rays, &reach));
    assert_eq!(all(&fastest, &rays), all(&portable, &rays));
}

#[test]
fn hits_do_not_depend_on_the_tree() {
    let mut random = Random(5);
    let mut triangles = random.soup(60);
    triangles.extend(triangles.clone()); // Everything twice: the lower number must win.
    let rays = random.rays(2000);
    let mut least = vec![Hit::MISS; rays.len()];
    for (k, triangle) in (0..).zip(&triangles) {
        for (least, hit) in least.iter_mut().zip(closest(&Bvh::new(&scene(&[*triangle])), &rays)) {
            if hit.t < least.t {
                *least = Hit { triangle: k, ..hit };
            }
        }
    }
    assert_eq!(closest(&Bvh::new(&scene(&triangles)), &rays), least);
}

#[test]
fn scaling_by_a_power_of_two_changes_no_bit() {
    let mut random = Random(6);
    let (triangles, rays) = (random.soup(100), random.rays(2000));
    let hits = closest(&Bvh::new(&scene(&triangles)), &rays);
    for scale in [-25, -10, 10, 36].map(|k| 2f32.powi(k)) {
        let triangles: Vec<_> = triangles.iter().map(|t| t.map(|v| v * scale)).collect();
        let rays: Vec<_> = rays.iter().map(|ray| Ray { origin: ray.origin * scale, ..*ray }).collect();
        for (hit, scaled) in hits.iter().zip(closest(&Bvh::new(&scene(&triangles)), &rays)) {
            assert_eq!(Hit { t: hit.t * scale, ..*hit }, scaled, "scale {scale:e}");
        }
    }
}

#[test]
fn needles_are_hit_at_the_right_distance() {
    let mut random = Random(7);
    let needle = |k: u32| {
        let x = k as f32 / 64.0;
        [Vec3::new(x, 0.0, 0.5), Vec3::new(x + 1e-5, 0.0, 0.5), Vec3::new(x, 1.0, 0.5)]
    };
    let triangles: Vec<_> = (0..64).map(needle).collect();
    let aim = |k: u32| {
        let weight = 0.1 + 0.3 * Vec2::new(random.next(), random.next());
        let [a, b, c] = needle(k % 64);
        let origin = random.point() * Vec3::new(1.0, 1.0, 0.4);
        let target = a + weight.x * (b - a) + weight.y * (c - a);
        Ray { origin, direction: (target - origin).normalize(), from: NONE }
    };
    let rays: Vec<_> = (0..640).map(aim).collect();
    let hits = closest(&Bvh::new(&scene(&triangles)), &rays);
    assert!(hits.iter().filter(|hit| !hit.is_miss()).count() > 600);
    for (ray, hit) in rays.iter().zip(hits).filter(|(_, hit)| !hit.is_miss()) {
        assert!((ray.origin.z + hit.t * ray.direction.z - 0.5).abs() < 1e-6, "{ray:?} {hit:?}");
    }
}

/// The surface of the cube [-1, 1]³ in squares of two triangles, `shape` applied to every corner.
fn closed(n: i32, shape: impl Fn(Vec3) -> Vec3) -> Vec<[Vec3; 3]> {
    let mut triangles = Vec::new();
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let at = |i: i32, j: i32| Vec3::new(2.0 * i as f32 / n as f32 - 1.0, 2.0 * j as f32 / n as f32 - 1.0, 1.0);
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        let turns = [|v: Vec3| v, |v: Vec3| Vec3::new(v.y, v.z, v.x), |v: Vec3| Vec3::new(v.z, v.x, v.y)];
        for side in turns.into_iter().flat_map(|turn| [1.0, -1.0].map(|sign| move |v: Vec3| turn(v) * sign)) {
            triangles.extend([[a, b, c], [a, c, d]].map(|t| t.map(|v| shape(side(v)))));
        }
    }
    triangles
}

#[test]
fn no_ray_leaves_a_closed_mesh_through_corners_or_edges() {
    let cube = closed(8, |v| v);
    let ball = closed(8, Vec3::normalize);
    let far = closed(8, |v| v.normalize() * 3.0 + Vec3::new(1000.0, -2000.0, 10.0));
    let mut random = Random(8);
    for (triangles, center) in [(cube, Vec3::ZERO), (ball, Vec3::ZERO), (far, Vec3::new(1000.0, -2000.0, 10.0))] {
        let bvh = Bvh::new(&scene(&triangles));
        let mut rays = Vec::new();
        for [a, b, c] in &triangles {
            for origin in [center, center + 0.5 * random.point(), center - 0.5 * random.point()] {
                let along = *a + random.next() * (*b - *a);
                for target in [*a, *b, *c, a.midpoint(*b), b.midpoint(*c), along] {
                    rays.push(Ray { origin, direction: (target - origin).normalize(), from: NONE });
                }
            }
        }
        // Straight along the axes, in the planes of the grid.
        let grid = (-3..=3).flat_map(|i| (-3..=3).map(move |j| (i, j)));
        for (i, j) in grid {
            let origin = center + Vec3::new(i as f32, j as f32, 0.0) * 0.125;
            let axes = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
            rays.extend(axes.map(|direction| Ray { origin, direction, from: NONE }));
        }
        let hits = closest(&bvh, &rays);
        let escaped = hits.iter().filter(|hit| hit.is_miss()).count();
        assert_eq!(escaped, 0, "of {}", rays.len());
        assert!(hits.iter().all(|hit| hit.uv.min_element() >= 0.0 && hit.uv.element_sum() <= 1.0));
        assert!(any(&bvh, &rays, &vec![f32::INFINITY; rays.len()]).into_iter().all(|blocked| blocked));
    }
}

#[test]
fn no_ray_from_far_outside_passes_through_a_ball() {
    let triangles = closed(8, Vec3::normalize);
    let mut random = Random(11);
    let mut rays = Vec::new();
    for origin in (0..200).map(|_| random.direction() * (2.0 + 1000.0 * random.next())) {
        let facing = triangles.iter().flatten().filter(|corner| corner.dot(origin.normalize()) > 0.6);
        rays.extend(facing.map(|&corner| Ray { origin, direction: (corner - origin).normalize(), from: NONE }));
    }
    let hits = closest(&Bvh::new(&scene(&triangles)), &rays);
    assert_eq!(hits.iter().filter(|hit| hit.is_miss()).count(), 0, "of {}", rays.len());
}

#[test]
fn coincident_triangles_make_no_chain() {
    let bvh = Bvh::new(&scene(&[[Vec3::X, Vec3::Y, Vec3::Z]; 5000]));
    assert!(bvh.tree.stack_size < 128, "{}", bvh.tree.stack_size);
    let ray = Ray { origin: Vec3::ZERO, direction: Vec3::ONE.normalize(), from: 0 };
    assert_eq!(closest(&bvh, &[ray])[0].triangle, 1);
}

#[test]
fn a_deep_tree_needs_a_deep_stack() {
    // Nested triangles make the clustering build a chain.
    let triangles: Vec<_> = (1..3000).map(|k| [Vec3::X, Vec3::Y, Vec3::Z].map(|v| v * k as f32 * 0.01)).collect();
    let bvh = Bvh::new(&scene(&triangles));
    assert!(bvh.tree.stack_size > 256, "{}", bvh.tree.stack_size);
    let ray = Ray { origin: Vec3::ZERO, direction: Vec3::ONE.normalize(), from: 0 };
    assert_eq!(closest(&bvh, &[ray])[0].triangle, 1);
    let ray = Ray { origin: Vec3::splat(20.0), direction: -Vec3::ONE.normalize(), from: NONE };
    assert_eq!(closest(&bvh, &[ray])[0].triangle, 2998);
}

#[test]
fn nothing_is_hit_where_nothing_is() {
    let rays = Random(9).rays(100);
    let nowhere = [[Vec3::NAN, Vec3::X, Vec3::Y], [Vec3::X, Vec3::Y, Vec3::INFINITY]];
    let point = [[Vec3::splat(0.5); 3]; 9];
    for triangles in [&[][..], &nowhere, &point] {
        let bvh = Bvh::new(&scene(triangles));
        assert!(closest(&bvh, &rays).iter().all(|hit| *hit == Hit::MISS));
        assert!(!any(&bvh, &rays, &[f32::INFINITY; 100]).contains(&true));
    }
    let lost = Ray { origin: Vec3::NAN, direction: Vec3::NAN, from: NONE };
    assert!(closest(&Bvh::new(&scene(&Random(10).soup(50))), &[lost])[0].is_miss());
}
