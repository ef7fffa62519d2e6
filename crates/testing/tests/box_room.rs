//! A box of six coloured faces: every element against the dense system of exact form factors between triangles.

use isolux_testing::contour::convex_room_answer;
use isolux_testing::ensemble::{assert_exact, constant_elements, ensemble, irradiances};
use isolux_testing::scenes::problem;

#[test]
fn two_elements_a_face_solve_the_system_of_twelve() {
    let problem = problem("box", 12);
    let runs = irradiances(&ensemble(&problem, constant_elements(30_000), 48));
    assert_exact("box: 12 elements", &problem, &runs, &convex_room_answer::<12>(&problem));
}

#[test]
fn eight_elements_a_face_solve_the_system_of_forty_eight() {
    let problem = problem("box", 48);
    let runs = irradiances(&ensemble(&problem, constant_elements(60_000), 48));
    let exact = convex_room_answer::<48>(&problem);
    assert_exact("box: 48 elements", &problem, &runs, &exact);
}
