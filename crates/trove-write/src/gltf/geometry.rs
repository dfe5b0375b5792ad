//! Meshes and their accessors.

use serde_json::{Value, json};
use trove_model::{Instance, Mesh, Scene};

use super::binary::Binary;
use crate::WriteError;

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

/// Encodes each scene mesh once, however many glTF meshes share its data.
pub(super) struct Geometry<'a> {
    scene: &'a Scene,
    binary: &'a mut Binary,
    accessors: Vec<Value>,
    /// For each scene mesh, where its data lie once they are there.
    shapes: Vec<Option<Shape>>,
}

/// A scene mesh's accessors.
#[derive(Clone)]
struct Shape {
    attributes: Value,
    /// Slots that have triangles, with the accessor of their indices.
    slots: Vec<(u16, usize)>,
}

impl<'a> Geometry<'a> {
    pub(super) fn new(scene: &'a Scene, binary: &'a mut Binary) -> Self {
        Self { scene, binary, accessors: Vec::new(), shapes: vec![None; scene.meshes.len()] }
    }

    pub(super) fn finish(self) -> Vec<Value> {
        self.accessors
    }

    /// The glTF mesh of an instance: one primitive a slot; `None` for a mesh without triangles.
    pub(super) fn mesh(&mut self, instance: &Instance) -> Result<Option<Value>, WriteError> {
        let wrong = |what: String| WriteError::Mismatch(format!("{what} of a {}", instance.class.row().name));
        let mesh = self.scene.meshes.get(instance.mesh).ok_or_else(|| wrong(format!("no mesh {}", instance.mesh)))?;
        if let Some(defect) = mesh.defect() {
            return Err(wrong(format!("mesh {}: {defect}", instance.mesh)));
        }
        if mesh.triangles.is_empty() {
            return Ok(None);
        }
        let shape = match &self.shapes[instance.mesh] {
            Some(shape) => shape.clone(),
            None => {
                let shape = self.encode(mesh);
                self.shapes[instance.mesh] = Some(shape.clone());
                shape
            }
        };
        let mut primitives = Vec::new();
        for (slot, indices) in shape.slots {
            let material = instance.materials.get(usize::from(slot)).copied();
            let material = material.filter(|&m| m < self.scene.materials.len());
            let material = material.ok_or_else(|| wrong(format!("no material for slot {slot}")))?;
            primitives.push(json!({ "attributes": shape.attributes, "indices": indices, "material": material }));
        }
        Ok(Some(json!({ "name": mesh_name(instance), "primitives": primitives })))
    }

    fn encode(&mut self, mesh: &Mesh) -> Shape {
        let count = mesh.positions.len();
        let mut attributes = json!({});
        let (low, high) = mesh.bounds().unwrap_or_default();
        let positions = mesh.positions.iter().flat_map(|p| p.to_array());
        let position = self.vertices(positions, count, "VEC3");
        self.accessors[position]["min"] = json!(low.to_array());
        self.accessors[position]["max"] = json!(high.to_array());
        attributes["POSITION"] = position.into();
        if !mesh.normals.is_empty() {
            let unit = mesh.normals.iter().flat_map(|n| n.try_normalize().unwrap_or(glam::Vec3::Z).to_array());
            attributes["NORMAL"] = self.vertices(unit, count, "VEC3").into();
        }
        if !mesh.uvs.is_empty() {
            // glTF's v runs down the picture.
            let uvs = mesh.uvs.iter().flat_map(|uv| [uv.x, 1.0 - uv.y]);
            attributes["TEXCOORD_0"] = self.vertices(uvs, count, "VEC2").into();
        }
        if !mesh.tints.is_empty() {
            let tints = mesh.tints.iter().flat_map(|tint| tint.clamp(glam::Vec3::ZERO, glam::Vec3::ONE).to_array());
            attributes["COLOR_0"] = self.vertices(tints, count, "VEC3").into();
        }
        let mut slots = Vec::new();
        for slot in 0..mesh.slot_count() as u16 {
            let of_slot = mesh.triangles.iter().enumerate().filter(|(t, _)| mesh.slot(*t) == slot);
            let indices: Vec<u8> = of_slot.flat_map(|(_, t)| t).flat_map(|i| i.to_le_bytes()).collect();
            if !indices.is_empty() {
                slots.push((slot, self.accessor(&indices, indices.len() / 4, UNSIGNED_INT, "SCALAR", INDICES)));
            }
        }
        Shape { attributes, slots }
    }

    fn vertices(&mut self, values: impl Iterator<Item = f32>, count: usize, shape: &str) -> usize {
        let bytes: Vec<u8> = values.flat_map(f32::to_le_bytes).collect();
        self.accessor(&bytes, count, FLOAT, shape, VERTICES)
    }

    fn accessor(&mut self, bytes: &[u8], count: usize, component: u32, shape: &str, target: u32) -> usize {
        let view = self.binary.add(bytes, Some(target));
        self.accessors.push(json!({ "bufferView": view, "componentType": component, "count": count, "type": shape }));
        self.accessors.len() - 1
    }
}

fn mesh_name(instance: &Instance) -> String {
    let asset = instance.object.as_ref().and_then(|object| object.asset.clone());
    asset.unwrap_or_else(|| format!("{} {}", instance.class.row().name, instance.mesh))
}
