//! A furnished office: rows of two desks between a window wall and a wall of books, oak planks on the floor, warm lamps
//! against cool daylight. Round parts are tessellated, so that it is as hard on the ray kernel as a modelled room.
//!
//! The shell is closed and without T-junctions; everything in it is a closed solid that looks outwards and keeps a millimetre of
//! distance, except leaves and curtains, which are thin and two-sided. Luminances are those of real lamps and of a bright
//! overcast sky behind frosted panes: the desks come out at 300 to 800 lux.

mod furniture;
mod palette;
mod shell;
mod things;

use super::shapes::{Builder, standing, variety};
use super::{BuiltIn, Expected, Parameter, Parameters};
use crate::Error;
use crate::scene::{Camera, Scene};
use glam::{Affine3A, Vec3};
use palette::Palette;

pub const OFFICE: BuiltIn = BuiltIn {
    name: "office",
    what: "a furnished office with windows, lamps, desks, chairs, books and plants",
    parameters: &[Parameter {
        name: "size",
        default: 3.0,
        range: [1.0, 100.0],
        what: "the number of rows of two desks, from 1 to 100",
    }],
    build,
    // Nine luminaires of 2262 lm, three windows of 7775 lm, and what the bulbs and screens give.
    expected: Expected { triangles: 38_856, area: 545.305, flux: 47_726.1 },
};

/// Width and height of the room [m].
const WIDTH: f32 = 6.0;
const HEIGHT: f32 = 2.9;
/// From one row of desks to the next [m].
const PITCH: f32 = 1.95;
/// Top of the planks, and the millimetre above it on which everything stands [m].
const FLOOR: f32 = 0.01;

/// What depends on the number of rows.
struct Layout {
    rows: u32,
    /// Depth of the room [m].
    depth: f32,
}

impl Layout {
    /// Where the desks of row `k` stand along z.
    fn row(&self, k: u32) -> f32 {
        2.2 + PITCH * k as f32
    }
}

fn build(parameters: &Parameters) -> Result<Scene, Error> {
    let rows = parameters.get("size").round() as u32;
    let layout = Layout { rows, depth: 2.9 + PITCH * rows as f32 };
    let mut builder = Builder::new("office");
    let palette = Palette::new(&mut builder);
    shell::build(&mut builder, &palette, &layout);
    for row in 0..rows {
        for (column, x) in [1.85, 3.5].into_iter().enumerate() {
            workplace(&mut builder, &palette, 2 * row + column as u32, Vec3::new(x, FLOOR, layout.row(row)));
        }
    }
    far_end(&mut builder, &palette);
    let bays = ((layout.depth - 2.6) / 0.95) as u32;
    for bay in 0..bays {
        let position = Vec3::new(WIDTH - 0.02, FLOOR, 0.9 + 0.95 * bay as f32);
        furniture::shelf(&mut builder, &palette, bay, standing(position, 0.0));
    }
    let eye = Vec3::new(5.2, 1.62, layout.depth - 0.2);
    builder.camera(Camera::looking_at("camera", eye, Vec3::new(2.65, 0.98, layout.depth - 5.4), 0.95));
    Ok(builder.finish())
}

/// A desk at `position` with a chair and what lies on it, every one a little different.
fn workplace(builder: &mut Builder, palette: &Palette, number: u32, position: Vec3) {
    let vary = |what: u64, amplitude: f32| amplitude * (2.0 * variety(16 * u64::from(number) + what) - 1.0);
    let desk = Affine3A::from_translation(position);
    furniture::desk(builder, palette, number + 1, desk);
    let seat = Vec3::new(vary(0, 0.12) - 0.1, 0.0, 0.74 + vary(1, 0.06));
    furniture::chair(builder, palette, number + 1, standing(position + seat, vary(2, 0.7)));

    let on_top =
        |x: f32, z: f32, angle: f32| standing(position + Vec3::new(x, furniture::DESK_HEIGHT + 0.001, z), angle);
    things::monitor(builder, palette, on_top(-0.1, -0.16, vary(3, 0.12)));
    things::keyboard(builder, palette, on_top(-0.1, 0.2, vary(4, 0.05)));
    things::mug(builder, palette, number, on_top(-0.52 + vary(5, 0.04), 0.1 + vary(6, 0.1), 0.0));
    things::papers(builder, palette, number, on_top(0.5, 0.18, vary(7, 0.3)));
    if number.is_multiple_of(2) {
        things::desk_lamp(builder, palette, number + 1, on_top(-0.62, -0.24, 0.9));
    } else {
        things::plant(builder, palette, number, 0.3, on_top(0.6, -0.2, vary(8, 3.0)));
    }
}

/// The wall opposite the camera: a sideboard with plants and books under a picture, two pendants, a door.
fn far_end(builder: &mut Builder, palette: &Palette) {
    let sideboard = Vec3::new(2.6, FLOOR, 0.26);
    furniture::sideboard(builder, palette, Affine3A::from_translation(sideboard));
    let on_top = |x: f32| standing(sideboard + Vec3::new(x, furniture::SIDEBOARD_HEIGHT + 0.001, 0.0), x);
    things::plant(builder, palette, 100, 0.42, on_top(-0.75));
    things::vase(builder, palette, on_top(0.35));
    things::vase(builder, palette, on_top(0.62) * Affine3A::from_scale(Vec3::splat(0.7)));
    things::picture(builder, palette, Affine3A::from_translation(Vec3::new(2.6, 1.62, 0.002)));
    for (number, x) in [1.75, 3.45].into_iter().enumerate() {
        things::pendant(builder, palette, number as u32 + 1, Affine3A::from_translation(Vec3::new(x, 1.95, 0.75)));
    }
    things::plant(builder, palette, 101, 1.25, standing(Vec3::new(0.75, FLOOR, 0.75), 0.0));
    furniture::door(builder, palette, Affine3A::from_translation(Vec3::new(4.75, FLOOR, 0.002)));
}
