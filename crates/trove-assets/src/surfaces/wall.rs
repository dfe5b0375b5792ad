//! Walls without their openings.

use glam::{Vec2, Vec3, vec2, vec3};

use super::canvas::{Canvas, Texel};
use super::noise::{Noise, hash, step};
use super::paving::Cement;

/// What a wall is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Finish {
    Brick,
    Plaster,
    /// Cast panels, width and height in metres.
    Concrete([f32; 2]),
    /// Coated sheets, width and height in metres.
    Metal([f32; 2]),
    Corrugated,
    /// Small ceramic tiles.
    Tiles,
    /// Boards, one over the other.
    Boards,
}

impl Finish {
    /// Every finish, with panels as in its own surface.
    pub(super) const ALL: [Self; 7] = [
        Self::Brick,
        Self::Plaster,
        Self::Concrete([1.8, 1.8]),
        Self::Metal([1.8, 1.8]),
        Self::Corrugated,
        Self::Tiles,
        Self::Boards,
    ];

    /// The id of the surface that shows it without openings.
    pub(super) fn id(self) -> &'static str {
        match self {
            Self::Brick => "wall/brick",
            Self::Plaster => "wall/plaster",
            Self::Concrete(_) => "wall/concrete",
            Self::Metal(_) => "wall/metal",
            Self::Corrugated => "wall/corrugated",
            Self::Tiles => "wall/tiles",
            Self::Boards => "wall/boards",
        }
    }

    /// What that surface is tagged with, the first of which facades name it by.
    pub(super) fn tags(self) -> &'static [&'static str] {
        match self {
            Self::Brick => &["brick"],
            Self::Plaster => &["plaster"],
            Self::Concrete(_) => &["concrete"],
            Self::Metal(_) => &["metal"],
            Self::Corrugated => &["corrugated"],
            Self::Tiles => &["tiles"],
            Self::Boards => &["boards"],
        }
    }

    /// The colour of that surface.
    pub(super) fn color(self) -> Vec3 {
        match self {
            Self::Brick => vec3(0.22, 0.125, 0.085),
            Self::Corrugated => vec3(0.36, 0.38, 0.39),
            _ => Vec3::splat(0.4),
        }
    }

    /// That surface.
    pub(super) fn bare(self, seed: u32, detail: u32) -> Canvas {
        self.paint(Grid { cells: [1, 1], cell_m: Vec2::splat(1.8), detail }, self.color(), seed)
    }

    /// A wall of a colour.
    pub(super) fn paint(self, grid: Grid, color: Vec3, seed: u32) -> Canvas {
        match self {
            Self::Brick => brick(grid, color, vec3(0.3, 0.28, 0.25), seed),
            Self::Plaster => plaster(grid, color, seed),
            Self::Concrete(panel_m) => panels(grid, color, Vec2::from_array(panel_m), 0.84, seed),
            Self::Metal(panel_m) => panels(grid, color, Vec2::from_array(panel_m), 0.35, seed),
            Self::Corrugated => corrugated(grid, color, seed),
            Self::Tiles => tiles(grid, color, seed),
            Self::Boards => boards(grid, color, seed),
        }
    }
}

/// A texture for whole bays and storeys.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// Bays and storeys.
    pub(super) cells: [u32; 2],
    /// Of one bay and storey.
    pub(super) cell_m: Vec2,
    /// Resolution as a multiple of the ordinary one.
    pub(super) detail: u32,
}

impl Grid {
    fn size_m(&self) -> Vec2 {
        self.cell_m * vec2(self.cells[0] as f32, self.cells[1] as f32)
    }

    fn size_px(&self) -> [u32; 2] {
        let size = match self.cells {
            [1, 1] => [512, 512],
            [_, rows] if rows < 4 => [1024, 512],
            _ => [1024, 1024],
        };
        size.map(|px| px * self.detail)
    }

    /// Every cell's low corner, with a number of its own.
    pub(super) fn corners(&self) -> impl Iterator<Item = (u64, Vec2)> + use<> {
        let Self { cells: [columns, rows], cell_m, .. } = *self;
        (0..rows * columns).map(move |i| (u64::from(i), vec2((i % columns) as f32, (i / columns) as f32) * cell_m))
    }
}

/// Rain streaks and blotches over a finished wall.
pub(super) fn weather(canvas: &mut Canvas, strength: f32, seed: u32) {
    let streaks = Noise::stretched(canvas.size_m, vec2(0.12, 3.0), seed + 91).field(2);
    let blotches = Noise::new(canvas.size_m, 1.6, seed + 92).field(3);
    canvas.all(|p, texel| {
        // Glass is washed.
        if texel.roughness > 0.3 {
            let dirt = 0.5 * streaks.at(p) + 0.7 * blotches.at(p);
            texel.albedo *= 1.0 - strength * dirt.clamp(-0.6, 1.0);
        }
    });
}

/// Glazed tiles of 100 × 60 mm, here and there one lost or renewed.
fn tiles(grid: Grid, color: Vec3, seed: u32) -> Canvas {
    let size = grid.size_m();
    let count = (size / vec2(0.1, 0.06)).round();
    let piece = size / count;
    let broad = Noise::new(size, 0.8, seed * 31 + 2).field(3);
    Canvas::new(grid.size_px(), size.to_array(), |p| {
        let id = (p / piece).floor().as_ivec2();
        let within = p - id.as_vec2() * piece;
        let odd = hash(id.x, id.y, seed + 3) > 0.985;
        let tone = 0.93 + 0.12 * hash(id.x, id.y, seed) - if odd { 0.2 } else { 0.0 };
        let mut texel = Texel::new(color * tone * (1.0 + 0.06 * broad.at(p)), 0.32);
        let joint = step(0.006, 0.003, within.min(piece - within).min_element());
        texel.tint(color * 0.55, 0.8 * joint);
        texel.roughness += 0.5 * joint;
        let tilt = vec2(hash(id.x, id.y, seed + 1), hash(id.x, id.y, seed + 2)) - 0.5;
        texel.height_m = tilt.dot(within - piece / 2.0) * 0.03 - 0.002 * joint;
        texel
    })
}

/// Painted boards of 15 cm, each standing out at its foot.
fn boards(grid: Grid, color: Vec3, seed: u32) -> Canvas {
    let size = grid.size_m();
    let high = size.y / (size.y / 0.15).round();
    let grain = Noise::stretched(size, vec2(0.5, 0.02), seed * 31 + 1).field(2);
    Canvas::new(grid.size_px(), size.to_array(), |p| {
        let (row, within) = ((p.y / high) as i32, (p.y / high).fract());
        let tone = 0.96 + 0.08 * hash(row, 0, seed);
        let mut texel = Texel::new(color * tone * (1.0 + 0.04 * grain.at(p)), 0.6);
        texel.albedo *= 1.0 - 0.55 * step(0.9, 0.98, within);
        texel.height_m = 0.012 * (1.0 - within) + 0.0006 * grain.at(p);
        texel
    })
}

/// Bricks of 225 × 75 mm in a running bond.
fn brick(grid: Grid, color: Vec3, mortar: Vec3, seed: u32) -> Canvas {
    let size = grid.size_m();
    let count = (size / vec2(0.225, 0.075) / 2.0).round() * 2.0;
    let piece = size / count;
    let noise = |feature_m, salt| Noise::new(size, feature_m, seed * 31 + salt);
    let (grain, broad) = (noise(0.03, 1), noise(1.1, 2).field(3));
    Canvas::new(grid.size_px(), size.to_array(), |p| {
        let row = (p.y / piece.y).floor();
        let along = p.x / piece.x + if row as i32 % 2 == 0 { 0.0 } else { 0.5 };
        let within = vec2(along - along.floor(), p.y / piece.y - row) * piece;
        let (i, k) = ((along.floor() as i32).rem_euclid(count.x as i32), row as i32);
        let tone = 0.72 + 0.5 * hash(i, k, seed) - if hash(i, k, seed + 2) > 0.93 { 0.25 } else { 0.0 };
        let warmth = 0.25 * (hash(i, k, seed + 1) - 0.5);
        let mut texel = Texel::new(color * tone * vec3(1.0 + 0.4 * warmth, 1.0, 1.0 - warmth), 0.88);
        texel.albedo *= 1.0 + 0.12 * grain.at(p) + 0.12 * broad.at(p);
        let edge_m = within.min(piece - within).min_element();
        let joint = step(0.0075, 0.004, edge_m);
        texel.tint(mortar * (1.0 + 0.15 * grain.at(p)), joint * 0.9);
        texel.height_m = -0.005 * joint + 0.001 * grain.at(p);
        texel
    })
}

/// Rendered and painted.
fn plaster(grid: Grid, color: Vec3, seed: u32) -> Canvas {
    let size = grid.size_m();
    let noise = |feature_m, salt| Noise::new(size, feature_m, seed * 31 + salt);
    let (grain, broad) = (noise(0.04, 1), noise(0.9, 2).field(4));
    Canvas::new(grid.size_px(), size.to_array(), |p| {
        let g = grain.fbm(p, 2);
        let mut texel = Texel::new(color * (1.0 + 0.04 * g + 0.07 * broad.at(p)), 0.9);
        texel.height_m = 0.0015 * g;
        texel
    })
}

/// Panels of `panel_m` with open joints: concrete (rough) or coated metal (smooth).
fn panels(grid: Grid, color: Vec3, panel_m: Vec2, roughness: f32, seed: u32) -> Canvas {
    let size = grid.size_m();
    let count = (size / panel_m).round().max(Vec2::ONE);
    let panel = size / count;
    let cement = Cement::new(size, color, seed);
    let metal = roughness < 0.6;
    Canvas::new(grid.size_px(), size.to_array(), |p| {
        let q = p / panel;
        let id = q.floor().as_ivec2();
        let within = (q - q.floor()) * panel;
        let edge_m = within.min(panel - within).min_element();
        let mut texel = if metal { Texel::new(color, roughness) } else { cement.at(p) };
        texel.albedo *= 1.0 + 0.1 * (hash(id.x, id.y, seed) - 0.5);
        let joint = step(0.016, 0.006, edge_m);
        texel.tint(color * 0.25, 0.8 * joint);
        // No two panels hang quite alike: mirrored light breaks at the joints.
        let tilt = vec2(hash(id.x, id.y, seed + 1), hash(id.x, id.y, seed + 2)) - 0.5;
        texel.height_m += tilt.dot(within - panel / 2.0) * 0.012 - 0.008 * joint;
        texel.roughness = if joint > 0.5 { 0.9 } else { roughness };
        texel
    })
}

/// Metal sheet with upright ribs.
fn corrugated(grid: Grid, color: Vec3, seed: u32) -> Canvas {
    let size = grid.size_m();
    let ribs = (size.x / 0.25).round();
    let noise = |feature_m: Vec2, salt| Noise::stretched(size, feature_m, seed * 31 + salt);
    let (rust, streak) = (noise(Vec2::splat(0.7), 1).field(4), noise(vec2(0.08, 1.6), 2).field(2));
    Canvas::new(grid.size_px(), size.to_array(), |p| {
        let wave = (p.x / size.x * ribs).fract();
        let rib = step(0.0, 0.12, wave) * step(0.6, 0.48, wave);
        let lap = step(0.03, 0.01, (p.y - size.y * 0.5).abs());
        let mut texel = Texel::new(color * (0.94 + 0.1 * rib) * (1.0 + 0.06 * streak.at(p)), 0.42);
        let rusty = step(0.45, 0.8, rust.at(p) + 0.4 * streak.at(p));
        texel.tint(vec3(0.13, 0.065, 0.035), 0.6 * rusty);
        texel.roughness += 0.4 * rusty;
        texel.albedo *= 1.0 - 0.3 * lap;
        texel.height_m = 0.035 * rib - 0.004 * lap;
        texel
    })
}
