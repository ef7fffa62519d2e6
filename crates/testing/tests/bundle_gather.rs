//! Gathering by bundles: what elements see, against rays, exact form factors and furnaces.

#![allow(clippy::unwrap_used)]

use isolux_core::Problem;
use isolux_core::geometry::HitLists;
use isolux_core::geometry::raster::{Raster, TileLists, grid::Grid};
use isolux_core::math::Rgb;
use isolux_core::math::moments::Moments;
use isolux_core::math::warp::square_to_sphere;
use isolux_core::sampling::{OwenSobol, Sample, Sequence};
use isolux_core::transport::bundle_gather::{Source, Sums, gather, gather_all};
use isolux_core::transport::{Bundle, Crossing, Span, bundle, spans};
use isolux_testing::budget::{assert_t, refutes};
use isolux_testing::exact::box_form_factors;
use isolux_testing::random::Random;
use isolux_testing::scenes::{cut, problem, rectangles, scene};
use isolux_testing::statistics::p_of_t;
use rayon::ThreadPoolBuilder;

const CELLS: u32 = 150;

/// The grid of a bundle, as [`Bundle::new`] makes it.
fn grid(problem: &Problem, [x1, x2, x3, x4]: Sample) -> Grid {
    let direction = square_to_sphere([x1, x2].into()).normalize();
    Grid::new(problem.geometry.bounding_sphere(), direction, [x3, x4].into(), CELLS)
}

fn samples(count: usize) -> Vec<Sample> {
    let mut random = Random::new(3);
    (0..count).map(|_| [0; 4].map(|_| random.uniform())).collect()
}

/// The office, full of needles, with every second material two-sided.
fn office() -> Problem {
    let mut scene = scene("office");
    (0..).zip(&mut scene.materials).for_each(|(k, material)| material.two_sided = k % 2 == 0);
    cut(scene, 80_000)
}

#[test]
fn crossings_have_the_elements_of_their_hits() {
    let problem = office();
    let (mut crossings, mut black, mut two_sided) = (0, 0, 0);
    for sample in samples(4) {
        let bundle = Bundle::new(&problem, sample, CELLS).unwrap();
        let raster = Raster::of(&problem.scene, grid(&problem, sample));
        for tile in 0..bundle.tiles() {
            let mut found = TileLists::default();
            bundle.crossings(tile, &mut found);
            let hits = raster.hits(tile);
            assert_eq!(found.len(), hits.len());
            for (crossing, hit) in found.iter().flatten().zip(hits.iter().flatten()) {
                let on = |back| problem.mesh.at(hit.triangle, hit.uv, back);
                let expected = (hit.t, on(hit.back), on(!hit.back));
                assert_eq!((crossing.t, crossing.near.element(), crossing.far.element()), expected, "{hit:?}");
                crossings += 1;
                black += usize::from(crossing.far.element().is_none());
                two_sided += usize::from(crossing.near.is_element() && crossing.far.is_element());
            }
        }
    }
    assert!(crossings > 50_000 && black > 10_000 && two_sided > 10_000, "{crossings} {black} {two_sided}");
}

/// The spans of each line of a bundle, found by rays.
fn traced(problem: &Problem, sample: Sample, tile: u32) -> Vec<Vec<Span>> {
    let mut lists = HitLists::default();
    problem.geometry.all(&grid(problem, sample).lines(tile), &mut lists);
    lists.iter().map(|hits| of_line(problem, hits.iter().map(|hit| Crossing::of(problem, hit)))).collect()
}

fn of_line(problem: &Problem, crossings: impl Iterator<Item = Crossing>) -> Vec<Span> {
    let mut found = Vec::new();
    spans(problem.geometry.lift(), crossings, |span| found.push(span));
    found
}

/// Numbers of spans of rays, and of those that a bundle does not have too.
fn compare(problem: &Problem, sample: Sample) -> (usize, usize) {
    let bundle = Bundle::new(problem, sample, CELLS).unwrap();
    let (mut all, mut missing, mut found) = (0, 0, TileLists::default());
    for tile in 0..bundle.tiles() {
        bundle.crossings(tile, &mut found);
        for (crossings, expected) in found.iter().zip(traced(problem, sample, tile)) {
            let spans = of_line(problem, crossings);
            all += expected.len();
            missing += expected.iter().filter(|span| !spans.contains(span)).count();
        }
    }
    (all, missing)
}

/// Share of the spans of rays that bundles do not have too.
fn missing(problem: &Problem, directions: usize) -> f64 {
    let counts = samples(directions).into_iter().map(|sample| compare(problem, sample));
    let (all, missing) = counts.fold((0, 0), |sum, (all, missing)| (sum.0 + all, sum.1 + missing));
    assert!(all > 20_000, "{all}");
    missing as f64 / all as f64
}

#[test]
fn bundles_join_the_elements_that_rays_join() {
    // Lines within rounding of the border of an element may be taken for its neighbour's.
    for problem in [problem("cornell-box", 5000), problem("cubes", 5000), office()] {
        let missing = missing(&problem, 6);
        assert!(missing < 1e-3, "{problem:?}: {missing}");
    }
    let sphere = problem("sphere", 800);
    assert_eq!(missing(&sphere, 3), 0.0, "the same rays");
}

#[test]
fn coincident_faces_are_met_as_rays_meet_them() {
    // On the floor a rug that faces up, and under it one that faces down; both lie in its plane, cut otherwise than the floor.
    let floor = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]];
    let rug = [[1.0, 1.0, 0.0], [3.0, 1.0, 0.0], [3.0, 3.0, 0.0], [1.0, 3.0, 0.0]];
    let below = [[1.0, 1.0, 0.0], [1.0, 2.0, 0.0], [2.0, 2.0, 0.0], [2.0, 1.0, 0.0]];
    let ceiling = [[0.0, 0.0, 3.0], [0.0, 4.0, 3.0], [4.0, 4.0, 3.0], [4.0, 0.0, 3.0]];
    for two_sided in [false, true] {
        let mut scene = rectangles(&[rug, floor, below, ceiling]);
        scene.materials.iter_mut().for_each(|material| material.two_sided = two_sided);
        let problem = cut(scene, 500);
        // Head-on, where faces in one plane are equally far to the last bit; for slanted lines rounding decides, for rays too.
        let (all, missing) = compare(&problem, [0.0, 0.3, 0.41, 0.67]);
        assert!(all > 5000 && missing == 0, "two-sided {two_sided}: {missing} of {all}");
    }
}

#[test]
fn in_even_light_everything_sees_the_same() {
    let even = Rgb::new(0.75, 5.0, 0.125);
    for problem in [problem("box", 300), problem("sphere", 800)] {
        let source = Source::new(&problem, |_| even);
        let sums = gather_all(&problem, &OwenSobol::new(1), 0..64, 80, &source).unwrap();
        for e in problem.mesh.elements() {
            assert_eq!(sums.irradiance(e), Some(even), "element {e} of {problem:?}");
        }
    }
}

#[test]
fn what_sees_the_open_or_a_back_sees_black() {
    // Two sheets, the upper one over half of the lower one's sky, and turned away from it or towards it.
    let low = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let up = low.map(|[x, y, _]| [x, y, 0.2]);
    let down = [up[0], up[3], up[2], up[1]];
    let seen = |above| {
        let problem = cut(rectangles(&[low, above]), 1);
        let source = Source::new(&problem, |_| Rgb::WHITE);
        let sums = gather_all(&problem, &OwenSobol::new(1), 0..64, 80, &source).unwrap();
        let of_low = problem.mesh.elements().filter(|&e| problem.mesh.triangle(e) < 2);
        of_low.map(|e| sums.irradiance(e).unwrap().r).collect::<Vec<_>>()
    };
    assert!(seen(up).iter().all(|&r| r == 0.0));
    assert!(seen(down).iter().all(|&r| 0.5 < r && r < 0.9));
}

const DIRECTIONS: u64 = 256;
const REPLICATES: u64 = 32;

/// Deviations of the irradiance of the six faces of a box from the exact one, with the radiosities of a die; `draw` may spoil the
/// sample numbers.
fn deviations(draw: impl Fn(Sample) -> Sample) -> Vec<f64> {
    let problem = problem("box:width=4,height=2,depth=3", 12);
    let face = |e: u32| problem.object(e) as usize;
    let radiosity = |face: usize| (face + 1) as f32;
    let source = Source::new(&problem, |e| Rgb::grey(radiosity(face(e))));
    let mut moments = [Moments::default(); 6];
    for replicate in 0..REPLICATES {
        let mut samples = vec![[0.0; 4]; DIRECTIONS as usize];
        OwenSobol::new(replicate).fill(bundle::STREAM, 0, &mut samples);
        let mut sums = Sums::new(&problem);
        for &sample in &samples {
            gather(&Bundle::new(&problem, draw(sample), 64).unwrap(), &source, &mut sums);
        }
        let mut faces = [[0.0; 2]; 6];
        for e in problem.mesh.elements() {
            let crossings = sums.crossings(e);
            faces[face(e)][0] += f64::from(sums.irradiance(e).unwrap().g) * crossings;
            faces[face(e)][1] += crossings;
        }
        moments.iter_mut().zip(faces).for_each(|(moments, [seen, crossings])| moments.push(seen / crossings));
    }
    let factors = box_form_factors([4.0, 2.0, 3.0]);
    let exact = |i: usize| (0..6).map(|j| factors[i][j] * f64::from(radiosity(j))).sum::<f64>();
    (0..6).map(|i| (moments[i].mean - exact(i)) / moments[i].std_error()).collect()
}

#[test]
fn faces_of_a_box_see_what_form_factors_say() {
    let dof = (REPLICATES - 1) as f64;
    deviations(|sample| sample).into_iter().for_each(|t| assert_t("gathering by bundles in a box", t, dof));
    // The fault: directions crowded at the poles.
    let polar = |[x1, x2, x3, x4]: Sample| [0.5 - 0.5 * (std::f32::consts::PI * x1).cos(), x2, x3, x4];
    assert!(deviations(polar).into_iter().any(|t| refutes(p_of_t(t, dof))));
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let problem = problem("cornell-box", 3000);
    let source = Source::new(&problem, |e| problem.mesh.reflectivity(e));
    let on = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| gather_all(&problem, &OwenSobol::new(1), 3..30, 100, &source).unwrap())
    };
    let one = on(1);
    assert!([2, 3, 7].into_iter().all(|threads| on(threads) == one));
    let reordered = gather_all(&problem, &OwenSobol::new(1), 4..31, 100, &source).unwrap();
    assert!(reordered != one, "other bundles, other sums");
}
