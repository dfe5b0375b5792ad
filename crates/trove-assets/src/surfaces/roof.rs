//! Roofs.

use glam::{Vec2, Vec3, vec2, vec3};

use super::canvas::{Canvas, Texel};
use super::noise::{Noise, hash, step};

/// Bitumen sheets a metre wide with lapped seams and puddle stains.
pub(super) fn bitumen(seed: u32) -> Canvas {
    let size = [6.0, 6.0];
    let noise = |feature_m, salt| Noise::new(Vec2::from_array(size), feature_m, seed * 31 + salt);
    let (grit, puddle, broad) = (noise(0.03, 1), noise(1.8, 2).field(3), noise(0.5, 3).field(3));
    Canvas::new([512, 512], size, |p| {
        let seam = (p.y - p.y.floor()).min(p.y.ceil() - p.y);
        let pond = step(0.1, 0.25, puddle.at(p));
        let value = 0.095 * (1.0 + 0.25 * grit.at(p) + 0.2 * broad.at(p)) * (1.0 + 0.35 * pond);
        let mut texel = Texel::new(vec3(1.0, 1.0, 0.99) * value, 0.9);
        texel.tint(Vec3::splat(0.05), step(0.06, 0.03, seam));
        texel.height_m = 0.004 * step(0.0, 0.06, p.y - p.y.floor()) + 0.001 * grit.at(p);
        texel
    })
}

/// Pantiles in courses.
pub(super) fn tiles(color: Vec3, seed: u32) -> Canvas {
    let size = [3.6, 3.6];
    let size_m = Vec2::from_array(size);
    let (count, noise) = (vec2(16.0, 11.0), |feature_m, salt| Noise::new(size_m, feature_m, seed * 31 + salt));
    let (moss, grain, broad) = (noise(0.25, 1).field(4), noise(0.03, 2), noise(1.0, 3).field(3));
    let tile_m = size_m / count;
    Canvas::new([512, 512], size, |p| {
        let q = p / tile_m;
        let (column, row) = (q.x.floor(), q.y.floor());
        let (u, v) = (q.x - column, q.y - row);
        let (i, k) = (column as i32, row as i32);
        let tone = 0.75 + 0.5 * hash(i, k, seed);
        let warmth = 0.12 * (hash(i, k, seed + 1) - 0.5);
        let wave = (u * std::f32::consts::TAU).sin();
        let mut texel = Texel::new(color * tone * vec3(1.0 + warmth, 1.0, 1.0 - warmth), 0.8);
        texel.albedo *= 1.0 + 0.12 * grain.at(p) + 0.15 * broad.at(p);
        // The tile above lies over this one's top and shades it.
        texel.albedo *= 1.0 - 0.55 * step(0.88, 1.0, v) - 0.25 * step(0.12, 0.02, u.min(1.0 - u));
        texel.tint(vec3(0.05, 0.055, 0.03), 0.6 * step(0.35, 0.8, moss.at(p)));
        texel.height_m = 0.02 * wave - 0.03 * v;
        texel
    })
}
