//! Groves on open land of which nothing is known: a place is not bare because no one has mapped its trees.

use glam::DVec2;
use trove_model::{Kind, Polygon, Seed};

use super::blue_noise::BlueNoise;
use super::wish::{Wish, species_group};
use crate::geometry::plane_raster::PlaneRaster;
use crate::ground::noise;
use crate::surroundings::Clearance;
use crate::surroundings::Surroundings;

/// Places for plants are at least this far apart, metres.
const LEAST_M: f64 = 4.2;
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
pub(super) fn wishes(around: &Surroundings, clearance: &Clearance, blue_noise: &BlueNoise, seed: Seed) -> Vec<Wish> {
    let mut mapped = PlaneRaster::new(around.place.bounds, 2.0);
    let known = around.place.map.iter().flat_map(|m| &m.land).filter(|l| !spans_towns(l.kind));
    for land in known {
        mapped.fill(std::slice::from_ref::<Polygon>(&land.polygon), 1);
    }
    let has_buildings = around.place.map.is_some_and(|m| !m.buildings.is_empty());
    let share = if has_buildings { TOWN_SHARE } else { BARE_SHARE };

    let mut random = seed.random();
    let mut wishes = Vec::new();
    for position in blue_noise.over(around.place.bounds, LEAST_M, seed) {
        let [keep, what, height] = std::array::from_fn(|_| random.unit());
        let free = clearance.is_land(position)
            && mapped.at(position) == 0
            && clearance.road_distance_m(position) >= OFF_ROAD_M
            && clearance.building_distance_m(position) >= OFF_BUILDING_M;
        if !free || keep >= share * density(seed, position) {
            continue;
        }
        let (kind, height_m) =
            if what < TREE_SHARE { (Kind::Tree, 6.0 + 8.0 * height) } else { (Kind::Bush, 0.7 + 1.1 * height) };
        wishes.push(Wish::new(kind, position, height_m, species_group(seed, position)));
    }
    wishes
}

/// Whether a kind of land says nothing about what grows on it.
fn spans_towns(kind: trove_model::LandKind) -> bool {
    use trove_model::LandKind::{Commercial, Industrial, Residential};
    matches!(kind, Residential | Commercial | Industrial)
}

/// 0 in clearings and 1 in groves.
fn density(seed: Seed, p: DVec2) -> f64 {
    ((noise(seed, p, GROVE_M) - 0.3) / 0.3).clamp(0.0, 1.0)
}
