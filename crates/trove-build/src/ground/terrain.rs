//! The ground of a place over a relief: land, flat water, and roads that lie in it as roads do.

use glam::{DVec2, UVec2};
use trove_model::{Bounds, HeightField, LandKind, Polygon, Raster, Road, RoadKind, StreetMap};

use super::land::Land;
use super::profiles::{Profiles, hangs};
use super::spans::Spans;
use crate::geometry::distance_field::DistanceField;
use crate::geometry::plane_raster::PlaneRaster;

/// Beside the carriageway the ground is as high as the road for so far, for kerb and sidewalk, metres.
const SHOULDER_M: f64 = 3.0;
/// From there it goes over into the land, metres.
const SLOPE_M: f64 = 18.0;
/// How fast a road's say falls beside its carriageway: where two run side by side each keeps its own height.
const NEAR_M: f64 = 1.0;
/// Width of a lane of a road whose width is not tagged, and of a road whose lanes are not, metres.
const LANE_M: f64 = 3.25;
const ROAD_M: f64 = 7.0;
/// Where a bridge would run lower than this above the land, the land is its dam, metres.
const DAM_M: f64 = 1.0;
/// Smaller water is drawn on the ground as it is, m².
const LEAST_WATER_M2: f64 = 60.0;
/// Water whose middle heights differ by more is a river on its way down, metres.
const RIVER_M: f64 = 3.0;
/// The shore is as high as the water for so far, and goes over into the land for so far, metres.
const SHORE_M: f64 = 5.0;
const BANK_M: f64 = 15.0;
/// Passes that round off the creases between all of these.
const ROUNDINGS: usize = 2;

/// Lays water and roads into a field of the land's heights; roads go on over the land beyond it.
pub(super) fn terrain(map: &StreetMap, mut field: HeightField, land: Land<'_>) -> (HeightField, Spans) {
    let waters: Vec<(&Polygon, f32)> = map
        .land
        .iter()
        .filter(|l| l.kind == LandKind::Water && l.polygon.area_m2() >= LEAST_WATER_M2)
        .filter_map(|l| Some((&l.polygon, water_level_m(&field, &l.polygon)?)))
        .collect();
    waters.iter().for_each(|(water, level_m)| flatten(&mut field, water, *level_m, BANK_M));
    let last = DVec2::new(f64::from(field.nodes.width), f64::from(field.nodes.height)) - 1.0;
    let whole = Bounds { min: field.origin, max: field.origin + last * field.cell_m };
    let beyond = |p: DVec2| if whole.contains(p) { None } else { land.height_m(p) };
    let profiles = Profiles::new(map, |p| beyond(p).unwrap_or_else(|| field.height_m(p)));
    let spans = Spans::new(map, &profiles);
    lay_roads(&mut field, map, &profiles);
    for _ in 0..ROUNDINGS {
        round_off(&mut field);
    }
    waters.iter().for_each(|(water, level_m)| flatten(&mut field, water, *level_m, 0.0));
    (field, spans)
}

/// The nodes in a rectangle, and their positions.
fn nodes_in(field: &HeightField, bounds: Bounds) -> impl Iterator<Item = (UVec2, DVec2)> + use<> {
    let limit = UVec2::new(field.nodes.width, field.nodes.height);
    let first = ((bounds.min - field.origin) / field.cell_m).ceil().max(DVec2::ZERO).as_uvec2();
    let end = (((bounds.max - field.origin) / field.cell_m).floor() + 1.0).max(DVec2::ZERO).as_uvec2().min(limit);
    let (origin, cell_m) = (field.origin, field.cell_m);
    (first.y..end.y.max(first.y))
        .flat_map(move |y| (first.x..end.x.max(first.x)).map(move |x| UVec2::new(x, y)))
        .map(move |node| (node, origin + node.as_dvec2() * cell_m))
}

/// How high a water lies; `None` for one beyond the field or on a slope.
fn water_level_m(field: &HeightField, water: &Polygon) -> Option<f32> {
    let last = DVec2::new(f64::from(field.nodes.width), f64::from(field.nodes.height)) - 1.0;
    let whole = Bounds { min: field.origin, max: field.origin + last * field.cell_m };
    let bounds = water.bounds().filter(|b| b.overlaps(&whole))?;
    let bounds = Bounds { min: bounds.min.max(whole.min), max: bounds.max.min(whole.max) };
    let mut covered = PlaneRaster::new(bounds, field.cell_m);
    covered.fill(std::slice::from_ref(water), 1);
    let inside = nodes_in(field, bounds).filter(|(_, p)| covered.at(*p) == 1);
    let mut heights_m: Vec<f32> = inside.map(|(node, _)| *field.nodes.at(node.x, node.y)).collect();
    heights_m.sort_by(f32::total_cmp);
    // Cliffs reach into what a coarse relief knows of the water below them, so the lower heights count.
    let at = |share: f64| heights_m.get((heights_m.len() as f64 * share) as usize).copied();
    let (lowest, low, middle) = (at(0.1)?, at(0.2)?, at(0.6)?);
    (f64::from(middle - lowest) < RIVER_M).then_some(low)
}

/// Makes a water level, and its bank for so far beyond its shore.
fn flatten(field: &mut HeightField, water: &Polygon, level_m: f32, bank_m: f64) {
    let last = DVec2::new(f64::from(field.nodes.width), f64::from(field.nodes.height)) - 1.0;
    let whole = Bounds { min: field.origin, max: field.origin + last * field.cell_m };
    let Some(bounds) = water.bounds().map(|b| b.grown(SHORE_M + bank_m + 2.0 * field.cell_m)) else { return };
    let bounds = Bounds { min: bounds.min.max(whole.min), max: bounds.max.min(whole.max) };
    if bounds.min.cmpge(bounds.max).any() {
        return;
    }
    let distance = DistanceField::to([water.clone()], bounds, field.cell_m);
    for (node, p) in nodes_in(field, bounds) {
        let off_m = distance.at(p) - SHORE_M;
        let height_m = field.nodes.at_mut(node.x, node.y);
        if off_m <= 0.0 {
            *height_m = level_m;
        } else if off_m < bank_m {
            *height_m = level_m + (*height_m - level_m) * ease(off_m / bank_m) as f32;
        }
    }
}

/// What roads have said of a node so far.
#[derive(Clone, Copy, Default)]
struct Said {
    weighted_m: f64,
    weight: f64,
    /// 1 on a road, less beside it.
    share: f64,
}

/// Raises and lowers the land to the roads on it; across its carriageway a road is level.
fn lay_roads(field: &mut HeightField, map: &StreetMap, profiles: &Profiles) {
    let mut said = Raster::filled(field.nodes.width, field.nodes.height, Said::default());
    for piece in &profiles.pieces {
        let road = &map.roads[piece.road];
        let [a, b] = piece.ends.map(|end| profiles.points[end]);
        let [from_m, to_m] = piece.ends.map(|end| profiles.heights_m[end]);
        let is_free = hangs(road) && (from_m + to_m) / 2.0 > field.height_m((a + b) / 2.0) + DAM_M;
        if road.tunnel || is_free {
            continue;
        }
        let half_m = width_m(road) / 2.0;
        let Some(bounds) = Bounds::around([a, b]) else { continue };
        for (node, p) in nodes_in(field, bounds.grown(half_m + SHOULDER_M + SLOPE_M)) {
            let along = b - a;
            let t = ((p - a).dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
            let beside_m = (a.lerp(b, t).distance(p) - half_m).max(0.0);
            let said = said.at_mut(node.x, node.y);
            let weight = profiles.length_m(piece) / (beside_m + NEAR_M).powi(4);
            said.weighted_m += weight * (from_m + t * (to_m - from_m));
            said.weight += weight;
            said.share = said.share.max(1.0 - ease((beside_m - SHOULDER_M) / SLOPE_M));
        }
    }
    for (height_m, said) in field.nodes.data.iter_mut().zip(&said.data) {
        if said.share > 0.0 {
            let road_m = said.weighted_m / said.weight;
            *height_m += ((road_m - f64::from(*height_m)) * said.share) as f32;
        }
    }
}

/// Width of a carriageway, about.
fn width_m(road: &Road) -> f64 {
    let lanes = |lanes: u32| LANE_M * f64::from(lanes.clamp(1, 12));
    let plain = if road.kind >= RoadKind::Service { ROAD_M / 2.0 } else { ROAD_M };
    road.width_m.filter(|w| (2.0..=40.0).contains(w)).or(road.lanes.map(lanes)).unwrap_or(plain)
}

/// From 0 to 1 without corners.
pub(super) fn ease(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// One pass of the 1-2-1 kernel in both directions; the border goes on straight.
fn round_off(field: &mut HeightField) {
    let (width, height) = (field.nodes.width, field.nodes.height);
    let mean = |before: Option<f32>, at: f32, after: Option<f32>| match (before, after) {
        (Some(before), Some(after)) => 0.25 * before + 0.5 * at + 0.25 * after,
        _ => at,
    };
    let old = field.nodes.clone();
    let known = |raster: &Raster<f32>, x: Option<u32>, y: Option<u32>| {
        Some(*raster.at(x.filter(|x| *x < width)?, y.filter(|y| *y < height)?))
    };
    let along_x = Raster::from_fn(width, height, |x, y| {
        mean(known(&old, x.checked_sub(1), Some(y)), *old.at(x, y), known(&old, Some(x + 1), Some(y)))
    });
    field.nodes = Raster::from_fn(width, height, |x, y| {
        mean(known(&along_x, Some(x), y.checked_sub(1)), *along_x.at(x, y), known(&along_x, Some(x), Some(y + 1)))
    });
}
