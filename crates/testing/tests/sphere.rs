//! The inside of a sphere, the one scene where every element's radiosity is known for any reflectivities and emissions.

use isolux_testing::ensemble::{assert_exact, ensemble, radiosities, with_rays};
use isolux_testing::scenes::{problem, sphere_answer};

#[test]
fn every_element_has_its_exact_radiosity() {
    for name in ["sphere:rho=0.5", "sphere:rho=0.9"] {
        let problem = problem(name, 8 * 16);
        let runs = ensemble(&problem, with_rays(60_000), 48);
        assert_exact("sphere", &problem, &radiosities(&problem, &runs), &sphere_answer(&problem));
    }
}
