//! Ways and multipolygons → roads, buildings, land, and furniture that is drawn as a line.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;
use trove_model::{Furniture, FurnitureKind, Land, Outcome, Polygon, Report, StreetMap};

use super::Places;
use super::coast::is_coastline;
use super::details;
use super::meaning::{Meaning, Outline, TREE_ROW_SPACING_M, meaning};
use super::raw::{Raw, RawRelation, RawWay, Tags};
use super::rings::{Repaired, polygons, trace};

/// Adds everything that ways and multipolygons are.
pub(super) fn add(raw: &Raw, places: &Places, map: &mut StreetMap, report: &Report) {
    let ways: BTreeMap<i64, &RawWay> = raw.ways.iter().map(|way| (way.id, way)).collect();
    // Ways that are an edge of something; those that are nothing else; both by their ids.
    let (mut edges, mut spent) = (BTreeSet::new(), BTreeSet::new());
    for relation in &raw.multipolygons {
        edges.extend(relation.ways.iter().copied());
        add_multipolygon(relation, &ways, places, &mut spent, map, report);
    }
    let (mut seen, mut used) = (0u32, 0u32);
    for way in &raw.ways {
        let line = Line::new(way, places);
        if line.runs.is_empty() {
            report.note(Outcome::Dropped, "osm: way without nodes in the file", format!("way {}", way.id));
            continue;
        }
        if !line.runs.iter().any(|run| places.touched_by(run)) {
            continue;
        }
        seen += 1;
        // The sea's edge is looked at elsewhere.
        let is_edge = edges.contains(&way.id) || is_coastline(way);
        let added = !spent.contains(&way.id) && add_way(way, &line, is_edge, places, map, report);
        used += u32::from(added || is_edge);
    }
    report.measure("osm.ways_in_area", f64::from(seen));
    report.measure("osm.ways_used", f64::from(used));
}

/// A way's nodes in World.
struct Line {
    /// Runs of nodes that are in the file, without repeated ones; a single one where nothing is missing.
    runs: Vec<Vec<DVec2>>,
    missing: usize,
    repeated: bool,
}

impl Line {
    fn new(way: &RawWay, places: &Places) -> Self {
        let mut line = Self { runs: Vec::new(), missing: 0, repeated: false };
        let mut run: Vec<DVec2> = Vec::new();
        let mut last = None;
        for &id in &way.nodes {
            match places.of(id) {
                None => {
                    line.missing += 1;
                    line.runs.extend((!run.is_empty()).then(|| std::mem::take(&mut run)));
                }
                Some(p) if last == Some(id) || run.last() == Some(&p) => line.repeated = true,
                Some(p) => run.push(p),
            }
            last = Some(id);
        }
        line.runs.extend((!run.is_empty()).then_some(run));
        line
    }
}

/// Adds what a way is by its own tags; whether it is anything. What is not is noted, unless it is the edge of a
/// multipolygon.
fn add_way(way: &RawWay, line: &Line, is_edge: bool, places: &Places, map: &mut StreetMap, report: &Report) -> bool {
    let owner = format!("way {}", way.id);
    let note = |outcome, what: &str| report.note(outcome, what, &owner);
    let outline = if way.is_closed() { Outline::Ring } else { Outline::Line };
    let meaning = meaning(&way.tags, outline);
    if let Meaning::Nothing(reason) = meaning {
        let key = way.tags.main_key();
        match (reason, key) {
            _ if is_edge => {}
            ("", "") => note(Outcome::Dropped, "osm: way without a tag that says what it looks like"),
            ("", key) => note(Outcome::Dropped, &format!("osm: {key} that is nothing of ours")),
            (reason, _) => note(Outcome::Dropped, &format!("osm: way not used: {reason}")),
        }
        return false;
    }
    if line.missing > 0 {
        note(Outcome::Warned, "osm: way with nodes that are not in the file");
    }
    if line.repeated {
        note(Outcome::Warned, "osm: way with the same place twice in a row");
    }
    match meaning {
        Meaning::Building | Meaning::Land(_) => {
            let mut ring: Vec<DVec2> = line.runs.concat();
            if ring.first() == ring.last() {
                ring.pop();
            }
            let outlines = polygons([ring]);
            note_repairs(&outlines, &owner, report);
            add_areas((way.id, &way.tags), meaning, outlines.polygons, places, map, report)
        }
        Meaning::Road(kind) => {
            let mut added = false;
            for run in line.runs.iter().filter(|run| run.len() > 1 && places.touched_by(run)) {
                map.roads.push(details::road(way.id, kind, run.clone(), &way.tags, report));
                added = true;
            }
            if !added {
                note(Outcome::Dropped, "osm: road of a single place");
            }
            added
        }
        Meaning::Furniture(kind) => {
            let points = line.runs.concat();
            let position = points.iter().sum::<DVec2>() / points.len() as f64;
            let inside = places.area.contains(position);
            map.furniture.extend(inside.then(|| Furniture::new(way.id, kind, position)));
            true
        }
        Meaning::TreeRow => {
            note(Outcome::Guessed, "osm: trees of a row, one every eight metres");
            for position in line.runs.iter().flat_map(|run| spaced(run)).filter(|p| places.area.contains(*p)) {
                map.furniture.push(Furniture::new(way.id, FurnitureKind::Tree, position));
            }
            true
        }
        Meaning::Nothing(_) => false,
    }
}

/// Points along a line, the first at its start.
fn spaced(line: &[DVec2]) -> Vec<DVec2> {
    let (mut points, mut ahead_m) = (Vec::new(), 0.0);
    for pair in line.windows(2) {
        let length_m = pair[0].distance(pair[1]);
        while ahead_m <= length_m {
            points.push(pair[0].lerp(pair[1], ahead_m / length_m));
            ahead_m += TREE_ROW_SPACING_M;
        }
        ahead_m -= length_m;
    }
    points
}

/// Notes what had to be repaired in an outline.
fn note_repairs(repaired: &Repaired, owner: &str, report: &Report) {
    if repaired.crossed {
        report.note(Outcome::Substituted, "osm: outline that crosses itself, cut where it does", owner);
    }
    if repaired.vanished {
        report.note(Outcome::Dropped, "osm: outline without an area", owner);
    }
}

/// Adds buildings or land of some outlines; whether any lies in the area.
fn add_areas(
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
            Meaning::Building => map.buildings.push(details::building(id, polygon, tags, report)),
            Meaning::Land(kind) => map.land.push(Land { id, kind, polygon }),
            _ => {}
        }
    }
    added
}

/// Adds a multipolygon, and to `spent` the member ways that are only its edges although they carry tags.
fn add_multipolygon(
    relation: &RawRelation,
    ways: &BTreeMap<i64, &RawWay>,
    places: &Places,
    spent: &mut BTreeSet<i64>,
    map: &mut StreetMap,
    report: &Report,
) {
    let ids: BTreeSet<i64> = relation.ways.iter().copied().collect();
    let members: Vec<&RawWay> = ids.iter().filter_map(|id| ways.get(id).copied()).collect();
    let points: Vec<DVec2> = members.iter().flat_map(|way| &way.nodes).filter_map(|&id| places.of(id)).collect();
    if !places.touched_by(&points) {
        return;
    }
    let owner = format!("relation {}", relation.id);
    let note = |outcome, what: &str| report.note(outcome, what, &owner);
    if members.len() < ids.len() {
        note(Outcome::Warned, "osm: multipolygon with ways that are not in the file");
    }
    let traced = trace(members.iter().map(|way| way.nodes.as_slice()));
    if traced.open {
        note(Outcome::Warned, "osm: multipolygon whose rings do not all close");
    }
    let positions = |ring: &Vec<i64>| ring.iter().filter_map(|&id| places.of(id)).collect();
    let outlines = polygons(traced.rings.iter().map(positions));
    // A way is outer where its first place lies on the outer edge of a polygon, whatever its role says.
    let is_outer = |way: &RawWay| {
        let place = way.nodes.iter().find_map(|&id| places.of(id));
        place.is_some_and(|p| outlines.polygons.iter().any(|o| o.exterior.iter().any(|v| v.distance(p) < 0.01)))
    };

    let as_area = |tags: &Tags| meaning(tags, Outline::Area);
    let own = as_area(&relation.tags);
    let old_style = own == Meaning::Nothing("");
    let tagged = match own {
        // In the old style the outer ways say what it is.
        _ if old_style => {
            let outer = members.iter().filter(|way| is_outer(way)).map(|way| (as_area(&way.tags), &way.tags));
            outer.into_iter().find(|(found, _)| matches!(found, Meaning::Building | Meaning::Land(_)))
        }
        Meaning::Nothing(reason) => {
            return note(Outcome::Dropped, &format!("osm: multipolygon not used: {reason}"));
        }
        own => Some((own, &relation.tags)),
    };
    let Some((meaning, tags)) = tagged else { return note(Outcome::Dropped, &nothing_of_ours(&relation.tags)) };
    // An outer way of the same meaning would be there twice and fill the holes; in the old style, inner ways carry the
    // tags too and are holes all the same.
    let same = |way: &&&RawWay| as_area(&way.tags) == meaning && (old_style || is_outer(way));
    spent.extend(members.iter().filter(same).map(|way| way.id));
    note_repairs(&outlines, &owner, report);
    if !add_areas((-relation.id, tags), meaning, outlines.polygons, places, map, report) {
        note(Outcome::Dropped, "osm: multipolygon without a closed ring in the area");
    }
}

fn nothing_of_ours(tags: &Tags) -> String {
    match tags.main_key() {
        "" => "osm: multipolygon without a tag that says what it looks like".into(),
        key => format!("osm: multipolygon with {key} that is nothing of ours"),
    }
}
