//! Desks, chairs, shelves, the sideboard and the door. Each is built about the point it stands on.

use super::super::shapes::{Builder, variety};
use super::palette::Palette;
use glam::{Affine3A, Vec2, Vec3};
use std::f32::consts::TAU;

pub const DESK_HEIGHT: f32 = 0.74;
pub const SIDEBOARD_HEIGHT: f32 = 0.72;

/// A desk of 1.6 m x 0.8 m on round legs with a chest of drawers; one sits at +z.
pub fn desk(builder: &mut Builder, palette: &Palette, number: u32, placement: Affine3A) {
    builder.place(placement);
    builder.object(&format!("desk {number} top"), palette.wood);
    builder.rounded_cuboid(Vec3::new(-0.8, 0.71, -0.4), Vec3::new(0.8, DESK_HEIGHT, 0.4), 0.006, 1);
    builder.object(&format!("desk {number} legs"), palette.white);
    for (x, z) in [(-0.74, -0.34), (-0.74, 0.34), (0.74, -0.34), (0.74, 0.34)] {
        builder.rod(Vec3::new(x, 0.0, z), Vec3::new(x, 0.709, z), 0.024, 12);
    }
    builder.cuboid(Vec3::new(-0.71, 0.62, -0.355), Vec3::new(0.71, 0.68, -0.325));
    builder.object(&format!("desk {number} drawers"), palette.white);
    builder.cuboid(Vec3::new(0.28, 0.0, -0.28), Vec3::new(0.70, 0.69, 0.36));
    for drawer in 0..3 {
        let bottom = 0.012 + 0.224 * drawer as f32;
        builder.cuboid(Vec3::new(0.285, bottom, 0.361), Vec3::new(0.695, bottom + 0.218, 0.378));
    }
    builder.object(&format!("desk {number} handles"), palette.brass);
    for drawer in 0..3 {
        let y = 0.18 + 0.224 * drawer as f32;
        builder.rod(Vec3::new(0.42, y, 0.39), Vec3::new(0.56, y, 0.39), 0.006, 8);
    }
}

/// A swivel chair on five castors, looking to -z.
pub fn chair(builder: &mut Builder, palette: &Palette, number: u32, placement: Affine3A) {
    builder.place(placement);
    builder.object(&format!("chair {number} frame"), palette.steel);
    builder.cylinder(0.03, 0.06, 0.14, 12);
    builder.cylinder(0.02, 0.141, 0.4, 12);
    for foot in 0..5 {
        let direction = Vec2::from_angle(TAU * foot as f32 / 5.0);
        let at = |r: f32, y: f32| Vec3::new(r * direction.x, y, r * direction.y);
        builder.rod(at(0.035, 0.1), at(0.27, 0.076), 0.013, 8);
    }
    builder.rod(Vec3::new(0.0, 0.38, 0.024), Vec3::new(0.0, 0.38, 0.298), 0.014, 8);
    builder.rod(Vec3::new(0.0, 0.37, 0.32), Vec3::new(0.0, 0.84, 0.362), 0.014, 8);
    for side in [-1.0, 1.0] {
        builder.rod(Vec3::new(side * 0.258, 0.43, 0.05), Vec3::new(side * 0.275, 0.635, 0.05), 0.011, 8);
    }
    builder.object(&format!("chair {number} castors"), palette.black);
    for foot in 0..5 {
        let direction = 0.27 * Vec2::from_angle(TAU * foot as f32 / 5.0);
        builder.ball(Vec3::new(direction.x, 0.028, direction.y), 0.028, 10);
    }
    for side in [-1.0, 1.0] {
        let middle = Vec3::new(side * 0.275, 0.655, 0.05);
        let half = Vec3::new(0.032, 0.016, 0.12);
        builder.rounded_cuboid(middle - half, middle + half, 0.012, 1);
    }
    builder.object(&format!("chair {number} upholstery"), palette.accents[(number % 4) as usize]);
    builder.rounded_cuboid(Vec3::new(-0.24, 0.401, -0.23), Vec3::new(0.24, 0.481, 0.23), 0.036, 2);
    builder.place(placement * Affine3A::from_translation(Vec3::new(0.0, 0.6, 0.25)) * Affine3A::from_rotation_x(0.12));
    builder.rounded_cuboid(Vec3::new(-0.22, 0.0, -0.03), Vec3::new(0.22, 0.5, 0.03), 0.029, 2);
}

/// A bay of shelves 0.9 m wide and 2.1 m high with books; its back is at x = 0 and it runs along z from 0.
pub fn shelf(builder: &mut Builder, palette: &Palette, number: u32, placement: Affine3A) {
    const DEPTH: f32 = 0.3;
    const INSIDE: [f32; 2] = [0.021, 0.879];
    builder.place(placement);
    builder.object(&format!("shelf {}", number + 1), palette.wood);
    let mut board = |y: [f32; 2], z: [f32; 2], back: f32| {
        builder.cuboid(Vec3::new(-DEPTH, y[0], z[0]), Vec3::new(-back, y[1], z[1]));
    };
    board([0.0, 2.1], [0.0, 0.02], 0.0);
    board([0.0, 2.1], [0.88, 0.9], 0.0);
    let levels = [0.06, 0.46, 0.86, 1.26, 1.66];
    levels.into_iter().chain([2.08]).for_each(|y| board([y, y + 0.02], INSIDE, 0.012));
    builder.cuboid(Vec3::new(-0.01, 0.0, INSIDE[0]), Vec3::new(0.0, 2.1, INSIDE[1]));
    for (level, y) in levels.into_iter().enumerate() {
        let mut key = 1000 * u64::from(number) + 100 * level as u64;
        let mut draw = |least: f32, greatest: f32| {
            key += 1;
            least + (greatest - least) * variety(key)
        };
        let full = INSIDE[0] + draw(0.45, 0.82);
        let mut z = INSIDE[0] + 0.003;
        while z < full {
            let (thickness, height, depth) = (draw(0.024, 0.058), draw(0.2, 0.33), draw(0.16, 0.24));
            let color = (draw(0.0, 8.0)) as usize;
            builder.resume(&format!("books {}", color + 1), palette.books[color]);
            let front = -DEPTH + 0.02 + draw(0.0, 0.03);
            let low = Vec3::new(front, y + 0.021, z);
            builder.cuboid(low, low + Vec3::new(depth, height, thickness));
            z += thickness + 0.0012;
        }
    }
}

/// A low cupboard of walnut with four doors, 2.2 m wide, its front at +z.
pub fn sideboard(builder: &mut Builder, palette: &Palette, placement: Affine3A) {
    builder.place(placement);
    builder.object("sideboard", palette.dark_wood);
    builder.rounded_cuboid(Vec3::new(-1.1, 0.14, -0.22), Vec3::new(1.1, SIDEBOARD_HEIGHT, 0.2), 0.006, 2);
    for door in 0..4 {
        let left = -1.085 + 0.5435 * door as f32;
        builder.cuboid(Vec3::new(left, 0.155, 0.201), Vec3::new(left + 0.539, 0.705, 0.219));
    }
    builder.object("sideboard legs", palette.brass);
    for (x, z) in [(-1.0, -0.15), (-1.0, 0.15), (1.0, -0.15), (1.0, 0.15)] {
        builder.rod(Vec3::new(x, 0.0, z), Vec3::new(x, 0.139, z), 0.014, 12);
    }
    for x in [-0.58, -0.5, 0.506, 0.586] {
        builder.ball(Vec3::new(x, 0.55, 0.234), 0.012, 10);
    }
}

/// A door of 0.95 m x 2.1 m in its frame, just before the wall z = 0.
pub fn door(builder: &mut Builder, palette: &Palette, placement: Affine3A) {
    builder.place(placement);
    builder.object("door", palette.accents[3]);
    builder.cuboid(Vec3::new(-0.475, 0.002, 0.0), Vec3::new(0.475, 2.1, 0.03));
    builder.object("door frame", palette.white);
    for side in [-1.0f32, 1.0] {
        let (near, far) = (side * 0.477, side * 0.547);
        builder.cuboid(Vec3::new(near.min(far), 0.0, 0.0), Vec3::new(near.max(far), 2.101, 0.045));
    }
    builder.cuboid(Vec3::new(-0.547, 2.102, 0.0), Vec3::new(0.547, 2.172, 0.045));
    builder.object("door handle", palette.brass);
    builder.rod(Vec3::new(-0.4, 1.02, 0.031), Vec3::new(-0.4, 1.02, 0.07), 0.012, 12);
    builder.rod(Vec3::new(-0.41, 1.02, 0.084), Vec3::new(-0.28, 1.02, 0.084), 0.01, 12);
}
