//! What grows and lies on the ground near the driven path: blades of grass, weeds, flowers, fallen leaves, tree pits.
//!
//! All of it is ground, or what it lies on: pieces without a number.

mod edges;
mod grass;
mod litter;
mod pits;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec2, DVec3, Vec3};
use trove_model::{
    AssetLibrary, Bounds, Class, CoverKind, Drive, GroundCover, Material, Polygon, Random, Report, Seed,
};

use super::blue_noise::BlueNoise;
use crate::geometry::distance_field::DistanceField;
use crate::geometry::plane_raster::PlaneRaster;
use crate::ground::Lawn;
use crate::pieces::Piece;
use crate::pieces::Scenery;
use crate::place::Conditions;
use crate::roads::Footing;
use crate::surroundings::Clearance;
use crate::surroundings::Surroundings;

/// Nothing is laid farther from the driven path than this, metres.
const REACH_M: f64 = 30.0;
/// Cells of the raster of lawns, metres, and the most of them each way.
const LAWN_CELL_M: f64 = 0.125;
const MOST_CELLS: f64 = 6000.0;
/// Keyframes farther apart than this are not driven between, metres.
const APART_M: f64 = 60.0;

/// Covers the ground near the driven path; `plants` stand already.
pub(crate) fn undergrowth(
    around: &Surroundings,
    library: &AssetLibrary,
    clearance: &Clearance,
    plants: &[Scenery],
    conditions: Conditions,
    seed: Seed,
    report: &Report,
) -> Vec<Piece> {
    let path = driven_path(around.drive);
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

/// What undergrowth is laid by.
struct Sower<'a> {
    around: &'a Surroundings<'a>,
    library: &'a AssetLibrary,
    clearance: &'a Clearance<'a>,
    lawn: Lawn,
    /// 1 where grass grows.
    lawns: PlaneRaster,
    /// Distance to the driven path.
    path_m: DistanceField,
    /// Within reach of the path.
    bounds: Bounds,
    blue_noise: BlueNoise,
    conditions: Conditions,
    seed: Seed,
}

/// Where and how a patch lies.
struct Lay {
    middle: DVec2,
    yaw_rad: f64,
    /// In the plane, and upwards.
    scale: [f64; 2],
    class: Class,
    /// Which of its paints it has: 0 the first to 1 the last.
    shade: f64,
    /// Above the surface, metres.
    lift_m: f64,
}

impl Sower<'_> {
    fn covers(&self, kind: CoverKind) -> Vec<&GroundCover> {
        self.library.covers_of(kind).collect()
    }

    /// Distance of a place to the driven path, metres; infinite out of reach.
    fn path_distance_m(&self, p: DVec2) -> f64 {
        if self.bounds.contains(p) { self.path_m.at(p) } else { f64::INFINITY }
    }

    fn is_lawn(&self, p: DVec2) -> bool {
        self.lawns.at(p) == 1
    }

    fn footing(&self, p: DVec2) -> Footing {
        self.around.stand.surfaces.footing(p)
    }

    /// Lays a patch: it follows the ground's slope by shear, so that all of it stands on the ground and upright.
    fn piece(&self, cover: &GroundCover, lay: &Lay, random: &mut Random) -> Piece {
        let h = |dx, dy| self.around.stand.ground.height_m(lay.middle + DVec2::new(dx, dy));
        let e = cover.side_m / 2.0;
        let slope = DVec2::new(h(e, 0.0) - h(-e, 0.0), h(0.0, e) - h(0.0, -e)) / cover.side_m;
        let axis = |turn: f64| {
            let flat = DVec2::from_angle(lay.yaw_rad + turn) * lay.scale[0];
            flat.extend(slope.dot(flat))
        };
        let axes = DMat3::from_cols(axis(0.0), axis(std::f64::consts::FRAC_PI_2), DVec3::Z * lay.scale[1]);
        let foot = lay.middle.extend(self.around.stand.surface_m(lay.middle) + lay.lift_m);
        // Between two paints one is drawn: neighbours lead from one to the next.
        let mut paint = |paints: &[Vec3]| {
            let at = lay.shade.clamp(0.0, 1.0) * (paints.len() as f64 - 1.0) + random.unit();
            paints.get((at as usize).min(paints.len().saturating_sub(1))).copied()
        };
        let materials = cover.slots.iter().map(|slot| {
            let base_color = paint(&slot.paints).unwrap_or(slot.material.base_color);
            Material { base_color, ..slot.material.clone() }
        });
        Piece {
            materials: materials.collect(),
            mesh: Arc::clone(&cover.mesh),
            world_from_mesh: DAffine3 { matrix3: axes, translation: foot },
            class: lay.class,
            kind: None,
            asset: String::new(),
        }
    }
}

/// What lies there is a part of what it lies on.
fn class_of(footing: Footing) -> Class {
    match footing {
        Footing::Carriageway => Class::Road,
        Footing::Sidewalk => Class::Sidewalk,
        Footing::Land | Footing::Water => Class::Ground,
    }
}
