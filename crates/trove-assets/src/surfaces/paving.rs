//! What is laid in pieces, and concrete.

use glam::{Vec2, Vec3, vec2, vec3};

use super::canvas::{Canvas, Texel};
use super::noise::{Field, Noise, hash, step};

/// Concrete's own look: fine pores, clouds, stains.
#[derive(Clone, Debug)]
pub(super) struct Cement {
    pores: Noise,
    clouds: Field,
    stains: Field,
    color: Vec3,
}

impl Cement {
    /// For a texture of some size.
    pub(super) fn new(size_m: Vec2, color: Vec3, seed: u32) -> Self {
        let noise = |feature_m, salt| Noise::new(size_m, feature_m, seed * 31 + salt);
        Self { pores: noise(0.025, 1), clouds: noise(0.9, 2).field(4), stains: noise(0.35, 3).field(3), color }
    }

    /// The surface at a point, metres.
    pub(super) fn at(&self, p: Vec2) -> Texel {
        let (pores, clouds) = (self.pores.fbm(p, 2), self.clouds.at(p));
        let stain = step(0.3, 0.8, self.stains.at(p));
        let mut texel = Texel::new(self.color * (1.0 + 0.1 * pores + 0.13 * clouds - 0.14 * stain), 0.84);
        texel.height_m = 0.0008 * pores;
        texel
    }
}

/// Where a point lies among pieces.
struct Piece {
    /// From the piece's edge inwards, metres.
    edge_m: f32,
    /// The piece's number.
    id: (i32, i32),
}

/// Shades a point of a piece: its own tone, a rounded edge, a joint.
fn lay(texel: &mut Texel, piece: &Piece, joint_m: f32, joint: Vec3, variety: f32, seed: u32) {
    let tone = 1.0 + variety * (hash(piece.id.0, piece.id.1, seed) - 0.5);
    let warmth = variety * 0.25 * (hash(piece.id.0, piece.id.1, seed + 1) - 0.5);
    texel.albedo *= tone * vec3(1.0 + warmth, 1.0, 1.0 - warmth);
    let gap = step(joint_m / 2.0 + 0.003, joint_m / 2.0 - 0.001, piece.edge_m);
    texel.tint(joint, 0.85 * gap);
    texel.albedo *= 1.0 - 0.18 * step(joint_m * 2.5, joint_m, piece.edge_m) * (1.0 - gap);
    texel.height_m -= 0.006 * step(joint_m * 1.5, joint_m * 0.3, piece.edge_m);
    texel.height_m += 0.0012 * (hash(piece.id.0, piece.id.1, seed + 2) - 0.5);
}

/// Rectangles of `piece_m`, every second course moved by half.
fn running(p: Vec2, size_m: Vec2, piece_m: Vec2, shifted: bool) -> Piece {
    let count = (size_m / piece_m).round();
    let piece = size_m / count;
    let row = (p.y / piece.y).floor();
    let shift = if shifted && row as i32 % 2 != 0 { 0.5 } else { 0.0 };
    let along = p.x / piece.x + shift;
    let within = vec2(along - along.floor(), p.y / piece.y - row) * piece;
    let column = (along.floor() as i32).rem_euclid(count.x as i32);
    Piece { edge_m: within.min(piece - within).min_element(), id: (column, row as i32) }
}

/// Concrete slabs of `slab_m` with joints.
pub(super) fn slabs(color: Vec3, slab_m: Vec2, seed: u32, detail: u32) -> Canvas {
    let size = [slab_m.x * 6.0, slab_m.y * 6.0];
    let size_m = Vec2::from_array(size);
    let cement = Cement::new(size_m, color, seed);
    let spots = Noise::new(size_m, 0.11, seed + 5);
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let mut texel = cement.at(p);
        let gum = spots.near(p);
        let is_gum = step(0.2, 0.14, gum.first) * step(0.93, 0.94, gum.id);
        texel.albedo *= 1.0 - 0.4 * is_gum;
        lay(&mut texel, &running(p, size_m, slab_m, false), 0.009, Vec3::splat(0.09), 0.16, seed);
        texel
    })
}

/// Concrete cast in squares of a metre and a half, each with a smooth rim, cracked here and there, with spots of gum.
pub(super) fn flags(color: Vec3, seed: u32, detail: u32) -> Canvas {
    let (size, flag_m) = ([4.5, 4.5], vec2(1.5, 1.5));
    let size_m = Vec2::from_array(size);
    let cement = Cement::new(size_m, color, seed);
    let (spots, plates) = (Noise::new(size_m, 0.16, seed + 5), Noise::new(size_m, 1.5, seed + 6));
    let (warp, sparse) = (Noise::new(size_m, 0.3, seed + 7).field(3), Noise::new(size_m, 1.5, seed + 8));
    Canvas::new([768 * detail, 768 * detail], size, |p| {
        let mut texel = cement.at(p);
        let gum = spots.near(p);
        texel.albedo *= 1.0 - 0.45 * step(0.17, 0.12, gum.first) * step(0.9, 0.91, gum.id);
        let piece = running(p, size_m, flag_m, false);
        texel.albedo *= 1.0 + 0.05 * step(0.07, 0.05, piece.edge_m);
        let cell = plates.near(p + vec2(warp.at(p), warp.at(p + size_m * 0.37)) * 0.2);
        let crack = step(0.008, 0.002, cell.second - cell.first) * step(0.2, 0.3, sparse.at(p));
        texel.tint(Vec3::splat(0.05), 0.8 * crack);
        lay(&mut texel, &piece, 0.012, Vec3::splat(0.08), 0.14, seed);
        texel
    })
}

/// Small bricks in a running bond.
pub(super) fn bricks(color: Vec3, seed: u32, detail: u32) -> Canvas {
    let size = [2.4, 2.4];
    let size_m = Vec2::from_array(size);
    let cement = Cement::new(size_m, color, seed);
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let mut texel = cement.at(p);
        lay(&mut texel, &running(p, size_m, vec2(0.2, 0.1), true), 0.006, Vec3::splat(0.075), 0.5, seed);
        texel
    })
}

/// Bricks of 0.2 × 0.1 m in a herringbone.
pub(super) fn herringbone(color: Vec3, seed: u32, detail: u32) -> Canvas {
    // The pattern of 2:1 bricks repeats every four widths each way.
    let (size, width) = ([2.4, 2.4], 0.1);
    let size_m = Vec2::from_array(size);
    let cement = Cement::new(size_m, color, seed);
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let q = p / width;
        let (x, y) = (q.x.floor() as i32, q.y.floor() as i32);
        let f = vec2(q.x - x as f32, q.y - y as f32);
        // Along each row the pattern is: lying brick (two cells), two standing halves; a row up it moves by one.
        let (low, size) = match (x - y).rem_euclid(4) {
            0 => (vec2(0.0, 0.0), vec2(2.0, 1.0)),
            1 => (vec2(1.0, 0.0), vec2(2.0, 1.0)),
            2 => (vec2(0.0, 1.0), vec2(1.0, 2.0)),
            _ => (vec2(0.0, 0.0), vec2(1.0, 2.0)),
        };
        let within = (f + low) * width;
        let edge_m = within.min(size * width - within).min_element();
        let cells = (size_m / width).as_ivec2();
        let id = ((x - low.x as i32).rem_euclid(cells.x), (y - low.y as i32).rem_euclid(cells.y));
        let mut texel = cement.at(p);
        lay(&mut texel, &Piece { edge_m, id }, 0.006, Vec3::splat(0.075), 0.4, seed);
        texel
    })
}

/// Plain concrete, cast in fields of `size_m`.
pub(crate) fn concrete(color: Vec3, size_m: [f32; 2], joint_m: f32, seed: u32, detail: u32) -> Canvas {
    let area = Vec2::from_array(size_m);
    let cement = Cement::new(area, color, seed);
    Canvas::new([512 * detail, 512 * detail], size_m, |p| {
        let mut texel = cement.at(p);
        if joint_m > 0.0 {
            lay(&mut texel, &running(p + area * 0.37, area, area, false), joint_m, Vec3::splat(0.09), 0.0, seed);
        }
        texel
    })
}

/// Kerb stones of a metre, along u; `black` paints every second one, both worn.
pub(super) fn kerb(color: Vec3, black: bool, seed: u32, detail: u32) -> Canvas {
    let size = [4.0, 1.0];
    let size_m = Vec2::from_array(size);
    let cement = Cement::new(size_m, color, seed);
    let (wear, chips) = (Noise::new(size_m, 0.3, seed + 7).field(4), Noise::new(size_m, 0.04, seed + 8));
    Canvas::new([1024 * detail, 256 * detail], size, |p| {
        let mut texel = cement.at(p);
        let stone = p.x.floor() as i32;
        let edge_m = (p.x - p.x.floor()).min(p.x.ceil() - p.x);
        if black {
            let paint = if stone % 2 == 0 { Vec3::splat(0.028) } else { vec3(0.62, 0.61, 0.57) };
            let worn = step(0.12, 0.45, wear.at(p) + 0.35 * chips.fbm(p, 2) - 0.1 * (stone % 2) as f32);
            texel.tint(paint * (1.0 + 0.12 * chips.at(p)), 1.0 - 0.85 * worn);
            texel.roughness = 0.6 + 0.25 * worn;
        }
        lay(&mut texel, &Piece { edge_m, id: (stone, 0) }, 0.008, Vec3::splat(0.06), 0.1, seed);
        texel
    })
}

/// Concrete that boards were taken off: their grain, their edges, holes of bubbles and of the ties.
pub(super) fn board_marked(color: Vec3, seed: u32, detail: u32) -> Canvas {
    let (size, board_m) = ([2.4, 2.4], 0.15);
    let size_m = Vec2::from_array(size);
    let cement = Cement::new(size_m, color, seed);
    let grain = Noise::stretched(size_m, vec2(0.35, 0.006), seed * 31 + 11);
    let bubbles = Noise::new(size_m, 0.03, seed * 31 + 12);
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let row = (p.y / board_m).floor() as i32;
        let edge_m = (p.y - row as f32 * board_m).min((row + 1) as f32 * board_m - p.y);
        let fibre = grain.at(p + vec2(hash(row, 0, seed), 0.0) * size_m);
        let mut texel = cement.at(p);
        texel.albedo *= 0.92 + 0.16 * hash(row, 1, seed) + 0.07 * fibre;
        let bubble = bubbles.near(p);
        let hole = step(0.16, 0.1, bubble.first) * step(0.8, 0.82, bubble.id);
        let tie = ((p / 1.2 - (p / 1.2).floor() - 0.5) * 1.2).length();
        let hole = hole.max(step(0.017, 0.013, tie));
        texel.albedo *= 1.0 - 0.6 * hole;
        texel.albedo *= 1.0 - 0.25 * step(0.006, 0.001, edge_m);
        texel.height_m +=
            0.0007 * fibre + 0.003 * hash(row, 2, seed) - 0.006 * hole - 0.002 * step(0.005, 0.001, edge_m);
        texel
    })
}

/// Concrete whose skin has gone: stones show, edges crumble, cracks are long open.
pub(super) fn weathered(color: Vec3, seed: u32, detail: u32) -> Canvas {
    let size = [2.4, 2.4];
    let size_m = Vec2::from_array(size);
    let cement = Cement::new(size_m, color, seed);
    let noise = |feature_m, salt| Noise::new(size_m, feature_m, seed * 31 + salt);
    let (stones, worn, plates, warp) =
        (noise(0.014, 11), noise(0.5, 12).field(4), noise(0.8, 13), noise(0.2, 14).field(3));
    let soot = Noise::stretched(size_m, vec2(0.07, 1.2), seed * 31 + 15).field(4);
    Canvas::new([512 * detail, 512 * detail], size, |p| {
        let mut texel = cement.at(p);
        let open = step(-0.05, 0.4, worn.at(p));
        let stone = stones.near(p);
        let shown = open * step(0.5, 0.3, stone.first);
        texel.tint(vec3(0.26, 0.25, 0.235) * (0.45 + 1.1 * stone.id), 0.7 * shown);
        texel.height_m += 0.0022 * shown - 0.002 * open;
        let cell = plates.near(p + 0.1 * vec2(warp.at(p), warp.at(p + size_m * 0.37)));
        let crack = step(0.014, 0.004, cell.second - cell.first) * step(-0.1, 0.2, warp.at(p * 0.5));
        texel.tint(Vec3::splat(0.04), 0.8 * crack);
        texel.height_m -= 0.004 * crack;
        texel.albedo *= 1.0 - 0.35 * step(0.0, 0.7, soot.at(p));
        texel
    })
}
