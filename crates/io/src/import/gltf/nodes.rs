//! The tree of nodes, walked depth first: what hangs on each node is placed in the world.

use super::file::File;
use super::material::Materials;
use super::{Reading, camera, container, light, primitive};
use crate::Error;
use crate::import::ImportOptions;
use glam::{DMat4, DQuat, DVec3, Mat4, Quat, Vec3};
use gltf::json::{Index, Node};

/// A walk over the scene of a file.
pub struct Walk<'a, 'b> {
    reading: Reading<'a, 'b>,
    options: &'a ImportOptions,
    materials: Materials,
}

impl<'a, 'b> Walk<'a, 'b> {
    pub fn new(reading: Reading<'a, 'b>, options: &'a ImportOptions) -> Walk<'a, 'b> {
        Walk { reading, options, materials: Materials::default() }
    }

    /// Reads everything that the scene shows.
    ///
    /// # Errors
    /// [`Error::Invalid`] with its place, [`Error::File`] for images that cannot be read.
    pub fn run(mut self) -> Result<(), Error> {
        let file = self.reading.file;
        let nodes = &file.root.nodes;
        let mut reached = vec![false; nodes.len()];
        // A stack of our own: a file may nest nodes deeper than any call stack.
        let mut waiting: Vec<(Index<Node>, DMat4, String)> =
            self.roots()?.into_iter().rev().map(|(node, place)| (node, DMat4::IDENTITY, place)).collect();
        while let Some((index, parent, from)) = waiting.pop() {
            let node = file.get(nodes, index, "nodes", &from)?;
            let place = format!("nodes/{}", index.value());
            if std::mem::replace(&mut reached[index.value()], true) {
                let what = format!("it is reached a second time, from {from}: nodes must form a tree, without cycles");
                return Err(file.error(&place, what));
            }
            let world = parent * local_matrix(node);
            if !world.is_finite() {
                return Err(file.error(&place, "its matrix is not finite"));
            }
            self.visit(node, &world, &place)?;
            for &child in node.children.iter().flatten().rev() {
                waiting.push((child, world, place.clone()));
            }
        }
        self.finish();
        Ok(())
    }

    /// The nodes to start from, each with the place that names it.
    fn roots(&mut self) -> Result<Vec<(Index<Node>, String)>, Error> {
        let Reading { file, builder, ignored } = &mut self.reading;
        let root = &file.root;
        let number = root.scene.map_or(0, |scene| scene.value());
        if let Some(scene) = root.scene {
            file.get(&root.scenes, scene, "scenes", "scene")?;
        }
        ignored.note_many("scenes other than the one shown", root.scenes.len().saturating_sub(1));
        if let Some(scene) = root.scenes.get(number) {
            return Ok(scene.nodes.iter().map(|&node| (node, format!("scenes/{number}"))).collect());
        }
        builder.remark("the file has no scene: all its nodes are taken");
        let mut is_child = vec![false; root.nodes.len()];
        for child in root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
            if let Some(flag) = is_child.get_mut(child.value()) {
                *flag = true;
            }
        }
        let roots = (0..root.nodes.len()).filter(|&k| !is_child[k]);
        Ok(roots.map(|k| (Index::new(k as u32), "nodes".to_owned())).collect())
    }

    fn visit(&mut self, node: &Node, world: &DMat4, place: &str) -> Result<(), Error> {
        let file = self.reading.file;
        let scene = &self.reading.builder.scene;
        let (camera_count, light_count) = (scene.cameras.len(), scene.lights.len());
        if let Some(index) = node.mesh {
            let mesh = file.get(&file.root.meshes, index, "meshes", place)?;
            let names = [&node.name, &mesh.name].into_iter().flatten();
            let named = names.into_iter().find(|name| !name.is_empty()).cloned();
            let base = named.unwrap_or_else(|| self.reading.builder.default_name());
            for (k, primitive) in mesh.primitives.iter().enumerate() {
                let place = format!("meshes/{}/primitives/{k}", index.value());
                let name = if mesh.primitives.len() > 1 { format!("{base}/primitive {k}") } else { base.clone() };
                primitive::read(&mut self.reading, &mut self.materials, primitive, &place, name, world)?;
            }
        }
        if let Some(index) = node.camera {
            let camera = file.get(&file.root.cameras, index, "cameras", place)?;
            let camera_place = format!("cameras/{}", index.value());
            let name = node.name.as_ref().or(camera.name.as_ref());
            let name = name.cloned().unwrap_or_else(|| format!("camera {}", camera_count + 1));
            self.reading.builder.scene.cameras.push(camera::read(file, camera, name, world, &camera_place)?);
        }
        if let Some(reference) = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref()) {
            let lights = file.root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
            let lights = lights.map_or(&[][..], |e| &e.lights);
            let light = file.get(lights, reference.light, "extensions/KHR_lights_punctual/lights", place)?;
            let light_place = format!("extensions/KHR_lights_punctual/lights/{}", reference.light.value());
            let name = node.name.as_ref().or(light.name.as_ref());
            let name = name.cloned().unwrap_or_else(|| format!("light {}", light_count + 1));
            let units = self.options.light_units;
            self.reading.builder.scene.lights.push(light::read(file, light, name, world, units, &light_place)?);
            self.reading.ignored.note_many("ranges of lights", usize::from(light.range.is_some()));
        }
        self.reading.ignored.note_many("skins, meshes kept as modelled", usize::from(node.skin.is_some()));
        Ok(())
    }

    /// Says what was assumed and left out.
    fn finish(mut self) {
        let Reading { file, builder, ignored } = &mut self.reading;
        if !builder.scene.lights.is_empty() {
            builder.remark(light::assumption(self.options.light_units));
        }
        self.materials.remark(builder);
        let root = &file.root;
        ignored.note_many("animations", root.animations.len());
        for name in root.extensions_used.iter().filter(|name| !container::is_understood(name)) {
            ignored.note(&format!("extension {name}"));
        }
        if let Some(sentence) = ignored.sentence() {
            builder.remark(sentence);
        }
    }
}

fn local_matrix(node: &Node) -> DMat4 {
    if let Some(matrix) = node.matrix {
        return Mat4::from_cols_array(&matrix).as_dmat4();
    }
    let scale = Vec3::from(node.scale.unwrap_or([1.0; 3])).as_dvec3();
    let rotation = Quat::from_array(node.rotation.unwrap_or_default().0).as_dquat();
    let translation: DVec3 = Vec3::from(node.translation.unwrap_or_default()).as_dvec3();
    // A quaternion that is not of unit length would scale; zero length means no rotation.
    let rotation = if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY };
    DMat4::from_scale_rotation_translation(scale, rotation, translation)
}

/// The world directions of the local axes -z (ahead) and y (up) under `world`: unit vectors at right angles.
pub fn forward_and_up(file: &File, world: &DMat4, place: &str) -> Result<(Vec3, Vec3), Error> {
    let forward = world.transform_vector3(DVec3::NEG_Z).try_normalize();
    let sides = forward.and_then(|forward| {
        let up = world.transform_vector3(DVec3::Y).reject_from_normalized(forward).try_normalize()?;
        Some((forward.as_vec3(), up.as_vec3()))
    });
    sides.ok_or_else(|| file.error(place, "the matrix of its node leaves it no direction"))
}
