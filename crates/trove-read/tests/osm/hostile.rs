//! Small files that ask for much memory or much time.

use std::io::Write;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use trove_model::{Outcome, Report, StreetMap};
use trove_read::ReadError;

use crate::wire::{bytes, deltas, header, packed, varint};
use crate::{METRE_DEG, noted, read_bytes, way};

/// Ten times as long as any of these takes on a slow machine that others use; without a budget they take many minutes.
const PATIENCE: Duration = Duration::from_secs(300);

/// What reading gives, in time.
fn in_time(content: Vec<u8>) -> (Result<StreetMap, ReadError>, Report) {
    let (give, take) = mpsc::channel();
    thread::spawn(move || drop(give.send(read_bytes(&content))));
    take.recv_timeout(PATIENCE).expect("the map is read in time")
}

/// An extract of blocks that are compressed.
fn extract(blocks: &[Vec<u8>]) -> Vec<u8> {
    let mut file = header();
    for block in blocks {
        let mut packer = ZlibEncoder::new(Vec::new(), Compression::best());
        packer.write_all(block).unwrap();
        let blob = [varint(2 << 3), varint(block.len() as u64), bytes(3, &packer.finish().unwrap())].concat();
        let header = [bytes(1, b"OSMData"), varint(3 << 3), varint(blob.len() as u64)].concat();
        file.extend((header.len() as u32).to_be_bytes());
        file.extend([header, blob].concat());
    }
    file
}

fn strings(strings: &[&[u8]]) -> Vec<u8> {
    bytes(1, &strings.iter().flat_map(|s| bytes(1, s)).collect::<Vec<_>>())
}

/// A way of some nodes whose tags are pairs of strings.
fn tagged_way(id: u64, nodes: &[i64], keys: &[u64], values: &[u64]) -> Vec<u8> {
    bytes(3, &[varint(1 << 3), varint(id), packed(2, keys), packed(3, values), deltas(8, nodes)].concat())
}

/// One node at the origin.
fn origin() -> Vec<u8> {
    bytes(2, &[deltas(1, &[1]), deltas(8, &[0]), deltas(9, &[0])].concat())
}

#[test]
fn a_long_string_is_not_copied_for_everything_that_refers_to_it() {
    let long = vec![b'x'; 16 << 20];
    let ways: Vec<u8> = (0..2000).flat_map(|id| tagged_way(id, &[1, 1], &[1], &[2])).collect();
    let file = extract(&[[strings(&[b"", b"name", &long]), bytes(2, &[origin(), ways].concat())].concat()]);
    assert!(file.len() < 64 << 10, "{}", file.len());
    let (map, report) = in_time(file);
    assert!(map.is_ok() && noted(&report, Outcome::Dropped, "osm: text longer than a tag may be"));
}

#[test]
fn a_string_that_is_no_text_is_decoded_once() {
    for length in [1000, 64 << 10] {
        let broken = vec![0xff; length];
        let references = vec![1; 1 << 20];
        let way = tagged_way(7, &[1, 1], &references, &references);
        let (map, _) = in_time(extract(&[[strings(&[b"", &broken]), bytes(2, &[origin(), way].concat())].concat()]));
        assert!(map.is_ok());
    }
}

#[test]
fn zeros_that_unpack_to_gigabytes_are_refused() {
    let zeros = vec![0; 10 << 20];
    let dense = bytes(2, &bytes(2, &[bytes(1, &zeros), bytes(8, &zeros), bytes(9, &zeros)].concat()));
    let file = extract(&vec![[strings(&[b""]), dense].concat(); 40]);
    assert!(file.len() < 2 << 20, "{}", file.len());
    let (map, _) = in_time(file);
    let message = map.unwrap_err().to_string();
    assert!(message.contains("unpacks to at most") && message.contains("byte "), "{message}");
}

#[test]
fn a_way_around_the_world_is_as_long_as_the_area() {
    let nodes = "<node id='1' lat='0' lon='-179'/><node id='2' lat='0' lon='179'/><node id='3' lat='1' lon='0'/>";
    let ways = [
        way(1, &[1, 2], "highway=primary"),
        way(2, &[1, 2], "barrier=fence"),
        way(3, &[1, 2], "natural=tree_row"),
        way(4, &[1, 2, 3, 1], "landuse=grass"),
    ];
    let (map, _) = in_time(format!("<osm>{nodes}{}</osm>", ways.concat()).into_bytes());
    let map = map.unwrap();
    // The area is 2 km wide, and a kilometre around it is kept of lines, five of outlines.
    assert_eq!((map.roads.len(), map.lines.len(), map.land.len()), (1, 1, 1));
    for line in [&map.roads[0].centreline, &map.lines[0].line] {
        assert!(line[0].distance(*line.last().unwrap()) < 4001.0, "{line:?}");
    }
    assert!(map.land[0].polygon.bounds().unwrap().size_m().max_element() < 12_001.0);
    assert!((200..600).contains(&map.furniture.len()), "{} trees", map.furniture.len());
}

#[test]
fn a_tangled_outline_is_left_out_and_the_rest_is_read() {
    // Each edge crosses nearly every other.
    let corners = 5001;
    let node = |i: i64| {
        let angle = (i * (corners / 2)) as f64 / corners as f64 * std::f64::consts::TAU;
        let [lat, lon] = [angle.sin(), angle.cos()].map(|v| 500.0 * v * METRE_DEG);
        format!("<node id='{i}' lat='{lat}' lon='{lon}'/>")
    };
    let nodes: String = (1..=corners).map(node).collect();
    let ring: Vec<i64> = (1..=corners).chain([1]).collect();
    let outlines: String = (0..40).map(|id| way(id, &ring, "building=yes")).collect();
    let road = way(99, &[1, 2], "highway=residential");
    let (map, report) = in_time(format!("<osm>{nodes}{outlines}{road}</osm>").into_bytes());
    assert_eq!(map.unwrap().roads.len(), 1);
    assert!(noted(&report, Outcome::Dropped, "osm: outline too tangled to be repaired"), "{:?}", report.entries());
}
