//! Geometry packed with meshopt and Draco comes out as it was, and damaged it is refused.

use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, Mesh, MeshEncoder, PointAttribute,
    PointIndex,
};
use glam::vec3;
use serde_json::json;

use crate::files::{Folder, Glb, asset};

/// The box's own numbers, as they stand in its views.
fn unpacked(glb: &Glb) -> (Vec<[f32; 3]>, Vec<u32>) {
    let word = |i: usize| [glb.bin[4 * i], glb.bin[4 * i + 1], glb.bin[4 * i + 2], glb.bin[4 * i + 3]];
    let positions = (0..8).map(|v| [0, 1, 2].map(|k| f32::from_le_bytes(word(3 * v + k)))).collect();
    (positions, (24..60).map(|i| u32::from_le_bytes(word(i))).collect())
}

fn meshopt_car() -> (Glb, [usize; 2]) {
    let mut glb = Glb::cuboid([1.8, 1.5, 4.5]);
    let (positions, indices) = unpacked(&glb);
    let packed = [
        (meshopt::encode_vertex_buffer(&positions).unwrap(), 12, 8, "ATTRIBUTES"),
        (meshopt::encode_index_buffer(&indices, 8).unwrap(), 4, 36, "TRIANGLES"),
    ];
    glb.bin.clear();
    let mut places = [0; 2];
    for (i, (bytes, stride, count, mode)) in packed.into_iter().enumerate() {
        places[i] = glb.bin.len();
        glb.json["bufferViews"][i] = json!({"buffer": 1, "byteLength": stride * count, "extensions":
            {"EXT_meshopt_compression": {"buffer": 0, "byteOffset": glb.bin.len(), "byteLength": bytes.len(),
            "byteStride": stride, "count": count, "mode": mode}}});
        glb.bin.extend(bytes);
        glb.bin.resize(glb.bin.len().next_multiple_of(4), 0);
    }
    glb.json["extensionsRequired"] = json!(["EXT_meshopt_compression"]);
    (glb, places)
}

fn draco_car() -> Glb {
    let mut glb = Glb::cuboid([1.8, 1.5, 4.5]);
    let (positions, indices) = unpacked(&glb);
    let mut mesh = Mesh::new();
    let mut attribute = PointAttribute::new();
    attribute.init(GeometryAttributeType::Position, 3, DataType::Float32, false, 8);
    for (i, position) in positions.iter().enumerate() {
        let bytes: Vec<u8> = position.iter().flat_map(|v| v.to_le_bytes()).collect();
        attribute.buffer_mut().write(i * 12, &bytes);
    }
    mesh.add_attribute(attribute);
    mesh.set_num_faces(12);
    for (i, t) in indices.chunks_exact(3).enumerate() {
        mesh.set_face(FaceIndex(i as u32), [PointIndex(t[0]), PointIndex(t[1]), PointIndex(t[2])]);
    }
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(mesh);
    let mut packed = EncoderBuffer::new();
    encoder.encode(&EncoderOptions::new(), &mut packed).unwrap();
    glb.bin.clear();
    glb.json["bufferViews"] = json!([]);
    let view = glb.view(packed.data());
    glb.json["accessors"] = json!([{"componentType": 5126, "count": 8, "type": "VEC3"}, {"componentType": 5125, "count": 36, "type": "SCALAR"}]);
    glb.json["meshes"][0]["primitives"][0]["extensions"] =
        json!({"KHR_draco_mesh_compression": {"bufferView": view, "attributes": {"POSITION": 0}}});
    glb.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    glb
}

#[test]
fn packed_geometry_is_unpacked() {
    for glb in [meshopt_car().0, draco_car()] {
        let car = asset("car.glb", &glb.bytes());
        assert!((car.size_m.as_vec3() - vec3(4.5, 1.8, 1.5)).length() < 0.01, "{}", car.size_m);
        assert_eq!(car.mesh.triangles.len(), 12);
    }
}

#[test]
fn damaged_packed_geometry_is_refused() {
    for which in 0..2 {
        let length = if which == 0 { meshopt_car().0.bin.len() } else { draco_car().bin.len() };
        for at in 0..length {
            let mut glb = if which == 0 { meshopt_car().0 } else { draco_car() };
            glb.bin[at] ^= 0x55;
            let (library, report) = Folder::new(&[("car.glb", &glb.bytes())]).read();
            assert!(library.is_some_and(|l| !l.assets.is_empty()) || report.contains("car.glb"), "{at}: {report}");
        }
    }
}
