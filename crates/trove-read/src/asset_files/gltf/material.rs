//! glTF's materials → `Material`.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{Mat2, Vec2, Vec3, Vec4, vec2};
use serde_json::Value;
use trove_model::{ColorSpace, Material, Outcome, Texture};

use super::container::{Container, none};
use super::json::{self, TextureRef};
use crate::asset_files::fault::Fault;
use crate::asset_files::looks::{self, Alpha};
use crate::asset_files::model::{Model, Piece};
use crate::asset_files::picture::{Pictures, Pixels, decode};
use crate::asset_files::repair::kept;

/// The materials that primitives have asked for.
pub(super) struct Looks<'a> {
    container: &'a Container,
    pictures: &'a Pictures,
    made: BTreeMap<Option<usize>, Look>,
}

/// How a primitive's material is used.
#[derive(Clone)]
pub(super) struct Look {
    slot: usize,
    /// Which texture coordinates its maps are looked up by.
    pub(super) uv_set: usize,
    /// Scale with rotation, then offset, of `KHR_texture_transform`.
    turn: Mat2,
    offset: Vec2,
    /// It shines from both sides.
    pub(super) two_sided_light: bool,
    /// Where it shines, if not everywhere, and the slot of what shines.
    glow: Option<(Arc<Texture>, Vec3)>,
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
        Self { container, pictures, made: BTreeMap::new() }
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
        let base = base_ref.as_ref().and_then(|r| self.texture(r, ColorSpace::Srgb, model));
        let mut alpha = factor.w;
        if let Some(gloss) = gloss {
            let four = |key: &str| color4(gloss.get(key)).unwrap_or(Vec4::ONE);
            let specular = color(gloss.get("specularFactor")).unwrap_or(Vec3::ONE);
            let shine = gloss.get("glossinessFactor").and_then(Value::as_f64).unwrap_or(1.0) as f32;
            alpha = four("diffuseFactor").w;
            // A map of specular colours is taken for its mean.
            let map = reference("/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture");
            let mean =
                map.and_then(|r| self.texture(&r, ColorSpace::Srgb, model)).map_or(Vec4::ONE, |t| looks::mean(&t));
            let (base, metalness) =
                looks::metal_of_specular(four("diffuseFactor").truncate(), specular * mean.truncate());
            (material.base_color, material.metalness) = (base, metalness);
            material.roughness = 1.0 - shine * mean.w;
        } else {
            material.orm_map = self.orm(m, model);
        }
        material.normal_map = m.normal_texture.as_ref().and_then(|r| self.normals(r, model));
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
        let glow = glow.and_then(|r| self.texture(r, ColorSpace::Srgb, model)).map(|t| (t, emission));
        if glow.is_none() {
            material.emission = emission;
        }
        looks::clamp(&mut material);
        let shines = emission.max_element() > 0.0;
        let leading = base_ref.as_ref().or(pbr.metallic_roughness_texture.as_ref()).or(m.normal_texture.as_ref());
        let (uv_set, turn, offset) =
            leading.or(m.emissive_texture.as_ref()).map_or((0, Mat2::IDENTITY, Vec2::ZERO), moved);
        let others = [&pbr.metallic_roughness_texture, &m.normal_texture, &m.occlusion_texture];
        if others.into_iter().flatten().any(|r| moved(r) != (uv_set, turn, offset)) {
            model.notice(
                Outcome::Substituted,
                "maps of one material with texture coordinates of their own use the base colour's",
                material.name.clone(),
            );
        }
        model.materials.push(material);
        Look { slot: model.materials.len() - 1, uv_set, turn, offset, two_sided_light: m.double_sided && shines, glow }
    }

    /// A texture's picture; what cannot be had is noted and left out.
    fn texture(&self, r: &TextureRef, color_space: ColorSpace, model: &mut Model) -> Option<Arc<Texture>> {
        let image = self.image_of(r, model)?;
        let suffix = if color_space == ColorSpace::Srgb { "" } else { ".linear" };
        let (bytes, name) = self.bytes(image, model)?;
        let result = self.pictures.texture(&format!("{name}{suffix}"), color_space, || {
            let pixels = decode(&bytes, &name, self.pictures.limit)?;
            Ok(noticed(pixels, &name, model))
        });
        kept(result, &name, model)
    }

    fn normals(&self, r: &TextureRef, model: &mut Model) -> Option<Arc<Texture>> {
        let scale = r.scale.unwrap_or(1.0);
        if scale == 1.0 {
            return self.texture(r, ColorSpace::Linear, model);
        }
        let image = self.image_of(r, model)?;
        let (bytes, name) = self.bytes(image, model)?;
        let result = self.pictures.texture(&format!("{name}.normal×{scale}"), ColorSpace::Linear, || {
            let mut pixels = decode(&bytes, &name, self.pictures.limit)?;
            let scaled = |v: u8| (((f32::from(v) / 127.5 - 1.0) * scale).clamp(-1.0, 1.0) * 127.5 + 127.5) as u8;
            pixels.rgba.iter_mut().for_each(|p| *p = [scaled(p[0]), scaled(p[1]), p[2], p[3]]);
            Ok(noticed(pixels, &name, model))
        });
        kept(result, &name, model)
    }

    /// Occlusion from its own picture, roughness and metalness from theirs.
    fn orm(&self, m: &json::Material, model: &mut Model) -> Option<Arc<Texture>> {
        let rough = m.pbr_metallic_roughness.metallic_roughness_texture.as_ref();
        let occlusion = m.occlusion_texture.as_ref().filter(|o| rough.is_none_or(|r| moved(o) == moved(r)));
        let (rough_image, occlusion_image) =
            (rough.and_then(|r| self.image_of(r, model)), occlusion.and_then(|r| self.image_of(r, model)));
        if rough_image.is_some() && rough_image == occlusion_image {
            return rough.and_then(|r| self.texture(r, ColorSpace::Linear, model));
        }
        let mut load = |image: Option<usize>| -> Option<(Pixels, String)> {
            let (bytes, name) = self.bytes(image?, model)?;
            let pixels = kept(decode(&bytes, &name, self.pictures.limit), &name, model)?;
            Some((noticed(pixels, &name, model), name))
        };
        let (rough, occlusion) = (load(rough_image), load(occlusion_image));
        let name = |part: &Option<(Pixels, String)>| part.as_ref().map_or(String::new(), |(_, name)| name.clone());
        let name = format!("{}+{}.orm", name(&occlusion), name(&rough));
        let channel = |part: Option<(Pixels, String)>, c: usize| part.map(|(pixels, _)| (pixels, c));
        let green_blue = rough.map(|(pixels, _)| pixels);
        let sources = [channel(occlusion, 0), green_blue.clone().map(|p| (p, 1)), green_blue.map(|p| (p, 2))];
        let pixels = looks::packed(sources, [255; 3])?;
        kept(self.pictures.texture(&name, ColorSpace::Linear, || Ok(pixels)), &name, model)
    }

    fn image_of(&self, r: &TextureRef, model: &mut Model) -> Option<usize> {
        let texture = self.container.root.textures.get(r.index);
        let ext = |name: &str| texture?.extensions.get(name)?.get("source")?.as_u64().map(|i| i as usize);
        let image = texture.and_then(|t| t.source).or_else(|| ext("EXT_texture_webp"));
        let image = image.or_else(|| ext("KHR_texture_basisu")).or_else(|| ext("EXT_texture_avif"));
        if image.is_none() {
            model.notice(
                Outcome::Dropped,
                "a texture without a picture was left out",
                format!("textures[{}]", r.index),
            );
        }
        image
    }

    fn bytes(&self, image: usize, model: &mut Model) -> Option<(Vec<u8>, String)> {
        let i = self.container.root.images.get(image);
        let label = i.and_then(|i| i.uri.clone().filter(|u| !u.starts_with("data:")).or(i.name.clone()));
        let (bytes, file) = kept(self.container.image(image), &label.unwrap_or(format!("images[{image}]")), model)?;
        Some((bytes, self.pictures.name_of(&file)))
    }

    /// Parts a piece into what shines and what does not, by its emission map; each with its slot.
    pub(super) fn split(&mut self, look: &Look, piece: Piece, model: &mut Model) -> Vec<(Piece, usize)> {
        let Some((map, emission)) = look.glow.as_ref().filter(|_| !piece.uvs.is_empty()) else {
            return vec![(piece, look.slot)];
        };
        let glow = |t: &[u32; 3]| {
            let corners = t.map(|i| piece.uvs.get(i as usize).copied().unwrap_or_default());
            looks::mean_in_triangle(map, corners)
        };
        let (mut bright, mut dark, mut sum) = (Vec::new(), Vec::new(), Vec3::ZERO);
        for t in &piece.triangles {
            let color = glow(t);
            if color.max_element() > 0.05 {
                sum += color;
                bright.push(*t);
            } else {
                dark.push(*t);
            }
        }
        if bright.is_empty() {
            return vec![(Piece { triangles: dark, ..piece }, look.slot)];
        }
        let mut material = model.materials[look.slot].clone();
        material.name = format!("{} (shining)", material.name);
        material.emission = *emission * sum / bright.len() as f32;
        model.materials.push(material);
        let slot = model.materials.len() - 1;
        let Piece { positions, normals, uvs, tints, .. } = piece;
        let lit = Piece {
            positions: positions.clone(),
            normals: normals.clone(),
            uvs: uvs.clone(),
            tints: tints.clone(),
            triangles: bright,
        };
        vec![(Piece { positions, normals, uvs, tints, triangles: dark }, look.slot), (lit, slot)]
    }
}

fn noticed(mut pixels: Pixels, name: &str, model: &mut Model) -> Pixels {
    if let Some(notice) = pixels.notice.take() {
        model.notice(Outcome::Substituted, "a texture was scaled down", format!("{name}: {notice}"));
    }
    pixels
}

/// Texture coordinates' set, scale with rotation, and offset (`KHR_texture_transform`).
fn moved(r: &TextureRef) -> (usize, Mat2, Vec2) {
    let Some(ext) = r.extensions.get("KHR_texture_transform") else {
        return (r.tex_coord, Mat2::IDENTITY, Vec2::ZERO);
    };
    let pair = |key: &str, otherwise: Vec2| {
        let values = ext.get(key).and_then(Value::as_array);
        let number = |i: usize| Some(values?.get(i)?.as_f64()? as f32);
        number(0).zip(number(1)).map_or(otherwise, |(x, y)| vec2(x, y))
    };
    let angle = ext.get("rotation").and_then(Value::as_f64).unwrap_or(0.0) as f32;
    let scale = pair("scale", Vec2::ONE);
    let set = ext.get("texCoord").and_then(Value::as_u64).map_or(r.tex_coord, |set| set as usize);
    // v runs down, so turning counter-clockwise in the picture is turning clockwise in numbers.
    (set, Mat2::from_angle(-angle) * Mat2::from_diagonal(scale), pair("offset", Vec2::ZERO))
}

fn color(value: Option<&Value>) -> Option<Vec3> {
    let v: [f32; 3] = serde_json::from_value(value?.clone()).ok()?;
    Some(Vec3::from(v))
}

fn color4(value: Option<&Value>) -> Option<Vec4> {
    let v: [f32; 4] = serde_json::from_value(value?.clone()).ok()?;
    Some(Vec4::from(v))
}
