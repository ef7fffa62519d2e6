//! An enclosed maze seen from inside, with `Be + rho = 1` on every surface: its radiosity is 1 lm/m² everywhere, exactly, for
//! any reflectivity and however the walls stand. After the labyrinth of the empirical comparison of Bekaert et al., WSCG 1999.
//!
//! The maze stands on a grid of cubes of 1.5 m: rooms at odd places, passages between some of them, the rest solid. Every
//! free face of a cube is a square of two triangles; one reflects a little more than the mean, the other as much less.

use super::shapes::{Builder, variety};
use super::{BuiltIn, Expected, Parameter, Parameters};
use crate::Error;
use crate::math::Rgb;
use crate::scene::{Camera, Material, Scene};
use glam::Vec3;

pub const LABYRINTH: BuiltIn = BuiltIn {
    name: "labyrinth",
    what: "an enclosed maze in which reflectivity and emission add up to one: radiosity is 1 everywhere",
    parameters: &[Parameter {
        name: "rho",
        default: 0.5,
        range: [0.001, 0.999],
        what: "the mean reflectivity, from 0.001 to 0.999",
    }],
    build,
    // 398 squares of 1.5 m x 1.5 m; flux = (1 - rho) area.
    expected: Expected { triangles: 796, area: 895.5, flux: 447.75 },
};

/// Edge of a cube of the grid [m].
const CELL: f32 = 1.5;
/// Rooms along each side of the maze; it has `2 ROOMS + 1` cubes a side.
const ROOMS: usize = 7;
const SIDE: usize = 2 * ROOMS + 1;
/// Different reflectivities, half above and half below the mean.
const LEVELS: usize = 16;

/// Which cubes of the grid can be walked in.
type Maze = [[bool; SIDE]; SIDE];

fn build(parameters: &Parameters) -> Result<Scene, Error> {
    let rho = parameters.get("rho");
    let mut builder = Builder::new("labyrinth");
    let maze = maze();
    let faces = faces(&maze);
    for surface in ["floor", "ceiling", "wall"] {
        for level in 0..LEVELS {
            let reflectivity = Rgb::grey(level_reflectivity(rho, level));
            let name = format!("{surface} {level:02}");
            let emission = Rgb::WHITE - reflectivity;
            let material = builder.material(Material { emission, ..Material::diffuse(&name, reflectivity) });
            builder.object(&name, material);
            for (k, (_, [a, b, c, d])) in faces.iter().enumerate().filter(|(_, (of, _))| *of == surface) {
                let first = (variety(k as u64) * LEVELS as f32) as usize;
                if level == first {
                    builder.polygon(&[*a, *b, *c]);
                }
                if level == LEVELS - 1 - first {
                    builder.polygon(&[*a, *c, *d]);
                }
            }
        }
    }
    let middle = |x: usize, z: usize| Vec3::new(x as f32 + 0.5, 0.5, z as f32 + 0.5) * CELL;
    builder.camera(Camera::looking_at(
        "camera",
        middle(1, 1),
        if maze[1][2] { middle(2, 1) } else { middle(1, 2) },
        1.2,
    ));
    Ok(builder.finish())
}

/// Reflectivity of a level, evenly spread over nine tenths of the way from the mean to 0 or 1, whichever is nearer; levels
/// k and LEVELS - 1 - k average to the mean.
fn level_reflectivity(mean: f32, level: usize) -> f32 {
    let deviation = (2 * level + 1) as f32 / LEVELS as f32 - 1.0;
    mean + 0.9 * mean.min(1.0 - mean) * deviation
}

/// The squares between free and solid cubes, counter-clockwise seen from the free side, and what they are.
fn faces(maze: &Maze) -> Vec<(&'static str, [Vec3; 4])> {
    let mut faces = Vec::new();
    let free = (0..SIDE * SIDE).map(|k| (k % SIDE, k / SIDE)).filter(|&(x, z)| maze[z][x]);
    for (x, z) in free {
        let corner = |dx: usize, dy: usize, dz: usize| Vec3::new((x + dx) as f32, dy as f32, (z + dz) as f32) * CELL;
        faces.push(("floor", [corner(0, 0, 0), corner(0, 0, 1), corner(1, 0, 1), corner(1, 0, 0)]));
        faces.push(("ceiling", [corner(0, 1, 0), corner(1, 1, 0), corner(1, 1, 1), corner(0, 1, 1)]));
        if !maze[z][x - 1] {
            faces.push(("wall", [corner(0, 0, 0), corner(0, 1, 0), corner(0, 1, 1), corner(0, 0, 1)]));
        }
        if !maze[z][x + 1] {
            faces.push(("wall", [corner(1, 0, 0), corner(1, 0, 1), corner(1, 1, 1), corner(1, 1, 0)]));
        }
        if !maze[z - 1][x] {
            faces.push(("wall", [corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0)]));
        }
        if !maze[z + 1][x] {
            faces.push(("wall", [corner(0, 0, 1), corner(0, 1, 1), corner(1, 1, 1), corner(1, 0, 1)]));
        }
    }
    faces
}

/// Carves a tree of passages depth first from the first room, then opens some more walls so that there are ways round.
fn maze() -> Maze {
    let mut maze = [[false; SIDE]; SIDE];
    let mut draw = (0u64..).map(variety);
    let mut pick = |n: usize| (draw.next().unwrap_or(0.0) * n as f32) as usize;
    maze[1][1] = true;
    let mut path = vec![(1, 1)];
    while let Some(&(x, z)) = path.last() {
        let steps: [(isize, isize); 4] = [(1, 0), (-1, 0), (0, 1), (0, -1)];
        let beyond = |(dx, dz): (isize, isize), n: isize| (x as isize + n * dx, z as isize + n * dz);
        let uncarved = |&step: &(isize, isize)| {
            let (x, z) = beyond(step, 2);
            let inside = 0..SIDE as isize;
            inside.contains(&x) && inside.contains(&z) && !maze[z as usize][x as usize]
        };
        let open: Vec<(isize, isize)> = steps.into_iter().filter(uncarved).collect();
        if open.is_empty() {
            path.pop();
            continue;
        }
        let step = open[pick(open.len())];
        for (x, z) in [beyond(step, 1), beyond(step, 2)] {
            maze[z as usize][x as usize] = true;
        }
        let (x, z) = beyond(step, 2);
        path.push((x as usize, z as usize));
    }
    for _ in 0..ROOMS {
        let (x, z) = (2 * pick(ROOMS - 1) + 2, 2 * pick(ROOMS) + 1);
        maze[z][x] = true;
    }
    maze
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin::builtin;

    #[test]
    fn reflectivity_and_emission_add_up_to_one_and_average_to_rho() {
        for rho in [0.1f32, 0.5, 0.9] {
            let scene = builtin(&format!("labyrinth:rho={rho}")).unwrap();
            let count = scene.triangles.len() as u32;
            let material = |t| scene.material_of(t);
            assert!((0..count).all(|t| material(t).reflectivity + material(t).emission == Rgb::WHITE));
            assert!((0..count).all(|t| material(t).reflectivity.r > 0.0 && material(t).emission.r > 0.0));
            let mean = (0..count).map(|t| f64::from(material(t).reflectivity.g)).sum::<f64>() / f64::from(count);
            assert!((mean - f64::from(rho)).abs() < 1e-6, "{mean}");
        }
    }
}
