//! Materials, textures and the extensions that carry what the core has no words for.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};
use trove_model::{Material, Scene, Texture};

use super::Binary;
use crate::{WriteError, png_file};

/// glTF's lists, ready to be written.
pub(super) struct Materials {
    pub(super) materials: Vec<Value>,
    pub(super) textures: Vec<Value>,
    pub(super) images: Vec<Value>,
    pub(super) extensions: BTreeSet<&'static str>,
}

impl Materials {
    /// All materials of a scene, in its order; pictures of the same name are embedded once.
    pub(super) fn encode(scene: &Scene, binary: &mut Binary) -> Result<Self, WriteError> {
        let mut lists =
            Self { materials: Vec::new(), textures: Vec::new(), images: Vec::new(), extensions: BTreeSet::new() };
        let mut texture_of: BTreeMap<&str, usize> = BTreeMap::new();
        for texture in scene.materials.iter().flat_map(Material::textures) {
            if !texture_of.contains_key(texture.name.as_str()) {
                let view = binary.add(&encode_texture(texture)?, None);
                lists.images.push(json!({ "name": texture.name, "mimeType": "image/png", "bufferView": view }));
                lists.textures.push(json!({ "sampler": 0, "source": lists.images.len() - 1 }));
                texture_of.insert(&texture.name, lists.textures.len() - 1);
            }
        }
        for material in &scene.materials {
            let value = lists.material(material, &texture_of);
            lists.materials.push(value);
        }
        Ok(lists)
    }

    fn material(&mut self, material: &Material, texture_of: &BTreeMap<&str, usize>) -> Value {
        let mut reference = |texture: &Texture| {
            let mut info = json!({ "index": texture_of[texture.name.as_str()] });
            let scale = material.uv_scale;
            if scale != glam::Vec2::ONE {
                // v is turned over in the mesh (1 − v); scaled, it must still be 1 − scale·v.
                let transform = json!({ "scale": scale.to_array(), "offset": [0.0, 1.0 - scale.y] });
                extend(&mut info, &mut self.extensions, "KHR_texture_transform", transform);
            }
            info
        };
        let [r, g, b] = material.base_color.clamp(glam::Vec3::ZERO, glam::Vec3::ONE).to_array();
        let mut surface = json!({
            "baseColorFactor": [r, g, b, 1.0],
            "roughnessFactor": material.roughness.clamp(0.0, 1.0),
            "metallicFactor": material.metalness.clamp(0.0, 1.0),
        });
        let mut value = json!({ "name": material.name, "doubleSided": true });
        if let Some(map) = &material.base_color_map {
            surface["baseColorTexture"] = reference(map);
        }
        if let Some(map) = &material.orm_map {
            surface["metallicRoughnessTexture"] = reference(map);
            value["occlusionTexture"] = reference(map);
        }
        if let Some(map) = &material.normal_map {
            value["normalTexture"] = reference(map);
        }
        value["pbrMetallicRoughness"] = surface;
        if material.alpha_cutoff > 0.0 {
            value["alphaMode"] = "MASK".into();
            value["alphaCutoff"] = material.alpha_cutoff.into();
        }
        let used = &mut self.extensions;
        if material.is_emitter() {
            // A factor goes up to 1; the rest is strength.
            let strength = material.emission.max_element().max(1.0);
            value["emissiveFactor"] = json!((material.emission / strength).max(glam::Vec3::ZERO).to_array());
            if strength > 1.0 {
                let extension = json!({ "emissiveStrength": strength });
                extend(&mut value, used, "KHR_materials_emissive_strength", extension);
            }
        }
        if material.ior != 1.5 {
            extend(&mut value, used, "KHR_materials_ior", json!({ "ior": material.ior.max(1.0) }));
        }
        if material.coat > 0.0 {
            // The renderer's lacquer is smooth.
            let extension = json!({ "clearcoatFactor": material.coat.min(1.0), "clearcoatRoughnessFactor": 0.03 });
            extend(&mut value, used, "KHR_materials_clearcoat", extension);
        }
        if material.transmission > 0.0 {
            let extension = json!({ "transmissionFactor": material.transmission.min(1.0) });
            extend(&mut value, used, "KHR_materials_transmission", extension);
        }
        value
    }
}

fn extend(value: &mut Value, used: &mut BTreeSet<&'static str>, name: &'static str, extension: Value) {
    value["extensions"][name] = extension;
    used.insert(name);
}

fn encode_texture(texture: &Texture) -> Result<Vec<u8>, WriteError> {
    let (width, height, name) = (texture.width, texture.height, texture.name.as_str());
    if width == 0 || height == 0 || texture.rgba.len() != width as usize * height as usize {
        let found = format!("{} texels for {width}×{height}", texture.rgba.len());
        return Err(WriteError::Encoding { name: name.to_owned(), found });
    }
    if texture.rgba.iter().all(|texel| texel[3] == 255) {
        let opaque: Vec<[u8; 3]> = texture.rgba.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
        return png_file::rgb(name, width, height, &opaque);
    }
    png_file::rgba(name, width, height, &texture.rgba)
}
