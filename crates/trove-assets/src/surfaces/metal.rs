//! Metals, bare, rusty and painted.

use glam::{Vec2, Vec3, vec2, vec3};

use super::canvas::{Canvas, Strokes, Texel};
use super::noise::{Noise, hash, step};

/// Rust from its young orange to its old brown, for a number from 0 to 1.
fn rust_color(age: f32) -> Vec3 {
    vec3(0.27, 0.1, 0.03).lerp(vec3(0.075, 0.034, 0.022), age.clamp(0.0, 1.0))
}

/// Zinc in crystals of a centimetre, dulled in clouds and along the ways of rain.
pub(super) fn galvanised(detail: u32) -> Canvas {
    let size = [1.0, 1.0];
    let size_m = Vec2::from_array(size);
    let (crystals, fine) = (Noise::new(size_m, 0.014, 3), Noise::new(size_m, 0.006, 4));
    let (clouds, runs) = (Noise::new(size_m, 0.22, 5).field(4), Noise::stretched(size_m, vec2(0.03, 0.5), 6).field(3));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let (large, small) = (crystals.near(p), fine.near(p));
        let dull = step(-0.25, 0.5, clouds.at(p) + 0.35 * runs.at(p));
        let tone = 0.4 + 0.09 * (large.id - 0.5) + 0.05 * (small.id - 0.5);
        let mut texel = Texel::new(vec3(0.98, 1.0, 1.02) * tone, 0.36 + 0.1 * large.id + 0.2 * dull);
        texel.tint(vec3(0.34, 0.345, 0.35), 0.75 * dull);
        texel.metalness = 0.85 - 0.45 * dull;
        texel.height_m = 0.00002 * large.id;
        texel
    })
}

/// Brushed along u.
pub(super) fn brushed(detail: u32) -> Canvas {
    let size = [0.5, 0.5];
    let size_m = Vec2::from_array(size);
    let (hair, smear) = (Noise::stretched(size_m, vec2(0.25, 0.002), 1), Noise::new(size_m, 0.12, 2).field(3));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let (line, hand) = (hair.at(p), step(0.0, 0.6, smear.at(p)));
        let mut texel = Texel::new(Vec3::splat(0.57 + 0.04 * line - 0.05 * hand), 0.3 + 0.06 * line + 0.12 * hand);
        texel.metalness = 1.0;
        texel.height_m = 0.000_01 * line;
        texel
    })
}

/// Cast iron that was black once.
pub(super) fn cast(detail: u32) -> Canvas {
    let size = [0.6, 0.6];
    let size_m = Vec2::from_array(size);
    let (grain, rust) = (Noise::new(size_m, 0.006, 1), Noise::new(size_m, 0.09, 2).field(4));
    Canvas::new([256 * detail, 256 * detail], size, |p| {
        let g = grain.fbm(p, 2);
        let mut texel = Texel::new(Vec3::splat(0.05) * (1.0 + 0.3 * g), 0.6);
        let rusty = step(0.1, 0.55, rust.at(p) + 0.2 * g);
        texel.tint(rust_color(0.6 + 0.5 * g), 0.6 * rusty);
        texel.metalness = 0.6 * (1.0 - rusty);
        texel.roughness += 0.25 * rusty;
        texel.height_m = 0.0003 * g;
        texel
    })
}

/// Steel that has rusted through and through.
pub(super) fn rusted(detail: u32) -> Canvas {
    let size = [1.2, 1.2];
    let size_m = Vec2::from_array(size);
    let noise = |feature_m, salt: u32| Noise::new(size_m, feature_m, 40 + salt);
    let (broad, scale, pits) = (noise(0.3, 1).field(4), noise(0.035, 2), noise(0.012, 3));
    let runs = Noise::stretched(size_m, vec2(0.05, 0.7), 44).field(3);
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let (b, s) = (broad.at(p), scale.fbm(p, 4));
        let age = 0.5 + 0.7 * b + 0.5 * s + 0.3 * runs.at(p);
        let mut texel = Texel::new(rust_color(age) * (1.0 + 0.3 * s), 0.88 - 0.08 * s);
        let pit = pits.near(p);
        texel.height_m = 0.0006 * s - 0.0006 * step(0.35, 0.1, pit.first);
        texel
    })
}

/// White paint, for objects to colour: scratched, chipped down to the steel, rust running from the chips down v.
pub(super) fn painted(detail: u32) -> Canvas {
    let size = [1.6, 1.6];
    let size_m = Vec2::from_array(size);
    let noise = |feature_m, salt: u32| Noise::new(size_m, feature_m, 60 + salt);
    let (patches, chip, ragged) = (noise(0.5, 1).field(3), noise(0.055, 2), noise(0.012, 3));
    let (fade, dents) = (noise(0.35, 4).field(4), noise(0.4, 5).field(2));
    let orange_peel = noise(0.004, 6);
    // How far a point lies within a chip, above 0.
    let chipped = |p: Vec2| {
        let cell = chip.near(p);
        let size = step(0.62, 1.0, cell.id) * step(-0.1, 0.5, patches.at(p) + 0.15) * 0.34;
        size - cell.first - 0.1 * ragged.at(p)
    };
    let mut canvas = Canvas::new([512 * detail, 512 * detail], size, |p| {
        let mut texel = Texel::new(Vec3::splat(0.9 + 0.06 * fade.at(p)), 0.4 + 0.07 * fade.at(p));
        texel.height_m = 0.0012 * dents.at(p) + 0.000_004 * orange_peel.at(p);
        for below in 1..5 {
            let run = step(0.0, 0.1, chipped(p + vec2(0.004 * ragged.at(p), 0.018 * below as f32)));
            texel.tint(vec3(0.4, 0.24, 0.12), run * (0.34 - 0.06 * below as f32));
        }
        let bare = step(0.0, 0.03, chipped(p));
        texel.tint(rust_color(0.35 + 0.5 * ragged.at(p)) * 1.3, bare);
        texel.roughness += 0.45 * bare;
        texel.height_m -= 0.0003 * bare;
        texel
    });
    let scratches = Strokes { count: 260, length_m: [0.02, 0.22], width_m: 0.0009, turn_rad: [-0.7, 0.7], seed: 66 };
    canvas.strokes(scratches, |texel, share, drawn| {
        texel.albedo *= 1.0 - share * (0.12 + 0.35 * drawn * drawn);
        texel.roughness += 0.2 * share;
    });
    canvas
}

/// Sheet with raised lozenges, every second one turned.
pub(super) fn diamond_plate(detail: u32) -> Canvas {
    let size = [0.48, 0.48];
    let size_m = Vec2::from_array(size);
    let (grime, fine) = (Noise::new(size_m, 0.1, 81).field(3), Noise::new(size_m, 0.01, 82));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let q = p / 0.04;
        let cell = q.floor();
        let turned = (cell.x + cell.y) as i32 % 2 == 0;
        let within = Vec2::from_angle(if turned { 0.785 } else { -0.785 }).rotate(q - cell - 0.5);
        let edge = 1.0 - (within.x / 0.5).powi(2) - (within.y / 0.15).powi(2);
        let top = step(0.0, 0.4, edge);
        let dirt = step(-0.2, 0.5, grime.at(p) + 0.2 * fine.at(p)) * (1.0 - 0.8 * top);
        let mut texel = Texel::new(Vec3::splat(0.3 + 0.12 * top + 0.03 * fine.at(p)), 0.42 - 0.1 * top);
        texel.tint(vec3(0.09, 0.08, 0.068), 0.7 * dirt);
        texel.metalness = 0.9 - 0.6 * dirt;
        texel.roughness += 0.3 * dirt;
        texel.height_m = 0.0014 * top;
        texel
    })
}

/// Waved sheets, rust along their laps and screws.
pub(super) fn corrugated(detail: u32) -> Canvas {
    let (size, wave_m) = ([1.52, 2.0], 0.076);
    let size_m = Vec2::from_array(size);
    let noise = |feature: Vec2, salt: u32| Noise::stretched(size_m, feature, 90 + salt);
    let (rust, runs, fine) =
        (noise(Vec2::splat(0.4), 1).field(4), noise(vec2(0.05, 0.9), 2).field(3), noise(Vec2::splat(0.02), 3));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let phase = p.x / wave_m;
        let wave = (phase * std::f32::consts::TAU).sin();
        let sheet = (p.x / 0.76) as i32;
        let side_m = (p.x / 0.76 - (p.x / 0.76).round()).abs() * 0.76;
        let lap = step(0.05, 0.0, p.y.min(size_m.y - p.y)) + 0.5 * step(0.05, 0.02, side_m);
        let screw = vec2((phase - 0.25 - (phase - 0.25).round()) * wave_m, p.y % (size_m.y / 3.0) - 0.08).length();
        let rusty = step(0.2, 0.75, rust.at(p) + 0.45 * runs.at(p) + 0.5 * lap + 0.08 * fine.at(p));
        let mut texel = Texel::new(Vec3::splat(0.36 + 0.04 * hash(sheet % 2, 0, 91)) * (1.0 + 0.06 * runs.at(p)), 0.45);
        texel.tint(rust_color(0.4 + 0.6 * fine.at(p)), rusty);
        texel.albedo *= 1.0 - 0.55 * step(0.012, 0.008, screw);
        texel.metalness = 0.7 * (1.0 - rusty);
        texel.roughness += 0.4 * rusty;
        texel.height_m = 0.009 * wave;
        texel
    })
}
