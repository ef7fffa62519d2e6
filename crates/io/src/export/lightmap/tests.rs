//! The files of small lightmaps, read with other programs' eyes.

use super::*;
use crate::export::{LitScene, scene_glb};
use crate::fixture;
use crate::import::{self, ImportOptions};
use glam::Vec2;
use isolux_core::lightmap::{Density, Origin};
use isolux_core::math::Rgb;
use isolux_core::scene::Scene;

const SIZE: u32 = 128;

fn layout() -> Layout {
    Layout { density: Density::Size(SIZE), ..Layout::default() }
}

/// Shows the baked [`fixture::lit_box`] to `see`.
fn with_baked<T>(carrier: Carrier, see: impl FnOnce(&BakedScene, &VertexField) -> T) -> T {
    let (problem, solution) = fixture::lit_box();
    let lit = LitScene::new(&problem, &solution);
    let files = ["a.glb", "a.exr", "a.png", "a.json"].map(str::to_owned).to_vec();
    let exposure = Exposure { stops: -3.0 };
    let baked = BakedScene::new(&problem, &solution, lit.field(), &layout(), carrier, exposure, files).unwrap();
    see(&baked, lit.field())
}

/// Lookups at the coordinates of the file find the light of the field where the file has the surface.
#[test]
fn the_map_fits_the_model() {
    with_baked(Carrier::Sidecar, |baked, field| {
        let gltf = gltf::Gltf::from_slice(&glb::write(baked).unwrap()).unwrap();
        let exr = maps::write_exr(baked).unwrap();
        let map = ::image::load_from_memory_with_format(&exr, ::image::ImageFormat::OpenExr).unwrap().into_rgb32f();
        assert_eq!((map.width(), map.height()), (baked.lightmap.atlas.width, baked.lightmap.atlas.height));
        assert!(map.pixels().zip(&baked.lightmap.irradiance).all(|(read, light)| read.0 == light.to_array()));
        let mut faces = baked.lightmap.atlas.faces.iter();
        for mesh in gltf.meshes() {
            let primitive = mesh.primitives().next().unwrap();
            let reader = primitive.reader(|_| gltf.blob.as_deref());
            let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
            let uvs: Vec<Vec2> = reader.read_tex_coords(1).unwrap().into_f32().map(Vec2::from).collect();
            let indices: Vec<usize> = reader.read_indices().unwrap().into_u32().map(|k| k as usize).collect();
            for corners in indices.chunks(3) {
                let face = faces.next().unwrap();
                let own = face.positions(baked.problem).map(|p| p.to_array());
                let mut written = [0, 1, 2].map(|k| positions[corners[k]]);
                if face.back {
                    written.swap(1, 2);
                }
                assert_eq!(written, own);
                let middle = (uvs[corners[0]] + uvs[corners[1]] + uvs[corners[2]]) / 3.0;
                let expected = face.irradiance(baked.problem, field, Vec2::splat(1.0 / 3.0));
                let found = baked.lightmap.lookup(middle);
                assert!((found.g - expected.g).abs() < 0.05 * expected.g.max(1.0), "{found:?} {expected:?}");
            }
        }
        assert!(faces.next().is_none());
    });
}

#[test]
fn carriers_are_what_they_say() {
    let parsed = |carrier| {
        with_baked(carrier, |baked, _| {
            (gltf::Gltf::from_slice_without_validation(&glb::write(baked).unwrap()).unwrap(), baked.lux_at_white)
        })
    };
    let (unlit, _) = parsed(Carrier::Unlit);
    assert_eq!(unlit.images().count(), 1);
    for material in unlit.materials() {
        let texture = material.pbr_metallic_roughness().base_color_texture().unwrap();
        assert!(material.unlit() && texture.tex_coord() == 0 && texture.texture().index() == 0);
        assert_eq!(texture.texture().sampler().min_filter(), Some(gltf::texture::MinFilter::Linear));
    }
    let (moz, lux_at_white) = parsed(Carrier::MozLightmap);
    assert_eq!(moz.extensions_used().filter(|name| *name == "MOZ_lightmap").count(), 1);
    let json = serde_json::to_value(moz.document.as_json()).unwrap();
    assert_eq!(json["asset"]["extras"]["isolux"]["lux_at_white"], f64::from(lux_at_white));
    let (sidecar, _) = parsed(Carrier::Sidecar);
    let extras = serde_json::to_value(sidecar.document.as_json()).unwrap()["asset"]["extras"]["isolux"].clone();
    assert_eq!((extras["lightmap"].as_str(), extras["exposure_stops"].as_f64()), (Some("a.exr"), Some(-3.0)));
    let scene = fixture::scene();
    for (read, material) in sidecar.materials().zip(&scene.materials) {
        assert_eq!(read.pbr_metallic_roughness().base_color_factor()[..3], material.reflectivity.to_array());
        let exitance = read.emissive_factor().map(|c| c * read.emissive_strength().unwrap_or(1.0) * PI);
        assert!(exitance.iter().zip(material.emission.to_array()).all(|(a, b)| (a - b).abs() < 1e-3));
    }
}

/// Every material has the map, on the second set of coordinates, as bright as the exposure makes it.
#[test]
fn every_material_has_its_moz_lightmap() {
    with_baked(Carrier::MozLightmap, |baked, _| {
        let file = glb::write(baked).unwrap();
        let length = u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize;
        let json: serde_json::Value = serde_json::from_slice(&file[20..20 + length]).unwrap();
        let maps = json["materials"].as_array().unwrap();
        assert_eq!(maps.len(), 3);
        for material in maps {
            let map = &material["extensions"]["MOZ_lightmap"];
            let source = json["textures"][map["index"].as_u64().unwrap() as usize]["source"].as_u64().unwrap();
            assert_eq!(
                (map["texCoord"].as_u64(), json["images"][source as usize]["name"].as_str()),
                (Some(1), Some("lightmap"))
            );
            assert!((map["intensity"].as_f64().unwrap() - f64::from(baked.lux_at_white) / 8.0).abs() < 1e-4);
        }
    });
}

#[test]
fn eight_bits_are_read_back_as_the_manifest_says() {
    with_baked(Carrier::Unlit, |baked, _| {
        let text = manifest::write(baked).unwrap();
        let manifest: serde_json::Value = serde_json::from_slice(&text).unwrap();
        let white = manifest["lux_at_white"].as_f64().unwrap() as f32;
        let decoded = |png: Vec<u8>| ::image::load_from_memory(&png).unwrap().into_rgb8();
        let (srgb, linear) = (decoded(maps::write_png(baked).unwrap()), decoded(maps::linear_png(baked).unwrap()));
        let mut seen = 0;
        for ((light, srgb), linear) in baked.lightmap.irradiance.iter().zip(srgb.pixels()).zip(linear.pixels()) {
            let clipped = (light.g / white).min(1.0);
            assert!((Rgb::from_srgb8(srgb.0).g - clipped).abs() < 0.01, "{clipped} {srgb:?}");
            assert!((f32::from(linear.0[1]) / 255.0 - clipped).abs() < 0.005, "{clipped} {linear:?}");
            seen += usize::from(clipped < 1.0 && clipped > 0.0);
        }
        assert!(seen > 100);
        assert_eq!(manifest["engines"]["three.js"]["lightMapIntensity_of_exr"], 0.125);
        assert_eq!(manifest["files"]["exr"], "a.exr");
        assert_eq!(manifest["objects"].as_array().unwrap().len(), 6);
        for object in manifest["objects"].as_array().unwrap() {
            assert!(object["texels"].as_u64().unwrap() > 10 && object["charts"].as_u64().unwrap() >= 1, "{object}");
        }
    });
}

/// The scene in the bytes of a `.glb`.
fn read(bytes: &[u8]) -> Scene {
    let importer = import::FORMATS.iter().find(|format| format.extensions.contains(&"glb")).unwrap();
    (importer.read)(Path::new("a.glb"), bytes, &ImportOptions::default()).unwrap()
}

#[test]
fn what_was_baked_once_keeps_its_coordinates() {
    with_baked(Carrier::Sidecar, |baked, _| {
        let scene = read(&glb::write(baked).unwrap());
        assert_eq!(scene.lightmap_uvs.len(), scene.vertices.len());
        let problem = Problem::new(scene, isolux_core::mesh::Resolution::Elements(200)).unwrap();
        let solution = Solution {
            irradiance: vec![Rgb::WHITE; problem.mesh.len()],
            std_error: vec![Rgb::BLACK; problem.mesh.len()],
            ..Solution::default()
        };
        let lit = LitScene::new(&problem, &solution);
        let again = bake(&problem, lit.field(), &layout()).unwrap();
        assert_eq!(again.atlas.origin, Origin::File);
        let bits = |lightmap: &Lightmap| {
            let corners = lightmap.atlas.uv.iter().flatten();
            let mut bits: Vec<[u32; 2]> = corners.map(|uv| uv.to_array().map(f32::to_bits)).collect();
            bits.sort_unstable();
            bits.dedup();
            bits
        };
        assert_eq!(bits(&again), bits(&baked.lightmap));
    });
}

#[test]
fn every_format_and_carrier_writes_the_same_bytes_each_time() {
    for carrier in Carrier::ALL {
        let all = || {
            with_baked(carrier, |baked, _| {
                FORMATS.iter().map(|format| (format.write)(baked).unwrap()).collect::<Vec<_>>()
            })
        };
        assert!(all() == all(), "{}", carrier.name());
    }
    let message = for_path(Path::new("a.obj")).unwrap_err().to_string();
    assert!(message.contains(".glb, .exr, .png, .json"), "{message}");
}

#[test]
fn coordinates_of_a_texture_are_not_taken_for_a_lightmaps() {
    let scene = read(&scene_glb::write(&fixture::scene()).unwrap());
    assert!(scene.lightmap_uvs.is_empty() && scene.remarks.iter().all(|remark| !remark.contains("TEXCOORD")));
}
