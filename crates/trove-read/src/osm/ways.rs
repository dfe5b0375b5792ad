//! Ways → roads, buildings, land, lines, and furniture that is drawn as a line.

use glam::DVec2;
use trove_model::{BarrierStyle, Furniture, FurnitureKind, LineKind, MapLine, Outcome, Report, StreetMap};

use super::account::Account;
use super::areas::{add_areas, note_repairs};
use super::buildings::is_shop;
use super::coast::is_coastline;
use super::meaning::{Meaning, Outline, line_kind, meaning};
use super::places::Places;
use super::raw::{Raw, RawWay};
use super::relations::Edges;
use super::rings::polygons;
use super::roads::road;
use super::tagged::Tagged;
use super::things::furniture;
use super::values::length_m;
use super::vocabulary::{BARRIER_STYLES, BARRIERS};

/// A usual distance of street trees, metres.
const TREE_SPACING_M: f64 = 8.0;
/// A car does not pass between bollards at this distance, metres.
const BOLLARD_SPACING_M: f64 = 1.6;

/// Adds everything that ways are, and to `shops` where those are that are a shop; `edges` are those of relations.
pub(super) fn add(
    raw: &Raw,
    edges: &Edges,
    places: &Places,
    map: &mut StreetMap,
    shops: &mut Vec<DVec2>,
    report: &Report,
) {
    let mut account = Account::default();
    for way in &raw.ways {
        let line = Line::new(way, places);
        if line.runs.is_empty() {
            report.note(Outcome::Dropped, "osm: way without nodes in the file", format!("way {}", way.id));
            continue;
        }
        if !line.runs.iter().any(|run| places.touched_by(run)) {
            continue;
        }
        account.in_area += 1;
        // What a relation says of its edge is not said again; the sea's edge is looked at elsewhere.
        let is_edge = edges.used.contains(&way.id) || is_coastline(way);
        let done = if edges.spent.contains(&way.id) { Ok(()) } else { add_way(way, &line, places, map, shops, report) };
        account.add(if is_edge { Ok(()) } else { done }, "way", way.id, report);
    }
    account.measure("way", report);
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

/// Adds what a way is by its own tags, or says why it is nothing.
fn add_way(
    way: &RawWay,
    line: &Line,
    places: &Places,
    map: &mut StreetMap,
    shops: &mut Vec<DVec2>,
    report: &Report,
) -> Result<(), String> {
    let owner = format!("way {}", way.id);
    let note = |outcome, what: &str| report.note(outcome, what, &owner);
    let meaning = meaning(&way.tags, if way.is_closed() { Outline::Ring } else { Outline::Line });
    let drawn = add_line(way, line, &owner, places, map, report);
    let points = || line.runs.iter().flatten().copied();
    let middle = points().sum::<DVec2>() / points().count() as f64;
    let shop = is_shop(&way.tags) && meaning != Meaning::Building;
    shops.extend(shop.then_some(middle));
    if let Meaning::Nothing(reason) = meaning {
        return match (reason, way.tags.main_key()) {
            _ if drawn || shop => Ok(()),
            ("", "") => Err("no tag says what it looks like".into()),
            ("", key) => Err(format!("{key} that is not used")),
            (reason, _) => Err(reason.into()),
        };
    }
    if line.missing > 0 {
        note(Outcome::Warned, "osm: way with nodes that are not in the file");
    }
    if line.repeated {
        note(Outcome::Warned, "osm: way with the same point twice in a row");
    }
    match meaning {
        Meaning::Building | Meaning::Land(_) => {
            let mut ring: Vec<DVec2> = points().collect();
            if ring.first() == ring.last() {
                ring.pop();
            }
            let outlines = polygons([places.near_ring(&ring)], &places.effort);
            note_repairs(&outlines, &owner, report);
            let added = add_areas((way.id, &way.tags), meaning, outlines.polygons, places, map, report);
            if added { Ok(()) } else { Err("outline without an area".into()) }
        }
        Meaning::Road(kind) => {
            let before = map.roads.len();
            for run in line.runs.iter().flat_map(|run| places.near(run)) {
                map.roads.push(road(way.id, kind, run, &way.tags, places.driving_side.is_left(), report));
            }
            if map.roads.len() > before { Ok(()) } else { Err("road with a single point".into()) }
        }
        Meaning::Furniture(kind) => {
            let thing = furniture(way.id, kind, middle, &way.tags, &owner, report);
            map.furniture.extend(places.area.contains(middle).then_some(thing));
            Ok(())
        }
        Meaning::Row(kind) => {
            note(Outcome::Guessed, "osm: positions of the things in a row");
            let template = furniture(way.id, kind, middle, &way.tags, &owner, report);
            let spacing_m = if kind == FurnitureKind::Tree { TREE_SPACING_M } else { BOLLARD_SPACING_M };
            let positions = line
                .runs
                .iter()
                .flat_map(|run| places.near(run))
                .flat_map(|run| spaced(&run, spacing_m))
                .filter(|p| places.area.contains(*p));
            map.furniture.extend(positions.map(|position| Furniture { position, ..template.clone() }));
            Ok(())
        }
        Meaning::Nothing(_) => Ok(()),
    }
}

/// Adds what a way is drawn as along its course; whether it is anything.
fn add_line(
    way: &RawWay,
    line: &Line,
    owner: &dyn std::fmt::Display,
    places: &Places,
    map: &mut StreetMap,
    report: &Report,
) -> bool {
    let Some(kind) = line_kind(&way.tags) else { return false };
    let before = map.lines.len();
    for run in line.runs.iter().flat_map(|run| places.near(run)) {
        let tagged = Tagged { tags: &way.tags, owner, report };
        map.lines.push(MapLine {
            id: way.id,
            kind,
            line: run,
            height_m: tagged.number(&["height"], length_m, 0.1..=150.0),
            style: barrier_style(kind, &tagged),
        });
    }
    map.lines.len() > before
}

/// How a fence, wall or guard rail is made.
fn barrier_style(kind: LineKind, tagged: &Tagged) -> Option<BarrierStyle> {
    let is_barrier = matches!(kind, LineKind::Fence | LineKind::Wall | LineKind::GuardRail);
    let made = || tagged.word(&["fence_type", "wall", "material"], &BARRIER_STYLES);
    is_barrier.then(|| made().or_else(|| tagged.word(&["barrier"], &BARRIERS))).flatten()
}

/// Points along a line, the first at its start.
fn spaced(line: &[DVec2], spacing_m: f64) -> Vec<DVec2> {
    let (mut points, mut ahead_m) = (Vec::new(), 0.0);
    for pair in line.windows(2) {
        let length_m = pair[0].distance(pair[1]);
        while ahead_m <= length_m {
            points.push(pair[0].lerp(pair[1], ahead_m / length_m));
            ahead_m += spacing_m;
        }
        ahead_m -= length_m;
    }
    points
}
