//! What is behind windows and above shops: back walls of rooms, and signs with made-up names.

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{Lettering, Random, Seed};

use super::canvas::{Canvas, Texel};
use super::noise::{hash, step};

/// Signs across and up.
pub(super) const SIGNS: [u32; 2] = [2, 8];
/// Rooms across, and a row each of homes, offices and shops.
pub(super) const ROOMS: [u32; 2] = [4, 3];

const NAMES: [&str; 16] = [
    "KORVA",
    "BELLINO",
    "CAFE LUMO",
    "ATELIER 9",
    "NORD & SON",
    "PANETTA",
    "MIRAVO",
    "SPEZI",
    "TULIPAN",
    "HOLM BOOKS",
    "OPTIK VERA",
    "FARO BAR",
    "LOTUS TEA",
    "VELO RAD",
    "BAKERY",
    "PHARMACY",
];

/// A cell each, 3.2 × 0.6 m.
pub(super) fn signs(seed: u32) -> Canvas {
    let cell = vec2(3.2, 0.6);
    let size = cell * vec2(SIGNS[0] as f32, SIGNS[1] as f32);
    let grounds = [
        vec3(0.3, 0.03, 0.03),
        vec3(0.03, 0.1, 0.22),
        vec3(0.03, 0.14, 0.07),
        vec3(0.45, 0.3, 0.03),
        vec3(0.03, 0.03, 0.035),
        vec3(0.55, 0.55, 0.52),
        vec3(0.12, 0.05, 0.025),
    ];
    let mut canvas = Canvas::new([1024, 1024], size.to_array(), |_| Texel::new(Vec3::splat(0.1), 0.45));
    for (i, name) in NAMES.iter().enumerate() {
        let corner = vec2((i % 2) as f32, (i / 2) as f32) * cell;
        let ground = grounds[(i * 3 + i / 7) % grounds.len()];
        let ink = if ground.y > 0.28 { vec3(0.05, 0.04, 0.04) } else { vec3(0.62, 0.6, 0.52) };
        let writing = Lettering::new(name);
        let high = (2.6 / (name.len() as f32 * 0.95)).min(0.36);
        let heavy = 0.07 + 0.04 * hash(i as i32, 1, seed);
        canvas.rect(corner, corner + cell, |p, texel| {
            *texel = Texel::new(ground * (0.95 + 0.1 * hash((p.x * 60.0) as i32, (p.y * 60.0) as i32, seed)), 0.45);
            let away = writing.distance((p - cell / 2.0) / high);
            texel.tint(ink, step(heavy + 0.02, heavy - 0.02, away));
            let rim = p.min(cell - p).min_element();
            texel.tint(ink, if i % 3 == 0 { step(0.05, 0.04, rim) * step(0.02, 0.03, rim) } else { 0.0 });
        });
    }
    canvas
}

/// A cell each, 3.2 × 2.6 m.
pub(super) fn rooms(seed: u32) -> Canvas {
    let cell = vec2(3.2, 2.6);
    let size = cell * vec2(ROOMS[0] as f32, ROOMS[1] as f32);
    let mut canvas = Canvas::new([1024, 768], size.to_array(), |_| Texel::new(Vec3::splat(0.4), 0.9));
    for i in 0..ROOMS[0] * ROOMS[1] {
        let corner = vec2((i % ROOMS[0]) as f32, (i / ROOMS[0]) as f32) * cell;
        let mut random = Seed(u64::from(seed)).nth(u64::from(i)).random();
        match i / ROOMS[0] {
            0 => home(&mut canvas, corner, cell, &mut random),
            1 => office(&mut canvas, corner, cell, &mut random),
            _ => shop(&mut canvas, corner, cell, &mut random),
        }
    }
    canvas
}

fn fill(canvas: &mut Canvas, low: Vec2, size: Vec2, color: Vec3) {
    canvas.rect(low, low + size, |p, texel| {
        let rim = step(0.03, 0.0, p.min(size - p).min_element());
        *texel = Texel::new(color * (1.0 - 0.35 * rim), 0.7);
    });
}

fn home(canvas: &mut Canvas, corner: Vec2, cell: Vec2, random: &mut Random) {
    // Rooms get little of the light that a street gets, so that their walls are painted in the shade of their depth.
    let walls = [vec3(0.36, 0.34, 0.29), vec3(0.33, 0.27, 0.19), vec3(0.25, 0.28, 0.3), vec3(0.36, 0.36, 0.34)];
    let wall = walls[random.index(4)];
    canvas.rect(corner, corner + cell, |p, texel| *texel = Texel::new(wall * (1.0 - 0.1 * p.y / cell.y), 0.9));
    fill(canvas, corner, vec2(cell.x, 0.1), vec3(0.5, 0.5, 0.48));
    if random.chance(0.6) {
        fill(canvas, corner + vec2(random.range(0.1, 2.0) as f32, 0.0), vec2(0.9, 2.05), vec3(0.42, 0.38, 0.32));
    }
    let x = random.range(0.2, 1.6) as f32;
    fill(canvas, corner + vec2(x, 0.0), vec2(1.5, 0.75), vec3(0.12, 0.08, 0.06) * random.range(0.7, 3.0) as f32);
    for k in 0..2 {
        let low = corner + vec2(x + 0.1 + 0.75 * k as f32, random.range(1.25, 1.5) as f32);
        let hue = vec3(random.unit() as f32, random.unit() as f32, random.unit() as f32) * 0.4;
        fill(canvas, low, vec2(0.5, random.range(0.4, 0.7) as f32), hue);
    }
}

fn office(canvas: &mut Canvas, corner: Vec2, cell: Vec2, random: &mut Random) {
    canvas.rect(corner, corner + cell, |_, texel| *texel = Texel::new(vec3(0.27, 0.27, 0.265), 0.9));
    fill(canvas, corner + vec2(random.range(0.0, 2.0) as f32, 0.0), vec2(1.1, 1.9), vec3(0.25, 0.26, 0.28));
    for k in 0..3 {
        let x = 0.15 + k as f32 * 1.05;
        fill(canvas, corner + vec2(x, 0.7), vec2(0.9, 0.06), vec3(0.45, 0.4, 0.33));
        fill(canvas, corner + vec2(x + 0.2, 0.8), vec2(0.5, 0.34), Vec3::splat(0.03));
        fill(canvas, corner + vec2(x + 0.25, 0.2), vec2(0.45, 0.75), vec3(0.05, 0.06, 0.08));
    }
}

fn shop(canvas: &mut Canvas, corner: Vec2, cell: Vec2, random: &mut Random) {
    let salt = random.bits() as u32;
    let rows = 5.0 + random.index(3) as f32;
    let wall = vec3(0.42, 0.38, 0.31) * random.range(0.6, 1.1) as f32;
    canvas.rect(corner, corner + cell, |p, texel| {
        let row = p.y / cell.y * rows;
        let (shelf, up) = (row as i32, row.fract());
        let column = (p.x / 0.11) as i32;
        let thing = hash(column, shelf, salt);
        *texel = Texel::new(wall, 0.8);
        if up < 0.1 {
            texel.albedo = vec3(0.3, 0.25, 0.2);
        } else if row < rows - 1.3 && up < 0.35 + 0.55 * thing && thing > 0.12 {
            let hue = vec3(hash(column, shelf, salt + 1), hash(column, shelf, salt + 2), hash(column, shelf, salt + 3));
            // Packages are printed in many colours, most of them dull.
            texel.albedo = 0.04 + 0.45 * (hue * hue).lerp(Vec3::splat(hue.y * hue.y), 0.6);
        } else if row < rows - 1.3 {
            texel.albedo *= 0.45;
        }
    });
}
