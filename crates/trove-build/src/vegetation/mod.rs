//! Trees and bushes: where the LiDAR saw them, and beyond its reach where the map and the streets have them.

mod blue_noise;
mod columns;
mod crowns;
mod hedges;
mod lidar;
mod map;
mod open_land;
mod species;
mod streets;
#[cfg(test)]
mod tests;
mod undergrowth;
mod walls;
mod wish;

use glam::DVec2;
use trove_model::{Kind, Outcome, PlantForm, Seed};

use crate::geometry::plane_raster::PlaneRaster;
use crate::pieces::Scenery;
use crate::place::Place;
use crate::surroundings::Surroundings;
use crate::surroundings::{Clearance, Room};
use blue_noise::BlueNoise;
use species::{Space, Species};
use wish::{Form, Wish};

pub(crate) use undergrowth::{driven_path, undergrowth};

/// Cells of the raster that tells lawns from paved ground, metres.
const LAWN_CELL_M: f64 = 0.5;
/// Corners of a row's pieces keep this far from walls, metres.
const CORNER_OFF_WALLS_M: f64 = 0.3;
/// Distances to roads and walls are known to this, metres.
const UNSURE_M: f64 = 0.25;
/// Feet are sunk into a slope by at most this, metres.
const MOST_SUNK_M: f64 = 0.029;

/// Plants the place. Wishes are taken in the order: seen by the LiDAR, mapped, along walls, along streets, on
/// open land.
pub(crate) fn vegetation<'a>(around: &Surroundings<'a>, clearance: &mut Clearance, seed: Seed) -> Vec<Scenery<'a>> {
    let Place { library, conditions, report, .. } = *around.place;
    let species = Species::new(library, conditions.climate());
    for kind in [Kind::Tree, Kind::Bush].into_iter().filter(|&kind| species.lacks(kind)) {
        let what = format!("plants without an asset of kind {}", kind.name());
        report.note(Outcome::Dropped, &what, kind.class().row().name);
    }
    let blue_noise = BlueNoise::new(seed.child("blue noise"));
    let seen = lidar::Seen::new(around, clearance);
    let mut wishes = seen.wishes(seed.child("lidar"));
    let counted = wishes.len();
    // What the LiDAR could see is left as it saw it.
    let beyond = |w: &Wish| !seen.covers(w.position);
    wishes.extend(map::wishes(around, &blue_noise, seed.child("map")).into_iter().filter(beyond));
    wishes.extend(walls::wishes(around, &blue_noise, seed.child("walls")).into_iter().filter(beyond));
    wishes.extend(streets::wishes(around, clearance, seed.child("streets")).into_iter().filter(beyond));
    wishes.extend(open_land::wishes(around, clearance, &blue_noise, seed.child("land")).into_iter().filter(beyond));
    report.measure("vegetation.lidar_wishes", counted as f64);
    report.measure("vegetation.wishes", wishes.len() as f64);

    let mut lawns = PlaneRaster::new(around.place.bounds, LAWN_CELL_M);
    lawns.fill(&around.stand.surfaces.lawns, 1);
    let mut plants = Vec::new();
    for (i, wish) in wishes.iter().enumerate().filter(|(_, w)| around.place.bounds.contains(w.position)) {
        let space = Space {
            lane_m: clearance.road_distance_m(wish.position) - UNSURE_M,
            wall_m: clearance.building_distance_m(wish.position) - UNSURE_M,
        };
        let Some(grown) = species.grow(wish, space, seed.child("plant").nth(i as u64)) else { continue };
        let radius_m = wish.radius_m.unwrap_or(grown.radius_m * 0.6);
        let body_m = grown.body_radius_m + 0.1;
        let room = match wish.kind {
            // A trunk beside the road; what hangs low keeps off what passes by.
            Kind::Tree => Room {
                road_m: 0.7,
                buildings_m: body_m.max(0.8),
                recorded_m: (grown.low_radius_m * 0.8).max(body_m).max(1.0),
                radius_m: body_m,
            },
            _ => Room {
                road_m: grown.radius_m + 0.2,
                buildings_m: grown.radius_m + 0.1,
                recorded_m: grown.radius_m + 0.3,
                radius_m: body_m,
            },
        };
        // Bushes and beds grow out of grass; trees and hedges have soil of their own.
        let is_hedge = matches!(wish.form, Form::Row { planted: PlantForm::Hedge, .. });
        let is_loose = wish.kind == Kind::Bush && !is_hedge;
        let grows = wish.paved || (clearance.is_land(wish.position) && (!is_loose || lawns.at(wish.position) == 1));
        let is_free = wish.spots().iter().all(|&spot| clearance.is_free(spot, &room));
        let is_out = wish.corners().iter().all(|&corner| clearance.building_distance_m(corner) >= CORNER_OFF_WALLS_M);
        if grows && is_free && is_out && clearance.is_unplanted(wish.position, radius_m) {
            clearance.plant(wish.position, radius_m);
            plants.push(grown.scenery(wish.position.extend(foot_m(around, wish))));
        }
    }
    report.measure("vegetation.plants", plants.len() as f64);
    plants
}

/// Height of the ground where a plant comes out of it: on a slope a bush that is wide stands in the lower ground.
fn foot_m(around: &Surroundings, wish: &Wish) -> f64 {
    let reach_m = match (wish.kind, wish.form) {
        (Kind::Tree, _) => 0.25,
        (_, Form::Row { length_m, .. }) => length_m * 0.5,
        _ => 0.4,
    };
    let middle_m = around.stand.surface_m(wish.position);
    let corners = [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y];
    let drop_m = corners.map(|c| middle_m - around.stand.surface_m(wish.position + c * reach_m));
    let drop_m = drop_m.into_iter().fold(0.0, f64::max);
    middle_m - drop_m.min(MOST_SUNK_M)
}
