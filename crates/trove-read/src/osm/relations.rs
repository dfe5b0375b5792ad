//! Relations → buildings and land with holes or of several ways.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;
use trove_model::{Outcome, Report, StreetMap};

use super::account::Account;
use super::areas::{add_areas, note_repairs};
use super::meaning::{Meaning, Outline, meaning};
use super::places::Places;
use super::raw::{Raw, RawRelation, RawWay, Tags};
use super::rings::{polygons, trace};

/// Steps that looking up a node and joining it to others takes.
const NODE_STEPS: usize = 20;

/// Ways that are an edge of an area that a relation shapes.
#[derive(Debug, Default)]
pub(super) struct Edges {
    /// All of them.
    pub(super) used: BTreeSet<i64>,
    /// Those that are nothing else, although they carry tags.
    pub(super) spent: BTreeSet<i64>,
}

/// Adds every area that a relation shapes.
pub(super) fn add(raw: &Raw, places: &Places, map: &mut StreetMap, report: &Report) -> Edges {
    let ways: BTreeMap<i64, &RawWay> = raw.ways.iter().map(|way| (way.id, way)).collect();
    let (mut edges, mut account) = (Edges::default(), Account::default());
    for relation in &raw.relations {
        let ids: BTreeSet<i64> = relation.ways.iter().copied().collect();
        let members: Vec<&RawWay> = ids.iter().filter_map(|id| ways.get(id).copied()).collect();
        // Many relations may name the same long ways.
        let nodes: usize = members.iter().map(|way| way.nodes.len()).sum();
        if !places.effort.spend(nodes.saturating_mul(NODE_STEPS)) {
            report.note(
                Outcome::Dropped,
                "osm: relation in a file that takes too long",
                format!("relation {}", relation.id),
            );
            continue;
        }
        let nodes = members.iter().flat_map(|way| &way.nodes).chain(&relation.nodes);
        let points: Vec<DVec2> = nodes.filter_map(|&id| places.of(id)).collect();
        if !places.touched_by(&points) {
            continue;
        }
        account.in_area += 1;
        let owner = format!("relation {}", relation.id);
        let done = match relation.tags.get("type") {
            "multipolygon" | "boundary" => {
                if members.len() < ids.len() && relation.tags.get("type") == "multipolygon" {
                    report.note(Outcome::Warned, "osm: multipolygon with ways that are not in the file", &owner);
                }
                add_area(relation, &members, &owner, places, &mut edges, map, report)
            }
            // Its outline and parts say themselves what they are.
            "building" => Ok(()),
            "" => Err("no type".into()),
            kind => Err(format!("{kind}, which is not drawn")),
        };
        account.add(done, "relation", relation.id, report);
    }
    account.measure("relation", report);
    edges
}

/// Adds the area that a relation shapes, or says why it is none.
fn add_area(
    relation: &RawRelation,
    members: &[&RawWay],
    owner: &str,
    places: &Places,
    edges: &mut Edges,
    map: &mut StreetMap,
    report: &Report,
) -> Result<(), String> {
    let as_area = |tags: &Tags| meaning(tags, Outline::Area);
    let own = as_area(&relation.tags);
    let kind = relation.tags.get("type");
    // In the old style the outer ways say what it is.
    let old_style = own == Meaning::Nothing("") && kind == "multipolygon";
    match own {
        Meaning::Building | Meaning::Land(_) => {}
        _ if old_style => {}
        Meaning::Nothing(reason) if !reason.is_empty() => return Err(reason.into()),
        _ => return Err(format!("{kind}, which is not drawn")),
    }
    let traced = trace(members.iter().map(|way| way.nodes.as_slice()));
    if traced.open {
        report.note(Outcome::Warned, "osm: multipolygon whose rings do not all close", owner);
    }
    let positions = |ring: &Vec<i64>| {
        let ring: Vec<DVec2> = ring.iter().filter_map(|&id| places.of(id)).collect();
        places.near_ring(&ring)
    };
    let outlines = polygons(traced.rings.iter().map(positions), &places.effort);
    // A way is outer where its first place lies on the outer edge of a polygon, whatever its role says.
    let is_outer = |way: &RawWay| {
        let place = way.nodes.iter().filter_map(|&id| places.of(id)).find(|&p| places.keeps(p));
        place.is_some_and(|p| outlines.polygons.iter().any(|o| o.exterior.iter().any(|v| v.distance(p) < 0.01)))
    };
    let of_outer = || {
        let outer = members.iter().filter(|way| is_outer(way)).map(|way| (as_area(&way.tags), &way.tags));
        outer.into_iter().find(|(found, _)| matches!(found, Meaning::Building | Meaning::Land(_)))
    };
    let tagged = if old_style { of_outer() } else { Some((own, &relation.tags)) };
    let Some((meaning, tags)) = tagged else {
        return Err(match relation.tags.main_key() {
            "" => format!("{kind} without a tag that says what it looks like"),
            key => format!("{kind} with {key} that is not used"),
        });
    };
    note_repairs(&outlines, owner, report);
    // An outer way of the same meaning would be there twice and fill the holes; in the old style, inner ways carry the
    // tags too and are holes all the same.
    let same = |way: &&&RawWay| as_area(&way.tags) == meaning && (old_style || is_outer(way));
    let spent: Vec<i64> = members.iter().filter(same).map(|way| way.id).collect();
    if !add_areas((-relation.id, tags), meaning, outlines.polygons, places, map, report) {
        return Err(format!("{kind} without a closed ring in the area"));
    }
    edges.spent.extend(spent);
    edges.used.extend(members.iter().map(|way| way.id));
    Ok(())
}
