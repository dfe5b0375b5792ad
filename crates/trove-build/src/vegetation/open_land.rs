//! Groves on open land of which nothing is known: a place is not bare because no one has mapped its trees.

use glam::DVec2;
use trove_model::{Kind, Polygon, Seed};

use super::{Wish, species_group};
use crate::clearance::Clearance;
use crate::plane_raster::PlaneRaster;
use crate::surroundings::Surroundings;

/// One place for a plant in every square of this side, metres.
const STEP_M: f64 = 5.0;
/// Groves and clearings alternate over this length, metres.
const GROVE_M: f64 = 55.0;
/// Share of a grove's places that carry a plant where buildings are mapped: what is left between them is mostly yards.
const TOWN_SHARE: f64 = 0.2;
/// The same where none are: the plants stand in for whatever hides the horizon.
const BARE_SHARE: f64 = 0.85;
/// Share of the plants that are trees.
const TREE_SHARE: f64 = 0.7;
/// Streets have their own rows: groves begin behind them, metres from the carriageway.
const OFF_ROAD_M: f64 = 5.0;
/// Walls are kept free for this, metres.
const OFF_BUILDING_M: f64 = 2.0;

/// Groves where there is neither road, sidewalk, building nor land that the map knows.
pub(super) fn wishes(around: &Surroundings, clearance: &Clearance, seed: Seed) -> Vec<Wish> {
    let mut mapped = PlaneRaster::new(around.bounds, 2.0);
    let known = around.map.iter().flat_map(|m| &m.land).filter(|l| !spans_towns(l.kind));
    for land in known {
        mapped.fill(std::slice::from_ref::<Polygon>(&land.polygon), 1);
    }
    let has_buildings = around.map.is_some_and(|m| !m.buildings.is_empty());
    let share = if has_buildings { TOWN_SHARE } else { BARE_SHARE };

    let count = (around.bounds.size_m() / STEP_M).floor();
    let mut random = seed.random();
    let mut wishes = Vec::new();
    for y in 0..count.y as usize {
        for x in 0..count.x as usize {
            let [dx, dy, keep, what, height] = std::array::from_fn(|_| random.unit());
            let position = around.bounds.min + (DVec2::new(x as f64, y as f64) + DVec2::new(dx, dy)) * STEP_M;
            let free = clearance.is_land(position)
                && mapped.at(position) == 0
                && clearance.road_distance_m(position) >= OFF_ROAD_M
                && clearance.building_distance_m(position) >= OFF_BUILDING_M;
            if !free || keep >= share * density(seed, position) {
                continue;
            }
            let (kind, height_m) =
                if what < TREE_SHARE { (Kind::Tree, 6.0 + 8.0 * height) } else { (Kind::Bush, 0.7 + 1.1 * height) };
            let group = species_group(seed, position);
            wishes.push(Wish { kind, position, height_m, group, radius_m: None });
        }
    }
    wishes
}

/// Whether a kind of land says nothing about what grows on it.
fn spans_towns(kind: trove_model::LandKind) -> bool {
    use trove_model::LandKind::{Commercial, Industrial, Residential};
    matches!(kind, Residential | Commercial | Industrial)
}

/// Value noise, 0 in clearings and 1 in groves.
fn density(seed: Seed, p: DVec2) -> f64 {
    let node = |x: f64, y: f64| seed.nth(x as i64 as u64).nth(y as i64 as u64).random().unit();
    let cell = (p / GROVE_M).floor();
    let f = p / GROVE_M - cell;
    let f = f * f * (3.0 - 2.0 * f);
    let south = node(cell.x, cell.y) * (1.0 - f.x) + node(cell.x + 1.0, cell.y) * f.x;
    let north = node(cell.x, cell.y + 1.0) * (1.0 - f.x) + node(cell.x + 1.0, cell.y + 1.0) * f.x;
    let value = south * (1.0 - f.y) + north * f.y;
    ((value - 0.3) / 0.3).clamp(0.0, 1.0)
}
