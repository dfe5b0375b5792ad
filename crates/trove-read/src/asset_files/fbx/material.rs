//! Materials of FBX and MTL files → `Material`.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{Vec3, vec3};
use trove_files::{LARGEST_FILE, read_regular};
use trove_model::{ColorSpace, Material, Outcome, Texture};

use crate::asset_files::looks::{self, Alpha};
use crate::asset_files::model::Model;
use crate::asset_files::picture::{Pictures, Pixels, decode};
use crate::asset_files::repair::kept;

/// ufbx maps the materials of all programs to those of a physically based one.
pub(super) fn look(m: &ufbx::Material, path: &Path, pictures: &Pictures, model: &mut Model) -> Material {
    let number =
        |map: &ufbx::MaterialMap, otherwise: f32| if map.has_value { map.value_vec4.x as f32 } else { otherwise };
    let rgb = |map: &ufbx::MaterialMap, otherwise: Vec3| {
        let v = map.value_vec4;
        if map.has_value { vec3(v.x as f32, v.y as f32, v.z as f32) } else { otherwise }
    };
    let pbr = &m.pbr;
    let mut texture = |map: &ufbx::MaterialMap, color: ColorSpace| picture(map, color, path, pictures, model);
    let base_color_map = texture(&pbr.base_color, ColorSpace::Srgb);
    let normal_map = texture(&pbr.normal_map, ColorSpace::Linear);
    let maps = [&pbr.ambient_occlusion, &pbr.roughness, &pbr.metalness].map(|map| texture(map, ColorSpace::Linear));
    let opacity = texture(&pbr.opacity, ColorSpace::Linear);
    let emission_map = texture(&pbr.emission_color, ColorSpace::Srgb);
    let orm_map = orm(&maps, pictures, model);
    let factor = number(&pbr.base_factor, 1.0);
    let mut material = Material {
        name: m.element.name.to_string(),
        base_color: if base_color_map.is_some() {
            Vec3::splat(factor)
        } else {
            rgb(&pbr.base_color, Vec3::splat(0.8)) * factor
        },
        roughness: if maps[1].is_some() { 1.0 } else { number(&pbr.roughness, 0.6) },
        metalness: if maps[2].is_some() { 1.0 } else { number(&pbr.metalness, 0.0) },
        ior: number(&pbr.specular_ior, 1.5),
        coat: number(&pbr.coat_factor, 0.0),
        sheen: number(&pbr.sheen_factor, 0.0),
        transmission: number(&pbr.transmission_factor, 0.0),
        base_color_map: covered(base_color_map, opacity, pictures, model),
        orm_map,
        normal_map,
        ..Material::default()
    };
    let emission = if emission_map.is_some() { Vec3::ONE } else { rgb(&pbr.emission_color, Vec3::ZERO) };
    material.emission = looks::radiance(emission * number(&pbr.emission_factor, 1.0));
    material.emission_map = emission_map;
    looks::apply_alpha(&mut material, Alpha::Blend, number(&pbr.opacity, 1.0));
    looks::clamp(&mut material);
    material
}

fn picture(
    map: &ufbx::MaterialMap,
    color_space: ColorSpace,
    path: &Path,
    pictures: &Pictures,
    model: &mut Model,
) -> Option<Arc<Texture>> {
    let texture = map.texture.as_ref().filter(|_| map.texture_enabled)?;
    let texture = texture.file_textures.iter().next().unwrap_or(texture);
    let (bytes, name) = if texture.content.is_empty() {
        let (bytes, file) = kept(beside(texture, path, pictures), &texture.relative_filename, model)?;
        (bytes, pictures.name_of(&file))
    } else {
        (texture.content.to_vec(), format!("{}#{}", pictures.name_of(path), texture.element.typed_id))
    };
    let suffix = if color_space == ColorSpace::Srgb { "" } else { ".linear" };
    let made = pictures.texture(&format!("{name}{suffix}"), color_space, || {
        let pixels = decode(&bytes, &name, pictures.limit)?;
        if let Some(notice) = &pixels.notice {
            model.notice(Outcome::Substituted, "a texture was scaled down", format!("{name}: {notice}"));
        }
        Ok(pixels)
    });
    kept(made, &name, model)
}

/// A texture's file where the model says, or by its name beside the model or in the folders where packs keep them:
/// models name the paths of their makers' machines.
fn beside(texture: &ufbx::Texture, path: &Path, pictures: &Pictures) -> Result<(Vec<u8>, PathBuf), String> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let relative = texture.relative_filename.replace('\\', "/");
    let named = [relative.as_str(), &texture.filename, &texture.absolute_filename].map(|n| n.replace('\\', "/"));
    let last = named.iter().filter_map(|n| n.rsplit('/').next()).find(|n| !n.is_empty()).unwrap_or_default().to_owned();
    if last.is_empty() {
        return Err("a texture without a file name".into());
    }
    let mut places = vec![folder.join(&relative), folder.join(&last)];
    for around in [Some(folder), folder.parent()].into_iter().flatten() {
        places.extend(["textures", "Textures", "texture", "maps", "images", "tex"].map(|f| around.join(f).join(&last)));
    }
    let found = places.into_iter().find(|place| pictures.folder.check(place).is_ok());
    let found = found.ok_or("no such file in the library; put it beside the model")?;
    Ok((read_regular(&found, LARGEST_FILE).map_err(|e| e.to_string())?, found))
}

fn pixels(texture: &Texture) -> Pixels {
    Pixels { width: texture.width, height: texture.height, rgba: texture.rgba.clone(), notice: None }
}

/// Occlusion, roughness and metalness from three pictures.
fn orm(maps: &[Option<Arc<Texture>>; 3], pictures: &Pictures, model: &mut Model) -> Option<Arc<Texture>> {
    let name = |m: &Option<Arc<Texture>>| m.as_ref().map_or("", |t| t.name.as_str()).to_owned();
    let name = format!("{}+{}+{}.orm", name(&maps[0]), name(&maps[1]), name(&maps[2]));
    let packed = looks::packed(maps.each_ref().map(|m| m.as_ref().map(|t| (pixels(t), 0))), [255; 3])?;
    kept(pictures.texture(&name, ColorSpace::Linear, || Ok(packed)), &name, model)
}

/// The base colour with its coverage from a picture of its own, where there is one beside it.
fn covered(
    base: Option<Arc<Texture>>,
    opacity: Option<Arc<Texture>>,
    pictures: &Pictures,
    model: &mut Model,
) -> Option<Arc<Texture>> {
    let (Some(base), Some(opacity)) = (&base, opacity) else { return base };
    // The same picture: its alpha already is the coverage.
    if opacity.name.trim_end_matches(".linear") == base.name {
        return Some(base.clone());
    }
    let name = format!("{}+{}.opacity", base.name, opacity.name);
    let made = pictures.texture(&name, ColorSpace::Srgb, || Ok(looks::with_alpha(pixels(base), &pixels(&opacity))));
    kept(made, &name, model)
}
