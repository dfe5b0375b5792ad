//! Plastics, rubber, glass, lacquer, sheeting.

use glam::{Vec2, Vec3, vec2, vec3};

use super::canvas::{Canvas, Strokes, Texel};
use super::noise::{Noise, step};

/// Moulded plastic in white, for objects to colour: bleached, scuffed where things rubbed it, scratched, with grime in
/// the runs of rain.
pub(super) fn plastic(detail: u32) -> Canvas {
    let size = [1.6, 1.6];
    let size_m = Vec2::from_array(size);
    let noise = |feature: Vec2, salt: u32| Noise::stretched(size_m, feature, 100 + salt);
    let (bleach, mould) = (noise(Vec2::splat(0.6), 1).field(3), noise(Vec2::splat(0.0045), 2));
    let (rub, hatch) = (noise(vec2(0.5, 0.2), 3).field(4), noise(vec2(0.12, 0.004), 4));
    let (runs, grime, dents) = (
        noise(vec2(0.04, 0.8), 5).field(3),
        noise(Vec2::splat(0.14), 6).field(4),
        noise(Vec2::splat(0.25), 7).field(2),
    );
    let mut canvas = Canvas::new([512 * detail, 512 * detail], size, |p| {
        let mut texel = Texel::new(Vec3::splat(0.86 + 0.05 * bleach.at(p)), 0.5 + 0.06 * bleach.at(p));
        let rubbed = step(0.2, 0.55, rub.at(p)) * (0.55 + 0.45 * hatch.at(p));
        texel.tint(Vec3::splat(0.7), 0.3 * rubbed);
        texel.roughness += 0.2 * rubbed;
        let dirty = step(0.05, 0.7, 0.7 * grime.at(p) + 0.6 * runs.at(p));
        texel.tint(vec3(0.34, 0.3, 0.25), 0.42 * dirty);
        texel.roughness += 0.2 * dirty;
        texel.height_m = 0.000_03 * mould.at(p) + 0.003 * dents.at(p);
        texel
    });
    let scratches = Strokes { count: 420, length_m: [0.01, 0.3], width_m: 0.0012, turn_rad: [-0.9, 0.9], seed: 108 };
    canvas.strokes(scratches, |texel, share, drawn| {
        texel.tint(Vec3::splat(if drawn > 0.6 { 0.25 } else { 1.0 }), share * 0.45 * (0.3 + drawn));
        texel.height_m -= 0.0002 * share;
    });
    canvas
}

/// Black rubber, grey where it is worn and dusty.
pub(super) fn rubber(detail: u32) -> Canvas {
    let size = [0.6, 0.6];
    let size_m = Vec2::from_array(size);
    let (dust, grain) = (Noise::new(size_m, 0.12, 121).field(4), Noise::new(size_m, 0.005, 122));
    let mut canvas = Canvas::new([256 * detail, 256 * detail], size, |p| {
        let g = grain.at(p);
        let mut texel = Texel::new(Vec3::splat(0.024 + 0.004 * g), 0.72 + 0.1 * dust.at(p));
        texel.tint(vec3(0.13, 0.12, 0.105), 0.45 * step(-0.1, 0.7, dust.at(p) + 0.15 * g));
        texel.height_m = 0.0002 * g;
        texel
    });
    let scuffs = Strokes { count: 60, length_m: [0.01, 0.1], width_m: 0.0015, turn_rad: [-1.6, 1.6], seed: 123 };
    canvas.strokes(scuffs, |texel, share, drawn| texel.tint(Vec3::splat(0.12), 0.5 * share * drawn));
    canvas
}

/// A pane's reflectance with smears that dull it; the material lets the light through.
pub(super) fn glass(detail: u32) -> Canvas {
    let size = [1.5, 1.5];
    let size_m = Vec2::from_array(size);
    let (wiped, runs, wavy) = (
        Noise::stretched(size_m, vec2(0.5, 0.1), 131).field(4),
        Noise::stretched(size_m, vec2(0.03, 0.6), 132).field(3),
        Noise::new(size_m, 0.5, 133).field(2),
    );
    Canvas::new([256 * detail, 256 * detail], size, |p| {
        let smear = step(0.1, 0.8, wiped.at(p) + 0.5 * runs.at(p));
        let mut texel = Texel::new(vec3(0.87, 0.93, 0.91) * (1.0 - 0.06 * smear), 0.03 + 0.06 * smear);
        texel.height_m = 0.0008 * wavy.at(p);
        texel
    })
}

/// Lacquer of cars in white, for objects to colour: a trace of orange peel, dust, the rings that washing leaves.
pub(super) fn lacquer(detail: u32) -> Canvas {
    let size = [1.2, 1.2];
    let size_m = Vec2::from_array(size);
    let (peel, dust) = (Noise::new(size_m, 0.006, 141), Noise::new(size_m, 0.25, 142).field(4));
    let mut canvas = Canvas::new([256 * detail, 256 * detail], size, |p| {
        let dusty = step(0.0, 0.8, dust.at(p));
        let mut texel = Texel::new(Vec3::splat(0.97 - 0.04 * dusty), 0.34 + 0.08 * dusty);
        texel.height_m = 0.000_008 * peel.at(p);
        texel
    });
    let swirls = Strokes { count: 200, length_m: [0.02, 0.12], width_m: 0.0005, turn_rad: [-1.6, 1.6], seed: 143 };
    canvas.strokes(swirls, |texel, share, drawn| texel.roughness += 0.06 * share * drawn);
    canvas
}

/// Retroreflective sheeting in white, for objects to colour: cells of prisms, scratches, grime.
pub(super) fn sheeting(detail: u32) -> Canvas {
    let size = [0.8, 0.8];
    let size_m = Vec2::from_array(size);
    let (grime, runs) =
        (Noise::new(size_m, 0.15, 151).field(4), Noise::stretched(size_m, vec2(0.04, 0.6), 152).field(3));
    let mut canvas = Canvas::new([256 * detail, 256 * detail], size, |p| {
        // Hexagons of a centimetre by their rims.
        let q = vec2(p.x / 0.01, p.y / 0.01);
        let rim = [vec2(1.0, 0.0), vec2(0.5, 0.75), vec2(-0.5, 0.75)].map(|n| (q.dot(n) - q.dot(n).round()).abs());
        let cell = step(0.06, 0.02, rim.into_iter().fold(1.0, f32::min));
        let dirty = step(0.1, 0.8, 0.7 * grime.at(p) + 0.5 * runs.at(p));
        let mut texel = Texel::new(Vec3::splat(0.92 - 0.08 * cell), 0.32);
        texel.tint(vec3(0.36, 0.32, 0.27), 0.4 * dirty);
        texel.roughness += 0.25 * dirty;
        texel
    });
    let scratches = Strokes { count: 90, length_m: [0.01, 0.12], width_m: 0.001, turn_rad: [-1.2, 1.2], seed: 153 };
    canvas.strokes(scratches, |texel, share, drawn| texel.albedo *= 1.0 - 0.5 * share * drawn);
    canvas
}
