//! Blades on the lawns, and what flowers among them.

use glam::DVec2;
use trove_model::{Class, CoverKind, GroundCover, Random};

use super::sower::{LAWN_CELL_M, Lay, REACH_M, Sower};
use crate::ground::noise;
use crate::pieces::Piece;

/// Blades are seen one by one up to the first distance from the driven path, some of them up to the second, metres.
const NEAR_M: f64 = 9.0;
const MIDDLE_M: f64 = 18.0;
/// Over so much before the end of its reach grass thins out, metres.
const FADE_M: f64 = 8.0;
/// The largest squares, metres.
const SIDE_M: f64 = 2.0;
/// The smallest, along the edges of lawns, metres.
const LEAST_M: f64 = 0.25;
/// Grass keeps off walls, metres.
const OFF_WALL_M: f64 = 0.3;

/// Covers lawns with squares of grass, as large as they fit in.
pub(super) fn lay(sower: &Sower) -> Vec<Piece> {
    let levels = [CoverKind::GrassNear, CoverKind::GrassMiddle, CoverKind::GrassFar].map(|kind| sower.covers(kind));
    let count = (sower.bounds.size_m() / SIDE_M).ceil().as_uvec2();
    let mut pieces = Vec::new();
    let mut random = sower.seed.child("grass").random();
    for y in 0..count.y {
        for x in 0..count.x {
            let low = sower.bounds.min + DVec2::new(f64::from(x), f64::from(y)) * SIDE_M;
            if sower.path_distance_m(low + SIDE_M / 2.0) < REACH_M {
                square(sower, &levels, low, SIDE_M, &mut random, &mut pieces);
            }
        }
    }
    pieces
}

/// Lays the largest patches that fit into what is lawn of a square.
fn square(
    sower: &Sower,
    levels: &[Vec<&GroundCover>; 3],
    low: DVec2,
    side_m: f64,
    random: &mut Random,
    pieces: &mut Vec<Piece>,
) {
    let middle = low + side_m / 2.0;
    let distance_m = sower.path_distance_m(middle);
    // The levels run into each other.
    let ragged_m = distance_m + random.range(-2.5, 2.5);
    let bare = sower.lawn.bareness(middle);
    let level = if ragged_m < NEAR_M {
        0
    } else if ragged_m < MIDDLE_M {
        1
    } else {
        2
    };
    let fitting: Vec<&GroundCover> = levels[level].iter().copied().filter(|c| c.side_m == side_m).collect();
    match share(sower, low, side_m) {
        Share::None => {}
        Share::All if !fitting.is_empty() => {
            let fades = (REACH_M - ragged_m) / FADE_M;
            let Some(&cover) = random.pick(&fitting) else { return };
            if random.unit() > fades || random.unit() < bare {
                return;
            }
            // Grass is shorter where it is dry, and meadows are not mown.
            let meadow = noise(sower.seed.child("height"), middle, 19.0);
            let height = (0.7 + 0.8 * meadow) * (1.0 - 0.35 * bare);
            let lay = Lay {
                middle,
                yaw_rad: std::f64::consts::FRAC_PI_2 * random.index(4) as f64,
                scale: [1.0, height * fades.clamp(0.6, 1.0)],
                class: Class::Ground,
                shade: sower.lawn.dryness(middle) * 1.1 + 0.3 * bare,
                lift_m: 0.0,
            };
            pieces.push(sower.piece(cover, &lay, random));
        }
        _ if side_m > LEAST_M => {
            let half_m = side_m / 2.0;
            for (x, y) in [(0.0, 0.0), (half_m, 0.0), (0.0, half_m), (half_m, half_m)] {
                square(sower, levels, low + DVec2::new(x, y), half_m, random, pieces);
            }
        }
        _ => {}
    }
}

enum Share {
    None,
    Some,
    All,
}

/// How much of a square is lawn, as far as eight rows of places tell, or those of the raster.
fn share(sower: &Sower, low: DVec2, side_m: f64) -> Share {
    let step_m = (side_m / 8.0).max(LAWN_CELL_M);
    let steps = (side_m / step_m) as u32;
    let wall_m = sower.clearance.building_distance_m(low + side_m / 2.0);
    let (mut any, mut all) = (false, wall_m >= OFF_WALL_M + side_m * std::f64::consts::FRAC_1_SQRT_2);
    for y in 0..steps {
        for x in 0..steps {
            let is_lawn = sower.is_lawn(low + (DVec2::new(f64::from(x), f64::from(y)) + 0.5) * step_m);
            any |= is_lawn;
            all &= is_lawn;
        }
        if any && !all {
            return Share::Some;
        }
    }
    if any { Share::All } else { Share::None }
}

/// Clover and dandelions, in swarms.
pub(super) fn flowers(sower: &Sower) -> Vec<Piece> {
    const LEAST_M: f64 = 0.7;
    const HALF_M: f64 = 0.3;
    const SWARM_M: f64 = 6.0;
    const FLOWERS_M: f64 = 20.0;
    let sorts = sower.covers(CoverKind::Flowers);
    let common = sower.conditions.bloom();
    let seed = sower.seed.child("flowers");
    let mut random = seed.random();
    let mut pieces = Vec::new();
    if sorts.is_empty() {
        return pieces;
    }
    let places = sower.blue_noise.over(sower.bounds, LEAST_M, seed);
    for middle in places.filter(|p| sower.path_distance_m(*p) < FLOWERS_M) {
        let [keep, turn, size, which] = std::array::from_fn(|_| random.unit());
        let swarm = noise(seed, middle, SWARM_M);
        let corners = [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y];
        let on_lawn = || corners.iter().all(|c| sower.is_lawn(middle + *c * HALF_M));
        if keep > common * ((swarm - 0.5) / 0.3) || !on_lawn() {
            continue;
        }
        // One sort has most of a swarm.
        let sort = noise(seed.child("sort"), middle, 2.0 * SWARM_M) * 0.7 + 0.3 * which;
        let cover = sorts[((sort * sorts.len() as f64) as usize).min(sorts.len() - 1)];
        let lay = Lay {
            middle,
            yaw_rad: std::f64::consts::TAU * turn,
            scale: [0.8 + 0.4 * size; 2],
            class: Class::Ground,
            shade: 0.0,
            lift_m: 0.0,
        };
        pieces.push(sower.piece(cover, &lay, &mut random));
    }
    pieces
}
