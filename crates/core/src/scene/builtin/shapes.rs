//! What the built-in scenes are made of: a builder of scenes, and quads, cuboids, grids, rounded cuboids, solids of revolution.
//!
//! Every solid is closed, shares the corners of its faces exactly, and looks outwards.

use crate::math::Rgb;
use crate::scene::{Camera, Material, Object, Scene, Triangle, Vertex};
use glam::{Affine3A, Quat, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_4, PI, TAU};

/// Builds a scene piece by piece. Shapes go into the object begun last, moved by the placement set last.
#[derive(Debug)]
pub struct Builder {
    scene: Scene,
    object: u32,
    placement: Affine3A,
    inwards: bool,
}

/// A placement at `position`, turned about the y axis by `angle` [rad].
pub fn standing(position: Vec3, angle: f32) -> Affine3A {
    Affine3A::from_rotation_translation(Quat::from_rotation_y(angle), position)
}

/// A diffuse material of an 8-bit sRGB colour.
pub fn paint(name: &str, srgb: [u8; 3]) -> Material {
    Material::diffuse(name, Rgb::from_srgb8(srgb))
}

/// A diffuse emitter of `luminance` [cd/m²], white with the given tint, that reflects like white plastic.
pub fn panel(name: &str, luminance: f32, tint: Rgb) -> Material {
    let emission = tint * (PI * luminance / tint.luminance());
    Material { emission, ..Material::diffuse(name, Rgb::grey(0.8)) }
}

impl Builder {
    pub fn new(name: &str) -> Builder {
        Builder {
            scene: Scene { name: name.to_owned(), ..Scene::default() },
            object: 0,
            placement: Affine3A::IDENTITY,
            inwards: false,
        }
    }

    /// Adds a material; its number is for [`Builder::object`].
    pub fn material(&mut self, material: Material) -> u32 {
        self.scene.materials.push(material);
        self.scene.materials.len() as u32 - 1
    }

    /// Begins a new object.
    pub fn object(&mut self, name: &str, material: u32) {
        self.object = self.scene.objects.len() as u32;
        self.scene.objects.push(Object { name: name.to_owned(), material });
    }

    /// Goes on with the object called `name`, or begins it.
    pub fn resume(&mut self, name: &str, material: u32) {
        match self.scene.objects.iter().position(|object| object.name == name) {
            Some(k) => self.object = k as u32,
            None => self.object(name, material),
        }
    }

    /// Moves what follows.
    pub fn place(&mut self, placement: Affine3A) {
        self.placement = placement;
    }

    /// Turns what follows inside out: solids become rooms.
    pub fn look_inwards(&mut self, inwards: bool) {
        self.inwards = inwards;
    }

    pub fn camera(&mut self, camera: Camera) {
        self.scene.cameras.push(camera);
    }

    /// The scene, without objects that nothing was put into.
    pub fn finish(mut self) -> Scene {
        let mut kept = vec![None; self.scene.objects.len()];
        self.scene.triangles.iter().for_each(|t| kept[t.object as usize] = Some(0));
        (0u32..).zip(kept.iter_mut().flatten()).for_each(|(number, slot)| *slot = number);
        self.scene.triangles.iter_mut().for_each(|t| t.object = kept[t.object as usize].unwrap_or(0));
        let mut number = kept.iter();
        self.scene.objects.retain(|_| number.next().is_some_and(Option::is_some));
        self.scene
    }

    /// Adds the corners, counter-clockwise seen from the front, as a fan of triangles; ones without area are left out.
    pub fn polygon(&mut self, corners: &[Vec3]) {
        let first = self.scene.vertices.len() as u32;
        let placed = corners.iter().map(|p| Vertex::at(self.placement.transform_point3(*p)));
        self.scene.vertices.extend(placed);
        for k in 1..corners.len() as u32 - 1 {
            let [a, b, c] = [0, k as usize, k as usize + 1].map(|k| corners[k]);
            if a != b && b != c && c != a {
                let source = self.scene.triangles.len() as u32;
                let (second, third) = if self.inwards { (k + 1, k) } else { (k, k + 1) };
                let vertices = [first, first + second, first + third];
                self.scene.triangles.push(Triangle { vertices, object: self.object, source });
            }
        }
    }

    /// The quads between neighbouring parameters of `us` and `vs` on the surface `point`, looking along du x dv; quad
    /// (i, j) is left out if `keep(i, j)` is false.
    pub fn grid(
        &mut self,
        us: &[f32],
        vs: &[f32],
        point: impl Fn(f32, f32) -> Vec3,
        keep: impl Fn(usize, usize) -> bool,
    ) {
        for (i, u) in us.windows(2).enumerate() {
            for (_, v) in vs.windows(2).enumerate().filter(|(j, _)| keep(i, *j)) {
                self.polygon(&[point(u[0], v[0]), point(u[1], v[0]), point(u[1], v[1]), point(u[0], v[1])]);
            }
        }
    }

    /// The whole surface of the box whose edges are cut at the given coordinates, looking outwards, quads `keep`
    /// refuses left out. `keep` gets the axis (0, 1, 2) the face is perpendicular to, whether it is the greater face, and the
    /// numbers of the quad along the two axes that follow cyclically. Cuts meet at the box's edges, so it has no T-junctions.
    pub fn cut_box(
        &mut self,
        cuts: [&[f32]; 3],
        point: impl Fn(Vec3) -> Vec3,
        keep: impl Fn(usize, bool, usize, usize) -> bool,
    ) {
        for axis in 0..3 {
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            for greater in [false, true] {
                let Some(&level) = (if greater { cuts[axis].last() } else { cuts[axis].first() }) else { continue };
                let at = |u: f32, v: f32| {
                    let mut p = [level; 3];
                    (p[next], p[last]) = (u, v);
                    point(Vec3::from_array(p))
                };
                if greater {
                    self.grid(cuts[next], cuts[last], at, |i, j| keep(axis, true, i, j));
                } else {
                    self.grid(cuts[last], cuts[next], |v, u| at(u, v), |j, i| keep(axis, false, i, j));
                }
            }
        }
    }

    /// A cuboid between two corners.
    pub fn cuboid(&mut self, low: Vec3, high: Vec3) {
        let cuts = [[low.x, high.x], [low.y, high.y], [low.z, high.z]];
        self.cut_box([&cuts[0], &cuts[1], &cuts[2]], |p| p, |_, _, _, _| true);
    }

    /// A cuboid whose edges are rounded with `radius`, in `steps` steps from each face to the middle of an edge.
    pub fn rounded_cuboid(&mut self, low: Vec3, high: Vec3, radius: f32, steps: u32) {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let core = half - Vec3::splat(radius);
        let cuts = half.to_array().map(|half| {
            // Equal angles on the rounding: its point at angle a from the face comes from tan(a) on the cube.
            let band = (0..=steps).map(|k| half - radius + radius * (FRAC_PI_4 * k as f32 / steps as f32).tan());
            let greater: Vec<f32> = band.collect();
            greater.iter().rev().map(|v| -v).chain(greater.iter().copied()).collect::<Vec<f32>>()
        });
        let round = |p: Vec3| {
            let inner = p.clamp(-core, core);
            middle + inner + radius * (p - inner).normalize_or_zero()
        };
        self.cut_box([&cuts[0], &cuts[1], &cuts[2]], round, |_, _, _, _| true);
    }

    /// The surface that `profile`, points (distance from the axis, height), makes turning about the y axis. Where the
    /// profile runs upwards it looks away from the axis. Closed if the profile is, or if it starts and ends on the axis.
    pub fn lathe(&mut self, profile: &[Vec2], segments: u32) {
        let at = |p: Vec2, k: u32| {
            let (sin, cos) = (TAU * (k % segments) as f32 / segments as f32).sin_cos();
            Vec3::new(p.x * cos, p.y, p.x * sin)
        };
        for edge in profile.windows(2) {
            for k in 0..segments {
                let corners = [at(edge[0], k), at(edge[1], k), at(edge[1], k + 1), at(edge[0], k + 1)];
                match (edge[0].x == 0.0, edge[1].x == 0.0) {
                    (true, _) => self.polygon(&corners[..3]),
                    (_, true) => self.polygon(&[corners[0], corners[1], corners[3]]),
                    _ => self.polygon(&corners),
                }
            }
        }
    }

    /// A closed cylinder about the y axis.
    pub fn cylinder(&mut self, radius: f32, bottom: f32, top: f32, segments: u32) {
        self.lathe(&[[0.0, bottom], [radius, bottom], [radius, top], [0.0, top]].map(Vec2::from), segments);
    }

    /// A closed cylinder from one point to another.
    pub fn rod(&mut self, from: Vec3, to: Vec3, radius: f32, segments: u32) {
        let before = self.placement;
        let turn = Quat::from_rotation_arc(Vec3::Y, (to - from).normalize_or(Vec3::Y));
        self.placement = before * Affine3A::from_rotation_translation(turn, from);
        self.cylinder(radius, 0.0, from.distance(to), segments);
        self.placement = before;
    }

    /// A ball about `center`, its pole along y.
    pub fn ball(&mut self, center: Vec3, radius: f32, segments: u32) {
        let rings = segments / 2;
        let point = |k: u32| match k {
            0 => Vec2::new(0.0, -radius),
            k if k == rings => Vec2::new(0.0, radius),
            k => radius * Vec2::from_angle(PI * (k as f32 / rings as f32 - 0.5)),
        };
        let profile: Vec<Vec2> = (0..=rings).map(point).collect();
        let before = self.placement;
        self.placement = before * Affine3A::from_translation(center);
        self.lathe(&profile, segments);
        self.placement = before;
    }
}

/// A different number in [0, 1) for every `key`: variety that is the same every time (SplitMix64 finaliser, Steele et al. 2014).
pub fn variety(key: u64) -> f32 {
    let mut z = key.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ z >> 31) >> 40) as f32 / (1u64 << 24) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume enclosed by a closed surface that looks outwards (divergence theorem), and its area.
    fn volume_and_area(make: impl Fn(&mut Builder)) -> (f32, f32) {
        let mut builder = Builder::new("solid");
        let material = builder.material(Material::diffuse("", Rgb::WHITE));
        builder.object("solid", material);
        make(&mut builder);
        let scene = builder.finish();
        (0..scene.triangles.len() as u32).map(|t| scene.corners(t)).fold((0.0, 0.0), |(volume, area), [a, b, c]| {
            (volume + a.dot(b.cross(c)) / 6.0, area + 0.5 * (b - a).cross(c - a).length())
        })
    }

    fn assert_near(found: (f32, f32), volume: f32, area: f32) {
        assert!((found.0 / volume - 1.0).abs() < 5e-3 && (found.1 / area - 1.0).abs() < 5e-3, "{found:?}");
    }

    #[test]
    fn solids_have_their_volume_and_area_and_look_outwards() {
        assert_near(volume_and_area(|b| b.cuboid(Vec3::ONE, Vec3::new(2.0, 3.0, 4.0))), 6.0, 22.0);
        assert_near(volume_and_area(|b| b.cylinder(1.0, -1.0, 1.0, 100)), TAU, 3.0 * TAU);
        assert_near(volume_and_area(|b| b.rod(Vec3::ONE, Vec3::new(1.0, 4.0, 5.0), 0.5, 100)), PI * 1.25, PI * 5.5);
        assert_near(volume_and_area(|b| b.ball(Vec3::X, 1.0, 100)), 4.0 / 3.0 * PI, 4.0 * PI);
        // Rounded completely, a cube is a ball.
        let ball = |b: &mut Builder| b.rounded_cuboid(Vec3::ZERO, Vec3::splat(2.0), 1.0, 16);
        assert_near(volume_and_area(ball), 4.0 / 3.0 * PI, 4.0 * PI);
    }

    #[test]
    fn variety_covers_the_unit_interval() {
        let mean = (0..10_000).map(variety).sum::<f32>() / 1e4;
        assert!((mean - 0.5).abs() < 0.02, "{mean}");
    }
}
