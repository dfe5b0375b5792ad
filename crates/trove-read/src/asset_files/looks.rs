//! What formats say about materials, in the terms of `Material`.

use glam::{Vec2, Vec3, Vec4, vec2};
use trove_model::{Material, Texture};

use super::picture::Pixels;

/// Radiance of an emission factor of 1: what white paper in sunshine has in the renderer's scale.
const WHITE: f32 = 0.3;

/// What a material's alpha is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Alpha {
    /// Nothing.
    Opaque,
    /// A surface is there where alpha is at least this.
    Mask(f32),
    /// A surface covers what is behind it by alpha.
    Blend,
}

/// Emission factor → radiance.
pub(super) fn radiance(factor: Vec3) -> Vec3 {
    factor.max(Vec3::ZERO) * WHITE
}

/// Cut-outs become a cutoff. What blends is a cut-out where its map holds both nothing and all (leaves, decals), and
/// otherwise a pane that lets through what it does not cover.
pub(super) fn apply_alpha(material: &mut Material, alpha: Alpha, factor: f32) {
    match alpha {
        Alpha::Opaque => {}
        Alpha::Mask(cutoff) => material.alpha_cutoff = (cutoff / factor.max(1e-3)).clamp(0.004, 1.0),
        Alpha::Blend => {
            let (mean, cut_out) = material.base_color_map.as_deref().map_or((1.0, false), coverage);
            if cut_out {
                material.alpha_cutoff = (0.5 / factor.max(1e-3)).clamp(0.004, 0.9);
            } else if mean * factor < 0.98 {
                material.transmission = material.transmission.max(1.0 - mean * factor);
                material.metalness = 0.0;
            }
        }
    }
}

/// Mean alpha, and whether at least a fiftieth of a texture is empty while a fiftieth is full.
fn coverage(texture: &Texture) -> (f32, bool) {
    let count = texture.rgba.len().max(1) as f32;
    let share = |is: fn(u8) -> bool| texture.rgba.iter().filter(|p| is(p[3])).count() as f32 / count;
    let mean = texture.rgba.iter().map(|p| f32::from(p[3])).sum::<f32>() / count / 255.0;
    (mean, share(|a| a < 64) > 0.02 && share(|a| a > 191) > 0.02)
}

/// Index of refraction whose reflectance at right angles is `specular` times that of `ior`.
pub(super) fn ior_of_specular(ior: f32, specular: f32) -> f32 {
    let root = ((ior - 1.0) / (ior + 1.0)).abs() * specular.clamp(0.0, 1.0).sqrt();
    (1.0 + root) / (1.0 - root).max(1e-3)
}

/// Diffuse and specular colour → base colour and metalness (the conversion that `KHR_materials_pbrSpecularGlossiness`
/// appends: the metalness whose mixture has both reflectances).
pub(super) fn metal_of_specular(diffuse: Vec3, specular: Vec3) -> (Vec3, f32) {
    const DIELECTRIC: f32 = 0.04;
    let bright = |c: Vec3| (0.299 * c.x * c.x + 0.587 * c.y * c.y + 0.114 * c.z * c.z).sqrt();
    let (d, s) = (bright(diffuse), bright(specular));
    let metalness = if s < DIELECTRIC {
        0.0
    } else {
        let b = d * (1.0 - specular.max_element()) / (1.0 - DIELECTRIC) + s - 2.0 * DIELECTRIC;
        let c = DIELECTRIC - s;
        ((-b + (b * b - 4.0 * DIELECTRIC * c).max(0.0).sqrt()) / (2.0 * DIELECTRIC)).clamp(0.0, 1.0)
    };
    let from_diffuse = diffuse * (1.0 - specular.max_element()) / (1.0 - DIELECTRIC) / (1.0 - metalness).max(1e-3);
    let from_specular = (specular - DIELECTRIC * (1.0 - metalness)) / metalness.max(1e-3);
    (from_diffuse.lerp(from_specular, metalness * metalness).clamp(Vec3::ZERO, Vec3::ONE), metalness)
}

/// Numbers that a file may set to anything, within what the renderer means by them.
pub(super) fn clamp(material: &mut Material) {
    let unit = |v: &mut f32, otherwise: f32| *v = if v.is_finite() { v.clamp(0.0, 1.0) } else { otherwise };
    unit(&mut material.roughness, 1.0);
    for v in [
        &mut material.metalness,
        &mut material.coat,
        &mut material.sheen,
        &mut material.transmission,
        &mut material.translucency,
    ] {
        unit(v, 0.0);
    }
    material.ior = if material.ior.is_finite() && material.ior >= 1.0 { material.ior.min(3.0) } else { 1.5 };
    let finite = |c: Vec3, otherwise: Vec3| if c.is_finite() { c } else { otherwise };
    material.base_color = finite(material.base_color, Vec3::ONE).clamp(Vec3::ZERO, Vec3::ONE);
    material.emission = finite(material.emission, Vec3::ZERO).clamp(Vec3::ZERO, Vec3::splat(1e4));
}

/// One channel of each of three pictures as red, green and blue, at the size of the largest; a missing one is
/// constant. `None` where all are missing.
pub(super) fn packed(sources: [Option<(Pixels, usize)>; 3], missing: [u8; 3]) -> Option<Pixels> {
    let (width, height) = sources.iter().flatten().map(|(p, _)| (p.width, p.height)).max_by_key(|(w, h)| w * h)?;
    let mut rgba = vec![[missing[0], missing[1], missing[2], 255]; (width * height) as usize];
    for (channel, source) in sources.iter().enumerate() {
        let Some((pixels, from)) = source else { continue };
        for (i, texel) in rgba.iter_mut().enumerate() {
            let (x, y) = (i as u32 % width, i as u32 / width);
            let at = y * pixels.height / height * pixels.width + x * pixels.width / width;
            texel[channel] = pixels.rgba[at as usize][*from];
        }
    }
    Some(Pixels { width, height, rgba, notice: None })
}

/// A picture whose alpha is another one's red.
pub(super) fn with_alpha(mut base: Pixels, opacity: &Pixels) -> Pixels {
    for i in 0..base.rgba.len() {
        let (x, y) = (i as u32 % base.width, i as u32 / base.width);
        let at = y * opacity.height / base.height * opacity.width + x * opacity.width / base.width;
        base.rgba[i][3] = opacity.rgba[at as usize][0];
    }
    base
}

/// The texel at a texture coordinate (v up): linear colour and alpha.
pub(super) fn look_up(texture: &Texture, uv: Vec2) -> Vec4 {
    let uv = if uv.is_finite() { uv } else { Vec2::ZERO };
    let uv = vec2(uv.x - uv.x.floor(), 1.0 - (uv.y - uv.y.floor()));
    let x = ((uv.x * texture.width as f32) as u32).min(texture.width.saturating_sub(1));
    let y = ((uv.y * texture.height as f32) as u32).min(texture.height.saturating_sub(1));
    texture.rgba.get((y * texture.width + x) as usize).map_or(Vec4::ONE, |t| texture.decoded(*t))
}

#[cfg(test)]
mod tests {
    use trove_model::ColorSpace;

    use super::*;

    #[test]
    fn glass_that_blends_lets_light_through_and_leaves_are_cut_out() {
        let mut glass = Material::default();
        apply_alpha(&mut glass, Alpha::Blend, 0.25);
        assert_eq!((glass.transmission, glass.alpha_cutoff), (0.75, 0.0));
        let rgba = (0..16).map(|i| [90, 120, 40, if i < 8 { 0 } else { 255 }]).collect();
        let map = Texture { name: "leaf".into(), width: 4, height: 4, rgba, color_space: ColorSpace::Srgb };
        let mut leaf = Material { base_color_map: Some(map.into()), ..Material::default() };
        apply_alpha(&mut leaf, Alpha::Blend, 1.0);
        assert_eq!((leaf.transmission, leaf.alpha_cutoff), (0.0, 0.5));
    }

    #[test]
    fn specular_colours_become_metals_and_plastics() {
        let (gold, metalness) = metal_of_specular(Vec3::ZERO, Vec3::new(1.0, 0.77, 0.34));
        assert!(metalness > 0.95 && (gold - Vec3::new(1.0, 0.77, 0.34)).length() < 0.05, "{gold} {metalness}");
        let (red, metalness) = metal_of_specular(Vec3::new(0.8, 0.1, 0.1), Vec3::splat(0.04));
        assert!(metalness < 0.01 && (red - Vec3::new(0.8, 0.1, 0.1)).length() < 0.05, "{red} {metalness}");
        assert!((ior_of_specular(1.5, 1.0) - 1.5).abs() < 1e-5 && ior_of_specular(1.5, 0.0) == 1.0);
    }
}
