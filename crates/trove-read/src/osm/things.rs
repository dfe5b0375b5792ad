//! Tagged nodes → furniture, and the shops that buildings have.

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::{Furniture, FurnitureDetail, FurnitureKind, MappedPlant, Outcome, Report, StreetMap};

use super::buildings::is_shop;
use super::meaning::{Meaning, Outline, furniture_kind, meaning};
use super::places::Places;
use super::raw::{Raw, RawThing, Tags};
use super::roads::crossing_marking;
use super::signs::sign;
use super::tagged::Tagged;
use super::values::{heading_rad, length_m};
use super::vocabulary::{LAMPS, LEAVES, PLANT_GROUPS, Said};

/// Adds every node that is a piece of furniture, and to `shops` where those are that are a shop.
pub(super) fn add(raw: &Raw, places: &Places, map: &mut StreetMap, shops: &mut Vec<DVec2>, report: &Report) {
    let traffic = traffic_directions(raw, places);
    for thing in &raw.things {
        let tags = &thing.tags;
        let Some(position) = places.of(thing.node.id).filter(|p| places.area.contains(*p)) else { continue };
        let owner = format!("node {}", thing.node.id);
        let shop = is_shop(tags);
        shops.extend(shop.then_some(position));
        match (furniture_kind(tags), tags.main_key()) {
            (Some(kind), _) => {
                let heading_rad = heading(&owner, tags, traffic.get(&thing.node.id).copied(), report);
                map.furniture
                    .push(Furniture { heading_rad, ..furniture(thing.node.id, kind, position, tags, &owner, report) });
            }
            (None, "") => {}
            (None, _) if shop => {}
            (None, key) => report.note(Outcome::Dropped, &format!("osm: node with {key} that is not used"), owner),
        }
    }
}

/// A thing with what its tags tell, but where it looks.
pub(super) fn furniture(
    id: i64,
    kind: FurnitureKind,
    position: DVec2,
    tags: &Tags,
    owner: &str,
    report: &Report,
) -> Furniture {
    let tagged = Tagged { tags, owner: &owner, report };
    let detail = match kind {
        FurnitureKind::Tree | FurnitureKind::Shrub => plant(&tagged).map(FurnitureDetail::Plant),
        FurnitureKind::TrafficSign => sign(&tagged).map(FurnitureDetail::Sign),
        FurnitureKind::Crossing => crossing_marking(&tagged).map(FurnitureDetail::Crossing),
        FurnitureKind::StreetLamp => tagged.word(&["lamp_mount", "support"], &LAMPS).map(FurnitureDetail::Lamp),
        _ => None,
    };
    let height_m = tagged.number(&["height"], length_m, 0.1..=150.0);
    Furniture { height_m, detail, ..Furniture::new(id, kind, position) }
}

/// What is tagged of a plant; `None` where nothing is.
fn plant(tagged: &Tagged) -> Option<MappedPlant> {
    let species = tagged.tags.first(&["species", "taxon", "genus"]).to_lowercase();
    let group = species.split(' ').find_map(|word| match PLANT_GROUPS.read(word) {
        Said::Meaning(leaves) => Some(leaves),
        Said::Nothing | Said::Unknown => None,
    });
    let leaves = group.or_else(|| tagged.word(&["leaf_type"], &LEAVES));
    let species = (!species.is_empty()).then_some(species);
    (species.is_some() || leaves.is_some()).then_some(MappedPlant { species, leaves })
}

/// Where it faces: as tagged, else against the traffic that it is for.
fn heading(owner: &str, tags: &Tags, traffic: Option<DVec2>, report: &Report) -> Option<f64> {
    match tags.first(&["direction", "traffic_signals:direction"]) {
        "" | "forward" | "backward" => traffic.map(|towards| (-towards).to_angle().rem_euclid(std::f64::consts::TAU)),
        "both" => None,
        _ => Tagged { tags, owner: &owner, report }.parsed(&["direction", "traffic_signals:direction"], heading_rad),
    }
}

/// The direction of the traffic that the signs and signals on roads are for: `forward` and `backward` are told by the
/// way, a one-way street has but one, and the traffic that has to give way drives towards the nearer end of its road.
fn traffic_directions(raw: &Raw, places: &Places) -> BTreeMap<i64, DVec2> {
    fn told(thing: &RawThing) -> &str {
        thing.tags.first(&["direction", "traffic_signals:direction"])
    }
    let yields = |thing: &RawThing| matches!(thing.tags.get("highway"), "stop" | "give_way");
    let asks = |thing: &&RawThing| {
        let kind = furniture_kind(&thing.tags);
        match told(thing) {
            "forward" | "backward" => kind.is_some(),
            "" => yields(thing) || matches!(kind, Some(FurnitureKind::TrafficSignal | FurnitureKind::TrafficSign)),
            _ => false,
        }
    };
    let asking: BTreeMap<i64, &RawThing> = raw.things.iter().filter(asks).map(|t| (t.node.id, t)).collect();
    let length_m = |nodes: &[i64]| -> f64 {
        let points: Vec<DVec2> = nodes.iter().filter_map(|&id| places.of(id)).collect();
        points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    };
    let mut found: BTreeMap<i64, DVec2> = BTreeMap::new();
    for way in raw.ways.iter().filter(|_| !asking.is_empty()) {
        let drivable = || matches!(meaning(&way.tags, Outline::Line), Meaning::Road(kind) if kind.is_for_cars());
        for (i, id) in way.nodes.iter().enumerate() {
            let Some(thing) = asking.get(id).filter(|_| !found.contains_key(id) && drivable()) else { continue };
            let last = way.nodes.len() - 1;
            let ends = [way.nodes[i.saturating_sub(1)], way.nodes[(i + 1).min(last)]].map(|id| places.of(id));
            let [Some(from), Some(to)] = ends else { continue };
            let Some(along) = (to - from).try_normalize() else { continue };
            let forward = match (told(thing), way.tags.get("oneway")) {
                ("forward", _) => true,
                ("backward", _) => false,
                (_, "yes" | "true" | "1") => true,
                (_, "-1" | "reverse") => false,
                _ if !yields(thing) => continue,
                _ => length_m(&way.nodes[i..]) <= length_m(&way.nodes[..=i]),
            };
            found.insert(*id, if forward { along } else { -along });
        }
    }
    found
}
