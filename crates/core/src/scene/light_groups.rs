//! Groups of light sources, and scenes in which they are dimmed and coloured.
//!
//! ```text
//! B = Σ_g f_g B_g,      B_g: the light of group g alone, f_g: its factor, for each channel
//! ```
//!
//! Radiosity is linear in the emission, so whoever knows the light of each group alone knows that of any mixture. A group
//! remembers what its sources emitted when it was formed: one that was switched off can be switched on again.

use super::Scene;
use crate::Error;
use crate::math::Rgb;

/// Each group is solved and stored for itself.
pub const MOST_GROUPS: usize = 64;

/// The group of what no list names.
const REST: &str = "rest";

/// Light sources that are dimmed and coloured together.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LightGroup {
    pub name: String,
    pub sources: Vec<Source>,
}

/// One source of light, with what it emits at factor 1.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Source {
    pub emitter: Emitter,
    /// Exitance [lm/m²] of an object's material, before its texture; intensity [cd], or illuminance [lux], of a light.
    pub emission: Rgb,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Emitter {
    /// Index into [`Scene::objects`].
    Object(u32),
    /// Index into [`Scene::lights`].
    Light(u32),
}

/// How sources are put together. Those of the same name are one group; lights without extent go by their own names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Grouping {
    /// By the name of the object.
    Objects,
    /// By the name of the material.
    Materials,
    /// Named groups, each with the names of its objects and lights; a `*` at the end stands for anything. What is in no list is one
    /// more group, `rest`.
    Listed(Vec<(String, Vec<String>)>),
}

impl Grouping {
    /// The groups of `scene`, in the order of its objects and lights, or of the list. Every source is in one of them.
    ///
    /// # Errors
    /// [`Error::Parameter`] without any source, for more than [`MOST_GROUPS`], and for a source in two lists; [`Error::UnknownName`]
    /// for a name in a list that no source has.
    pub fn groups(&self, scene: &Scene) -> Result<Vec<LightGroup>, Error> {
        let groups = match self {
            Grouping::Objects => by_name(scene, false),
            Grouping::Materials => by_name(scene, true),
            Grouping::Listed(lists) => listed(by_name(scene, false), lists)?,
        };
        match groups.len() {
            0 => Err(refused("0 groups".to_owned(), "nothing emits light, so there is none to group")),
            1..=MOST_GROUPS => Ok(groups),
            n => {
                let allowed = "at most 64, for each is solved and stored for itself; put lights together, \
                               as in 'Ceiling=lamp 1,lamp 2;Windows=window *'";
                Err(refused(format!("{n} groups"), allowed))
            }
        }
    }
}

fn refused(value: String, allowed: &'static str) -> Error {
    Error::Parameter { name: "light-groups", value, allowed }
}

/// Sources of the same name together, in the order in which the names appear.
fn by_name(scene: &Scene, of_material: bool) -> Vec<LightGroup> {
    let mut groups: Vec<LightGroup> = Vec::new();
    let mut add = |name: &str, what: &str, source: Source| {
        let (Emitter::Object(k) | Emitter::Light(k)) = source.emitter;
        let name = if name.is_empty() { format!("{what} {k}") } else { name.to_owned() };
        match groups.iter_mut().find(|group| group.name == name) {
            Some(group) => group.sources.push(source),
            None => groups.push(LightGroup { name, sources: vec![source] }),
        }
    };
    for (object, k) in scene.objects.iter().zip(0..) {
        let material = &scene.materials[object.material as usize];
        if material.is_emitter() {
            let name = if of_material { &material.name } else { &object.name };
            add(name, "object", Source { emitter: Emitter::Object(k), emission: material.emission });
        }
    }
    for (light, k) in scene.lights.iter().zip(0..).filter(|(light, _)| !light.intensity.is_black()) {
        add(&light.name, "light", Source { emitter: Emitter::Light(k), emission: light.intensity });
    }
    groups
}

/// `single` sources put together as the lists say.
fn listed(single: Vec<LightGroup>, lists: &[(String, Vec<String>)]) -> Result<Vec<LightGroup>, Error> {
    let mut groups: Vec<LightGroup> =
        lists.iter().map(|(name, _)| LightGroup { name: name.clone(), sources: Vec::new() }).collect();
    if let Some(k) = (1..lists.len()).find(|&k| lists[..k].iter().any(|(name, _)| *name == lists[k].0)) {
        return Err(refused(format!("'{}'", lists[k].0), "two groups have this name"));
    }
    for pattern in lists.iter().flat_map(|(_, patterns)| patterns) {
        if !single.iter().any(|group| matches(pattern, &group.name)) {
            let names = single.iter().map(|group| group.name.as_str());
            return Err(Error::unknown_name("light source", pattern, names));
        }
    }
    let mut rest = LightGroup { name: REST.to_owned(), sources: Vec::new() };
    for LightGroup { name, sources } in single {
        let mut owners = (0..lists.len()).filter(|&k| lists[k].1.iter().any(|pattern| matches(pattern, &name)));
        match (owners.next(), owners.next()) {
            (None, _) => rest.sources.extend(sources),
            (Some(k), None) => groups[k].sources.extend(sources),
            (Some(_), Some(_)) => return Err(refused(format!("'{name}'"), "this source is in two groups")),
        }
    }
    match groups.iter_mut().find(|group| group.name == REST) {
        Some(named) => named.sources.extend(rest.sources),
        None if rest.sources.is_empty() => {}
        None => groups.push(rest),
    }
    Ok(groups)
}

fn matches(pattern: &str, name: &str) -> bool {
    pattern.strip_suffix('*').map_or(pattern == name, |start| name.starts_with(start))
}

impl LightGroup {
    /// Which objects of `scene` are sources of it.
    pub fn objects(&self, scene: &Scene) -> Vec<bool> {
        let mut objects = vec![false; scene.objects.len()];
        for source in &self.sources {
            if let Emitter::Object(k) = source.emitter {
                objects[k as usize] = true;
            }
        }
        objects
    }

    /// Whether all sources are there in `scene`: of a group that was read from a file.
    pub fn fits(&self, scene: &Scene) -> bool {
        self.sources.iter().all(|source| {
            source.emission.is_finite()
                && match source.emitter {
                    Emitter::Object(k) => (k as usize) < scene.objects.len(),
                    Emitter::Light(k) => (k as usize) < scene.lights.len(),
                }
        })
    }
}

impl Scene {
    /// Lets the sources of each group emit so many times, by channel, what they emitted when the group was formed. A material of
    /// objects that emit differently now becomes several; what is in no group stays as it is.
    pub fn relight<'a>(&mut self, groups: impl IntoIterator<Item = (&'a LightGroup, Rgb)>) {
        let emission = |material: u32| self.materials[material as usize].emission;
        let mut wanted: Vec<Rgb> = self.objects.iter().map(|object| emission(object.material)).collect();
        for (group, factor) in groups {
            for &Source { emitter, emission } in &group.sources {
                match emitter {
                    Emitter::Object(k) => wanted[k as usize] = emission * factor,
                    Emitter::Light(k) => self.lights[k as usize].intensity = emission * factor,
                }
            }
        }
        // The first object of a material keeps it, and whoever emits the same.
        let mut versions = vec![Vec::new(); self.materials.len()];
        for (object, wanted) in self.objects.iter_mut().zip(wanted) {
            let versions: &mut Vec<u32> = &mut versions[object.material as usize];
            let emits = |version: &&u32| self.materials[**version as usize].emission == wanted;
            object.material = match versions.iter().find(emits) {
                Some(&version) => version,
                None => {
                    let version = if versions.is_empty() { object.material } else { self.materials.len() as u32 };
                    if version != object.material {
                        self.materials.push(self.materials[object.material as usize].clone());
                    }
                    self.materials[version as usize].emission = wanted;
                    versions.push(version);
                    version
                }
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Light, LightKind, Material, Object};
    use glam::Vec3;

    /// Two lamps and a window of one glowing material, one more of another, a wall, a bulb, and a lamp without a name.
    fn scene() -> Scene {
        let glowing = |name: &str, k: f32| Material { emission: Rgb::grey(k), ..Material::diffuse(name, Rgb::BLACK) };
        let object = |name: &str, material| Object { name: name.to_owned(), material };
        let kind = LightKind::Point { position: Vec3::ZERO };
        Scene {
            objects: vec![
                object("lamp 1", 1),
                object("wall", 0),
                object("lamp 2", 1),
                object("window", 2),
                object("", 1),
            ],
            materials: vec![Material::diffuse("paint", Rgb::grey(0.5)), glowing("glow", 2.0), glowing("sky", 3.0)],
            lights: vec![Light { name: "lamp 2".to_owned(), intensity: Rgb::grey(7.0), kind }],
            ..Scene::default()
        }
    }

    fn names(groups: &[LightGroup]) -> Vec<&str> {
        groups.iter().map(|group| group.name.as_str()).collect()
    }

    fn list(lists: &[(&str, &[&str])]) -> Grouping {
        let owned = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
        Grouping::Listed(lists.iter().map(|&(name, members)| (name.to_owned(), owned(members))).collect())
    }

    #[test]
    fn every_source_is_in_one_group() {
        let scene = scene();
        let objects = Grouping::Objects.groups(&scene).unwrap();
        assert_eq!(names(&objects), ["lamp 1", "lamp 2", "window", "object 4"]);
        assert_eq!(objects[1].sources.len(), 2, "an object and a light of the same name");
        let materials = Grouping::Materials.groups(&scene).unwrap();
        assert_eq!(names(&materials), ["glow", "sky", "lamp 2"]);
        let lists = list(&[("ceiling", &["lamp *"]), ("window", &["window"])]).groups(&scene).unwrap();
        assert_eq!(names(&lists), ["ceiling", "window", "rest"]);
        for groups in [objects, materials, lists] {
            assert_eq!(groups.iter().map(|group| group.sources.len()).sum::<usize>(), 5);
            assert!(groups.iter().all(|group| group.fits(&scene)));
        }
    }

    #[test]
    fn lists_without_meaning_are_refused() {
        let refused = |lists: &[(&str, &[&str])]| list(lists).groups(&scene()).unwrap_err().to_string();
        assert!(refused(&[("a", &["lamp 3"])]).contains("did you mean 'lamp 1'"));
        assert!(refused(&[("a", &["lamp 1"]), ("b", &["lamp *"])]).contains("'lamp 1': this source is in two groups"));
        assert!(refused(&[("a", &["lamp 1"]), ("a", &["window"])]).contains("two groups have this name"));
        let mut many = scene();
        many.objects = (0..65).map(|k| Object { name: k.to_string(), material: 1 }).collect();
        assert!(Grouping::Objects.groups(&many).unwrap_err().to_string().contains("at most 64"));
        assert!(Grouping::Objects.groups(&Scene::default()).unwrap_err().to_string().contains("nothing emits"));
    }

    #[test]
    fn a_dimmed_lamp_gets_a_material_of_its_own_and_shines_again() {
        let original = scene();
        let groups = Grouping::Objects.groups(&original).unwrap();
        let relit = |scene: &Scene, factors: [f32; 4]| {
            let mut scene = scene.clone();
            scene.relight(groups.iter().zip(factors.map(Rgb::grey)));
            scene
        };
        let emission = |scene: &Scene| -> Vec<f32> {
            scene.objects.iter().map(|object| scene.materials[object.material as usize].emission.r).collect()
        };
        let dimmed = relit(&original, [1.0, 0.0, 0.5, 1.0]);
        assert_eq!(emission(&dimmed), [2.0, 0.0, 0.0, 1.5, 2.0]);
        assert_eq!((dimmed.materials.len(), dimmed.lights[0].intensity), (4, Rgb::BLACK));
        let again = relit(&dimmed, [1.0; 4]);
        assert_eq!((emission(&again), again.lights[0].intensity), (emission(&original), Rgb::grey(7.0)));
        assert_eq!(relit(&original, [1.0; 4]).materials, original.materials, "nothing changes at factor 1");
    }
}
