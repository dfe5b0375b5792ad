//! What a map has, read from its XML without the reader: whether it is all in what was read.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use glam::DVec2;
use trove_model::{Bounds, MapProjection, StreetMap};

/// Values of `highway` that are drawn everywhere.
const ROADS: [&str; 13] = [
    "motorway",
    "trunk",
    "primary",
    "secondary",
    "tertiary",
    "unclassified",
    "residential",
    "living_street",
    "service",
    "pedestrian",
    "footway",
    "cycleway",
    "steps",
];

/// A way as its lines say.
#[derive(Default)]
struct Way {
    nodes: Vec<i64>,
    tags: BTreeMap<String, String>,
}

/// The value of an attribute in a line.
fn attribute<'a>(line: &'a str, name: &str) -> Option<&'a str> {
    let at = line.find(&format!(" {name}="))? + name.len() + 2;
    let quote = line[at..].chars().next()?;
    line[at + 1..].split(quote).next()
}

/// Buildings and roads of a file with one element a line that are not in what was read.
pub(crate) fn missing(path: &Path, projection: &MapProjection, area: Bounds, map: &StreetMap) -> Vec<String> {
    let text = std::fs::read_to_string(path).unwrap().replace("><", ">\n<");
    let (mut nodes, mut ways) = (BTreeMap::new(), BTreeMap::<i64, Way>::new());
    // What is part of an area is there under the area's number.
    let mut members = BTreeSet::new();
    let mut open: Option<i64> = None;
    for line in text.lines().map(str::trim) {
        let number = |name: &str| attribute(line, name)?.parse::<f64>().ok();
        let id = |name: &str| attribute(line, name)?.parse::<i64>().ok();
        if line.starts_with("<node ") {
            if let (Some(id), Some(lat_deg), Some(lon_deg)) = (id("id"), number("lat"), number("lon")) {
                nodes.insert(id, projection.world_from_geo(lat_deg, lon_deg));
            }
        } else if line.starts_with("<way ") {
            open = id("id");
            ways.extend(open.map(|id| (id, Way::default())));
        } else if line.starts_with("</way") || line.starts_with("<relation") {
            open = None;
        } else if line.starts_with("<member ") && attribute(line, "type") == Some("way") {
            members.extend(id("ref"));
        } else if let Some(way) = open.and_then(|id| ways.get_mut(&id)) {
            if line.starts_with("<nd ") {
                way.nodes.extend(id("ref"));
            } else if let (true, Some(k), Some(v)) =
                (line.starts_with("<tag "), attribute(line, "k"), attribute(line, "v"))
            {
                way.tags.insert(k.to_owned(), v.to_owned());
            }
        }
    }
    let places = |way: &Way| -> Vec<DVec2> { way.nodes.iter().filter_map(|id| nodes.get(id).copied()).collect() };
    let inside = |way: &Way| places(way).len() == way.nodes.len() && places(way).iter().any(|&p| area.contains(p));
    let tag = |way: &Way, key: &str| way.tags.get(key).cloned().unwrap_or_default();
    let is_building = |way: &Way| {
        let closed = way.nodes.len() > 3 && way.nodes.first() == way.nodes.last();
        closed && !["", "no", "none", "roof"].contains(&tag(way, "building").as_str())
    };
    let is_road =
        |way: &Way| way.nodes.len() > 1 && ROADS.contains(&tag(way, "highway").as_str()) && tag(way, "area") != "yes";
    let built: BTreeSet<i64> = map.buildings.iter().map(|b| b.id).collect();
    let drawn: BTreeSet<i64> = map.roads.iter().map(|r| r.id).collect();
    let mut wrong = Vec::new();
    for (what, is, there) in [("buildings", &is_building as &dyn Fn(&Way) -> bool, built), ("roads", &is_road, drawn)] {
        let mapped: Vec<i64> = ways
            .iter()
            .filter(|(id, way)| !members.contains(id) && is(way) && inside(way))
            .map(|(id, _)| *id)
            .collect();
        let found = mapped.iter().filter(|id| there.contains(id)).count();
        println!("{}: {found} of {} {what}", path.display(), mapped.len());
        if found < mapped.len() {
            let lost: Vec<i64> = mapped.iter().copied().filter(|id| !there.contains(id)).take(5).collect();
            wrong.push(format!("{found} of {} {what} of the map are there; ways {lost:?} are not", mapped.len()));
        }
    }
    wrong
}
