//! What formats say comes out as it is meant.

use glam::vec3;
use serde_json::json;
use trove_model::{Class, Kind, Mesh};

use crate::files::{Folder, Glb, asset, fbx, obj};

const CAR: [f32; 3] = [1.8, 1.5, 4.5];

fn volume(mesh: &Mesh) -> f32 {
    let corner = |i: u32| mesh.positions[i as usize];
    mesh.triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2])))).sum::<f32>() / 6.0
}

#[test]
fn a_glb_stands_on_the_ground_and_looks_forward() {
    let car = asset("red_sedan.glb", &Glb::cuboid(CAR).bytes());
    assert_eq!((car.id.as_str(), car.kind, car.class), ("mine/red_sedan", Kind::Car, Class::Car));
    assert!((car.size_m.as_vec3() - vec3(4.5, 1.8, 1.5)).length() < 1e-4, "{}", car.size_m);
    let (low, high) = car.mesh.bounds().unwrap();
    assert!(low.z.abs() < 1e-5 && (low + high).truncate().length() < 1e-4);
    assert!((volume(&car.mesh) - 4.5 * 1.8 * 1.5).abs() < 1e-2);
    assert_eq!(car.mesh.defect(), None);
}

#[test]
fn mirrored_and_stretched_nodes_keep_their_outside_outside() {
    let mut glb = Glb::cuboid([0.9, 0.5, 1.5]);
    glb.json["nodes"] = json!([
        {"children": [1], "scale": [-2.0, 3.0, 1.0]},
        {"mesh": 0, "scale": [1.0, 1.0, 3.0], "translation": [5.0, 1.0, 0.0]}
    ]);
    let car = asset("car.glb", &glb.bytes());
    assert!((volume(&car.mesh) - 4.5 * 1.8 * 1.5).abs() < 1e-2, "{}", volume(&car.mesh));
    for (position, normal) in car.mesh.positions.iter().zip(&car.mesh.normals) {
        assert!((*position - vec3(0.0, 0.0, 0.75)).dot(*normal) > 0.0);
    }
}

#[test]
fn fbx_comes_in_its_unit_and_obj_by_its_proportions() {
    let car = asset("hatchback.fbx", fbx().as_bytes());
    assert!((car.size_m.as_vec3() - vec3(4.5, 1.8, 1.5)).length() < 1e-3, "{}", car.size_m);
    assert!(volume(&car.mesh) > 0.0);
    assert!((car.slots[0].material.base_color - vec3(0.8, 0.1, 0.1)).length() < 1e-3);
    let (text, materials) = obj();
    let folder = Folder::new(&[("car.obj", text.as_bytes()), ("car.mtl", materials.as_bytes())]);
    let (library, report) = folder.read();
    let car = library.expect(&report).assets.remove(0);
    assert!((car.size_m.as_vec3() - vec3(4.5, 1.8, 1.5)).length() < 1e-3, "{} {report}", car.size_m);
    assert!(volume(&car.mesh) > 0.0);
    let glass = car.slots.iter().find(|s| s.material.name == "Glass").unwrap();
    assert!((glass.material.transmission - 0.7).abs() < 1e-3);
    let paint = car.slots.iter().find(|s| s.material.name == "Paint").unwrap();
    assert!((paint.material.base_color - vec3(0.1, 0.2, 0.8)).length() < 1e-3);
}

#[test]
fn materials_mean_what_their_extensions_say() {
    let glb = Glb::cuboid(CAR).material(json!({
        "name": "paint", "emissiveFactor": [1.0, 0.5, 0.0],
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.1, 1.0], "metallicFactor": 0.25, "roughnessFactor": 0.3},
        "extensions": {
            "KHR_materials_emissive_strength": {"emissiveStrength": 10.0}, "KHR_materials_ior": {"ior": 1.3},
            "KHR_materials_clearcoat": {"clearcoatFactor": 0.9}, "KHR_materials_transmission": {"transmissionFactor": 0.4}
        }
    }));
    let material = asset("car.glb", &glb.bytes()).slots.remove(0).material;
    assert_eq!((material.metalness, material.roughness, material.ior), (0.25, 0.3, 1.3));
    assert_eq!((material.coat, material.transmission), (0.9, 0.4));
    assert_eq!(material.base_color, vec3(0.5, 0.25, 0.1));
    assert!((material.emission - vec3(3.0, 1.5, 0.0)).length() < 1e-5);
    let glb = Glb::cuboid(CAR).material(json!({"extensions": {"KHR_materials_pbrSpecularGlossiness": {
        "diffuseFactor": [0.6, 0.1, 0.1, 1.0], "specularFactor": [0.04, 0.04, 0.04], "glossinessFactor": 0.7
    }}}));
    let material = asset("car.glb", &glb.bytes()).slots.remove(0).material;
    assert!((material.base_color - vec3(0.6, 0.1, 0.1)).length() < 0.03 && material.metalness < 0.01);
    assert!((material.roughness - 0.3).abs() < 1e-5);
}

#[test]
fn what_of_a_material_is_not_rendered_is_told() {
    let told = |extensions: serde_json::Value| {
        let glb = Glb::cuboid(CAR).material(json!({"name": "paint", "extensions": extensions}));
        let (library, report) = Folder::new(&[("car.glb", &glb.bytes())]).read();
        library.expect(&report);
        report.contains("paint: anisotropy, dispersion") as usize + report.contains("is not rendered") as usize
    };
    let some = json!({"KHR_materials_anisotropy": {"anisotropyStrength": 0.4}, "KHR_materials_dispersion": {"dispersion": 2.0}});
    assert_eq!(told(some), 2);
    let none = json!({"KHR_materials_anisotropy": {"anisotropyStrength": 0.0},
        "KHR_materials_specular": {"specularColorFactor": [1.0, 1.0, 1.0]}});
    assert_eq!(told(none), 0);
}

#[test]
fn alpha_is_a_cut_out_or_a_pane() {
    let of = |alpha: &dyn Fn(u32) -> u8, mode: &str, factor: f32| {
        let mut glb = Glb::cuboid(CAR);
        let texture = glb.texture(8, 8, |x, _| [200, 200, 200, alpha(x)]);
        let glb = glb.material(json!({"alphaMode": mode, "alphaCutoff": 0.3, "pbrMetallicRoughness":
            {"metallicFactor": 0, "baseColorFactor": [1, 1, 1, factor], "baseColorTexture": {"index": texture}}}));
        let material = asset("car.glb", &glb.bytes()).slots.remove(0).material;
        (material.alpha_cutoff, (material.transmission * 100.0).round() / 100.0)
    };
    let half = |x: u32| if x < 4 { 0 } else { 255 };
    assert_eq!(of(&half, "MASK", 1.0), (0.3, 0.0));
    assert_eq!(of(&half, "BLEND", 1.0), (0.5, 0.0));
    assert_eq!(of(&half, "OPAQUE", 1.0), (0.0, 0.0));
    assert_eq!(of(&|_| 255, "BLEND", 0.25), (0.0, 0.75));
    assert_eq!(of(&|_| 51, "BLEND", 1.0), (0.0, 0.8));
}

#[test]
fn texture_coordinates_are_transformed_and_turned_upright() {
    let mut glb = Glb::cuboid(CAR);
    let texture = glb.texture(4, 4, |x, y| [x as u8 * 60, y as u8 * 60, 0, 255]);
    let glb = glb.material(json!({"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorTexture": {"index": texture,
        "extensions": {"KHR_texture_transform": {"offset": [0.25, 0.5], "scale": [2.0, 0.5]}}}}}));
    let mesh = asset("car.glb", &glb.bytes()).mesh;
    // Vertex 4 of the box has (0.25, 0.5): (0.25, 0.5) · (2, 0.5) + (0.25, 0.5), then v turned over.
    assert!(mesh.uvs.iter().any(|uv| (*uv - glam::vec2(0.75, 0.25)).length() < 1e-5), "{:?}", mesh.uvs);
}

#[test]
fn skins_and_morphs_are_posed_by_the_first_frame() {
    let mut glb = Glb::cuboid([0.4, 1.75, 0.3]);
    // Both joints push the box by a metre along x in the animation's first frame; a morph doubles its height.
    let joints = glb.view(&[0u8, 1, 0, 0].repeat(8));
    let joints = glb.accessor(json!({"bufferView": joints, "componentType": 5121, "count": 8, "type": "VEC4"}));
    let weights = glb.floats(&[0.5, 0.5, 0.0, 0.0].repeat(8), "VEC4");
    let lift: Vec<f32> = (0..8).flat_map(|i| [0.0, if i & 2 > 0 { 1.75 } else { 0.0 }, 0.0]).collect();
    let lift = glb.floats(&lift, "VEC3");
    let times = glb.floats(&[0.0, 1.0], "SCALAR");
    let moves = glb.floats(&[2.0, 0.0, 0.0, 9.0, 9.0, 9.0], "VEC3");
    let scale = glb.floats(&[0.5, 0.5, 0.5, 9.0, 9.0, 9.0], "VEC3");
    glb.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(joints);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(weights);
    glb.json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": lift}]);
    glb.json["meshes"][0]["weights"] = json!([1.0]);
    glb.json["nodes"] = json!([{"mesh": 0, "skin": 0, "translation": [50, 50, 50]}, {"name": "a"}, {"name": "b"}]);
    glb.json["scenes"][0]["nodes"] = json!([0, 1, 2]);
    glb.json["skins"] = json!([{"joints": [1, 2]}]);
    let channel =
        |sampler: usize, node: usize, path: &str| json!({"sampler": sampler, "target": {"node": node, "path": path}});
    glb.json["animations"] = json!([{"channels": [channel(0, 1, "translation"), channel(1, 1, "scale"), channel(1, 2, "scale")],
        "samplers": [{"input": times, "output": moves}, {"input": times, "output": scale}]}]);
    let person = asset("person.glb", &glb.bytes());
    // 1.75 m, twice by the morph, half by the joints.
    assert!((person.size_m.z - 1.75).abs() < 1e-4, "{}", person.size_m);
    assert!(person.figure.is_some());
}

#[test]
fn sparse_accessors_and_vertex_colours_are_read() {
    let mut glb = Glb::cuboid(CAR);
    let index = glb.view(&[7u8, 0, 0, 0]);
    let value = glb.view(&[0.9f32, 1.6, 2.25].iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>());
    glb.json["accessors"][0]["sparse"] = json!({"count": 1, "indices": {"bufferView": index, "componentType": 5121},
        "values": {"bufferView": value}});
    let colors = glb.floats(&[0.5, 0.25, 0.125].repeat(8), "VEC3");
    glb.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    let car = asset("car.glb", &glb.bytes());
    assert!((car.size_m.z / car.size_m.x - 1.6 / 4.5).abs() < 1e-4, "{}", car.size_m);
    assert!(car.mesh.tints.iter().all(|t| *t == vec3(0.5, 0.25, 0.125)));
}

#[test]
fn lamps_of_an_emission_map_shine_and_the_rest_does_not() {
    let mut glb = Glb::cuboid(CAR);
    let texture = glb.texture(8, 8, |x, _| if x < 4 { [0, 0, 0, 255] } else { [255; 4] });
    let glb = glb.material(json!({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": texture},
        "pbrMetallicRoughness": {"metallicFactor": 0}}));
    let car = asset("car.glb", &glb.bytes());
    let [paint] = &car.slots[..] else { panic!("{} slots", car.slots.len()) };
    let map = paint.material.emission_map.as_ref().unwrap();
    assert!(paint.material.is_emitter() && map.rgba[0] == [0, 0, 0, 255] && map.rgba[7] == [255; 4]);
    assert_eq!(car.mesh.triangles.len(), 12);
}

#[test]
fn a_part_of_a_file_is_an_asset_of_its_own() {
    let mut glb = Glb::cuboid(CAR);
    glb.json["nodes"] = json!([{"name": "both", "children": [1, 2]}, {"name": "near", "mesh": 0},
        {"name": "far", "mesh": 0, "translation": [40.0, 0.0, 0.0]}]);
    let folder = Folder::new(&[
        ("cars.glb", &glb.bytes()),
        ("library.toml", b"[[asset]]\nfile = \"cars.glb\"\npart = \"far\"\nkind = \"car\"\n"),
    ]);
    let (library, report) = folder.read();
    let library = library.expect(&report);
    assert_eq!(library.assets[0].id, "mine/cars-far");
    assert!((library.assets[0].size_m.x - 4.5).abs() < 1e-3);
}
