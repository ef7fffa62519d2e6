//! The room itself: walls with window niches, planks, skirting, curtains and the lights of the ceiling.

use super::super::shapes::{Builder, variety};
use super::palette::Palette;
use super::{FLOOR, HEIGHT, Layout, PITCH, WIDTH};
use glam::{Affine3A, Vec3};
use std::f32::consts::TAU;

/// Width, sill and head of a window, and the depth of its niche [m].
const WINDOW: f32 = 1.25;
const SILL: f32 = 0.85;
const HEAD: f32 = 2.5;
const NICHE: f32 = 0.24;

pub fn build(builder: &mut Builder, palette: &Palette, layout: &Layout) {
    walls(builder, palette, layout);
    planks(builder, palette, layout);
    skirting(builder, palette, layout);
    for row in 0..layout.rows {
        let z = layout.row(row) + 0.2;
        builder.place(Affine3A::IDENTITY);
        window(builder, palette, row + 1, z);
        for (column, x) in [1.85, 3.5, 5.0].into_iter().enumerate() {
            builder.place(Affine3A::from_translation(Vec3::new(x, HEIGHT - 0.16, z)));
            ceiling_light(builder, palette, 3 * row + column as u32 + 1);
        }
    }
}

/// Six faces, cut along the edges of the windows wherever they meet, with holes for the windows.
fn walls(builder: &mut Builder, palette: &Palette, layout: &Layout) {
    let edges = (0..layout.rows).flat_map(|row| [-0.5, 0.5].map(|side| layout.row(row) + 0.2 + side * WINDOW));
    let along: Vec<f32> = [0.0].into_iter().chain(edges).chain([layout.depth]).collect();
    let cuts: [&[f32]; 3] = [&[0.0, WIDTH], &[0.0, SILL, HEAD, HEIGHT], &along];
    let faces = [
        ("window wall", palette.wall),
        ("book wall", palette.wall),
        ("floor", palette.dark_wood),
        ("ceiling", palette.ceiling),
        ("far wall", palette.wall),
        ("near wall", palette.wall),
    ];
    builder.look_inwards(true);
    for (k, (name, material)) in faces.into_iter().enumerate() {
        builder.object(name, material);
        let hole = |i: usize, j: usize| k == 0 && i == 1 && j % 2 == 1;
        builder.cut_box(cuts, |p| p, |axis, greater, i, j| (axis, greater) == (k / 2, k % 2 == 1) && !hole(i, j));
    }
    builder.look_inwards(false);
}

/// A niche with a frosted pane at its end, a frame before it, and a curtain on either side.
fn window(builder: &mut Builder, palette: &Palette, number: u32, z: f32) {
    let (low, high) = (Vec3::new(-NICHE, SILL, z - 0.5 * WINDOW), Vec3::new(0.0, HEAD, z + 0.5 * WINDOW));
    let cuts = [[low.x, high.x], [low.y, high.y], [low.z, high.z]];
    let cuts: [&[f32]; 3] = [&cuts[0], &cuts[1], &cuts[2]];
    builder.look_inwards(true);
    builder.object(&format!("window {number}"), palette.sky);
    builder.cut_box(cuts, |p| p, |axis, greater, _, _| (axis, greater) == (0, false));
    builder.object(&format!("window {number} niche"), palette.white);
    builder.cut_box(cuts, |p| p, |axis, _, _, _| axis != 0);
    builder.look_inwards(false);

    builder.object(&format!("window {number} frame"), palette.white);
    let (back, front) = (-NICHE + 0.002, -NICHE + 0.05);
    let (bottom, top) = (SILL + 0.002, HEAD - 0.002);
    let mut bar = |y: [f32; 2], z: [f32; 2]| builder.cuboid(Vec3::new(back, y[0], z[0]), Vec3::new(front, y[1], z[1]));
    let (left, right) = (low.z + 0.002, high.z - 0.002);
    bar([bottom, bottom + 0.06], [left, right]);
    bar([top - 0.06, top], [left, right]);
    for middle in [left + 0.03, z, right - 0.03] {
        bar([bottom + 0.061, top - 0.061], [middle - 0.03, middle + 0.03]);
    }

    builder.object(&format!("curtains {number}"), palette.linen);
    for side in [-1.0, 1.0] {
        let folds: Vec<f32> = (0..=24).map(|k| k as f32 / 24.0).collect();
        let fabric = |t: f32, y: f32| {
            let out = 0.075 + 0.03 * (4.0 * TAU * t).sin() * (1.0 - 0.25 * y / HEIGHT);
            Vec3::new(out, y, z + side * (0.5 * WINDOW + 0.02 + 0.28 * t))
        };
        builder.grid(&folds, &[0.08, 1.0, 1.9, HEIGHT - 0.12], fabric, |_, _| true);
    }
    builder.resume("curtain rods", palette.brass);
    let rod = |side: f32| Vec3::new(0.12, HEIGHT - 0.09, z + side * (0.5 * WINDOW + 0.34));
    builder.rod(rod(-1.0), rod(1.0), 0.011, 10);
}

/// Oak boards in four shades, laid with staggered ends.
fn planks(builder: &mut Builder, palette: &Palette, layout: &Layout) {
    const BOARD: f32 = 0.2;
    const LENGTH: f32 = 2.4;
    for column in 0..(WIDTH / BOARD).round() as u64 {
        let x = BOARD * column as f32;
        let mut start = 0.002;
        let mut end = LENGTH * (0.25 + 0.75 * variety(1000 + column));
        for board in 0.. {
            let shade = (4.0 * variety(97 * column + board)) as usize;
            builder.resume(&format!("planks {}", shade + 1), palette.planks[shade]);
            let stop = if end > layout.depth - 0.3 { layout.depth } else { end };
            builder
                .cuboid(Vec3::new(x + 0.001, 0.001, start), Vec3::new(x + BOARD - 0.001, FLOOR - 0.001, stop - 0.002));
            if stop == layout.depth {
                break;
            }
            (start, end) = (stop, stop + LENGTH);
        }
    }
}

/// Skirting boards, a millimetre off the walls; the far one stops at the door.
fn skirting(builder: &mut Builder, palette: &Palette, layout: &Layout) {
    builder.object("skirting", palette.white);
    let mut board = |x: [f32; 2], z: [f32; 2]| {
        builder.cuboid(Vec3::new(x[0], FLOOR, z[0]), Vec3::new(x[1], FLOOR + 0.07, z[1]));
    };
    let far_to_near = [0.016, layout.depth - 0.016];
    board([0.001, 0.015], far_to_near);
    board([WIDTH - 0.015, WIDTH - 0.001], far_to_near);
    board([0.001, 4.19], [0.001, 0.015]);
    board([5.31, WIDTH - 0.001], [0.001, 0.015]);
    board([0.001, WIDTH - 0.001], [layout.depth - 0.015, layout.depth - 0.001]);
}

/// A flat luminaire that hangs from two rods; its under side shines.
fn ceiling_light(builder: &mut Builder, palette: &Palette, number: u32) {
    let cuts: [&[f32]; 3] = [&[-0.6, 0.6], &[0.0, 0.035], &[-0.15, 0.15]];
    builder.object(&format!("ceiling light {number}"), palette.ceiling_light);
    builder.cut_box(cuts, |p| p, |axis, greater, _, _| (axis, greater) == (1, false));
    builder.resume("ceiling light housings", palette.white);
    builder.cut_box(cuts, |p| p, |axis, greater, _, _| (axis, greater) != (1, false));
    for x in [-0.45, 0.45] {
        builder.rod(Vec3::new(x, 0.036, 0.0), Vec3::new(x, 0.159, 0.0), 0.004, 8);
    }
}

const _: () = assert!(WINDOW + 0.7 <= PITCH, "curtains of neighbouring windows must not meet");
