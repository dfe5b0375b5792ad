//! Tagged nodes → furniture.

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::{Furniture, FurnitureKind, Outcome, Report, StreetMap};

use super::Places;
use super::meaning::{Meaning, Outline, furniture_kind, meaning};
use super::raw::{Raw, RawThing};
use super::values::heading_rad;

/// Adds every node that is a piece of furniture.
pub(super) fn add(raw: &Raw, places: &Places, map: &mut StreetMap, report: &Report) {
    let directions = way_directions(raw, places);
    for thing in &raw.things {
        let Some(kind) = furniture_kind(&thing.tags) else { continue };
        let Some(position) = places.of(thing.node.id).filter(|p| places.area.contains(*p)) else { continue };
        let heading_rad = heading(thing, kind, directions.get(&thing.node.id).copied(), report);
        map.furniture.push(Furniture { heading_rad, ..Furniture::new(thing.node.id, kind, position) });
    }
}

/// Where it faces. A sign for traffic that runs `forward` faces that traffic: against the way's direction.
fn heading(thing: &RawThing, kind: FurnitureKind, way: Option<DVec2>, report: &Report) -> Option<f64> {
    let text = thing.tags.first(&["direction", "traffic_signals:direction"]);
    let along = || way.map(|direction| direction.to_angle().rem_euclid(std::f64::consts::TAU));
    let against = || way.map(|direction| (-direction).to_angle().rem_euclid(std::f64::consts::TAU));
    match text {
        "" | "both" => None,
        "forward" => against(),
        "backward" => along(),
        bearing => {
            let heading = heading_rad(bearing);
            if heading.is_none() {
                let example = format!("node {} ({kind:?}): {bearing}", thing.node.id);
                report.note(Outcome::Dropped, "osm: direction that cannot be used", example);
            }
            heading
        }
    }
}

/// Direction of the first road through each node whose furniture asks for it.
fn way_directions(raw: &Raw, places: &Places) -> BTreeMap<i64, DVec2> {
    let relative = |thing: &&RawThing| {
        matches!(thing.tags.first(&["direction", "traffic_signals:direction"]), "forward" | "backward")
    };
    let mut wanted: BTreeMap<i64, Option<DVec2>> =
        raw.things.iter().filter(relative).map(|t| (t.node.id, None)).collect();
    if wanted.is_empty() {
        return BTreeMap::new();
    }
    for way in &raw.ways {
        if !matches!(meaning(&way.tags, Outline::Line), Meaning::Road(kind) if kind.is_for_cars()) {
            continue;
        }
        for (i, id) in way.nodes.iter().enumerate() {
            let Some(direction @ None) = wanted.get_mut(id) else { continue };
            let ends = [way.nodes.get(i.saturating_sub(1)), way.nodes.get((i + 1).min(way.nodes.len() - 1))];
            let [Some(from), Some(to)] = ends.map(|id| id.and_then(|&id| places.of(id))) else { continue };
            *direction = (to - from).try_normalize();
        }
    }
    wanted.into_iter().filter_map(|(id, direction)| Some((id, direction?))).collect()
}
