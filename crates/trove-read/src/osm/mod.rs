//! OpenStreetMap extracts (`.osm`, `.osm.pbf`) and GeoJSON → `StreetMap`.
//!
//! A file is read whole into nodes, ways and relations (`raw`), places become World's, and what lies in the wanted area
//! or crosses it becomes roads, buildings, land, lines and furniture. Everything else in the area is reported.

mod account;
mod areas;
mod buildings;
mod clip;
mod coast;
mod colors;
mod effort;
mod fault;
mod geojson;
mod meaning;
mod pbf;
mod places;
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

use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use trove_files::{LARGEST_FILE, open_regular};
use trove_model::{Bounds, DrivingSide, MapProjection, Report, StreetMap};

use crate::ReadError;
use fault::Fault;
use places::Places;
use raw::{Raw, RawNode};
use trove_files::Budget;

pub use self::geojson::GeoJsonFrame;
pub use crate::geo_extent::GeoExtent;

const LICENCE: &str = "© OpenStreetMap contributors, ODbL 1.0";

/// Reads what lies in `area` or crosses it, where traffic keeps to the `driving_side`; ways are kept whole.
///
/// # Errors
/// A file that cannot be read, is packed or damaged, or has no nodes; an extract of another place is
/// [`ReadError::Elsewhere`].
pub fn read(
    path: &Path,
    projection: &MapProjection,
    area: Bounds,
    driving_side: DrivingSide,
    report: &Report,
) -> Result<StreetMap, ReadError> {
    read_in(GeoJsonFrame::Wgs84, path, projection, area, driving_side, report)
}

/// As [`read`], with what the coordinates of a GeoJSON file are that does not say so itself.
///
/// # Errors
/// As [`read`], and coordinates that are none of that kind.
pub fn read_in(
    frame: GeoJsonFrame,
    path: &Path,
    projection: &MapProjection,
    area: Bounds,
    driving_side: DrivingSide,
    report: &Report,
) -> Result<StreetMap, ReadError> {
    let raw = parse_file(path, frame, Some(projection), report)?;
    let extent = raw.covers.or_else(|| extent_of(&raw.nodes)).filter(|_| !raw.nodes.is_empty());
    let extent = extent.ok_or_else(|| without_nodes(path))?;
    if !extent.bounds(projection).overlaps(&area) {
        return Err(elsewhere(path, &extent, projection, area));
    }
    let mut map = StreetMap { licence: raw.licence.clone(), ..StreetMap::default() };
    let places = Places::new(&raw, projection, area, driving_side);
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
///
/// # Errors
/// A file that cannot be read, is packed or damaged, or has no nodes.
pub fn extent(path: &Path) -> Result<GeoExtent, ReadError> {
    let raw = parse_file(path, GeoJsonFrame::Wgs84, None, &Report::default())?;
    extent_of(&raw.nodes).ok_or_else(|| without_nodes(path))
}

/// Reads any of the formats, told apart by the first bytes.
fn parse_file(
    path: &Path,
    frame: GeoJsonFrame,
    projection: Option<&MapProjection>,
    report: &Report,
) -> Result<Raw, ReadError> {
    let io = |source| ReadError::io(path, source);
    let file = open_regular(path).map_err(io)?;
    let length = file.metadata().map_err(io)?.len();
    let budget = Budget::of_file(length);
    let mut input = BufReader::with_capacity(1 << 16, file);
    let head = input.fill_buf().map_err(io)?.to_vec();
    let packed =
        [(&[0x1f, 0x8b][..], "gzip"), (b"BZh", "bzip2"), (b"PK\x03\x04", "zip"), (b"\x28\xb5\x2f\xfd", "zstd")];
    let (parsed, binary) = if let Some((_, packer)) = packed.iter().find(|(magic, _)| head.starts_with(magic)) {
        let remedy = format!("decompress it with {packer} first");
        (Err(Fault::new("OpenStreetMap XML or PBF", format!("a file compressed with {packer}"), &remedy)), true)
    } else if pbf::is_pbf(&head) {
        (pbf::parse(input, &budget, report).map(of_osm), true)
    } else if geojson::is_geojson(&head) && length > LARGEST_FILE {
        let remedy = "cut the area out of it that is needed";
        (Err(Fault::new(format!("GeoJSON of at most {LARGEST_FILE} bytes"), format!("{length} bytes"), remedy)), false)
    } else if geojson::is_geojson(&head) {
        let mut bytes = Vec::new();
        input.take(LARGEST_FILE).read_to_end(&mut bytes).map_err(io)?;
        let parsed = geojson::parse(&bytes, frame, projection, &budget, report);
        (parsed.map(|raw| with_licence(raw, path)), false)
    } else {
        (xml::parse(input, report).map(of_osm), false)
    };
    parsed.map(Raw::sorted).map_err(|fault| match fault {
        Fault::Io(source) => ReadError::io(path, source),
        Fault::Content { byte, expected, found, remedy } => {
            let line = || open_regular(path).and_then(|file| line_of(file, byte));
            let place = if binary { format!("byte {byte}") } else { format!("line {}", line().unwrap_or(0)) };
            ReadError::Format { path: path.to_owned(), place, expected, found, remedy }
        }
    })
}

fn of_osm(raw: Raw) -> Raw {
    Raw { licence: LICENCE.into(), ..raw }
}

/// With the licence that the file states, or that it states none.
fn with_licence(raw: Raw, path: &Path) -> Raw {
    let name = path.file_name().unwrap_or_default().display();
    let licence = match raw.licence.trim() {
        "" => format!("{name}: licence not stated; ask whoever published it"),
        stated => format!("{name}: {stated}"),
    };
    Raw { licence, ..raw }
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

fn extent_of(nodes: &[RawNode]) -> Option<GeoExtent> {
    GeoExtent::around(nodes.iter().map(|n| [n.lat_deg, n.lon_deg]))
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
    let apart_km = extent.bounds(projection).centre().distance(area.centre()) / 1000.0;
    let wanted = GeoExtent::of_bounds(projection, area);
    ReadError::Elsewhere { path: path.to_owned(), wanted, extent: *extent, apart_km }
}
