//! Trees and bushes: where the LiDAR saw them, and beyond its reach where the map and the streets have them.

mod columns;
mod lidar;
mod map;
mod open_land;
mod species;
mod streets;

use glam::DVec2;
use trove_model::{AssetLibrary, Kind, Outcome, Report, Seed};

use crate::clearance::{Clearance, Room};
use crate::scenery::Scenery;
use crate::surroundings::Surroundings;
use species::Species;

/// Side of the squares in which plants are of one species, metres.
const SPECIES_SQUARE_M: f64 = 60.0;

/// A plant that is wanted somewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wish {
    /// Tree or bush.
    kind: Kind,
    /// Where.
    position: DVec2,
    /// How tall, metres.
    height_m: f64,
    /// Plants with the same number are of one species.
    group: u64,
    /// Half the distance to its like, metres; `None`: as its size asks.
    radius_m: Option<f64>,
}

/// Plants the place. Wishes are taken in the order: seen by the LiDAR, mapped, along streets, on open land.
pub(crate) fn vegetation<'a>(
    around: &Surroundings,
    library: &'a AssetLibrary,
    clearance: &mut Clearance,
    seed: Seed,
    report: &Report,
) -> Vec<Scenery<'a>> {
    let species = Species::new(library, around.drive.projection.origin_lat_deg);
    for (kind, none) in [(Kind::Tree, species.trees.is_empty()), (Kind::Bush, species.bushes.is_empty())] {
        if none {
            report.note(
                Outcome::Dropped,
                &format!("plants without an asset of kind {kind:?}"),
                kind.class().row().name,
            );
        }
    }
    let seen = lidar::Seen::new(around, clearance);
    let mut wishes = seen.wishes(seed.child("lidar"));
    let counted = wishes.len();
    // What the LiDAR could see is left as it saw it.
    let beyond = |w: &Wish| !seen.covers(w.position);
    wishes.extend(map::wishes(around, seed.child("map")).into_iter().filter(beyond));
    wishes.extend(streets::wishes(around, clearance, seed.child("streets")).into_iter().filter(beyond));
    wishes.extend(open_land::wishes(around, clearance, seed.child("open-land")).into_iter().filter(beyond));
    report.measure("vegetation.lidar_wishes", counted as f64);
    report.measure("vegetation.wishes", wishes.len() as f64);

    let mut plants = Vec::new();
    for (i, wish) in wishes.iter().enumerate() {
        let Some(grown) = species.grow(wish, seed.child("plant").nth(i as u64)) else { continue };
        let radius_m = wish.radius_m.unwrap_or(grown.radius_m * 0.6);
        let room = match wish.kind {
            // A trunk beside the road, a crown off the walls and off what passes by.
            Kind::Tree => Room {
                road_m: 0.7,
                buildings_m: (grown.radius_m * 0.7).max(0.8),
                recorded_m: (grown.radius_m * 0.8).max(1.0),
                radius_m,
            },
            _ => Room {
                road_m: grown.radius_m + 0.2,
                buildings_m: grown.radius_m * 0.8,
                recorded_m: grown.radius_m + 0.3,
                radius_m,
            },
        };
        if around.bounds.contains(wish.position) && clearance.is_free(wish.position, &room) {
            clearance.take(wish.position, radius_m);
            let foot_world = wish.position.extend(around.stand.surface_m(wish.position));
            plants.push(grown.scenery(foot_world));
        }
    }
    report.measure("vegetation.plants", plants.len() as f64);
    plants
}

/// Plants in the same large square are of one species.
fn species_group(seed: Seed, p: DVec2) -> u64 {
    let cell = (p / SPECIES_SQUARE_M).floor();
    seed.child("species").nth(cell.x as i64 as u64).nth(cell.y as i64 as u64).0
}
