//! Wood and bark; grain runs along u, bark's furrows along v.

use glam::{Vec2, Vec3, vec2, vec3};

use super::canvas::{Canvas, Texel};
use super::noise::{Field, Noise, hash, step};

/// What grows in wood: years, fibres and pores along u.
struct Grain {
    /// Years across v for a metre, a whole number in the texture.
    per_m: f32,
    years: Field,
    bend: Field,
    fibre: Noise,
    pores: Noise,
}

impl Grain {
    fn new(size_m: Vec2, seed: u32) -> Self {
        let noise = |feature: Vec2, salt: u32| Noise::stretched(size_m, feature, seed * 31 + salt);
        Self {
            per_m: std::f32::consts::TAU * (size_m.y * 7.0).round() / size_m.y,
            years: noise(vec2(1.0, 0.06), 1).field(3),
            bend: noise(vec2(0.5, 0.15), 2).field(3),
            fibre: noise(vec2(0.12, 0.0022), 3),
            pores: noise(vec2(0.03, 0.0016), 4),
        }
    }

    /// Late wood (0 to 1), fibres (−1 to 1) and pores (0 to 1).
    fn at(&self, p: Vec2) -> [f32; 3] {
        let rings = (self.years.at(p) * 9.0 + self.bend.at(p) * 2.0 + p.y * self.per_m).sin();
        [step(-0.2, 0.95, rings), self.fibre.at(p), step(0.3, 0.7, self.pores.at(p))]
    }
}

/// Boards side by side, oiled once: `grey` is how far sun and rain have got.
pub(super) fn boards(board_m: f32, size: [f32; 2], color: Vec3, grey: f32, seed: u32, detail: u32) -> Canvas {
    let size_m = Vec2::from_array(size);
    let grain = Grain::new(size_m, seed);
    let (cloud, split) =
        (Noise::new(size_m, 0.3, seed * 31 + 9).field(4), Noise::stretched(size_m, vec2(0.6, 0.004), seed * 31 + 10));
    let rows = (size_m.y / board_m).round().max(1.0);
    let board = size_m.y / rows;
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let row = (p.y / board).floor() as i32;
        // Every board is cut from elsewhere.
        let q = p + vec2(hash(row, 1, seed), 0.37 * row as f32) * size_m;
        let [late, fibre, pore] = grain.at(q);
        let edge_m = if rows > 1.0 { (p.y - row as f32 * board).min((row + 1) as f32 * board - p.y) } else { 1.0 };
        let tone = 0.85 + 0.3 * hash(row, 2, seed);
        let mut texel = Texel::new(color * tone * (1.0 - 0.32 * late + 0.1 * fibre - 0.2 * pore), 0.62 + 0.08 * late);
        let bleached = (grey + 0.5 * grey * cloud.at(p)).clamp(0.0, 1.0);
        texel.tint(vec3(0.26, 0.25, 0.235) * (1.0 + 0.22 * fibre - 0.25 * late), bleached);
        texel.roughness += 0.22 * bleached;
        let crack = step(0.62, 0.85, split.at(q)) * step(0.1, 0.6, grey);
        texel.albedo *= 1.0 - 0.55 * crack;
        let gap = step(0.003, 0.001, edge_m);
        texel.tint(Vec3::splat(0.02), 0.9 * gap);
        texel.height_m = -0.0003 * late * (0.4 + grey) + 0.0001 * fibre - 0.0008 * crack - 0.004 * gap;
        texel
    })
}

/// Sheets of veneer with wild grain, filled knots, stamps of cement.
pub(super) fn plywood(detail: u32) -> Canvas {
    let size = [2.4, 1.2];
    let size_m = Vec2::from_array(size);
    let noise = |feature: Vec2, salt: u32| Noise::stretched(size_m, feature, 200 + salt);
    let (wild, fibre) = (noise(vec2(0.9, 0.35), 1).field(3), noise(vec2(0.1, 0.003), 2));
    let (knots, cloud) = (noise(Vec2::splat(0.4), 3), noise(Vec2::splat(0.5), 4).field(4));
    Canvas::new([512 * detail, 256 * detail], size, |p| {
        let knot = knots.near(p);
        let eye = step(0.09, 0.05, knot.first) * step(0.6, 0.62, knot.id);
        let rings = (wild.at(p) * 26.0 + 1.4 / (knot.first + 0.25)).sin();
        let tone = 1.0 - 0.14 * step(-0.1, 0.9, rings) + 0.07 * fibre.at(p) + 0.1 * cloud.at(p);
        let mut texel = Texel::new(vec3(0.4, 0.27, 0.15) * tone, 0.7);
        texel.tint(vec3(0.16, 0.085, 0.045), 0.8 * eye);
        let sheet = (p.x / 1.2 - (p.x / 1.2).round()).abs().min(p.y.min(size_m.y - p.y) / 1.2) * 1.2;
        texel.tint(Vec3::splat(0.03), 0.8 * step(0.005, 0.002, sheet));
        texel.tint(vec3(0.42, 0.4, 0.37), 0.35 * step(0.35, 0.7, cloud.at(p + size_m * 0.4)));
        texel.height_m = 0.0001 * fibre.at(p);
        texel
    })
}

/// Furrowed bark with lichen.
pub(super) fn bark(detail: u32) -> Canvas {
    let size = [1.0, 1.5];
    let size_m = Vec2::from_array(size);
    let noise = |feature: Vec2, salt: u32| Noise::stretched(size_m, feature, 220 + salt);
    let (plates, bend) = (noise(vec2(0.045, 0.16), 1), noise(vec2(0.12, 0.25), 2).field(3));
    let (fine, lichen) = (noise(vec2(0.012, 0.03), 3), noise(Vec2::splat(0.12), 4).field(4));
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let cell = plates.near(p + vec2(0.03 * bend.at(p), 0.03 * bend.at(p + size_m * 0.4)));
        let ridge = step(0.02, 0.38, cell.second - cell.first);
        let f = fine.fbm(p, 3);
        let tone = 0.45 + 0.65 * ridge + 0.2 * (cell.id - 0.5) + 0.3 * f;
        let mut texel = Texel::new(vec3(0.14, 0.105, 0.075) * tone, 0.92);
        texel.tint(vec3(0.2, 0.215, 0.16), 0.55 * step(0.15, 0.6, lichen.at(p)) * ridge);
        texel.height_m = 0.014 * ridge + 0.003 * f;
        texel
    })
}
