//! The white furnace: in a closed scene where everything emits what it does not reflect, radiosity is 1 on every element,
//! whatever the shape.

use isolux_testing::ensemble::{assert_exact, ensemble, irradiances, radiosities, with_rays};
use isolux_testing::scenes::{cut, furnace, furnace_answer, scene};

/// Holds radiosities and irradiances of `name`, made a furnace, against 1.
fn assert_furnace(test: &str, name: &str, elements: u64, rays: u64) {
    let problem = cut(furnace(scene(name)), elements);
    let runs = ensemble(&problem, with_rays(rays), 32);
    let exact = furnace_answer(&problem);
    assert_exact(test, &problem, &irradiances(&runs), &exact);
    assert_exact(test, &problem, &radiosities(&problem, &runs), &exact);
}

#[test]
fn a_box_of_coloured_faces() {
    assert_furnace("furnace: box", "box", 600, 60_000);
}

#[test]
fn a_room_with_hard_contacts() {
    assert_furnace("furnace: cubes", "cubes", 1500, 100_000);
}

#[test]
fn a_labyrinth_dark_grey_and_bright() {
    for rho in ["0.1", "0.5", "0.9"] {
        assert_furnace("furnace: labyrinth", &format!("labyrinth:rho={rho}"), 796, 100_000);
    }
}
