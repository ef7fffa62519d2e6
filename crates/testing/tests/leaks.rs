//! Light that passes under a wall because an element does: much less of it if it leaves from where it landed.

use glam::Vec3;
use isolux_core::math::Rgb;
use isolux_core::scene::Material;
use isolux_core::scene::builtin::shapes::Builder;
use isolux_core::solvers::monte_carlo::Settings;
use isolux_core::transport::Leaving;
use isolux_testing::ensemble::{solve, with_rays};
use isolux_testing::scenes::cut;

/// Where partitions stand [m]: across elements in many ways, for a leak depends on how much of an element is beyond.
const PARTITIONS: [f32; 8] = [0.82, 0.86, 0.90, 0.94, 0.98, 1.02, 1.06, 1.10];

/// Share of the emitted light that lands beyond the partition, at x, of a room whose lamp is on this side.
fn leaked(leaving: Leaving, partition_x: f32) -> f64 {
    let mut builder = Builder::new("leaky");
    let white = Material::diffuse("white", Rgb::grey(0.7));
    let walls = builder.material(white.clone());
    let partition = builder.material(Material { two_sided: true, ..white.clone() });
    let lamp = builder.material(Material { emission: Rgb::grey(10.0), ..white });
    builder.look_inwards(true);
    let cuts: [&[f32]; 3] = [&[0.0, 2.0], &[0.0, 1.0], &[0.0, 1.0]];
    builder.object("walls", walls);
    builder.cut_box(cuts, |p| p, |axis, greater, _, _| (axis, greater) != (0, false));
    builder.object("lamp", lamp);
    builder.cut_box(cuts, |p| p, |axis, greater, _, _| (axis, greater) == (0, false));
    builder.object("partition", partition);
    builder.polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[y, z]| Vec3::new(partition_x, y, z)));
    let problem = cut(builder.finish(), 2000);
    let solution = solve(&problem, Settings { leaving, ..with_rays(500_000) });
    let is_beyond = |e: u32| {
        let place = problem.mesh.place(e);
        problem.mesh.corners(e).iter().all(|&uv| problem.geometry.surface(place.triangle, uv).0.x > partition_x + 1e-3)
    };
    let flux = |e: u32| (solution.irradiance[e as usize] * problem.mesh.area(e)).luminance_f64();
    problem.mesh.elements().filter(|&e| is_beyond(e)).map(flux).sum::<f64>() / solution.balance.emitted
}

#[test]
fn light_that_leaves_from_where_it_landed_leaks_much_less() {
    let mean = |leaving| PARTITIONS.iter().map(|&x| leaked(leaving, x)).sum::<f64>() / PARTITIONS.len() as f64;
    let (landed, whole) = (mean(Leaving::WhereLanded), mean(Leaving::WholeElement));
    assert!(whole > 0.03, "the rooms must leak to begin with: {whole}");
    assert!(landed < 0.45 * whole, "{landed} against {whole}");
}
