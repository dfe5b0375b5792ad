//! OpenStreetMap extracts (`.osm`, `.osm.pbf`) → `StreetMap`.
//!
//! A file is read whole into nodes, ways and relations ([`raw`]), places become World's, and what lies in the wanted area
//! or crosses it becomes roads, buildings, land, lines and furniture. Everything else in the area is reported.

mod buildings;
mod coast;
mod colors;
mod meaning;
mod pbf;
mod protobuf;
mod raw;
mod relations;
mod rings;
mod roads;
mod sides;
mod signs;
mod tagged;
mod things;
mod values;
mod vocabulary;
mod ways;
mod xml;

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use glam::DVec2;
use trove_model::{Bounds, MapProjection, Report, StreetMap, drives_on_left};

use crate::ReadError;
use raw::{Raw, RawNode};

const LICENCE: &str = "© OpenStreetMap contributors, ODbL 1.0";

/// Reads what lies in `area` or crosses it; ways are kept whole. An extract of another place is
/// [`ReadError::Elsewhere`].
pub fn read(path: &Path, projection: &MapProjection, area: Bounds, report: &Report) -> Result<StreetMap, ReadError> {
    let raw = parse_file(path, report)?;
    let extent = GeoExtent::around(&raw.nodes).ok_or_else(|| without_nodes(path))?;
    if !extent.bounds(projection).overlaps(&area) {
        return Err(elsewhere(path, &extent, projection, area));
    }
    let mut map = StreetMap { licence: LICENCE.into(), ..StreetMap::default() };
    let places = Places::new(&raw, projection, area);
    let mut shops = Vec::new();
    let edges = relations::add(&raw, &places, &mut map, report);
    ways::add(&raw, &edges, &places, &mut map, &mut shops, report);
    coast::add(&raw, &places, &mut map, report);
    things::add(&raw, &places, &mut map, &mut shops, report);
    buildings::mark_shops(&mut map.buildings, &shops);
    map.roads.sort_by_key(|road| road.id);
    map.buildings.sort_by_key(|building| building.id);
    map.land.sort_by_key(|land| land.id);
    map.furniture.sort_by_key(|furniture| furniture.id);
    map.lines.sort_by_key(|line| line.id);
    Ok(map)
}

/// The latitudes and longitudes that a file's nodes lie in.
pub fn extent(path: &Path) -> Result<GeoExtent, ReadError> {
    let raw = parse_file(path, &Report::default())?;
    GeoExtent::around(&raw.nodes).ok_or_else(|| without_nodes(path))
}

/// A rectangle of latitudes and longitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeoExtent {
    /// Southern edge.
    pub min_lat_deg: f64,
    /// Northern edge.
    pub max_lat_deg: f64,
    /// Western edge, −180 to 180.
    pub min_lon_deg: f64,
    /// Eastern edge; above 180 where the rectangle crosses the antimeridian.
    pub max_lon_deg: f64,
}

impl GeoExtent {
    fn around(nodes: &[RawNode]) -> Option<Self> {
        let box_of =
            |lon_deg: fn(&RawNode) -> f64| Bounds::around(nodes.iter().map(|n| DVec2::new(lon_deg(n), n.lat_deg)));
        let plain = box_of(|n| n.lon_deg)?;
        // Across the antimeridian the narrower rectangle is the right one.
        let across = box_of(|n| n.lon_deg.rem_euclid(360.0))?;
        let narrow = if across.size_m().x < plain.size_m().x { across } else { plain };
        Some(Self {
            min_lat_deg: narrow.min.y,
            max_lat_deg: narrow.max.y,
            min_lon_deg: narrow.min.x,
            max_lon_deg: narrow.max.x,
        })
    }

    /// The rectangle in World, metres.
    pub fn bounds(&self, projection: &MapProjection) -> Bounds {
        let width_deg = self.max_lon_deg - self.min_lon_deg;
        // From the middle, so that a wide rectangle is not taken for the rest of the earth.
        let middle_lon_deg = self.min_lon_deg + width_deg / 2.0;
        let min = projection.world_from_geo(self.min_lat_deg, middle_lon_deg);
        let max = projection.world_from_geo(self.max_lat_deg, middle_lon_deg);
        let metres_per_deg = projection.world_from_geo(0.0, projection.origin_lon_deg + 1.0).x
            - projection.world_from_geo(0.0, projection.origin_lon_deg).x;
        let half = DVec2::new(width_deg / 2.0 * metres_per_deg, 0.0);
        Bounds { min: min - half, max: max + half }
    }
}

impl std::fmt::Display for GeoExtent {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "latitude {:.4}° to {:.4}°, longitude {:.4}° to {:.4}°",
            self.min_lat_deg, self.max_lat_deg, self.min_lon_deg, self.max_lon_deg
        )
    }
}

/// Where nodes are in World, and what part of it is wanted.
struct Places<'a> {
    nodes: &'a [RawNode],
    world: Vec<DVec2>,
    area: Bounds,
    drives_on_left: bool,
}

impl<'a> Places<'a> {
    fn new(raw: &'a Raw, projection: &MapProjection, area: Bounds) -> Self {
        let world = raw.nodes.iter().map(|n| projection.world_from_geo(n.lat_deg, n.lon_deg)).collect();
        let drives_on_left = drives_on_left(projection.origin_lat_deg, projection.origin_lon_deg);
        Self { nodes: &raw.nodes, world, area, drives_on_left }
    }

    /// A node's position; `None` where it is not in the file.
    fn of(&self, id: i64) -> Option<DVec2> {
        self.nodes.binary_search_by_key(&id, |n| n.id).ok().map(|i| self.world[i])
    }

    /// Whether the rectangle around some points shares a point with the area.
    fn touched_by(&self, points: &[DVec2]) -> bool {
        Bounds::around(points.iter().copied()).is_some_and(|bounds| bounds.overlaps(&self.area))
    }
}

/// What is wrong with a file's bytes.
#[derive(Debug)]
enum Fault {
    Io(io::Error),
    Content { byte: u64, expected: String, found: String, remedy: String },
}

impl Fault {
    fn new(expected: impl Into<String>, found: impl Into<String>, remedy: &str) -> Self {
        Self::Content { byte: 0, expected: expected.into(), found: found.into(), remedy: remedy.into() }
    }

    /// The same with its place, where it has none yet.
    fn at(self, place: u64) -> Self {
        match self {
            Self::Content { byte: 0, expected, found, remedy } => {
                Self::Content { byte: place, expected, found, remedy }
            }
            fault => fault,
        }
    }
}

/// Reads either format, told apart by the first bytes.
fn parse_file(path: &Path, report: &Report) -> Result<Raw, ReadError> {
    let open = || File::open(path).map(|file| BufReader::with_capacity(1 << 16, file));
    let io = |source| ReadError::io(path, source);
    let mut input = open().map_err(io)?;
    let head = input.fill_buf().map_err(io)?.to_vec();
    let packed =
        [(&[0x1f, 0x8b][..], "gzip"), (b"BZh", "bzip2"), (b"PK\x03\x04", "zip"), (b"\x28\xb5\x2f\xfd", "zstd")];
    let (parsed, binary) = if let Some((_, packer)) = packed.iter().find(|(magic, _)| head.starts_with(magic)) {
        let remedy = format!("unpack it with {packer} first");
        (Err(Fault::new("OpenStreetMap XML or PBF", format!("a file packed with {packer}"), &remedy)), true)
    } else if pbf::is_pbf(&head) {
        (pbf::parse(input, report), true)
    } else {
        (xml::parse(input, report), false)
    };
    parsed.map(Raw::sorted).map_err(|fault| match fault {
        Fault::Io(source) => ReadError::io(path, source),
        Fault::Content { byte, expected, found, remedy } => {
            let line = || open().and_then(|file| line_of(file, byte));
            let place = if binary { format!("byte {byte}") } else { format!("line {}", line().unwrap_or(0)) };
            ReadError::Format { path: path.to_owned(), place, expected, found, remedy }
        }
    })
}

/// The line, from 1, in which a byte stands.
fn line_of(file: impl Read, byte: u64) -> io::Result<u64> {
    let mut reader = BufReader::new(file.take(byte));
    let (mut lines, mut buffer) = (1, Vec::new());
    while reader.read_until(b'\n', &mut buffer)? > 0 {
        lines += u64::from(buffer.ends_with(b"\n"));
        buffer.clear();
    }
    Ok(lines)
}

fn without_nodes(path: &Path) -> ReadError {
    ReadError::Missing {
        path: path.to_owned(),
        expected: "an extract with nodes that have coordinates".into(),
        found: "none".into(),
        remedy: "download the extract again".into(),
    }
}

fn elsewhere(path: &Path, extent: &GeoExtent, projection: &MapProjection, area: Bounds) -> ReadError {
    let (south, west) = projection.geo_from_world(area.min);
    let (north, east) = projection.geo_from_world(area.max);
    let apart_km = extent.bounds(projection).centre().distance(area.centre()) / 1000.0;
    let wanted = GeoExtent { min_lat_deg: south, max_lat_deg: north, min_lon_deg: west, max_lon_deg: east };
    ReadError::Elsewhere { path: path.to_owned(), wanted, extent: *extent, apart_km }
}
