//! The carriageway: asphalt, paint, setts, iron covers.

use glam::{Vec2, Vec3, vec2, vec3};

use super::canvas::{Canvas, Texel};
use super::noise::{Noise, hash, step};

/// Asphalt's character.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wear {
    /// Colour of the binder between the stones.
    pub(super) binder: f32,
    /// Colour of the stones.
    pub(super) stone: f32,
    /// Size of the stones.
    pub(super) stone_m: f32,
    /// Share of the stones that the binder has worn off, 0 to 1.
    pub(super) worn: f32,
    /// Hairline cracks, 0 to 1.
    pub(super) cracks: f32,
    /// What the texture covers, each way.
    pub(super) size_m: f32,
    pub(super) seed: u32,
}

/// Stones in bitumen, stains, hairline cracks.
pub(super) fn asphalt(kind: Wear, detail: u32) -> Canvas {
    let size = [kind.size_m; 2];
    let size_m = Vec2::from_array(size);
    // Stones of a centimetre get two texels.
    let side = (kind.size_m / 6.0 * 1024.0) as u32 * detail;
    let noise = |feature_m, salt| Noise::new(size_m, feature_m, kind.seed * 31 + salt);
    let (stones, grain, blotch, stain) =
        (noise(kind.stone_m, 1), noise(0.05, 2), noise(1.5, 3).field(3), noise(0.6, 4).field(3));
    let (plates, warp, sparse) = (noise(2.0, 5), noise(0.35, 6).field(3), noise(1.7, 7));
    // Dust of the ground takes the blue away.
    let warm = vec3(1.04, 1.0, 0.93);
    Canvas::new([side, side], size, |p| {
        let stone = stones.near(p);
        let broad = blotch.at(p);
        let shown = step(0.62, 0.25, stone.first) * step(1.0 - kind.worn, 1.15 - kind.worn, stone.id + 0.25 * broad);
        let tone = kind.stone * (0.65 + 0.7 * stone.id);
        let mut value = kind.binder * (1.0 + 0.22 * grain.at(p)) + (tone - kind.binder) * shown;
        value *= 1.0 + 0.1 * broad - 0.12 * step(0.25, 0.7, stain.at(p));
        let mut texel = Texel::new(warm * value, 0.86 - 0.1 * shown);
        texel.height_m = 0.0012 * step(0.7, 0.2, stone.first) + 0.0015 * grain.at(p);
        if kind.cracks > 0.0 {
            let bent = p + vec2(warp.at(p), warp.at(p + size_m * 0.37)) * 0.22;
            let cell = plates.near(bent);
            let open = step(0.25, 0.55, sparse.at(p) + kind.cracks - 0.45);
            let crack = step(0.012, 0.003, cell.second - cell.first) * open;
            texel.tint(Vec3::splat(0.022), 0.85 * crack);
            texel.height_m -= 0.004 * crack;
        }
        texel
    })
}

/// Asphalt in which trenches were closed with darker asphalt, its seams poured.
pub(super) fn patched(kind: Wear, patch: Wear, detail: u32) -> Canvas {
    let (mut canvas, fresh) = (asphalt(kind, detail), asphalt(patch, detail));
    let edge = Noise::new(canvas.size_m, 0.2, kind.seed * 31 + 9).field(4);
    for (low, size) in
        [(vec2(0.7, 0.9), vec2(1.3, 2.6)), (vec2(3.1, 3.7), vec2(2.2, 0.9)), (vec2(4.3, 1.0), vec2(0.8, 0.8))]
    {
        canvas.rect(low - 0.1, low + size + 0.1, |p, texel| {
            let q = p - 0.1;
            let inside_m = q.min(size - q).min_element() + 0.02 * edge.at(p + low);
            let share = step(-0.008, 0.008, inside_m);
            let within = fresh.at(p + low - 0.1);
            texel.tint(within.albedo, share);
            texel.height_m += (within.height_m + 0.003 - texel.height_m) * share;
            let poured = step(0.035, 0.02, inside_m.abs());
            texel.tint(Vec3::splat(0.028), 0.9 * poured);
            texel.roughness -= 0.35 * poured;
        });
    }
    canvas
}

/// Road paint that has worn off in places (alpha), over stones that show through.
pub(super) fn marking(color: Vec3, seed: u32, detail: u32) -> Canvas {
    let size = [3.0, 3.0];
    let noise = |feature_m, salt| Noise::new(Vec2::from_array(size), feature_m, seed * 31 + salt);
    let (stones, grain, blotch, dirt) =
        (noise(0.014, 1), noise(0.03, 2), noise(0.6, 3).field(4), noise(0.25, 4).field(3));
    let (plates, warp) = (noise(0.4, 5), noise(0.12, 6).field(2));
    Canvas::new([768 * detail, 768 * detail], size, |p| {
        let stone = stones.near(p);
        let broad = blotch.at(p);
        let worn = broad + 0.5 * (0.5 - stone.first) + 0.3 * grain.at(p);
        let grime = 0.22 * step(0.1, 0.8, worn) + 0.16 * step(-0.2, 0.6, dirt.at(p));
        let mut texel = Texel::new(color.lerp(vec3(0.15, 0.145, 0.135), grime), 0.62);
        texel.height_m = 0.001 * step(0.7, 0.2, stone.first);
        // Thick paint breaks along cracks before it flakes off.
        let cell = plates.near(p + Vec2::splat(0.08 * warp.at(p)));
        let crack = step(0.035, 0.01, cell.second - cell.first) * step(-0.15, 0.3, broad);
        texel.alpha = step(0.86, 0.7, worn).min(1.0 - crack);
        texel
    })
}

/// Cut stones of about a decimetre in rows, none like the next.
pub(super) fn setts(color: Vec3, seed: u32, detail: u32) -> Canvas {
    let size = [2.4, 2.4];
    let size_m = Vec2::from_array(size);
    let noise = |feature_m, salt| Noise::new(size_m, feature_m, seed * 31 + salt);
    let (grain, bend, stain) = (noise(0.012, 1), noise(0.25, 2).field(2), noise(0.5, 3).field(3));
    let (rows, columns) = (20.0, 18.0);
    Canvas::new([768 * detail, 768 * detail], size, |p| {
        let p = p + 0.012 * vec2(bend.at(p), bend.at(p + size_m * 0.41));
        let y = p.y / size_m.y * rows;
        let row = y.floor() as i32;
        let x = p.x / size_m.x * columns
            + 0.5 * (row.rem_euclid(2)) as f32
            + 0.2 * (hash(row.rem_euclid(20), 3, seed) - 0.5);
        let stone = ((x.floor() as i32).rem_euclid(18), row.rem_euclid(20));
        let within = vec2(x - x.floor(), y - y.floor());
        // Distance from the edge of a rounded square, 0 to 0.5.
        let q = (within - 0.5).abs();
        let edge = 0.5 - (q.x.powi(4) + q.y.powi(4)).powf(0.25);
        let tone = 0.75 + 0.5 * hash(stone.0, stone.1, seed);
        let warmth = 0.1 * (hash(stone.0, stone.1, seed + 1) - 0.5);
        let top = step(0.03, 0.14, edge);
        let mut texel =
            Texel::new(color * tone * (1.0 + 0.25 * grain.at(p)) * vec3(1.0 + warmth, 1.0, 1.0 - warmth), 0.72);
        texel.tint(vec3(0.085, 0.078, 0.066) * (1.0 + 0.3 * stain.at(p)), 1.0 - top);
        texel.height_m = 0.012 * step(0.02, 0.3, edge) + 0.004 * (tone - 1.0);
        texel
    })
}

/// Small stones of some centimetres, set as they come.
pub(super) fn mosaic(color: Vec3, seed: u32, detail: u32) -> Canvas {
    let size = [2.0, 2.0];
    let noise = |feature_m, salt| Noise::new(Vec2::from_array(size), feature_m, seed * 31 + salt);
    let (stones, grain, stain) = (noise(0.058, 1), noise(0.012, 2), noise(0.6, 3).field(3));
    Canvas::new([768 * detail, 768 * detail], size, |p| {
        let stone = stones.near(p);
        let edge = stone.second - stone.first;
        let tone = (0.7 + 0.6 * stone.id) * (1.0 + 0.2 * grain.at(p)) * (1.0 + 0.12 * stain.at(p));
        let top = step(0.06, 0.2, edge);
        let mut texel = Texel::new(color * tone, 0.75);
        texel.tint(vec3(0.1, 0.092, 0.08), 1.0 - top);
        texel.height_m = 0.005 * step(0.0, 0.4, edge);
        texel
    })
}

/// What iron covers look like between their rims.
#[derive(Clone, Copy, Debug)]
pub(super) enum Cover {
    /// A disc with raised squares.
    Round,
    /// Two plates with raised lozenges.
    Square,
    /// Bars over a dark shaft.
    Grating,
}

/// An iron cover that fills its texture, worn bright where wheels polish it.
pub(super) fn cover(kind: Cover, size: [f32; 2], seed: u32, detail: u32) -> Canvas {
    let size_m = Vec2::from_array(size);
    let noise = |feature_m, salt| Noise::new(size_m, feature_m, seed * 31 + salt);
    let (rust, grain) = (noise(0.15, 1).field(3), noise(0.01, 2));
    Canvas::new([256 * detail, 256 * detail], size, |p| {
        let q = p - size_m / 2.0;
        let half = size_m / 2.0;
        // From the cover's edge inwards.
        let edge_m = match kind {
            Cover::Round => half.x - q.length(),
            _ => (half - q.abs()).min_element(),
        };
        let (raised, open) = match kind {
            Cover::Round => {
                let cell = (q / 0.042).rem_euclid(Vec2::ONE) - 0.5;
                let slot = vec2(q.x.abs() - 0.2, q.y).abs().cmplt(vec2(0.03, 0.012)).all();
                (step(0.36, 0.28, cell.abs().max_element()), slot)
            }
            Cover::Square => {
                let cell = (vec2(q.x + q.y, q.x - q.y) / 0.05).rem_euclid(Vec2::ONE) - 0.5;
                (step(0.4, 0.3, cell.abs().max_element()), q.x.abs() < 0.006)
            }
            Cover::Grating => {
                let bar = (q.x / 0.045).rem_euclid(1.0);
                let cross = q.y.abs() < 0.02;
                (1.0, bar < 0.55 && !cross)
            }
        };
        let rim = edge_m < 0.045;
        let gap = (0.037..0.045).contains(&edge_m);
        let top = if rim { 1.0 } else { raised };
        let dull = 0.075 + 0.02 * grain.at(p);
        let iron = vec3(1.0, 0.96, 0.92) * (dull + 0.07 * top);
        let mut texel = Texel::new(iron, 0.62 - 0.18 * top);
        texel.tint(vec3(0.1, 0.06, 0.035), 0.45 * step(0.05, 0.5, rust.at(p)) * (1.0 - 0.6 * top));
        texel.height_m = 0.003 * top;
        if gap || (open && !rim) {
            texel = Texel::new(Vec3::splat(0.012), 0.9);
            texel.height_m = -0.02;
        }
        texel
    })
}
