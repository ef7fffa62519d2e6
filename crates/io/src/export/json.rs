//! The summary of a solution: what was computed, how sure it is, where the light went, and how much falls on each object.
//!
//! Numbers that are not known are `null`. The hash of the scene is text, as it needs more digits than some readers keep.

use super::{ExportOptions, LitScene, cannot_encode};
use crate::Error;
use isolux_core::report;
use isolux_core::superposition;
use isolux_core::{Problem, Solution};
use serde_json::{Map, Value, json};

/// [`summary`], indented.
///
/// # Errors
/// None that a text in memory could meet.
pub fn write(lit: &LitScene, options: &ExportOptions) -> Result<Vec<u8>, Error> {
    let LitScene { problem, solution, .. } = lit;
    let summary = summary(problem, solution, &options.extras);
    let mut text = serde_json::to_vec_pretty(&summary).map_err(cannot_encode("json"))?;
    text.push(b'\n');
    Ok(text)
}

/// The summary as one object; `extras` are entries that only the caller knows, like the seconds it took.
pub fn summary(problem: &Problem, solution: &Solution, extras: &Map<String, Value>) -> Value {
    let Solution { work, balance, provenance, .. } = solution;
    let scene = &problem.scene;
    let parameters: Map<String, Value> =
        provenance.parameters.iter().map(|(name, value)| (name.clone(), json!(value))).collect();
    let mut summary = json!({
        "version": provenance.version,
        "scene": {
            "name": provenance.scene,
            "hash": format!("{:016x}", provenance.scene_hash),
            "objects": scene.objects.len(),
            "materials": scene.materials.len(),
            "images": scene.images.len(),
            "lights": scene.lights.len(),
            "cameras": scene.cameras.len(),
            "remarks": scene.remarks,
        },
        "triangles": scene.triangles.len(),
        "elements": problem.mesh.len(),
        "area": problem.mesh.total_area(),
        "method": provenance.method,
        "parameters": parameters,
        "seed": provenance.seed,
        "rays": work.rays,
        "replicates": work.replicates,
        "rms_error_estimate": solution.rms_error(),
        "mean": solution.certainty.as_ref().map(|certainty| certainty.scene.mean),
        "mean_error": solution.certainty.as_ref().map(|certainty| {
            let scene = certainty.scene;
            json!({ "std_error": scene.std_error(), "freedom": scene.freedom })
        }),
        "balance": {
            "emitted": balance.emitted,
            "absorbed": balance.absorbed,
            "escaped": balance.escaped,
            "back_face": balance.back_face,
            "unshot": balance.unshot,
            "residual": balance.residual(),
        },
        "objects": report::per_object(problem, solution),
        "units": { "area": "m²", "mean, mean_error, min, max": "lux", "balance, emitted, incident, reflected": "lm" },
    });
    if !solution.groups.is_empty() {
        summary["light_groups"] = light_groups(problem, solution);
    }
    for (name, value) in extras {
        summary[name.as_str()] = value.clone();
    }
    summary
}

/// The light of each group of sources, alone.
fn light_groups(problem: &Problem, solution: &Solution) -> Value {
    let one = |k: usize| {
        let (part, alone) = (&solution.groups[k], superposition::alone(problem, solution, k));
        json!({
            "name": part.group.name,
            "sources": part.group.sources.len(),
            "factor": part.factor.to_array(),
            "emitted": alone.balance.emitted,
            "rays": alone.work.rays,
            "mean": alone.certainty.as_ref().map(|certainty| certainty.scene.mean),
            "rms_error_estimate": alone.rms_error(),
        })
    };
    (0..solution.groups.len()).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn the_summary_says_what_was_computed() {
        let (problem, solution) = fixture::lit_box();
        let mut options = ExportOptions::default();
        options.extras.insert("seconds".into(), json!(1.5));
        let text = write(&LitScene::new(&problem, &solution), &options).unwrap();
        let read: Value = serde_json::from_slice(&text).unwrap();
        assert_eq!(read["elements"], problem.mesh.len());
        assert_eq!((&read["seed"], &read["seconds"]), (&json!(u64::MAX), &json!(1.5)));
        assert_eq!(read["balance"]["absorbed"], 90.0);
        // The first five have one side, the last one two.
        assert_eq!(read["objects"].as_array().map(Vec::len), Some(7));
        assert_eq!((&read["objects"][0]["side"], &read["objects"][5]["side"]), (&Value::Null, &"front".into()));
        assert_eq!((&read["objects"][6]["name"], &read["objects"][6]["side"]), (&"größe".into(), &"back".into()));
        assert_eq!(read["rms_error_estimate"], Value::Null, "one element has no standard error");
    }
}
