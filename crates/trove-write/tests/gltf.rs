//! glTF files as other programs see them.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DMat4, DQuat, DVec3, Vec2, Vec3};
use gltf_json::validation::Validate;
use serde_json::Value;
use trove_model::{
    Class, ColorSpace, Cuboid, Distortion, Environment, EnvironmentMap, Instance, InstanceId, Kind, Lens, Light,
    Material, Mesh, Origin, PhysicalSky, Pose, Provenance, Scene, SceneObject, Shot, Texture,
};
use trove_write::gltf::{GlbStats, SunLight, write_environment, write_glb};

fn square() -> Mesh {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
    Mesh {
        normals: vec![Vec3::Z; 4],
        uvs: positions.iter().map(|p| p.truncate()).collect(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        slots: vec![0, 1],
        positions,
        ..Mesh::default()
    }
}

fn texture(name: &str, alpha: u8) -> Arc<Texture> {
    let rgba = vec![[255, 0, 0, 255], [0, 255, 0, alpha]];
    Arc::new(Texture { name: name.into(), width: 2, height: 1, rgba, color_space: ColorSpace::Srgb })
}

fn instance(id: u32, class: Class, mesh: usize, materials: &[usize], world_from_mesh: DAffine3) -> Instance {
    let object = SceneObject {
        kind: Kind::Car,
        origin: Origin::Recorded {
            track_token: "track".into(),
            annotation_token: "annotation".into(),
            category: "vehicle.car".into(),
        },
        asset: Some("car/sedan".into()),
        cuboid: Cuboid { world_from_body: Pose::IDENTITY, size_m: DVec3::ONE },
        velocity_mps: None,
        yaw_rate_radps: None,
        states: Vec::new(),
        paint: None,
        keypoints_world: None,
    };
    Instance {
        id: InstanceId(id),
        class,
        mesh,
        materials: materials.to_vec(),
        world_from_mesh,
        previous: None,
        next: None,
        object: (id > 0).then(|| Arc::new(object)),
    }
}

/// A ground, the same car twice in one colour and once in another, and a mesh without triangles.
fn scene() -> Scene {
    let asphalt = Material {
        base_color_map: Some(texture("asphalt", 255)),
        normal_map: Some(texture("asphalt.normal", 255)),
        uv_scale: Vec2::new(0.5, 0.25),
        ..Material::plain("asphalt", Vec3::ONE, 0.9)
    };
    let leaves = Material {
        base_color_map: Some(texture("leaves", 0)),
        alpha_cutoff: 0.5,
        ..Material::plain("leaves", Vec3::ONE, 0.9)
    };
    let lamp = Material {
        emission: Vec3::new(4.0, 2.0, 0.0),
        coat: 1.0,
        transmission: 0.5,
        sheen: 0.5,
        translucency: 0.3,
        dirt: 0.25,
        base_color_map: Some(texture("asphalt", 255)),
        ..Material::default()
    };
    let at = |x: f64| {
        DAffine3::from_scale_rotation_translation(
            DVec3::splat(2.0),
            DQuat::from_rotation_z(1.0),
            DVec3::new(x, 5.0, 1.0),
        )
    };
    let sky = PhysicalSky {
        to_sun: DVec3::Z,
        moon: None,
        turbidity: 3.0,
        ground_albedo: 0.2,
        cloud_cover: 0.0,
        cloud_seed: 0,
    };
    Scene {
        meshes: vec![Arc::new(square()), Arc::new(square()), Arc::new(Mesh::default())],
        materials: vec![asphalt, leaves, lamp],
        instances: vec![
            instance(0, Class::Road, 0, &[0, 1], DAffine3::IDENTITY),
            instance(7, Class::Car, 1, &[1, 2], at(1.0)),
            instance(8, Class::Car, 1, &[1, 2], at(2.0)),
            instance(9, Class::Car, 1, &[0, 2], at(3.0)),
            instance(0, Class::Ground, 2, &[0], DAffine3::IDENTITY),
        ],
        others: Default::default(),
        keyframes_apart_s: [0.5; 2],
        light: Light::clear(Environment::Sky(sky)),
        provenance: vec![Provenance { source: "made up".into(), licence: "MIT".into() }],
    }
}

fn shot() -> Shot {
    let lens = Lens {
        width_px: 1600,
        height_px: 900,
        fx_px: 1250.0,
        fy_px: 1250.0,
        cx_px: 816.0,
        cy_px: 491.0,
        distortion: Distortion::None,
    };
    Shot {
        carrier: Some(InstanceId(7)),
        ..Shot::new("ego.CAM_FRONT", lens, Pose::from_yaw(0.0, DVec3::new(1.0, 2.0, 3.0)))
    }
}

fn sun() -> SunLight {
    let to_sun = DVec3::new(0.0, 0.6, 0.8);
    SunLight { to_sun, irradiance: Vec3::new(2.0, 1.5, 1.0), radius_rad: 0.004_66 }
}

fn write(scene: &Scene) -> (GlbStats, Vec<u8>) {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("scene.glb");
    let stats = write_glb(&path, scene, &[shot()], Some(&sun())).unwrap();
    (stats, fs::read(path).unwrap())
}

/// The JSON chunk and the binary chunk.
fn chunks(bytes: &[u8]) -> (&[u8], &[u8]) {
    let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&bytes[..4], number(4), number(8)), (&b"glTF"[..], 2, bytes.len()));
    let json_end = 20 + number(12);
    assert_eq!((&bytes[16..20], &bytes[json_end + 4..json_end + 8]), (&b"JSON"[..], &b"BIN\0"[..]));
    assert_eq!(json_end + 8 + number(json_end), bytes.len());
    (&bytes[20..json_end], &bytes[json_end + 8..])
}

#[test]
fn the_file_is_sound_gltf() {
    let (stats, bytes) = write(&scene());
    let (json, binary) = chunks(&bytes);
    let root = gltf_json::Root::from_slice(json).unwrap();
    let mut errors = Vec::new();
    root.validate(&root, gltf_json::Path::new, &mut |path, error| errors.push(format!("{}: {error}", path())));
    assert_eq!(errors, Vec::<String>::new());
    for view in &root.buffer_views {
        let start = view.byte_offset.unwrap_or_default().0 as usize;
        assert!(start.is_multiple_of(4) && start + view.byte_length.0 as usize <= binary.len());
    }
    let expected =
        GlbStats { meshes: 3, instances: 4, materials: 3, images: 3, triangles: 8, bytes: bytes.len() as u64 };
    assert_eq!(stats, expected);
}

#[test]
fn shapes_are_stored_once_and_nodes_carry_what_they_are() {
    let (_, bytes) = write(&scene());
    let (json, binary) = chunks(&bytes);
    let root: Value = serde_json::from_slice(json).unwrap();
    let position = |mesh: usize| root["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"].as_u64().unwrap();
    assert_eq!(position(1), position(2), "two colours share a shape");
    assert_ne!(position(0), position(1));
    assert_eq!(root["meshes"][1]["primitives"].as_array().unwrap().len(), 2, "one primitive a slot");
    assert_eq!((&root["nodes"][2]["mesh"], &root["nodes"][3]["mesh"]), (&1.into(), &1.into()));
    let extras = &root["nodes"][2]["extras"];
    assert_eq!((&extras["class"], &extras["id"], &extras["asset"]), (&"car".into(), &7.into(), &"car/sedan".into()));
    assert_eq!(root["asset"]["copyright"], "made up: MIT");

    // The texture coordinate of the third vertex, (1, 1) with v up, is (1, 0) with v down.
    let accessor = root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"].as_u64().unwrap() as usize;
    let view = root["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize;
    let start = root["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize + 2 * 8;
    let float = |at: usize| f32::from_le_bytes(binary[at..at + 4].try_into().unwrap());
    assert_eq!((float(start), float(start + 4)), (1.0, 0.0));

    // World's up becomes glTF's up.
    let turn: Vec<f64> = root["nodes"][0]["rotation"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    let up = DQuat::from_xyzw(turn[0], turn[1], turn[2], turn[3]) * DVec3::Z;
    assert!((up - DVec3::Y).length() < 1e-12);
    let matrix: Vec<f64> = root["nodes"][2]["matrix"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    assert_eq!(matrix[12..], [1.0, 5.0, 1.0, 1.0]);
}

#[test]
fn camera_and_sun_point_where_they_should() {
    let (_, bytes) = write(&scene());
    let root: Value = serde_json::from_slice(chunks(&bytes).0).unwrap();
    let node = |name: &str| root["nodes"].as_array().unwrap().iter().find(|n| n["name"] == name).unwrap();
    let numbers = |v: &Value| v.as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect::<Vec<_>>();
    let camera = node("ego.CAM_FRONT");
    let world_from_node = DMat4::from_cols_slice(&numbers(&camera["matrix"]));
    let (forward, up) = (world_from_node.transform_vector3(-DVec3::Z), world_from_node.transform_vector3(DVec3::Y));
    assert_eq!((forward, up), (DVec3::Z, -DVec3::Y), "this camera's axes are World's: it looks up");
    assert_eq!((&camera["extras"]["cx_px"], &camera["extras"]["carrier"]), (&816.0.into(), &7.into()));
    let fov = root["cameras"][0]["perspective"]["yfov"].as_f64().unwrap();
    assert!((fov - 2.0 * (450.0f64 / 1250.0).atan()).abs() < 1e-12);
    let turn = numbers(&node("sun")["rotation"]);
    let to_sun = DQuat::from_xyzw(turn[0], turn[1], turn[2], turn[3]) * DVec3::Z;
    assert!((to_sun - sun().to_sun).length() < 1e-12);
    let light = &root["extensions"]["KHR_lights_punctual"]["lights"][0];
    assert_eq!((&light["color"][1], &light["intensity"]), (&0.75.into(), &1366.0.into()));
    assert_eq!(root["nodes"][0]["children"].as_array().unwrap().len(), 6, "four instances, the camera and the sun");
}

#[test]
fn a_sky_s_rows_come_back_from_its_file() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("sky.exr");
    let rgb = vec![[1.0, 0.5, 0.25], [2.0, 0.0, 1e4]];
    write_environment(&path, &EnvironmentMap { name: "sky".into(), width: 2, height: 1, rgb }).unwrap();
    let image = exr::prelude::read_first_flat_layer_from_file(&path).unwrap();
    let planes: Vec<Vec<f32>> =
        image.layer_data.channel_data.list.iter().map(|c| c.sample_data.values_as_f32().collect()).collect();
    assert_eq!(planes, [[0.25, 1e4], [0.5, 0.0], [1.0, 2.0]], "B, G, R");
}

#[test]
fn materials_keep_what_gltf_can_say() {
    let (_, bytes) = write(&scene());
    let root: Value = serde_json::from_slice(chunks(&bytes).0).unwrap();
    let transform =
        &root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"];
    assert_eq!(transform["scale"], serde_json::json!([0.5, 0.25]));
    assert_eq!(transform["offset"], serde_json::json!([0.0, 0.75]));
    assert_eq!(root["materials"][1]["alphaMode"], "MASK");
    let lamp = &root["materials"][2];
    assert_eq!(lamp["emissiveFactor"], serde_json::json!([1.0, 0.5, 0.0]));
    assert_eq!(lamp["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"], 4.0);
    assert_eq!(lamp["extensions"]["KHR_materials_clearcoat"]["clearcoatFactor"], 1.0);
    assert_eq!(lamp["extensions"]["KHR_materials_transmission"]["transmissionFactor"], 0.5);
    assert_eq!(lamp["extensions"]["KHR_materials_sheen"]["sheenColorFactor"], serde_json::json!([0.375, 0.375, 0.375]));
    let behind = &lamp["extensions"]["KHR_materials_diffuse_transmission"];
    assert!((behind["diffuseTransmissionFactor"].as_f64().unwrap() - 0.3).abs() < 1e-6);
    assert_eq!(behind["diffuseTransmissionColorTexture"], lamp["pbrMetallicRoughness"]["baseColorTexture"]);
    assert_eq!(lamp["extras"]["dirt"], 0.25);
    let used: Vec<&str> = root["extensionsUsed"].as_array().unwrap().iter().map(|v| v.as_str().unwrap()).collect();
    assert!(used.is_sorted() && used.contains(&"KHR_texture_transform"));
    assert_eq!(root["images"].as_array().unwrap().len(), 3, "the same picture is embedded once");
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    assert_eq!(write(&scene()).1, write(&scene()).1);
}

#[test]
fn an_empty_scene_is_a_sound_file_and_a_defective_one_an_error() {
    let empty = Scene { meshes: vec![], materials: vec![], instances: vec![], ..scene() };
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("scene.glb");
    assert_eq!(write_glb(&path, &empty, &[], None).unwrap().instances, 0);
    let text = String::from_utf8_lossy(&fs::read(&path).unwrap()).into_owned();
    assert!(!text.contains("[]"), "glTF forbids empty lists: {text}");
    let refused = |change: fn(&mut Scene), path: &Path| {
        let mut scene = scene();
        change(&mut scene);
        write_glb(path, &scene, &[], None).unwrap_err().to_string()
    };
    assert!(refused(|s| s.instances[0].materials.clear(), &path).contains("no material for slot 0 of a road"));
    assert!(refused(|s| s.instances[1].mesh = 99, &path).contains("no mesh 99"));
    let dangling = |s: &mut Scene| s.meshes[0] = Arc::new(Mesh { triangles: vec![[0, 1, 9]; 2], ..square() });
    assert!(refused(dangling, &path).contains("index 9"));
    assert!(refused(|s| s.instances[0].world_from_mesh.translation.x = f64::NAN, &path).contains("not finite"));
}
