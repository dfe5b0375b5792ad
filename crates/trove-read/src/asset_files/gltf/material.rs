//! glTF's materials → `Material`.

use std::collections::BTreeMap;

use glam::{Mat2, Vec2, Vec3, Vec4, vec2};
use serde_json::Value;
use trove_model::{ColorSpace, Material, Outcome};

use super::container::{Container, none};
use super::json::{self, TextureRef};
use super::texture::{Textures, moved};
use crate::asset_files::fault::Fault;
use crate::asset_files::looks::{self, Alpha};
use crate::asset_files::model::Model;
use crate::asset_files::picture::Pictures;

/// What glTF's extensions tell of a material and is not rendered, with what it is called.
const LEFT_OUT: [(&str, &str); 14] = [
    ("/KHR_materials_anisotropy/anisotropyStrength", "anisotropy"),
    ("/KHR_materials_clearcoat/clearcoatTexture", "map of the clear coat"),
    ("/KHR_materials_clearcoat/clearcoatRoughnessFactor", "roughness of the clear coat"),
    ("/KHR_materials_clearcoat/clearcoatNormalTexture", "normals of the clear coat"),
    ("/KHR_materials_diffuse_transmission/diffuseTransmissionTexture", "map of diffuse transmission"),
    ("/KHR_materials_diffuse_transmission/diffuseTransmissionColorTexture", "colours of diffuse transmission"),
    ("/KHR_materials_dispersion/dispersion", "dispersion"),
    ("/KHR_materials_iridescence/iridescenceFactor", "iridescence"),
    ("/KHR_materials_sheen/sheenColorTexture", "map of the sheen"),
    ("/KHR_materials_specular/specularTexture", "map of the reflectance"),
    ("/KHR_materials_specular/specularColorFactor", "colour of the reflectance"),
    ("/KHR_materials_specular/specularColorTexture", "colours of the reflectance"),
    ("/KHR_materials_transmission/transmissionTexture", "map of transmission"),
    ("/KHR_materials_volume/thicknessFactor", "thickness"),
];

/// The materials that primitives have asked for.
pub(super) struct Looks<'a> {
    container: &'a Container,
    textures: Textures<'a>,
    made: BTreeMap<Option<usize>, Look>,
}

/// How a primitive's material is used.
#[derive(Clone)]
pub(super) struct Look {
    pub(super) slot: usize,
    /// Which texture coordinates its maps are looked up by.
    pub(super) uv_set: usize,
    /// Scale with rotation, then offset, of `KHR_texture_transform`.
    turn: Mat2,
    offset: Vec2,
    /// It shines from both sides.
    pub(super) two_sided_light: bool,
}

impl Look {
    /// glTF's texture coordinate → the mesh's, whose v runs up.
    pub(super) fn uv(&self, uv: Vec2) -> Vec2 {
        let uv = self.turn * uv + self.offset;
        vec2(uv.x, 1.0 - uv.y)
    }
}

impl<'a> Looks<'a> {
    pub(super) fn new(container: &'a Container, pictures: &'a Pictures) -> Self {
        Self { container, textures: Textures { container, pictures }, made: BTreeMap::new() }
    }

    /// The look of a material, made and added to the model at first use.
    pub(super) fn of(&mut self, index: Option<usize>, model: &mut Model) -> Result<Look, Fault> {
        if let Some(look) = self.made.get(&index) {
            return Ok(look.clone());
        }
        let default = json::Material::default();
        let materials = &self.container.root.materials;
        let source = match index {
            Some(i) => materials.get(i).ok_or_else(|| none("primitive", "material", i, materials.len()))?,
            None => &default,
        };
        let look = self.make(source, index, model);
        self.made.insert(index, look.clone());
        Ok(look)
    }

    fn make(&self, m: &json::Material, index: Option<usize>, model: &mut Model) -> Look {
        let pbr = &m.pbr_metallic_roughness;
        let ext = |pointer: &str| m.extensions.pointer(pointer);
        let number = |pointer: &str| ext(pointer).and_then(Value::as_f64).map(|v| v as f32);
        let gloss = ext("/KHR_materials_pbrSpecularGlossiness");
        let reference = |pointer: &str| ext(pointer).and_then(|v| serde_json::from_value::<TextureRef>(v.clone()).ok());
        let base_ref = match gloss {
            Some(_) => reference("/KHR_materials_pbrSpecularGlossiness/diffuseTexture"),
            None => pbr.base_color_texture.clone(),
        };
        let name = m.name.clone().unwrap_or_else(|| index.map_or("default".into(), |i| format!("material {i}")));
        let factor = Vec4::from(pbr.base_color_factor.unwrap_or([1.0; 4]));
        let mut material = Material {
            name,
            base_color: factor.truncate(),
            roughness: pbr.roughness_factor.unwrap_or(1.0),
            metalness: pbr.metallic_factor.unwrap_or(1.0),
            ior: number("/KHR_materials_ior/ior").unwrap_or(1.5),
            coat: number("/KHR_materials_clearcoat/clearcoatFactor").unwrap_or(0.0),
            transmission: number("/KHR_materials_transmission/transmissionFactor").unwrap_or(0.0),
            translucency: number("/KHR_materials_diffuse_transmission/diffuseTransmissionFactor").unwrap_or(0.0),
            sheen: color(ext("/KHR_materials_sheen/sheenColorFactor")).map_or(0.0, Vec3::max_element),
            ..Material::default()
        };
        if let Some(specular) = number("/KHR_materials_specular/specularFactor") {
            material.ior = looks::ior_of_specular(material.ior, specular);
        }
        let base = base_ref.as_ref().and_then(|r| self.textures.texture(r, ColorSpace::Srgb, model));
        let mut alpha = factor.w;
        if let Some(gloss) = gloss {
            let four = |key: &str| color4(gloss.get(key)).unwrap_or(Vec4::ONE);
            let specular = color(gloss.get("specularFactor")).unwrap_or(Vec3::ONE);
            let shine = gloss.get("glossinessFactor").and_then(Value::as_f64).unwrap_or(1.0) as f32;
            alpha = four("diffuseFactor").w;
            // A map of specular colours is taken for its mean.
            let map = reference("/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture");
            let mean = map
                .and_then(|r| self.textures.texture(&r, ColorSpace::Srgb, model))
                .map_or(Vec4::ONE, |t| t.mean(0.0).0);
            let (base, metalness) =
                looks::metal_of_specular(four("diffuseFactor").truncate(), specular * mean.truncate());
            (material.base_color, material.metalness) = (base, metalness);
            material.roughness = 1.0 - shine * mean.w;
        } else {
            material.orm_map = self.textures.orm(m, model);
        }
        let left_out = LEFT_OUT.iter().filter(|(pointer, _)| ext(pointer).is_some_and(has_effect));
        let left_out: Vec<&str> = left_out.map(|(_, called)| *called).collect();
        if !left_out.is_empty() {
            let example = format!("{}: {}", material.name, left_out.join(", "));
            model.notice(Outcome::Dropped, "what a material has besides is not rendered", example);
        }
        material.normal_map = m.normal_texture.as_ref().and_then(|r| self.textures.normals(r, model));
        let mode = match m.alpha_mode.as_deref() {
            Some("MASK") => Alpha::Mask(m.alpha_cutoff.unwrap_or(0.5)),
            Some("BLEND") => Alpha::Blend,
            _ => Alpha::Opaque,
        };
        material.base_color_map = base;
        looks::apply_alpha(&mut material, mode, alpha);
        let strength = number("/KHR_materials_emissive_strength/emissiveStrength").unwrap_or(1.0);
        let emission = looks::radiance(Vec3::from(m.emissive_factor) * strength);
        let glow = m.emissive_texture.as_ref().filter(|_| emission.max_element() > 0.0);
        material.emission_map = glow.and_then(|r| self.textures.texture(r, ColorSpace::Srgb, model));
        material.emission = emission;
        looks::clamp(&mut material);
        let shines = emission.max_element() > 0.0;
        let leading = base_ref.as_ref().or(pbr.metallic_roughness_texture.as_ref()).or(m.normal_texture.as_ref());
        let (uv_set, turn, offset) =
            leading.or(m.emissive_texture.as_ref()).map_or((0, Mat2::IDENTITY, Vec2::ZERO), moved);
        let others = [&pbr.metallic_roughness_texture, &m.normal_texture, &m.occlusion_texture, &m.emissive_texture];
        if others.into_iter().flatten().any(|r| moved(r) != (uv_set, turn, offset)) {
            model.notice(
                Outcome::Substituted,
                "maps with their own texture coordinates use the base colour's",
                material.name.clone(),
            );
        }
        model.materials.push(material);
        Look { slot: model.materials.len() - 1, uv_set, turn, offset, two_sided_light: m.double_sided && shines }
    }
}

/// Whether a value of an extension differs from its default: none of a factor, white of a colour, no map.
fn has_effect(value: &Value) -> bool {
    match value {
        Value::Number(factor) => factor.as_f64() != Some(0.0),
        Value::Array(color) => color.iter().any(|channel| channel.as_f64() != Some(1.0)),
        _ => value.is_object(),
    }
}

fn color(value: Option<&Value>) -> Option<Vec3> {
    let v: [f32; 3] = serde_json::from_value(value?.clone()).ok()?;
    Some(Vec3::from(v))
}

fn color4(value: Option<&Value>) -> Option<Vec4> {
    let v: [f32; 4] = serde_json::from_value(value?.clone()).ok()?;
    Some(Vec4::from(v))
}
