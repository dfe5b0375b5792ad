//! What is woven, coated or tanned.

use glam::{Vec2, Vec3, vec2, vec3};

use super::canvas::{Canvas, Strokes, Texel};
use super::noise::{Noise, hash, step};

/// Height (0 to 1) of the thread on top at a point of a plain weave, whether it runs along u, and its number.
fn weave(p: Vec2, thread_m: f32, over: i32) -> (f32, bool, (i32, i32)) {
    let q = p / thread_m;
    let cell = q.floor().as_ivec2();
    let f = q - q.floor() - 0.5;
    let along = (cell.x + cell.y * if over > 1 { 1 } else { 3 }).rem_euclid(over + 1) != 0;
    let across = if along { f.y } else { f.x };
    let crown = (1.0 - 4.0 * across * across).max(0.0).sqrt();
    (crown, along, (cell.x, cell.y))
}

/// A plain weave in white, for objects to colour.
pub(super) fn woven(detail: u32) -> Canvas {
    let size = [0.32, 0.32];
    let size_m = Vec2::from_array(size);
    let (slub, worn) = (Noise::stretched(size_m, vec2(0.08, 0.0025), 1), Noise::new(size_m, 0.1, 2).field(3));
    Canvas::new([256 * detail, 256 * detail], size, |p| {
        let (crown, _, _) = weave(p, 0.0025, 1);
        let tone = 0.84 + 0.06 * slub.at(p) + 0.06 * worn.at(p) - 0.2 * (1.0 - crown);
        let mut texel = Texel::new(Vec3::splat(tone), 0.9);
        texel.height_m = 0.0003 * crown;
        texel
    })
}

/// Blue twill, washed pale along its ridges.
pub(super) fn denim(detail: u32) -> Canvas {
    let size = [0.3, 0.3];
    let size_m = Vec2::from_array(size);
    let (fade, slub) = (Noise::new(size_m, 0.12, 11).field(4), Noise::stretched(size_m, vec2(0.003, 0.06), 12));
    Canvas::new([256 * detail, 256 * detail], size, |p| {
        let (crown, weft, cell) = weave(p, 0.0025, 2);
        let wear = 0.5 + 0.6 * fade.at(p) + 0.2 * slub.at(p) + 0.2 * (hash(cell.0 % 120, cell.1 % 120, 3) - 0.5);
        let blue = vec3(0.022, 0.034, 0.075).lerp(vec3(0.12, 0.16, 0.23), wear.clamp(0.0, 1.0));
        let mut texel = Texel::new(if weft { blue } else { vec3(0.2, 0.21, 0.22) } * (0.55 + 0.45 * crown), 0.92);
        texel.height_m = 0.0003 * crown;
        texel
    })
}

/// Coated cloth of lorries and sheds in white, for objects to colour: welded seams, folds, dust in them, scuffs.
pub(super) fn tarpaulin(detail: u32) -> Canvas {
    let size = [2.4, 2.4];
    let size_m = Vec2::from_array(size);
    let noise = |feature: Vec2, salt: u32| Noise::stretched(size_m, feature, 20 + salt);
    let (sag, fold) = (noise(Vec2::splat(0.6), 1).field(3), noise(vec2(0.1, 0.8), 2).field(3));
    let (cloud, fine) = (noise(Vec2::splat(0.35), 3).field(4), noise(Vec2::splat(0.012), 4));
    let runs = noise(vec2(0.05, 1.2), 5).field(3);
    let mut canvas = Canvas::new([512 * detail, 512 * detail], size, |p| {
        let seam_m = (p.x / 1.2 - (p.x / 1.2).round()).abs() * 1.2;
        let folded = fold.at(p);
        let dust = step(0.0, 0.7, cloud.at(p) - 0.4 * folded + 0.5 * runs.at(p));
        let mut texel = Texel::new(Vec3::splat(0.9 + 0.03 * folded), 0.5);
        texel.tint(vec3(0.5, 0.46, 0.4), 0.32 * dust);
        texel.albedo *= 1.0 - 0.1 * step(0.028, 0.024, seam_m) * step(0.0, 0.02, seam_m);
        texel.roughness += 0.25 * dust;
        texel.height_m =
            0.012 * sag.at(p) + 0.006 * folded + 0.0004 * step(0.028, 0.025, seam_m) + 0.00003 * fine.at(p);
        texel
    });
    let creases = Strokes { count: 120, length_m: [0.1, 0.7], width_m: 0.003, turn_rad: [-1.6, 1.6], seed: 27 };
    canvas.strokes(creases, |texel, share, drawn| {
        texel.albedo *= 1.0 - 0.14 * share * drawn;
        texel.height_m += 0.0012 * share * (drawn - 0.4);
    });
    canvas
}

/// Grained leather in white, for objects to colour.
pub(super) fn leather(detail: u32) -> Canvas {
    let size = [0.3, 0.3];
    let size_m = Vec2::from_array(size);
    let (grain, worn) = (Noise::new(size_m, 0.0035, 31), Noise::new(size_m, 0.09, 32).field(3));
    Canvas::new([256 * detail, 256 * detail], size, |p| {
        let cell = grain.near(p);
        let valley = step(0.14, 0.02, cell.second - cell.first);
        let mut texel = Texel::new(Vec3::splat(0.86 - 0.25 * valley + 0.06 * worn.at(p)), 0.48 + 0.1 * worn.at(p));
        texel.height_m = 0.00025 * (1.0 - valley) + 0.0001 * cell.id;
        texel
    })
}

/// Brown board with its flutes showing through, for boxes.
pub(super) fn cardboard(detail: u32) -> Canvas {
    let size = [0.6, 0.6];
    let size_m = Vec2::from_array(size);
    let (fibre, cloud) = (Noise::stretched(size_m, vec2(0.004, 0.02), 41), Noise::new(size_m, 0.15, 42).field(4));
    let mut canvas = Canvas::new([256 * detail, 256 * detail], size, |p| {
        let flute = (p.x / 0.0075 * std::f32::consts::TAU).sin();
        let tone = 1.0 + 0.05 * fibre.at(p) + 0.1 * cloud.at(p) + 0.012 * flute;
        let mut texel = Texel::new(vec3(0.36, 0.235, 0.13) * tone, 0.85);
        texel.height_m = 0.00006 * flute + 0.0008 * cloud.at(p);
        texel
    });
    let creases = Strokes { count: 40, length_m: [0.03, 0.2], width_m: 0.002, turn_rad: [-1.6, 1.6], seed: 43 };
    canvas.strokes(creases, |texel, share, drawn| {
        texel.albedo *= 1.0 - 0.25 * share * drawn;
        texel.height_m -= 0.0006 * share;
    });
    canvas
}
