//! What a solution says about each named object: how much light it gets, and what it does with it.

use crate::math::Estimate;
use crate::problem::Side;
use crate::{Problem, Solution};

/// Light on one object, or on one side of it; everything is luminance.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct ObjectSummary {
    /// Index into [`crate::scene::Scene::objects`].
    pub object: u32,
    pub name: String,
    /// Which side of it, if it has elements on both.
    pub side: Option<Side>,
    pub elements: u64,
    /// [m²]
    pub area: f64,
    /// Mean irradiance by area, and the least and greatest of an element [lux].
    pub mean: f64,
    pub min: f64,
    pub max: f64,
    /// The error bar of the mean [lux], if replicates have told it.
    #[serde(rename = "mean_error", serialize_with = "error_bar")]
    pub certainty: Option<Estimate>,
    /// Flux sent out by the object itself [lm].
    pub emitted: f64,
    /// Flux that falls on it [lm], `sum A E`.
    pub incident: f64,
    /// Flux that it reflects [lm], `sum A rho E`.
    pub reflected: f64,
}

/// The error bar of an estimate, if there is one: its standard error, and how many degrees of freedom that has.
///
/// # Errors
/// Those of the serializer.
pub fn error_bar<S: serde::Serializer>(estimate: &Option<Estimate>, serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(serde::Serialize)]
    struct ErrorBar {
        std_error: f64,
        freedom: f64,
    }
    let bar = estimate.map(|estimate| ErrorBar { std_error: estimate.std_error(), freedom: estimate.freedom });
    serde::Serialize::serialize(&bar, serializer)
}

/// One summary for each object that has elements, two if it has them on both sides, in the order of the scene's objects.
pub fn per_object(problem: &Problem, solution: &Solution) -> Vec<ObjectSummary> {
    let (scene, mesh) = (&problem.scene, &problem.mesh);
    let empty = |(face, side): (usize, Option<Side>)| ObjectSummary {
        object: face as u32 / 2,
        name: scene.objects[face / 2].name.clone(),
        side,
        elements: 0,
        area: 0.0,
        mean: 0.0,
        min: f64::INFINITY,
        max: f64::NEG_INFINITY,
        certainty: solution.certainty.as_ref().and_then(|certainty| certainty.faces.get(face).copied()),
        emitted: 0.0,
        incident: 0.0,
        reflected: 0.0,
    };
    let mut summaries: Vec<ObjectSummary> = problem.sides().into_iter().enumerate().map(empty).collect();
    for e in mesh.elements() {
        let irradiance = solution.irradiance[e as usize];
        let area = f64::from(mesh.area(e));
        let lux = irradiance.luminance_f64();
        let summary = &mut summaries[problem.face(e) as usize];
        summary.elements += 1;
        summary.area += area;
        summary.min = summary.min.min(lux);
        summary.max = summary.max.max(lux);
        summary.emitted += area * mesh.emission(e).luminance_f64();
        summary.incident += area * lux;
        summary.reflected += area * (mesh.reflectivity(e) * irradiance).luminance_f64();
    }
    summaries.retain(|s| s.elements > 0);
    summaries.iter_mut().for_each(|s| s.mean = s.incident / s.area);
    summaries
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;
    use crate::mesh::Resolution;
    use crate::scene::{Material, Object, Scene, Triangle, Vertex};
    use glam::Vec3;

    #[test]
    fn the_objects_of_a_folded_sheet_are_summed_apart() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, 2.0 * Vec3::Z];
        let object = |name: &str| Object { name: name.into(), material: 0 };
        let mut material = Material::diffuse("grey", Rgb::grey(0.25));
        material.emission = Rgb::grey(3.0);
        let scene = Scene {
            vertices: corners.map(Vertex::at).to_vec(),
            triangles: [[0, 1, 2], [0, 1, 3]]
                .iter()
                .zip([0, 2])
                .map(|(&vertices, object)| Triangle { vertices, object, source: object })
                .collect(),
            objects: vec![object("floor"), object("nothing"), object("wall")],
            materials: vec![material],
            ..Scene::default()
        };
        let problem = Problem::new(scene, Resolution::MaxEdge(0.8)).unwrap();
        let on_wall = |e| problem.mesh.triangle(e) == 1;
        let lux = |e: u32| if on_wall(e) { 8.0 } else { e as f32 };
        let floor: Vec<f64> = problem.mesh.elements().filter(|&e| !on_wall(e)).map(f64::from).collect();
        let solution = Solution {
            irradiance: problem.mesh.elements().map(|e| Rgb::grey(lux(e))).collect(),
            std_error: vec![Rgb::BLACK; problem.mesh.len()],
            ..Solution::default()
        };

        let [a, b] = per_object(&problem, &solution).try_into().unwrap();
        assert_eq!((a.name.as_str(), b.name.as_str(), b.object), ("floor", "wall", 2));
        let close = |x: f64, y: f64| (x - y).abs() < 1e-6;
        assert!(close(a.area, 0.5) && close(b.area, 1.0));
        assert!(close(b.mean, 8.0) && close(b.incident, 8.0) && close(b.reflected, 2.0) && close(b.emitted, 3.0));
        assert!(close(a.mean, floor.iter().sum::<f64>() / floor.len() as f64));
        assert_eq!((a.min, a.max), (floor[0], floor[floor.len() - 1]));
    }

    #[test]
    fn the_two_sides_of_a_wall_have_means_of_their_own() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let material = Material { two_sided: true, ..Material::diffuse("grey", Rgb::grey(0.25)) };
        let scene = Scene {
            vertices: corners.map(Vertex::at).to_vec(),
            triangles: vec![Triangle { vertices: [0, 1, 2], object: 0, source: 0 }],
            objects: vec![Object { name: "wall".into(), material: 0 }],
            materials: vec![material],
            ..Scene::default()
        };
        let problem = Problem::new(scene, Resolution::MaxEdge(0.5)).unwrap();
        let lux = |e: u32| Rgb::grey(if problem.mesh.place(e).back { 0.0 } else { 300.0 });
        let irradiance: Vec<Rgb> = problem.mesh.elements().map(lux).collect();
        let solution = Solution { std_error: irradiance.clone(), irradiance, ..Solution::default() };
        let [front, back] = per_object(&problem, &solution).try_into().unwrap();
        assert_eq!((front.side, back.side), (Some(Side::Front), Some(Side::Back)));
        assert_eq!((front.mean, back.mean, front.elements, back.elements), (300.0, 0.0, 9, 9));
        assert!((front.area - 0.5).abs() < 1e-6 && front.object == back.object && front.name == back.name);
    }
}
