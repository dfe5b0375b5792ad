//! What a map has, read from its XML without the reader: whether it is all in what was read, and where its buildings stand.

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

/// A way or a relation as its lines say.
#[derive(Default)]
struct Element {
    /// Of a way its nodes, of a relation its ways.
    members: Vec<i64>,
    tags: BTreeMap<String, String>,
}

impl Element {
    fn tag(&self, key: &str) -> &str {
        self.tags.get(key).map_or("", String::as_str)
    }

    fn is_closed(&self) -> bool {
        self.members.len() > 3 && self.members.first() == self.members.last()
    }

    /// Whether it is a building or a part of one above the ground.
    fn is_built(&self) -> bool {
        let is = |key: &str| !["", "no", "none"].contains(&self.tag(key));
        let buried = self.tag("location") == "underground" || self.tag("layer").starts_with('-');
        (is("building") || is("building:part")) && !buried
    }
}

/// A map's file with one element a line, its nodes in World.
pub(crate) struct MapFile {
    nodes: BTreeMap<i64, DVec2>,
    ways: BTreeMap<i64, Element>,
    relations: BTreeMap<i64, Element>,
}

/// The value of an attribute in a line.
fn attribute<'a>(line: &'a str, name: &str) -> Option<&'a str> {
    let at = line.find(&format!(" {name}="))? + name.len() + 2;
    let quote = line[at..].chars().next()?;
    line[at + 1..].split(quote).next()
}

impl MapFile {
    pub(crate) fn read(path: &Path, projection: &MapProjection) -> Self {
        let text = std::fs::read_to_string(path).unwrap().replace("><", ">\n<");
        let mut file = Self { nodes: BTreeMap::new(), ways: BTreeMap::new(), relations: BTreeMap::new() };
        // Tags of nodes belong to nothing that is asked for.
        let mut open: Option<(bool, i64)> = None;
        for line in text.lines().map(str::trim) {
            let number = |name: &str| attribute(line, name)?.parse::<f64>().ok();
            let id = |name: &str| attribute(line, name)?.parse::<i64>().ok();
            if line.starts_with("<node ") {
                open = None;
                if let (Some(id), Some(lat_deg), Some(lon_deg)) = (id("id"), number("lat"), number("lon")) {
                    file.nodes.insert(id, projection.world_from_geo(lat_deg, lon_deg));
                }
            } else if line.starts_with("<way ") || line.starts_with("<relation ") {
                open = id("id").map(|id| (line.starts_with("<way "), id));
            }
            let Some((is_way, at)) = open else { continue };
            let element = if is_way { &mut file.ways } else { &mut file.relations }.entry(at).or_default();
            if line.starts_with("<way ") || line.starts_with("<relation ") {
                // Some extracts tell a way twice: its edges counted twice would enclose nothing.
                *element = Element::default();
            }
            if line.starts_with("<nd ") || (line.starts_with("<member ") && attribute(line, "type") == Some("way")) {
                element.members.extend(id("ref"));
            } else if let (true, Some(k), Some(v)) =
                (line.starts_with("<tag "), attribute(line, "k"), attribute(line, "v"))
            {
                element.tags.insert(k.to_owned(), v.to_owned());
            }
        }
        file
    }

    fn places(&self, way: &Element) -> Vec<DVec2> {
        way.members.iter().filter_map(|id| self.nodes.get(id).copied()).collect()
    }

    /// Buildings and roads that are not in what was read.
    pub(crate) fn missing(&self, area: Bounds, map: &StreetMap) -> Vec<String> {
        // What is part of an area is there under the area's number.
        let members: BTreeSet<i64> = self.relations.values().flat_map(|r| &r.members).copied().collect();
        let inside = |way: &Element| {
            let places = self.places(way);
            places.len() == way.members.len() && places.iter().any(|&p| area.contains(p))
        };
        let is_building = |way: &Element| way.is_closed() && !["", "no", "none", "roof"].contains(&way.tag("building"));
        let is_road =
            |way: &Element| way.members.len() > 1 && ROADS.contains(&way.tag("highway")) && way.tag("area") != "yes";
        let built: BTreeSet<i64> = map.buildings.iter().map(|b| b.id).collect();
        let drawn: BTreeSet<i64> = map.roads.iter().map(|r| r.id).collect();
        let mut wrong = Vec::new();
        for (what, is, there) in
            [("buildings", &is_building as &dyn Fn(&Element) -> bool, built), ("roads", &is_road, drawn)]
        {
            let ways = self.ways.iter().filter(|(id, way)| !members.contains(id) && is(way) && inside(way));
            let mapped: Vec<i64> = ways.map(|(id, _)| *id).collect();
            let lost: Vec<i64> = mapped.iter().copied().filter(|id| !there.contains(id)).collect();
            println!("{} of {} {what}", mapped.len() - lost.len(), mapped.len());
            if !lost.is_empty() {
                let few = &lost[..lost.len().min(5)];
                wrong.push(format!(
                    "{} of {} {what} of the map are missing, such as {few:?}",
                    lost.len(),
                    mapped.len()
                ));
            }
        }
        wrong
    }

    /// Buildings and their parts, each with all of its edges: of ways that a building's relation names it is the relation
    /// that tells what is inside.
    pub(crate) fn footprints(&self) -> Vec<Footprint> {
        let areas = self.relations.iter().filter(|(_, r)| r.tag("type") == "multipolygon" && r.is_built());
        let edges =
            |way: &Element| -> Vec<[DVec2; 2]> { self.places(way).windows(2).map(|pair| [pair[0], pair[1]]).collect() };
        let mut taken = BTreeSet::new();
        let mut found: Vec<Footprint> = Vec::new();
        for (id, area) in areas {
            taken.extend(area.members.iter().copied());
            let ways = area.members.iter().filter_map(|way| self.ways.get(way));
            found.push(Footprint::new(-id, ways.flat_map(edges).collect()));
        }
        let ways = self.ways.iter().filter(|(id, way)| !taken.contains(id) && way.is_closed() && way.is_built());
        found.extend(ways.map(|(id, way)| Footprint::new(*id, edges(way))));
        found
    }
}

/// What a building covers, by its edges alone: a point is inside if a line from it crosses an odd number of them.
pub(crate) struct Footprint {
    pub(crate) id: i64,
    edges: Vec<[DVec2; 2]>,
    pub(crate) bounds: Bounds,
}

impl Footprint {
    pub(crate) fn new(id: i64, edges: Vec<[DVec2; 2]>) -> Self {
        let corners = || edges.iter().flatten().copied();
        let (min, max) = (corners().fold(DVec2::INFINITY, DVec2::min), corners().fold(DVec2::NEG_INFINITY, DVec2::max));
        Self { id, bounds: Bounds { min, max }, edges }
    }

    /// The same somewhere else.
    pub(crate) fn moved(&self, to: impl Fn(DVec2) -> DVec2) -> Self {
        Self::new(self.id, self.edges.iter().map(|edge| edge.map(&to)).collect())
    }

    pub(crate) fn contains(&self, p: DVec2) -> bool {
        let crosses =
            |[a, b]: &&[DVec2; 2]| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y);
        self.bounds.contains(p) && self.edges.iter().filter(crosses).count() % 2 == 1
    }
}
