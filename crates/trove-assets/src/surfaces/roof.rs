//! Roofs.

use glam::{Vec2, Vec3, vec2, vec3};

use super::canvas::{Canvas, Texel};
use super::noise::{Noise, hash, step};

/// Bitumen sheets a metre wide with lapped seams and puddle stains.
pub(super) fn bitumen(seed: u32, detail: u32) -> Canvas {
    let size = [6.0, 6.0];
    let noise = |feature_m, salt| Noise::new(Vec2::from_array(size), feature_m, seed * 31 + salt);
    let (grit, puddle, broad) = (noise(0.03, 1), noise(1.8, 2).field(3), noise(0.5, 3).field(3));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
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
pub(super) fn tiles(color: Vec3, seed: u32, detail: u32) -> Canvas {
    let size = [3.6, 3.6];
    let size_m = Vec2::from_array(size);
    let (count, noise) = (vec2(16.0, 11.0), |feature_m, salt| Noise::new(size_m, feature_m, seed * 31 + salt));
    let (moss, grain, broad) = (noise(0.25, 1).field(4), noise(0.03, 2), noise(1.0, 3).field(3));
    let tile_m = size_m / count;
    Canvas::new([512 * detail, 512 * detail], size, |p| {
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

/// Flat pieces in courses, every other one moved by half a piece: slates, or shingles with `soft` edges and grit.
pub(super) fn slates(color: Vec3, soft: bool, seed: u32, detail: u32) -> Canvas {
    let size = [3.6, 3.6];
    let size_m = Vec2::from_array(size);
    let count = if soft { vec2(12.0, 24.0) } else { vec2(14.0, 18.0) };
    let noise = |feature_m, salt| Noise::new(size_m, feature_m, seed * 31 + salt);
    let (grit, streak, broad) = (noise(0.02, 1), noise(0.3, 2).field(3), noise(1.2, 3).field(3));
    let piece_m = size_m / count;
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let row = (p.y / piece_m.y).floor();
        let shift = if row as i32 % 2 == 0 { 0.0 } else { 0.5 };
        let along = p.x / piece_m.x + shift;
        let (u, v) = (along - along.floor(), p.y / piece_m.y - row);
        let (i, k) = ((along.floor() as i32).rem_euclid(count.x as i32), row as i32);
        let spread = if soft { 0.22 } else { 0.4 };
        let tone = 1.0 - spread / 2.0 + spread * hash(i, k, seed);
        let cool = 0.1 * (hash(i, k, seed + 1) - 0.5);
        let mut texel = Texel::new(color * tone * vec3(1.0 - cool, 1.0, 1.0 + cool), if soft { 0.9 } else { 0.55 });
        texel.albedo *= 1.0 + if soft { 0.35 } else { 0.1 } * grit.at(p) + 0.14 * broad.at(p) + 0.08 * streak.at(p);
        // The lower edge throws a shadow on the course below; the joints are dark.
        let joint = step(0.05, 0.015, u.min(1.0 - u)) * if soft { step(0.85, 0.7, v) } else { 1.0 };
        texel.albedo *= 1.0 - 0.5 * step(0.9, 1.0, v) - 0.4 * joint;
        texel.height_m = -0.006 * v - 0.002 * joint + 0.0006 * grit.at(p);
        texel
    })
}

/// Sheets with standing seams half a metre apart that run up the slope.
pub(super) fn seams(color: Vec3, patina: f32, seed: u32, detail: u32) -> Canvas {
    let size = [3.0, 4.0];
    let noise = |feature: Vec2, salt| Noise::stretched(Vec2::from_array(size), feature, seed * 31 + salt);
    let (streak, broad) = (noise(vec2(0.08, 1.0), 1).field(3), noise(vec2(0.9, 1.3), 2).field(3));
    Canvas::new([384 * detail, 512 * detail], size, |p| {
        let sheet = (p.x / 0.5).floor();
        let across = p.x - sheet * 0.5;
        let edge_m = across.min(0.5 - across);
        let tone = 0.93 + 0.14 * hash(sheet as i32, 0, seed);
        let mut texel = Texel::new(color * tone, 0.42 + 0.35 * patina);
        texel.albedo *= 1.0 + (0.06 + 0.25 * patina) * streak.at(p) + (0.05 + 0.2 * patina) * broad.at(p);
        texel.albedo *= 1.0 - 0.35 * step(0.035, 0.02, edge_m) * step(0.008, 0.016, edge_m);
        // Sheets end in a fold across, every other one higher up.
        let fold = (p.y + if sheet as i32 % 2 == 0 { 0.0 } else { 2.0 }) / 4.0;
        let fold_m = (fold - fold.round()).abs() * 4.0;
        texel.albedo *= 1.0 - 0.3 * step(0.02, 0.008, fold_m);
        texel.height_m = 0.025 * step(0.022, 0.012, edge_m) + 0.004 * step(0.02, 0.01, fold_m);
        texel
    })
}

/// A welded membrane, pale and stained where water stood.
pub(super) fn membrane(color: Vec3, seed: u32, detail: u32) -> Canvas {
    let size = [8.0, 8.0];
    let noise = |feature_m, salt| Noise::new(Vec2::from_array(size), feature_m, seed * 31 + salt);
    let (puddle, broad, speck) = (noise(2.1, 1).field(3), noise(0.7, 2).field(4), noise(0.05, 3));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let seam_m = (p.y / 2.0 - (p.y / 2.0).round()).abs() * 2.0;
        let mut texel = Texel::new(color * (1.0 + 0.06 * broad.at(p) + 0.04 * speck.at(p)), 0.7);
        texel.tint(vec3(0.16, 0.15, 0.12), 0.45 * step(0.05, 0.4, puddle.at(p)));
        texel.albedo *= 1.0 - 0.18 * step(0.04, 0.015, seam_m);
        texel.height_m = 0.002 * step(0.06, 0.04, seam_m);
        texel
    })
}

/// Stonecrop on a thin bed: green, rust and straw in patches.
pub(super) fn stonecrop(seed: u32, detail: u32) -> Canvas {
    let size = [5.0, 5.0];
    let noise = |feature_m, salt| Noise::new(Vec2::from_array(size), feature_m, seed * 31 + salt);
    let (leaf, patch, dry) = (noise(0.035, 1), noise(0.6, 2).field(4), noise(1.1, 3).field(3));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let mut texel = Texel::new(vec3(0.07, 0.1, 0.035), 0.9);
        texel.tint(vec3(0.16, 0.075, 0.05), step(0.05, 0.5, patch.at(p)));
        texel.tint(vec3(0.2, 0.17, 0.08), 0.8 * step(0.15, 0.5, dry.at(p)));
        texel.albedo *= 1.0 + 0.45 * leaf.at(p);
        texel.height_m = 0.02 * leaf.at(p) + 0.015 * patch.at(p);
        texel
    })
}
