//! Materials, textures and the extensions that carry what the core has no words for.

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;
use serde_json::{Value, json};
use trove_model::{ColorSpace, Mapping, Material, Scene, Texture};

use super::binary::Binary;
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
        let with_maps = scene.materials.iter().filter(|m| m.mapping == Mapping::Uv);
        let maps = with_maps.flat_map(|m| [&m.base_color_map, &m.orm_map, &m.normal_map, &m.emission_map]).flatten();
        for texture in maps {
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

    /// One material; glTF knows no textures without coordinates, so those are replaced by their mean.
    fn material(&mut self, material: &Material, texture_of: &BTreeMap<&str, usize>) -> Value {
        let plain = (material.mapping == Mapping::Triplanar).then(|| without_maps(material));
        // Taken apart whole: a new field does not compile until it is written or said not to be.
        let Material {
            name,
            base_color,
            base_color_map,
            alpha_cutoff,
            roughness,
            metalness,
            orm_map,
            normal_map,
            // glTF has normals alone, which a surface with heights may lack.
            height_map: _,
            height_m: _,
            ior,
            coat,
            flakes,
            sheen,
            subsurface,
            transmission,
            translucency,
            // No glTF viewer knows it.
            retroreflection: _,
            emission,
            emission_map,
            // Nor beams.
            beam: _,
            dirt,
            wetness,
            uv_scale,
            // Triplanar surfaces have become plain above.
            mapping: _,
            // Textures repeat; how their period is hidden is the renderer's.
            tiling: _,
            // For whoever builds scenes.
            role: _,
        } = plain.as_ref().unwrap_or(material);
        let mut reference = |texture: &Texture| {
            let mut info = json!({ "index": texture_of[texture.name.as_str()] });
            let scale = *uv_scale;
            if scale != glam::Vec2::ONE {
                // v is turned over in the mesh (1 − v); scaled, it must still be 1 − scale·v.
                let transform = json!({ "scale": scale.to_array(), "offset": [0.0, 1.0 - scale.y] });
                extend(&mut info, &mut self.extensions, "KHR_texture_transform", transform);
            }
            info
        };
        let [r, g, b] = base_color.clamp(Vec3::ZERO, Vec3::ONE).to_array();
        let mut surface = json!({
            "baseColorFactor": [r, g, b, 1.0],
            "roughnessFactor": roughness.clamp(0.0, 1.0),
            "metallicFactor": metalness.clamp(0.0, 1.0),
        });
        let mut value = json!({ "name": name, "doubleSided": true });
        if let Some(map) = base_color_map {
            surface["baseColorTexture"] = reference(map);
        }
        if let Some(map) = orm_map {
            surface["metallicRoughnessTexture"] = reference(map);
            value["occlusionTexture"] = reference(map);
        }
        if let Some(map) = normal_map {
            value["normalTexture"] = reference(map);
        }
        let glow = emission_map.as_ref().map(|map| reference(map));
        let color_texture = surface.get("baseColorTexture").cloned();
        value["pbrMetallicRoughness"] = surface;
        if *alpha_cutoff > 0.0 {
            value["alphaMode"] = "MASK".into();
            value["alphaCutoff"] = (*alpha_cutoff).into();
        }
        let used = &mut self.extensions;
        if emission.max_element() > 0.0 {
            // A factor goes up to 1; the rest is strength.
            let strength = emission.max_element().max(1.0);
            value["emissiveFactor"] = json!((emission / strength).max(Vec3::ZERO).to_array());
            if let Some(map) = glow {
                value["emissiveTexture"] = map;
            }
            if strength > 1.0 {
                let extension = json!({ "emissiveStrength": strength });
                extend(&mut value, used, "KHR_materials_emissive_strength", extension);
            }
        }
        if *ior != 1.5 {
            extend(&mut value, used, "KHR_materials_ior", json!({ "ior": ior.max(1.0) }));
        }
        if *coat > 0.0 {
            // The renderer's lacquer is smooth.
            let extension = json!({ "clearcoatFactor": coat.min(1.0), "clearcoatRoughnessFactor": 0.03 });
            extend(&mut value, used, "KHR_materials_clearcoat", extension);
        }
        if *transmission > 0.0 {
            let extension = json!({ "transmissionFactor": transmission.min(1.0) });
            extend(&mut value, used, "KHR_materials_transmission", extension);
        }
        if *sheen > 0.0 {
            // The renderer's fibres are half as colourful as the cloth, and α = ½.
            let color = *sheen * (0.5 + 0.5 * base_color);
            let color = color.clamp(Vec3::ZERO, Vec3::ONE).to_array();
            let extension = json!({ "sheenColorFactor": color, "sheenRoughnessFactor": 0.5_f32.sqrt() });
            extend(&mut value, used, "KHR_materials_sheen", extension);
        }
        if *translucency > 0.0 {
            let mut extension = json!({
                "diffuseTransmissionFactor": translucency.min(1.0),
                "diffuseTransmissionColorFactor": [r, g, b],
            });
            if let Some(color) = color_texture {
                extension["diffuseTransmissionColorTexture"] = color;
            }
            extend(&mut value, used, "KHR_materials_diffuse_transmission", extension);
        }
        // What glTF has no words for.
        for (name, amount) in [("flakes", flakes), ("subsurface", subsurface), ("dirt", dirt), ("wetness", wetness)] {
            if *amount > 0.0 {
                value["extras"][name] = (*amount).into();
            }
        }
        value
    }
}

fn extend(value: &mut Value, used: &mut BTreeSet<&'static str>, name: &'static str, extension: Value) {
    value["extensions"][name] = extension;
    used.insert(name);
}

/// The same in one colour and one roughness.
fn without_maps(material: &Material) -> Material {
    let mean = |texture: &Texture| {
        let linear =
            |c: u8| (f32::from(c) / 255.0).powf(if texture.color_space == ColorSpace::Srgb { 2.2 } else { 1.0 });
        let sum: Vec3 = texture.rgba.iter().map(|t| Vec3::new(linear(t[0]), linear(t[1]), linear(t[2]))).sum();
        sum / texture.rgba.len().max(1) as f32
    };
    let color = material.base_color_map.as_deref().map_or(Vec3::ONE, mean);
    let orm = material.orm_map.as_deref().map_or(Vec3::ONE, mean);
    Material {
        base_color: material.base_color * color,
        roughness: material.roughness * orm.y,
        metalness: material.metalness * orm.z,
        base_color_map: None,
        orm_map: None,
        normal_map: None,
        height_map: None,
        emission: material.emission * material.emission_map.as_deref().map_or(Vec3::ONE, mean),
        emission_map: None,
        ..material.clone()
    }
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
