//! Bricks and stones that walls are laid of.

use glam::{Vec2, Vec3, vec2, vec3};

use super::canvas::{Canvas, Texel};
use super::noise::{Noise, hash, step};

/// How bricks lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Bond {
    /// Stretchers, every course moved by half a brick.
    Running,
    /// A stretcher, a header, and so on.
    Flemish,
    /// A course of stretchers, a course of headers.
    English,
    /// Joints in line.
    Stack,
}

impl Bond {
    /// Distance from the brick's edge and the brick's number, for a point in a course; `period_m` is how far the
    /// pattern goes before it repeats: a stretcher and a header.
    fn brick(self, x: f32, row: i32, periods: i32, period_m: f32) -> (f32, i32) {
        let odd = row.rem_euclid(2) == 1;
        let (ends, shift): (&[f32], f32) = match (self, odd) {
            (Self::Running | Self::Stack, false) | (Self::Stack, true) => (&[0.5, 1.0], 0.0),
            (Self::Running, true) => (&[0.5, 1.0], 0.25),
            (Self::Flemish, _) => (&[0.667, 1.0], if odd { 0.5 } else { 0.0 }),
            (Self::English, false) => (&[0.667, 1.0], 0.0),
            (Self::English, true) => (&[0.333, 0.667, 1.0], 0.167),
        };
        let q = x / period_m + shift;
        let (period, f) = (q.floor(), q - q.floor());
        let k = ends.iter().position(|e| f < *e).unwrap_or(0);
        let start = if k == 0 { 0.0 } else { ends[k - 1] };
        let edge_m = (f - start).min(ends[k] - f) * period_m;
        (edge_m, (period as i32).rem_euclid(periods) * 4 + k as i32)
    }
}

/// Fired bricks of some colours, burnt more here and there, with soot, salts and chipped edges.
pub(super) fn bricks(bond: Bond, colors: [Vec3; 3], mortar: Vec3, seed: u32, detail: u32) -> Canvas {
    let (size, rows, periods) = ([2.025, 1.8], 24, 6);
    let size_m = Vec2::from_array(size);
    let noise = |feature_m, salt| Noise::new(size_m, feature_m, seed * 31 + salt);
    let (grain, ragged, soot, salt) =
        (noise(0.012, 1), noise(0.03, 2), noise(0.7, 3).field(4), noise(0.35, 4).field(4));
    let course = size_m.y / rows as f32;
    let period_m = size_m.x / periods as f32;
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let row = (p.y / course).floor() as i32;
        let up = (p.y - row as f32 * course).min((row + 1) as f32 * course - p.y);
        let (across, id) = bond.brick(p.x, row, periods, period_m);
        let drawn = |salt: u32| hash(id, row, seed + salt);
        let pick = if drawn(0) < 0.68 {
            0
        } else if drawn(0) < 0.93 {
            1
        } else {
            2
        };
        let g = grain.fbm(p, 3);
        let mut texel = Texel::new(colors[pick] * (0.85 + 0.3 * drawn(1)) * (1.0 + 0.2 * g), 0.87);
        texel.height_m = 0.0008 * g + 0.002 * (drawn(2) - 0.5);
        let edge_m = up.min(across) + 0.0018 * ragged.at(p);
        let joint = step(0.0065, 0.0035, edge_m);
        texel.tint(mortar * (1.0 + 0.2 * g), 0.95 * joint);
        texel.height_m -= 0.006 * step(0.009, 0.003, edge_m);
        texel.albedo *= 1.0 - 0.3 * step(0.0, 0.7, soot.at(p));
        texel.tint(vec3(0.42, 0.4, 0.37), 0.35 * step(0.3, 0.75, salt.at(p)) * (1.0 - joint));
        texel
    })
}

/// Cut stones in courses, each of its own length and tooling, with fine joints.
pub(super) fn ashlar(color: Vec3, seed: u32, detail: u32) -> Canvas {
    let (size, rows) = ([2.4, 2.4], 8);
    let size_m = Vec2::from_array(size);
    let noise = |feature_m, salt| Noise::new(size_m, feature_m, seed * 31 + salt);
    let (grain, vein, soot) = (noise(0.012, 1), noise(0.16, 2).field(4), noise(0.8, 3).field(4));
    let runs = Noise::stretched(size_m, vec2(0.06, 1.0), seed * 31 + 4).field(3);
    let course = size_m.y / rows as f32;
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let row = (p.y / course).floor() as i32;
        let up = (p.y - row as f32 * course).min((row + 1) as f32 * course - p.y);
        // Four stones a course, their joints each moved by up to a sixth of a stone.
        let length = size_m.x / 4.0;
        let joint = |k: i32| {
            let moved = hash(k.rem_euclid(4), row, seed) * 0.33 + if row % 2 == 0 { 0.0 } else { 0.5 };
            (k as f32 + moved) * length
        };
        let mut k = (p.x / length).floor() as i32;
        k -= i32::from(p.x < joint(k));
        let (from, to) = (joint(k), joint(k + 1));
        let id = k.rem_euclid(4);
        let (edge_m, g) = (up.min(p.x - from).min(to - p.x), grain.fbm(p, 4));
        let warmth = 0.14 * (hash(id, row, seed + 1) - 0.5);
        let tone = (0.82 + 0.32 * hash(id, row, seed + 2)) * (1.0 + 0.1 * g + 0.12 * vein.at(p));
        let mut texel = Texel::new(color * tone * vec3(1.0 + warmth, 1.0, 1.0 - warmth), 0.82);
        texel.height_m = 0.0012 * g + 0.003 * step(0.0, 0.02, edge_m) + 0.0025 * (hash(id, row, seed + 3) - 0.5);
        let gap = step(0.005, 0.0025, edge_m);
        texel.tint(vec3(0.2, 0.19, 0.17), 0.85 * gap);
        texel.height_m -= 0.003 * gap;
        texel.albedo *= 1.0 - 0.4 * step(-0.05, 0.8, soot.at(p) + 0.5 * runs.at(p));
        texel
    })
}

/// Field stones of all sizes in much mortar.
pub(super) fn rubble(color: Vec3, seed: u32, detail: u32) -> Canvas {
    let size = [2.4, 2.4];
    let size_m = Vec2::from_array(size);
    let noise = |feature: Vec2, salt| Noise::stretched(size_m, feature, seed * 31 + salt);
    let (stones, bend) = (noise(vec2(0.27, 0.17), 1), noise(Vec2::splat(0.12), 2).field(3));
    let (grain, moss) = (noise(Vec2::splat(0.014), 3), noise(Vec2::splat(0.5), 4).field(4));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let stone = stones.near(p + 0.025 * vec2(bend.at(p), bend.at(p + size_m * 0.43)));
        let (edge, g) = (stone.second - stone.first, grain.fbm(p, 4));
        let hue = vec3(1.0 + 0.3 * (stone.id - 0.5), 1.0, 1.0 - 0.35 * (stone.id - 0.5));
        let face = step(0.09, 0.2, edge + 0.03 * g);
        let mut texel = Texel::new(vec3(0.3, 0.285, 0.25) * (1.0 + 0.15 * g), 0.92);
        texel.tint(color * hue * (0.6 + 0.75 * (stone.id * 7.3).fract()) * (1.0 + 0.25 * g), face);
        texel.tint(vec3(0.06, 0.07, 0.03), 0.4 * step(0.25, 0.7, moss.at(p)));
        texel.height_m = 0.022 * step(0.06, 0.5, edge) + 0.003 * g;
        texel
    })
}

/// Granite: grains of feldspar, quartz and mica.
pub(super) fn granite(detail: u32) -> Canvas {
    let size = [0.6, 0.6];
    let size_m = Vec2::from_array(size);
    let noise = |feature_m, salt: u32| Noise::new(size_m, feature_m, 350 + salt);
    let (grains, mica, cloud) = (noise(0.0045, 1), noise(0.007, 2), noise(0.2, 3).field(3));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let (grain, dark) = (grains.near(p), mica.near(p));
        let mut texel = Texel::new(vec3(0.34, 0.325, 0.31) * (0.65 + 0.7 * grain.id), 0.6 - 0.2 * grain.id);
        texel.tint(Vec3::splat(0.05), 0.85 * step(0.4, 0.3, dark.first) * step(0.68, 0.72, dark.id));
        texel.albedo *= 1.0 - 0.2 * step(0.0, 0.7, cloud.at(p));
        texel.height_m = 0.0001 * grain.id;
        texel
    })
}

/// Square tiles on their own glaze: `gloss` for glazed ones; without it fired clay.
pub(super) fn tiles(color: Vec3, tile_m: f32, gloss: bool, seed: u32, detail: u32) -> Canvas {
    let size_m = Vec2::splat(tile_m * 10.0);
    let noise = |feature_m, salt| Noise::new(size_m, feature_m, seed * 31 + salt);
    let (grain, cloud) = (noise(0.01, 1), noise(0.3, 2).field(4));
    Canvas::new([512 * detail, 512 * detail], size_m.to_array(), |p| {
        let id = (p / tile_m).floor().as_ivec2();
        let within = p - id.as_vec2() * tile_m;
        let edge_m = within.min(tile_m - within).min_element();
        let drawn = |salt: u32| hash(id.x, id.y, seed + salt);
        let tone = 1.0 + if gloss { 0.06 } else { 0.3 } * (drawn(0) - 0.5) + 0.06 * cloud.at(p);
        let g = grain.fbm(p, 2);
        let mut texel =
            Texel::new(color * tone * (1.0 + if gloss { 0.01 } else { 0.12 } * g), if gloss { 0.12 } else { 0.75 });
        let tilt = vec2(drawn(1), drawn(2)) - 0.5;
        texel.height_m = tilt.dot(within - tile_m / 2.0) * 0.012 + if gloss { 0.0 } else { 0.0003 * g };
        let joint = step(0.004, 0.002, edge_m);
        texel.tint(Vec3::splat(0.3) * (1.0 + 0.3 * g - 0.4 * step(0.0, 0.6, cloud.at(p))), joint);
        texel.roughness += 0.7 * joint * if gloss { 1.0 } else { 0.2 };
        texel.height_m -= 0.0015 * joint;
        texel
    })
}
