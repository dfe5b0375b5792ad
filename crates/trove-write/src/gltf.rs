//! A scene as glTF 2.0 binary, which Blender and every viewer open.
//!
//! One glTF mesh a scene mesh and set of materials, one node an instance, below a root node that turns World's z-up
//! into glTF's y-up. A node's extras hold class, id, kind, asset, track and box. The sky is left out, because glTF has no
//! word for it: [`write_environment`] puts it into a file of its own.

mod binary;
mod cameras;
mod geometry;
mod materials;

use std::collections::BTreeMap;
use std::path::Path;

use glam::DAffine3;
use serde_json::{Value, json};
use trove_model::{EnvironmentMap, Instance, Origin, Raster, Scene, Shot};

use crate::{WriteError, exr_file, write_atomically};
use binary::Binary;
use geometry::Geometry;
use materials::Materials;

pub use cameras::SunLight;

/// What a file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GlbStats {
    /// glTF meshes: scene meshes times the sets of materials that they are seen in.
    pub meshes: usize,
    /// Nodes that stand for instances.
    pub instances: usize,
    /// Materials.
    pub materials: usize,
    /// Embedded pictures.
    pub images: usize,
    /// Triangles on the screen: a mesh counts as often as it is placed.
    pub triangles: u64,
    /// Length of the file.
    pub bytes: u64,
}

/// Writes the picture of a sky as OpenEXR, in the rows and columns of [`EnvironmentMap`], which are those of Blender's
/// environment texture too.
///
/// # Errors
/// A map that does not have as many values as pixels, or a file system that refuses.
pub fn write_environment(path: &Path, map: &EnvironmentMap) -> Result<(), WriteError> {
    let raster = Raster { width: map.width, height: map.height, data: map.rgb.clone() };
    write_atomically(path, &exr_file::encode(&file_name(path), &raster, ["R", "G", "B"])?)
}

/// Writes a scene with its cameras and its sun into one file, whole or not at all.
///
/// # Errors
/// A mesh with a defect, a placement that is not finite, a texture that cannot be encoded, or a file system that refuses.
pub fn write_glb(path: &Path, scene: &Scene, shots: &[Shot], sun: Option<&SunLight>) -> Result<GlbStats, WriteError> {
    let mut binary = Binary::default();
    let materials = Materials::encode(scene, &mut binary)?;
    let mut geometry = Geometry::new(scene, &mut binary);
    // Meshes are told apart by their shape and the materials of their slots.
    let mut mesh_of: BTreeMap<(usize, &[usize]), Option<usize>> = BTreeMap::new();
    let mut meshes = Vec::new();
    let mut nodes = vec![Value::Null];
    let mut triangles = 0;
    for instance in &scene.instances {
        let key = (instance.mesh, instance.materials.as_slice());
        let mesh = match mesh_of.get(&key) {
            Some(&mesh) => mesh,
            None => {
                let encoded = geometry.mesh(instance)?;
                let index = encoded.map(|mesh| {
                    meshes.push(mesh);
                    meshes.len() - 1
                });
                mesh_of.insert(key, index);
                index
            }
        };
        let Some(mesh) = mesh else { continue };
        triangles += scene.meshes[instance.mesh].triangles.len() as u64;
        nodes.push(node(instance, mesh)?);
    }
    let accessors = geometry.finish();
    let instances = nodes.len() - 1;
    let (cameras, camera_nodes): (Vec<_>, Vec<_>) =
        shots.iter().enumerate().map(|(i, shot)| cameras::camera(shot, i)).unzip();
    nodes.extend(camera_nodes);
    let (lights, light_nodes): (Vec<_>, Vec<_>) = sun.map(cameras::sun).into_iter().unzip();
    nodes.extend(light_nodes);
    let mut extensions = materials.extensions;
    if !lights.is_empty() {
        extensions.insert("KHR_lights_punctual");
    }
    let half_turn = std::f64::consts::FRAC_1_SQRT_2;
    nodes[0] = json!({ "name": "world (x east, y north, z up)", "rotation": [-half_turn, 0.0, 0.0, half_turn] });
    if nodes.len() > 1 {
        nodes[0]["children"] = (1..nodes.len()).collect();
    }

    let stats = GlbStats {
        meshes: meshes.len(),
        instances,
        materials: materials.materials.len(),
        images: materials.images.len(),
        triangles,
        bytes: 0,
    };
    let licences: Vec<String> = scene.provenance.iter().map(|p| format!("{}: {}", p.source, p.licence)).collect();
    let mut root = json!({
        "asset": { "version": "2.0", "generator": concat!("TRoVE ", env!("CARGO_PKG_VERSION")), "copyright": licences.join("; ") },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": nodes,
        "cameras": cameras,
        "meshes": meshes,
        "accessors": accessors,
        "materials": materials.materials,
        "textures": materials.textures,
        "images": materials.images,
        "samplers": if materials.textures.is_empty() { json!([]) } else { json!([{ "magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497 }]) },
        "extensionsUsed": extensions,
        "bufferViews": binary.views,
        "buffers": [{ "byteLength": binary.bytes.len() }],
    });
    if !lights.is_empty() {
        root["extensions"]["KHR_lights_punctual"]["lights"] = lights.into();
    }
    // glTF forbids empty lists, and a buffer of nothing.
    if let Some(fields) = root.as_object_mut() {
        fields.retain(|_, value| value.as_array().is_none_or(|list| !list.is_empty()));
        if binary.bytes.is_empty() {
            fields.remove("buffers");
        }
    }
    let bytes = container(&root.to_string(), &binary.bytes).ok_or_else(|| WriteError::Encoding {
        name: file_name(path),
        found: "over 4 GiB, the format's limit".into(),
    })?;
    write_atomically(path, &bytes)?;
    Ok(GlbStats { bytes: bytes.len() as u64, ..stats })
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn node(instance: &Instance, mesh: usize) -> Result<Value, WriteError> {
    let class = instance.class.row();
    let mut extras = json!({ "class": class.name, "class_id": instance.class.id(), "id": instance.id.0 });
    let mut name = class.name.to_owned();
    if let Some(object) = &instance.object {
        name = format!("{name} {}", instance.id.0);
        extras["kind"] = object.kind.name().into();
        extras["origin"] = object.origin.name().into();
        extras["size_m"] = json!(object.cuboid.size_m.to_array());
        let world_from_body = glam::DMat4::from(object.cuboid.world_from_body.affine());
        extras["world_from_body"] = json!(world_from_body.transpose().to_cols_array_2d());
        if let Some(asset) = &object.asset {
            extras["asset"] = asset.as_str().into();
        }
        if let Origin::Recorded { category, track_token, .. } = &object.origin {
            extras["category"] = category.as_str().into();
            extras["track_token"] = track_token.as_str().into();
        }
    }
    let placement = instance.world_from_mesh;
    if !placement.is_finite() {
        return Err(WriteError::Mismatch(format!("{name} placed by a number that is not finite")));
    }
    let mut node = json!({ "name": name, "mesh": mesh, "extras": extras });
    if placement != DAffine3::IDENTITY {
        node["matrix"] = json!(glam::DMat4::from(placement).to_cols_array());
    }
    Ok(node)
}

/// Header, JSON chunk padded with spaces, binary chunk padded with zeros; `None` where the file would be too long.
fn container(json: &str, binary: &[u8]) -> Option<Vec<u8>> {
    let (json_len, binary_len) = (json.len().next_multiple_of(4), binary.len().next_multiple_of(4));
    let binary_chunk = if binary.is_empty() { 0 } else { 8 + binary_len };
    let total = u32::try_from(12 + 8 + json_len + binary_chunk).ok()?;
    let mut bytes = Vec::with_capacity(total as usize);
    bytes.extend(b"glTF");
    bytes.extend(2u32.to_le_bytes());
    bytes.extend(total.to_le_bytes());
    bytes.extend((json_len as u32).to_le_bytes());
    bytes.extend(b"JSON");
    bytes.extend(json.as_bytes());
    bytes.resize(20 + json_len, b' ');
    if !binary.is_empty() {
        bytes.extend((binary_len as u32).to_le_bytes());
        bytes.extend(b"BIN\0");
        bytes.extend(binary);
        bytes.resize(total as usize, 0);
    }
    Some(bytes)
}
