//! The pictures of a glTF file → `Texture`.

use std::sync::Arc;

use glam::{Mat2, Vec2, vec2};
use serde_json::Value;
use trove_model::{ColorSpace, Outcome, Texture};

use super::container::Container;
use super::json::{self, TextureRef};
use crate::asset_files::looks;
use crate::asset_files::model::Model;
use crate::asset_files::picture::{Pictures, Pixels, decode};
use crate::asset_files::repair::kept;

/// Where a file's pictures are and where its textures go.
pub(super) struct Textures<'a> {
    pub(super) container: &'a Container,
    pub(super) pictures: &'a Pictures,
}

impl Textures<'_> {
    /// A texture's picture; what cannot be had is noted and left out.
    pub(super) fn texture(&self, r: &TextureRef, color_space: ColorSpace, model: &mut Model) -> Option<Arc<Texture>> {
        let image = self.image_of(r, model)?;
        let suffix = if color_space == ColorSpace::Srgb { "" } else { ".linear" };
        let (bytes, name) = self.bytes(image, model)?;
        let result = self.pictures.texture(&format!("{name}{suffix}"), color_space, || {
            let pixels = decode(&bytes, &name, self.pictures.limit)?;
            Ok(noticed(pixels, &name, model))
        });
        kept(result, &name, model)
    }

    pub(super) fn normals(&self, r: &TextureRef, model: &mut Model) -> Option<Arc<Texture>> {
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
    pub(super) fn orm(&self, m: &json::Material, model: &mut Model) -> Option<Arc<Texture>> {
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
            model.notice(Outcome::Dropped, "a texture without an image was left out", format!("textures[{}]", r.index));
        }
        image
    }

    fn bytes(&self, image: usize, model: &mut Model) -> Option<(Vec<u8>, String)> {
        let i = self.container.root.images.get(image);
        let label = i.and_then(|i| i.uri.clone().filter(|u| !u.starts_with("data:")).or(i.name.clone()));
        let (bytes, file) = kept(self.container.image(image), &label.unwrap_or(format!("images[{image}]")), model)?;
        Some((bytes, self.pictures.name_of(&file)))
    }
}

fn noticed(mut pixels: Pixels, name: &str, model: &mut Model) -> Pixels {
    if let Some(notice) = pixels.notice.take() {
        model.notice(Outcome::Substituted, "a texture was scaled down", format!("{name}: {notice}"));
    }
    pixels
}

/// Texture coordinates' set, scale with rotation, and offset (`KHR_texture_transform`).
pub(super) fn moved(r: &TextureRef) -> (usize, Mat2, Vec2) {
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
