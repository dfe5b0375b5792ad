//! What grows and lies on the ground near the driven path: blades of grass, weeds, flowers, fallen leaves, tree pits.
//!
//! All of it is ground, or what it lies on: pieces without a number.

mod edges;
mod grass;
mod litter;
mod pits;
mod sower;

use glam::DVec2;
use trove_model::{Bounds, Drive, Polygon, Seed};

use self::sower::{LAWN_CELL_M, REACH_M, Sower};
use super::blue_noise::BlueNoise;
use crate::geometry::distance_field::DistanceField;
use crate::geometry::plane_raster::PlaneRaster;
use crate::pieces::Piece;
use crate::pieces::Scenery;
use crate::place::Place;
use crate::surroundings::Clearance;
use crate::surroundings::Surroundings;

const MOST_CELLS: f64 = 6000.0;
/// Keyframes farther apart than this are not driven between, metres.
const APART_M: f64 = 60.0;

/// Covers the ground near the driven path; `plants` stand already.
pub(crate) fn undergrowth(around: &Surroundings, clearance: &Clearance, plants: &[Scenery], seed: Seed) -> Vec<Piece> {
    let Place { drive, library, conditions, report, .. } = *around.place;
    let path = driven_path(drive);
    let Some(bounds) = Bounds::around(path.iter().copied()).map(|b| b.grown(REACH_M)) else { return Vec::new() };
    let points = path.iter().map(|p| square(*p, 1.0));
    let cell_m = LAWN_CELL_M.max(bounds.size_m().max_element() / MOST_CELLS);
    let mut lawns = PlaneRaster::new(bounds, cell_m);
    lawns.fill(&around.stand.surfaces.lawns, 1);
    let sower = Sower {
        around,
        library,
        clearance,
        lawn: around.stand.surfaces.lawn,
        lawns,
        path_m: DistanceField::to(points, bounds, 1.0),
        bounds,
        blue_noise: BlueNoise::new(seed.child("blue noise")),
        conditions,
        seed,
    };
    let mut pieces = grass::lay(&sower);
    report.measure("undergrowth.grass", pieces.len() as f64);
    pieces.extend(edges::weeds(&sower));
    pieces.extend(grass::flowers(&sower));
    pieces.extend(litter::leaves(&sower, plants));
    pieces.extend(pits::pits(&sower, plants));
    report.measure("undergrowth.pieces", pieces.len() as f64);
    pieces
}

/// Positions a metre apart along the driven path.
pub(crate) fn driven_path(drive: &Drive) -> Vec<DVec2> {
    let at: Vec<DVec2> = drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    let mut path = at.clone();
    for pair in at.windows(2) {
        let length_m = pair[0].distance(pair[1]);
        if length_m < APART_M {
            let steps = length_m.ceil() as usize;
            path.extend((1..steps).map(|i| pair[0].lerp(pair[1], i as f64 / steps as f64)));
        }
    }
    path.retain(|p| p.is_finite());
    path
}

fn square(middle: DVec2, side_m: f64) -> Polygon {
    crate::geometry::plane::rectangle(Bounds::square(middle, side_m))
}
