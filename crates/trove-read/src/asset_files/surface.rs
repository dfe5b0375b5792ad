//! A library's texture set → `Surface`.

use glam::{Vec3, vec2};
use trove_model::{ColorSpace, Material, Outcome, Report, Surface, SurfaceKind, Tags, Tiling};

use super::fault::Fault;
use super::library_file::SurfaceEntry;
use super::looks;
use super::names::surface_kind_named;
use super::picture::{Pictures, Pixels, decode};
use crate::ReadError;

/// Reads a set's pictures; `None` for one that is not to be used. Errors: the colour cannot be read, or a key is wrong;
/// other maps that cannot be read are reported and left out.
pub(super) fn surface(
    entry: &SurfaceEntry,
    id: &str,
    pictures: &Pictures,
    report: &Report,
) -> Result<Option<Surface>, ReadError> {
    let place = format!("surface {:?}", entry.name);
    let folder = pictures.folder.path();
    let library = folder.join(super::FILE_NAME);
    let kind = surface_kind_named(entry.kind.as_deref(), &place).map_err(|f| f.at(&library))?;
    let Some(Some(kind)) = kind else { return Ok(None) };
    let cells = cells(kind, entry, &place).map_err(|f| f.at(&library))?;
    let load = |file: &str| -> Result<Pixels, ReadError> {
        let path = folder.join(file);
        let bytes = pictures.folder.read(folder, file).map_err(|source| ReadError::io(&path, source))?;
        let mut pixels = decode(&bytes, file, pictures.limit).map_err(|found| {
            Fault::new("picture", "a picture", found, "replace it, or remove it from library.toml").at(&path)
        })?;
        if let Some(notice) = pixels.notice.take() {
            report.note(Outcome::Substituted, "a texture was scaled down", format!("{file}: {notice}"));
        }
        Ok(pixels)
    };
    let optional = |file: &Option<String>| {
        load(file.as_deref()?).map_err(|e| report.note(Outcome::Dropped, "a texture was left out", e)).ok()
    };
    let mut color = load(&entry.color)?;
    let mut material = Material { name: id.to_owned(), base_color: Vec3::ONE, roughness: 0.8, ..Material::default() };
    if let Some(opacity) = optional(&entry.opacity) {
        color = looks::with_alpha(color, &opacity);
        material.alpha_cutoff = 0.5;
    }
    let texture = |pixels: Pixels, role: &str, color_space| {
        pictures.texture(&format!("{}.{role}", entry.name), color_space, || Ok(pixels)).ok()
    };
    material.base_color_map = texture(color, "color", ColorSpace::Srgb);
    let height = optional(&entry.displacement);
    if let Some(mut normal) = optional(&entry.normal) {
        let dx = match entry.normal_style.as_deref() {
            Some(style) => style == "dx",
            None => {
                let dx = height.as_ref().and_then(|h| points_down(&normal, h)).unwrap_or(false);
                let style = if dx { "dx" } else { "gl" };
                report.note(Outcome::Guessed, "direction of a normal map's green channel", format!("{id}: {style}"));
                dx
            }
        };
        if dx {
            normal.rgba.iter_mut().for_each(|p| p[1] = 255 - p[1]);
        }
        material.normal_map = texture(normal, "normal", ColorSpace::Linear);
    }
    let (orm, metal) = (optional(&entry.orm), optional(&entry.metalness));
    let separate = [optional(&entry.occlusion), optional(&entry.roughness), metal];
    let sources: [Option<(Pixels, usize)>; 3] = std::array::from_fn(|channel| {
        separate[channel].clone().map(|p| (p, 0)).or_else(|| orm.clone().map(|p| (p, channel)))
    });
    if sources[1].is_some() {
        material.roughness = 1.0;
    }
    if sources[2].is_some() {
        material.metalness = 1.0;
    }
    material.orm_map = looks::packed(sources, [255; 3]).and_then(|p| texture(p, "orm", ColorSpace::Linear));
    if let Some(height) = height {
        material.height_m = entry.height_m.unwrap_or(relief(kind));
        material.height_map = texture(height, "height", ColorSpace::Linear);
    }
    if let Some(emission) = optional(&entry.emission).and_then(|p| texture(p, "emission", ColorSpace::Srgb)) {
        material.emission = looks::radiance(Vec3::ONE);
        material.emission_map = Some(emission);
    }
    if matches!(kind, SurfaceKind::Asphalt | SurfaceKind::Grass | SurfaceKind::Soil | SurfaceKind::Gravel) {
        material.tiling = Tiling::Stochastic;
    }
    let size_m = entry.size_m.unwrap_or([2.0; 2]);
    material.uv_scale = vec2(1.0 / size_m[0], 1.0 / size_m[1]);
    Ok(Some(Surface {
        id: id.to_owned(),
        kind,
        tags: Tags::new(entry.tags.iter().flatten()),
        material,
        size_m,
        cells,
        design: None,
    }))
}

/// Kinds whose pictures hold whole things have to say how many.
fn cells(kind: SurfaceKind, entry: &SurfaceEntry, place: &str) -> Result<[u32; 2], Fault> {
    let counted = matches!(
        kind,
        SurfaceKind::Facade | SurfaceKind::FacadeGroundFloor | SurfaceKind::ShopSign | SurfaceKind::RoomBack
    );
    match entry.cells {
        Some([u, v]) if u > 0 && v > 0 => Ok([u, v]),
        None if !counted => Ok([1, 1]),
        other => {
            let remedy = "count the bays and storeys in the image and write `cells = [bays, storeys]`";
            Err(Fault::new(format!("{place}: cells"), "two numbers above 0", format!("{other:?}"), remedy))
        }
    }
}

/// Usual height of a surface's relief, metres.
fn relief(kind: SurfaceKind) -> f32 {
    match kind {
        SurfaceKind::Gravel | SurfaceKind::RoofTiles | SurfaceKind::Grass => 0.03,
        SurfaceKind::Soil | SurfaceKind::Paving | SurfaceKind::Wall => 0.015,
        _ => 0.005,
    }
}

/// Whether a normal map's green points down the picture (DirectX): a slope that rises down the picture has normals that
/// point up it. `None` where heights say too little.
fn points_down(normal: &Pixels, height: &Pixels) -> Option<bool> {
    let at = |p: &Pixels, x: f32, y: f32, c: usize| {
        let (px, py) = ((x * p.width as f32) as u32 % p.width, (y * p.height as f32) as u32 % p.height);
        f32::from(p.rgba[(py * p.width + px) as usize][c])
    };
    let step = 1.0 / height.height as f32;
    let (mut sum, mut squares) = (0.0f32, 0.0f32);
    for i in 0..128 * 128 {
        let (x, y) = ((i % 128) as f32 / 128.0, (i / 128) as f32 / 128.0);
        let rises = at(height, x, y + step, 0) - at(height, x, y + 1.0 - step, 0);
        let green = at(normal, x, y, 1) - 127.5;
        sum += rises * green;
        squares += (rises * green).abs();
    }
    (squares > 0.0 && sum.abs() > 0.1 * squares).then_some(sum < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_tell_which_way_green_points() {
        let size = 64;
        let wave = |y: u32| (std::f32::consts::TAU * y as f32 / size as f32).sin();
        let slope = |y: u32| (std::f32::consts::TAU * y as f32 / size as f32).cos();
        let picture = |value: &dyn Fn(u32) -> f32| Pixels {
            width: size,
            height: size,
            rgba: (0..size * size).map(|i| [(127.5 + 100.0 * value(i / size)) as u8; 4]).collect(),
            notice: None,
        };
        let height = picture(&wave);
        // Rows run down, so where heights grow with the row, OpenGL's normals lean up the picture: more green.
        assert_eq!(points_down(&picture(&slope), &height), Some(false));
        assert_eq!(points_down(&picture(&|y| -slope(y)), &height), Some(true));
        assert_eq!(points_down(&picture(&|_| 0.0), &height), None);
    }
}
