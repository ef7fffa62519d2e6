//! What stands, lies and hangs in the office: screens, lamps, mugs, paper, plants, a picture.

use super::super::shapes::{Builder, variety};
use super::palette::Palette;
use glam::{Affine3A, Quat, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};

/// A monitor that looks to +z.
pub fn monitor(builder: &mut Builder, palette: &Palette, placement: Affine3A) {
    builder.place(placement);
    builder.resume("monitors", palette.black);
    builder.cylinder(0.11, 0.0, 0.012, 24);
    builder.rod(Vec3::new(0.0, 0.013, -0.03), Vec3::new(0.0, 0.3, -0.03), 0.015, 12);
    builder.rounded_cuboid(Vec3::new(-0.31, 0.11, -0.01), Vec3::new(0.31, 0.48, 0.015), 0.006, 1);
    let cuts: [&[f32]; 3] = [&[-0.3, 0.3], &[0.12, 0.47], &[0.016, 0.019]];
    builder.cut_box(cuts, |p| p, |axis, greater, _, _| (axis, greater) != (2, true));
    builder.resume("screens", palette.screen);
    builder.cut_box(cuts, |p| p, |axis, greater, _, _| (axis, greater) == (2, true));
}

/// A keyboard with five rows of keys, and a mouse.
pub fn keyboard(builder: &mut Builder, palette: &Palette, placement: Affine3A) {
    builder.place(placement);
    builder.resume("keyboards", palette.steel);
    builder.rounded_cuboid(Vec3::new(-0.22, 0.0, -0.065), Vec3::new(0.22, 0.014, 0.065), 0.004, 1);
    builder.resume("keys and mice", palette.white);
    for row in 0..5 {
        let z = -0.0575 + 0.0235 * row as f32;
        let cuts: Vec<f32> = (0..=4).map(|k| -0.21 + 0.105 * k as f32).collect();
        for cut in cuts.windows(2) {
            builder.cuboid(Vec3::new(cut[0], 0.015, z), Vec3::new(cut[1] - 0.003, 0.02, z + 0.02));
        }
    }
    let mouse = Affine3A::from_scale_rotation_translation(
        Vec3::new(0.032, 0.016, 0.055),
        Quat::IDENTITY,
        Vec3::new(0.3, 0.0165, 0.02),
    );
    builder.place(placement * mouse);
    builder.ball(Vec3::ZERO, 1.0, 12);
}

pub fn mug(builder: &mut Builder, palette: &Palette, number: u32, placement: Affine3A) {
    builder.place(placement);
    let color = ((number + 2) % 4) as usize;
    builder.resume(&format!("mugs {}", color + 1), palette.accents[color]);
    let profile = [[0.0, 0.0], [0.034, 0.0], [0.04, 0.01], [0.04, 0.09], [0.036, 0.09], [0.036, 0.012], [0.0, 0.008]];
    builder.lathe(&profile.map(Vec2::from), 16);
}

/// A stack of sheets and a book.
pub fn papers(builder: &mut Builder, palette: &Palette, number: u32, placement: Affine3A) {
    builder.place(placement);
    builder.resume("papers", palette.paper);
    builder.cuboid(Vec3::new(-0.105, 0.0, -0.1485), Vec3::new(0.105, 0.008, 0.1485));
    let color = (number as usize * 3 + 1) % 8;
    builder.resume(&format!("books {}", color + 1), palette.books[color]);
    builder.place(placement * Affine3A::from_rotation_y(0.25));
    builder.cuboid(Vec3::new(-0.07, 0.009, -0.1), Vec3::new(0.07, 0.033, 0.1));
}

/// A lamp whose arm reaches along +x, with a bulb under its shade.
pub fn desk_lamp(builder: &mut Builder, palette: &Palette, number: u32, placement: Affine3A) {
    builder.place(placement);
    builder.object(&format!("desk lamp {number} arm"), palette.brass);
    let foot = [[0.0, 0.0], [0.08, 0.0], [0.08, 0.01], [0.06, 0.02], [0.02, 0.026], [0.0, 0.027]];
    builder.lathe(&foot.map(Vec2::from), 24);
    let (elbow, head) = (Vec3::new(-0.1, 0.34, 0.0), Vec3::new(0.1, 0.52, 0.0));
    builder.rod(Vec3::new(0.0, 0.03, 0.0), elbow - Vec3::new(-0.005, 0.017, 0.0), 0.007, 10);
    builder.ball(elbow, 0.012, 10);
    builder.rod(elbow + Vec3::new(0.012, 0.011, 0.0), head - Vec3::new(0.002, 0.002, 0.0), 0.007, 10);
    builder.place(placement * Affine3A::from_translation(head + Vec3::new(0.03, -0.115, 0.0)));
    shade(builder, &format!("desk lamp {number}"), palette, palette.accents[(number / 2 % 3) as usize], 0.08);
}

/// A dome hanging from the ceiling.
pub fn pendant(builder: &mut Builder, palette: &Palette, number: u32, placement: Affine3A) {
    builder.place(placement);
    shade(builder, &format!("pendant {number}"), palette, palette.accents[0], 0.2);
    builder.resume("pendant cords", palette.black);
    builder.place(placement);
    builder.rod(Vec3::new(0.0, 0.271, 0.0), Vec3::new(0.0, super::HEIGHT - 1.951, 0.0), 0.005, 8);
}

/// A shade of `radius` [m], open below and white inside, 1.35 times as high, and its bulb.
fn shade(builder: &mut Builder, name: &str, palette: &Palette, color: u32, radius: f32) {
    let scaled = |profile: &[[f32; 2]]| -> Vec<Vec2> { profile.iter().map(|p| radius * Vec2::from(*p)).collect() };
    let rim = [0.965, 0.0];
    builder.object(&format!("{name} shade"), color);
    let outside = [
        rim,
        [1.0, 0.0],
        [0.98, 0.25],
        [0.88, 0.55],
        [0.68, 0.85],
        [0.4, 1.08],
        [0.16, 1.18],
        [0.14, 1.32],
        [0.0, 1.34],
    ];
    builder.lathe(&scaled(&outside), 24);
    builder.object(&format!("{name} inside"), palette.white);
    let inside = [[0.0, 1.14], [0.14, 1.13], [0.37, 1.04], [0.64, 0.82], [0.84, 0.53], [0.945, 0.24], rim];
    builder.lathe(&scaled(&inside), 24);
    builder.object(&format!("{name} bulb"), palette.bulb);
    builder.ball(Vec3::new(0.0, 0.62 * radius, 0.0), 0.28 * radius, 16);
}

/// A vase of 0.3 m.
pub fn vase(builder: &mut Builder, palette: &Palette, placement: Affine3A) {
    builder.place(placement);
    builder.resume("vases", palette.accents[1]);
    let outside = [[0.05, 0.0], [0.085, 0.05], [0.1, 0.11], [0.08, 0.18], [0.04, 0.24], [0.035, 0.27], [0.045, 0.3]];
    let inside = outside.iter().rev().map(|[r, y]| [r - 0.004, f32::max(*y, 0.005)]);
    let closed = [[0.0, 0.0]].into_iter().chain(outside).chain(inside).chain([[0.0, 0.005]]);
    builder.lathe(&closed.map(Vec2::from).collect::<Vec<Vec2>>(), 20);
}

/// A potted plant of `height` [m], leaves and all: arching leaves around a stem by the golden angle.
pub fn plant(builder: &mut Builder, palette: &Palette, number: u32, height: f32, placement: Affine3A) {
    let vary = |what: u32| variety(u64::from(number) << 20 | what as u64);
    builder.place(placement * Affine3A::from_scale(Vec3::splat(height)));
    builder.resume("plant pots", if number.is_multiple_of(2) { palette.clay } else { palette.white });
    let pot =
        [[0.0, 0.0], [0.14, 0.0], [0.18, 0.29], [0.19, 0.29], [0.19, 0.32], [0.17, 0.32], [0.165, 0.27], [0.0, 0.27]];
    builder.lathe(&pot.map(Vec2::from), 18);
    builder.resume("plant stems", palette.soil);
    builder.rod(Vec3::new(0.0, 0.272, 0.0), Vec3::new(0.0, 0.72, 0.0), 0.012, 8);
    builder.resume("leaves", palette.leaf);
    let golden = PI * (3.0 - 5f32.sqrt());
    let (leaves, steps) = if height < 0.5 { (20, 4) } else { (36, 6) };
    let steps: Vec<f32> = (0..=steps).map(|k| k as f32 / steps as f32).collect();
    for leaf in 0..leaves {
        let share = leaf as f32 / leaves as f32;
        let direction = Quat::from_rotation_y(golden * leaf as f32);
        let length = 0.42 - 0.16 * share + 0.08 * vary(3 * leaf);
        let rise = 0.16 + 0.3 * share + 0.08 * vary(3 * leaf + 1);
        let droop = 0.24 - 0.08 * share + 0.06 * vary(3 * leaf + 2);
        let root = 0.4 + 0.33 * share;
        let surface = |along: f32, across: f32| {
            let width = 0.075 * (PI * along.powf(0.75)).sin().max(0.0) + 0.004 * (1.0 - along);
            let fold = 0.25 * width * across.abs();
            let height = root + rise * along - droop * along * along + fold;
            direction * Vec3::new(0.014 + length * along, height, width * across)
        };
        builder.grid(&steps, &[-1.0, 0.0, 1.0], surface, |_, _| true);
    }
}

/// A picture of the sun over the sea, 1.5 m x 1 m, its back at z = 0.
pub fn picture(builder: &mut Builder, palette: &Palette, placement: Affine3A) {
    builder.place(placement);
    let mut band = |name: &str, color: u32, low: [f32; 2], high: [f32; 2], front: f32| {
        builder.object(&format!("picture {name}"), color);
        builder.cuboid(Vec3::new(low[0], low[1], front - 0.006), Vec3::new(high[0], high[1], front));
    };
    band("canvas", palette.paper, [-0.75, -0.5], [0.75, 0.5], 0.01);
    band("sky", palette.books[2], [-0.66, -0.08], [0.66, 0.42], 0.017);
    band("sea", palette.accents[1], [-0.66, -0.26], [0.66, -0.084], 0.017);
    band("shore", palette.accents[0], [-0.66, -0.42], [0.66, -0.264], 0.017);
    band("frame left", palette.dark_wood, [-0.785, -0.53], [-0.752, 0.53], 0.025);
    band("frame right", palette.dark_wood, [0.752, -0.53], [0.785, 0.53], 0.025);
    band("frame top", palette.dark_wood, [-0.751, 0.502], [0.751, 0.53], 0.025);
    band("frame bottom", palette.dark_wood, [-0.751, -0.53], [0.751, -0.502], 0.025);
    builder.object("picture sun", palette.accents[2]);
    let facing = Affine3A::from_rotation_translation(Quat::from_rotation_x(FRAC_PI_2), Vec3::new(0.22, 0.12, 0.018));
    builder.place(placement * facing);
    builder.cylinder(0.16, 0.0, 0.004, 40);
}
