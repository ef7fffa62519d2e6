use super::*;
pub const OFFICE: BuiltIn = BuiltIn { name: "office", what: "", parameters: &[], build: |_| Ok(Scene::default()), expected: Expected { triangles: 0, area: 0.0, flux: 0.0 } };
