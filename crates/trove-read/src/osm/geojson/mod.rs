//! GeoJSON (RFC 7946, and one feature a line) of roads, buildings and whatever has OpenStreetMap's tags as properties.
//!
//! Features become nodes, ways and relations, properties become tags, and everything behind is as with OpenStreetMap's
//! own files. A node is a position, so lines that share one meet there.

mod document;
mod frame;
mod geometry;
mod json;
mod properties;

use std::collections::{BTreeSet, HashMap};

use glam::DVec2;
use trove_model::{MapProjection, Outcome, Report};

use self::document::{Collector, Feature};
use self::geometry::Geometry;
use self::properties::Of;
use super::fault::Fault;
use super::raw::{Raw, RawNode, RawRelation, RawThing, RawWay, Tags};
use trove_files::{Budget, Exceeded};

pub use self::frame::GeoJsonFrame;

/// Names of the coordinate reference system that RFC 7946 prescribes.
const WGS84: [&str; 4] =
    ["urn:ogc:def:crs:ogc:1.3:crs84", "urn:ogc:def:crs:ogc::crs84", "urn:ogc:def:crs:epsg::4326", "epsg:4326"];
/// What a file may state of itself instead of the recipe.
const DATASET: &str = "trove:dataset";
/// Parts of a feature beyond the first are ways that no feature has the number of.
const FIRST_PART: i64 = 1 << 40;
/// No plane of a dataset is wider, metres: half of the way around the earth.
const WIDEST_M: f64 = 2e7;
/// What a position takes at most, bytes: as a node, in the table of nodes, and in a way.
const POSITION_BYTES: usize = 160;

/// Whether a file that begins like this is GeoJSON.
pub(super) fn is_geojson(head: &[u8]) -> bool {
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    head.iter().find(|b| !b.is_ascii_whitespace()) == Some(&b'{')
}

/// Reads a whole file. Where its coordinates are the dataset's, `projection` tells where on earth they are.
pub(super) fn parse(
    bytes: &[u8],
    frame: GeoJsonFrame,
    projection: Option<&MapProjection>,
    budget: &Budget,
    report: &Report,
) -> Result<Raw, Fault> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut map = Map::new(budget, report);
    let heading = document::read(bytes, &mut map)?;
    map.name_the_rest();
    let mut raw = map.raw;
    raw.licence = heading.licence;
    match frame_of(&heading.crs, frame)? {
        GeoJsonFrame::Wgs84 => on_earth(&raw)?,
        GeoJsonFrame::Dataset => {
            let Some(projection) = projection else {
                let remedy = "read it together with the drive that it belongs to";
                return Err(Fault::new("longitudes and latitudes", "metres in a dataset's own plane", remedy));
            };
            project(&mut raw, projection, report);
        }
    }
    Ok(raw)
}

/// What its coordinates are: as the file says, else as is asked for.
fn frame_of(crs: &str, asked: GeoJsonFrame) -> Result<GeoJsonFrame, Fault> {
    match crs.to_lowercase().as_str() {
        "" => Ok(asked),
        DATASET => Ok(GeoJsonFrame::Dataset),
        name if WGS84.contains(&name) && asked == GeoJsonFrame::Wgs84 => Ok(asked),
        name if WGS84.contains(&name) => {
            let remedy = "remove map.geojson_frame = \"dataset\", or the file's member crs";
            Err(Fault::new("metres in the dataset's own plane", format!("the crs {crs}"), remedy))
        }
        _ => {
            let remedy = "convert it, such as with ogr2ogr -t_srs EPSG:4326";
            Err(Fault::new("longitude and latitude (WGS84, RFC 7946)", format!("the crs {crs}"), remedy))
        }
    }
}

/// Whether all coordinates are longitudes and latitudes.
fn on_earth(raw: &Raw) -> Result<(), Fault> {
    let off = raw.nodes.iter().find(|node| node.lat_deg.abs() > 90.0 || node.lon_deg.abs() > 180.0);
    let Some(RawNode { lon_deg, lat_deg, .. }) = off else { return Ok(()) };
    let remedy = "if they are metres in the dataset's own plane, set map.geojson_frame = \"dataset\"; \
                  else convert them, such as with ogr2ogr -t_srs EPSG:4326";
    let found = format!("the position [{lon_deg}, {lat_deg}]");
    Err(Fault::new("longitudes within ±180° and latitudes within ±90°", found, remedy))
}

/// From the dataset's plane to longitude and latitude; positions that no plane has are left out.
fn project(raw: &mut Raw, projection: &MapProjection, report: &Report) {
    let on_earth = |node: &mut RawNode| {
        let plane_m = DVec2::new(node.lon_deg, node.lat_deg);
        (node.lat_deg, node.lon_deg) = projection.geo_from_world(projection.plane.world(plane_m));
        plane_m.abs().max_element() <= WIDEST_M && node.lat_deg.abs() <= 90.0
    };
    let before = raw.nodes.len();
    raw.nodes.retain_mut(on_earth);
    raw.things.retain_mut(|thing| on_earth(&mut thing.node));
    if raw.nodes.len() < before {
        let example = format!("{} positions", before - raw.nodes.len());
        report.note(Outcome::Dropped, "geojson: position that lies in no plane", example);
    }
}

/// What features become.
struct Map<'r> {
    raw: Raw,
    /// The node at each position, by its bits.
    nodes: HashMap<[u64; 2], i64>,
    /// Nodes that a point is told of.
    things: BTreeSet<i64>,
    ids: BTreeSet<String>,
    /// Features so far, and ways beyond the first of a feature.
    features: i64,
    parts: i64,
    /// Whether some feature says what it is in OpenStreetMap's own words.
    is_own: bool,
    /// Ways and relations that do not say what they are.
    unnamed: Vec<Unnamed>,
    budget: &'r Budget,
    report: &'r Report,
}

#[derive(Clone, Copy)]
enum Unnamed {
    Line(usize),
    Area(usize),
    Relation(usize),
}

impl<'r> Map<'r> {
    fn new(budget: &'r Budget, report: &'r Report) -> Self {
        Self {
            raw: Raw::default(),
            nodes: HashMap::new(),
            things: BTreeSet::new(),
            ids: BTreeSet::new(),
            features: 0,
            parts: 0,
            is_own: false,
            unnamed: Vec::new(),
            budget,
            report,
        }
    }

    fn node(&mut self, position: [f64; 2]) -> i64 {
        let new = self.raw.nodes.len() as i64 + 1;
        // 0 and −0 are one place.
        let id = *self.nodes.entry(position.map(|c| (c + 0.0).to_bits())).or_insert(new);
        if id == new {
            self.raw.nodes.push(RawNode { id, lat_deg: position[1], lon_deg: position[0] });
        }
        id
    }

    fn thing(&mut self, position: [f64; 2], tags: Tags) {
        let mut id = self.node(position);
        if !self.things.insert(id) {
            id = self.raw.nodes.len() as i64 + 1;
            self.raw.nodes.push(RawNode { id, lat_deg: position[1], lon_deg: position[0] });
            self.things.insert(id);
        }
        let node = RawNode { id, lat_deg: position[1], lon_deg: position[0] };
        self.raw.things.push(RawThing { node, tags });
    }

    /// Adds a way under the feature's number, or under one of its own; where it stands among the ways.
    fn way(&mut self, positions: &[[f64; 2]], is_first: bool, tags: Tags) -> (i64, usize) {
        let id = if is_first { self.features } else { FIRST_PART + self.parts };
        self.parts += i64::from(!is_first);
        let nodes = positions.iter().map(|&position| self.node(position)).collect();
        self.raw.add_way(RawWay { id, nodes, tags }, self.report);
        (id, self.raw.ways.len())
    }

    fn polygon(&mut self, rings: &[&[[f64; 2]]], is_first: bool, tags: &Tags) -> Option<Unnamed> {
        let mut closed: Vec<Vec<[f64; 2]>> = rings.iter().map(|ring| ring.to_vec()).collect();
        for ring in &mut closed {
            if ring.first() != ring.last() {
                self.note(Outcome::Substituted, "ring that does not close, closed");
                ring.extend(ring.first().copied());
            }
        }
        let mut tags = tags.clone();
        if let [ring] = &closed[..] {
            if tags.get("area").is_empty() {
                // A road whose way closes is a loop elsewhere.
                tags.push("area", "yes");
            }
            let before = self.raw.ways.len();
            let (_, after) = self.way(ring, is_first, tags);
            return (after > before).then_some(Unnamed::Area(before));
        }
        let ways = closed.iter().map(|ring| self.way(ring, false, Tags::default()).0).collect();
        let id = if is_first { self.features } else { FIRST_PART + self.parts };
        self.parts += i64::from(!is_first);
        let mut of_relation = Tags::default();
        of_relation.push("type", "multipolygon");
        of_relation.extend(tags);
        self.raw.relations.push(RawRelation { id, ways, nodes: Vec::new(), tags: of_relation });
        Some(Unnamed::Relation(self.raw.relations.len() - 1))
    }

    fn note(&self, outcome: Outcome, what: &str) {
        self.report.note(outcome, &format!("geojson: {what}"), format!("feature {}", self.features));
    }

    /// Adds what a feature is, or says why it is nothing.
    fn add(&mut self, feature: &Feature) -> Result<(), String> {
        if feature.kind.0 != "Feature" {
            return Err("object that is no Feature".into());
        }
        let properties = &feature.properties;
        if properties.odd {
            self.note(Outcome::Warned, "properties that are no object");
        }
        if properties.partial > 0 {
            self.note(Outcome::Dropped, "property of a part of a line");
        }
        if properties.too_long > 0 {
            self.note(Outcome::Dropped, "text longer than a tag may be");
        }
        if !feature.geometry.is_there {
            return Err("feature without a geometry".into());
        }
        let Some(geometry) = feature.geometry.geometry() else {
            return Err("geometry whose type is not read, or whose coordinates are not those of its type".into());
        };
        if !feature.id.0.is_empty() && !self.ids.insert(feature.id.0.clone()) {
            return Err("feature with the id of another one".into());
        }
        let of = match geometry {
            Geometry::Points(_) => Of::Point,
            Geometry::Lines(_) => Of::Line,
            Geometry::Polygons(_) => Of::Area,
        };
        let (tags, is_own) = properties.tags(of);
        self.is_own |= is_own;
        let is_unnamed = tags.main_key().is_empty();
        let mut unnamed = Vec::new();
        match geometry {
            Geometry::Points(positions) => {
                for &position in positions.iter().filter(|_| !tags.is_empty()) {
                    self.thing(position, tags.clone());
                }
            }
            Geometry::Lines(lines) => {
                for (i, line) in lines.iter().enumerate() {
                    let before = self.raw.ways.len();
                    let (_, after) = self.way(line, i == 0, tags.clone());
                    unnamed.extend((after > before).then_some(Unnamed::Line(before)));
                }
            }
            Geometry::Polygons(polygons) => {
                for (i, rings) in polygons.iter().enumerate().filter(|(_, rings)| !rings.is_empty()) {
                    unnamed.extend(self.polygon(rings, i == 0, &tags));
                }
            }
        }
        if is_unnamed {
            self.unnamed.extend(unnamed);
        }
        Ok(())
    }

    /// Where no feature says what it is in OpenStreetMap's words, the file is one of roads or of footprints alone.
    fn name_the_rest(&mut self) {
        for unnamed in std::mem::take(&mut self.unnamed).into_iter().filter(|_| !self.is_own) {
            let (tags, id, tag, what) = match unnamed {
                Unnamed::Line(i) => {
                    let RawWay { tags, id, .. } = &mut self.raw.ways[i];
                    (tags, id, ("highway", "road"), "line that does not say what it is, taken for a road")
                }
                Unnamed::Area(i) => {
                    let RawWay { tags, id, .. } = &mut self.raw.ways[i];
                    (tags, id, ("building", "yes"), "outline that does not say what it is, taken for a building")
                }
                Unnamed::Relation(i) => {
                    let RawRelation { tags, id, .. } = &mut self.raw.relations[i];
                    (tags, id, ("building", "yes"), "outline that does not say what it is, taken for a building")
                }
            };
            tags.push(tag.0, tag.1);
            self.report.note(Outcome::Guessed, &format!("geojson: {what}"), format!("feature {id}"));
        }
    }
}

impl Collector for Map<'_> {
    fn feature(&mut self, feature: &Feature) -> Result<(), Fault> {
        self.features += 1;
        let bytes = feature.geometry.positions() * POSITION_BYTES + feature.properties.size() + feature.id.0.len();
        self.budget.take(1, bytes).map_err(too_much)?;
        self.add(feature).unwrap_or_else(|reason| self.note(Outcome::Dropped, &reason));
        Ok(())
    }

    fn broken_line(&mut self, line: usize, error: &serde_json::Error) {
        let found = error.to_string();
        let found = found.split(" at line").next().unwrap_or_default().to_owned();
        self.report.note(Outcome::Dropped, "geojson: line that is no JSON", format!("line {line}: {found}"));
    }
}

fn too_much(exceeded: Exceeded) -> Fault {
    Fault::new(exceeded.expected(), "more", "the file is damaged: download it again")
}
