//! Normal maps and height maps whose smaller copies remember how uneven the surface is that they no longer show.
//!
//! The mean of unit normals is the shorter the more they differ; what it lacks becomes roughness (Toksvig 2005,
//! Olano and Baker 2010), so that a rough road does not turn into a mirror with distance.

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};
use trove_model::{ColorSpace, Texture};

use super::mip_map::{Level, MipMap, encode};
use crate::lookups::LOOKUPS;

/// The normals' directions, with √(1 − length of their mean) in alpha.
pub(super) fn from_normals(texture: &Texture) -> MipMap {
    let normals = texture.rgba.iter().map(|&t| (LOOKUPS.decode(t, false).truncate() * 2.0 - 1.0).normalize_or(Vec3::Z));
    mip_map(texture, normals.map(|normal| normal.extend(0.0)).collect(), |mean| {
        let mean = mean.truncate();
        let length = mean.length().min(1.0);
        (mean.normalize_or(Vec3::Z) * 0.5 + 0.5).extend((1.0 - length).sqrt())
    })
}

/// Slopes by central differences of the first channel, the heights, and the root of the slopes' variance in alpha.
pub(super) fn from_heights(texture: &Texture) -> MipMap {
    let (w, h) = (texture.width as usize, texture.height as usize);
    let height = |x: usize, y: usize| LOOKUPS.decode(texture.rgba[y * w + x], false).x;
    let slope = |x: usize, y: usize| {
        let along_u = height((x + 1) % w, y) - height((x + w - 1) % w, y);
        let along_v = height(x, (y + h - 1) % h) - height(x, (y + 1) % h);
        let slope = Vec2::new(along_u, along_v) / 2.0;
        Vec4::new(slope.x, slope.y, height(x, y), slope.length_squared())
    };
    let slopes = (0..h).flat_map(|y| (0..w).map(move |x| (x, y))).map(|(x, y)| slope(x, y));
    mip_map(texture, slopes.collect(), |mean| {
        // Of both directions alike.
        let variance = (mean.w - mean.xy().length_squared()).max(0.0) / 2.0;
        Vec4::new(mean.x * 0.5 + 0.5, mean.y * 0.5 + 0.5, mean.z, variance.sqrt())
    })
}

/// Averages 2×2 of `texels` again and again, and keeps what `code` (0 to 1) makes of each mean.
fn mip_map(texture: &Texture, mut texels: Vec<Vec4>, code: impl Fn(Vec4) -> Vec4) -> MipMap {
    let (mut width, mut height) = (texture.width, texture.height);
    let mut levels = Vec::new();
    loop {
        let coded = texels.iter().map(|&t| encode(code(t), ColorSpace::Linear)).collect();
        levels.push(Level { width, height, texels: coded });
        if width == 1 && height == 1 {
            return MipMap::of(&levels, ColorSpace::Linear);
        }
        let at = |x: u32, y: u32| texels[(y.min(height - 1) * width + x.min(width - 1)) as usize];
        let (columns, rows) = (width.div_ceil(2), height.div_ceil(2));
        let mean = |x: u32, y: u32| (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1)) / 4.0;
        texels = (0..rows).flat_map(|y| (0..columns).map(move |x| (2 * x, 2 * y))).map(|(x, y)| mean(x, y)).collect();
        (width, height) = (columns, rows);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(rgba: Vec<[u8; 4]>) -> Texture {
        let side = rgba.len().isqrt() as u32;
        Texture { name: "relief".into(), width: side, height: side, rgba, color_space: ColorSpace::Linear }
    }

    #[test]
    fn normals_that_differ_become_variance_and_flat_ones_do_not() {
        // Tilted by ±0.3 along x from column to column.
        let tilted =
            |i: usize| Vec3::new(if i.is_multiple_of(2) { 0.3 } else { -0.3 }, 0.0, 1.0).normalize() * 0.5 + 0.5;
        let map = from_normals(&texture((0..256).map(|i| encode(tilted(i).extend(1.0), ColorSpace::Linear)).collect()));
        let (near, far) = (map.at(Vec2::splat(0.03)), map.mean());
        assert!(near.w < 0.01 && (near.x - 0.5).abs() > 0.1, "{near}");
        let lost = 1.0 - 1.0 / 1.09f32.sqrt();
        assert!((far.w.powi(2) - lost).abs() < 2e-3 && (far.x - 0.5).abs() < 0.01, "{far}");
        let flat = from_normals(&texture(vec![[128, 128, 255, 255]; 64]));
        assert!(flat.mean().w < 0.01);
    }

    #[test]
    fn a_ramp_has_one_slope_and_no_variance() {
        let ramp = |i: usize| [(8 * (i % 16)) as u8, 0, 0, 255];
        let map = from_heights(&texture((0..256).map(ramp).collect()));
        let middle = map.at(Vec2::splat(0.5));
        assert!((middle.x * 2.0 - 1.0 - 8.0 / 255.0).abs() < 0.005 && middle.w < 0.01, "{middle}");
        assert!((middle.z - 7.5 * 8.0 / 255.0).abs() < 0.005, "{middle}");
    }
}
