//! Outlines of ways and of relations → buildings and land.

use trove_model::{Land, Outcome, Polygon, Report, StreetMap};

use super::buildings::building;
use super::meaning::Meaning;
use super::places::Places;
use super::raw::Tags;
use super::rings::Repaired;

/// Notes what had to be repaired in an outline.
pub(super) fn note_repairs(repaired: &Repaired, owner: &str, report: &Report) {
    if repaired.crossed {
        report.note(Outcome::Substituted, "osm: self-intersecting outline, split where it crosses", owner);
    }
    if repaired.tangled {
        report.note(Outcome::Dropped, "osm: outline too tangled to be repaired", owner);
    }
    if repaired.vanished {
        report.note(Outcome::Dropped, "osm: outline or hole without an area", owner);
    }
}

/// Adds buildings or land of some outlines; whether any lies in the area.
pub(super) fn add_areas(
    (id, tags): (i64, &Tags),
    meaning: Meaning,
    outlines: Vec<Polygon>,
    places: &Places,
    map: &mut StreetMap,
    report: &Report,
) -> bool {
    let mut added = false;
    for polygon in outlines.into_iter().filter(|p| places.touched_by(&p.exterior)) {
        added = true;
        match meaning {
            Meaning::Building => map.buildings.push(building(id, polygon, tags, report)),
            Meaning::Land(kind) => map.land.push(Land { id, kind, polygon }),
            _ => {}
        }
    }
    added
}
