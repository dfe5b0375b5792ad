//! OpenStreetMap extracts and GeoJSON.

use std::fs;
use std::io::Write;
use std::path::Path;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use glam::DVec2;
use trove_model::{Bounds, DrivingSide, MapProjection, Report};
use trove_read::osm::{self, GeoJsonFrame};

#[path = "../../crates/trove-read/tests/osm/wire.rs"]
mod wire;

use wire::{bytes, deltas, header, packed, varint};

pub(crate) fn feed(folder: &Path, data: &[u8]) {
    feed_as(GeoJsonFrame::Wgs84, folder, data);
}

/// GeoJSON, its coordinates as degrees and as metres.
pub(crate) fn feed_geojson(folder: &Path, data: &[u8]) {
    feed_as(GeoJsonFrame::Wgs84, folder, data);
    feed_as(GeoJsonFrame::Dataset, folder, data);
}

fn feed_as(frame: GeoJsonFrame, folder: &Path, data: &[u8]) {
    let path = folder.join("map.osm");
    if fs::write(&path, data).is_err() {
        return;
    }
    let projection = MapProjection::spherical(0.0, 0.0, DVec2::ZERO);
    let area = Bounds::square(DVec2::ZERO, 2000.0);
    // Whatever is wrong is an error.
    let _ = osm::read_in(frame, &path, &projection, area, DrivingSide::Right, &Report::default());
}

/// Blocks as they are: what is compressed is packed anew after it was mutated, or mutations would only break zlib.
pub(crate) fn feed_pbf(folder: &Path, data: &[u8]) {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::fast());
    let packed = packer.write_all(data).and_then(|()| packer.finish()).unwrap_or_default();
    let blob = [varint(2 << 3), varint(data.len() as u64), bytes(3, &packed)].concat();
    let head = [bytes(1, b"OSMData"), varint(3 << 3), varint(blob.len() as u64)].concat();
    let whole = [header(), (head.len() as u32).to_be_bytes().to_vec(), head, blob].concat();
    feed(folder, &whole);
    // And the file itself.
    feed(folder, &[header(), data.to_vec()].concat());
}

pub(crate) fn xml_seeds() -> Vec<Vec<u8>> {
    let node = |i: i32, x: f64, y: f64| format!("<node id='{i}' lat='{}' lon='{}'/>\n", y * 1e-5, x * 1e-5);
    let nodes: String = (1..9).map(|i| node(i, f64::from(i % 3) * 10.0, f64::from(i / 3) * 10.0)).collect();
    let way = |id: i32, nodes: &[i32], tags: &[(&str, &str)]| {
        let nodes: String = nodes.iter().map(|n| format!("<nd ref='{n}'/>")).collect();
        let tags: String = tags.iter().map(|(k, v)| format!("<tag k='{k}' v='{v}'/>")).collect();
        format!("<way id='{id}'>{nodes}{tags}</way>\n")
    };
    let ways = [
        way(
            1,
            &[1, 2, 5, 4, 1],
            &[("building", "yes"), ("height", "12.5 m"), ("roof:shape", "gabled"), ("building:colour", "#a05")],
        ),
        way(
            2,
            &[1, 5, 8],
            &[
                ("highway", "residential"),
                ("lanes", "2"),
                ("turn:lanes", "left|through"),
                ("maxspeed", "30 mph"),
                ("width", "7'6\""),
            ],
        ),
        way(3, &[3, 6, 8, 3], &[("natural", "coastline")]),
        way(4, &[2, 6], &[("barrier", "fence"), ("fence_type", "chain_link")]),
        way(5, &[1, 4, 7], &[("natural", "tree_row"), ("species", "Platanus")]),
        way(6, &[1, 3, 6, 4, 1], &[]),
    ]
    .concat();
    let relation = "<relation id='9'><member type='way' ref='6' role='outer'/><member type='way' ref='1' role='inner'/>\
        <tag k='type' v='multipolygon'/><tag k='landuse' v='grass'/></relation>";
    let things = "<node id='20' lat='0.0001' lon='0.0001'><tag k='highway' v='traffic_signals'/><tag k='direction' v='forward'/></node>\
        <node id='21' lat='0.0001' lon='0'><tag k='shop' v='bakery'/><tag k='traffic_sign' v='DE:274[50]'/></node>";
    vec![format!("<?xml version='1.0'?><osm version='0.6'>{nodes}{things}{ways}{relation}</osm>").into_bytes()]
}

pub(crate) fn geojson_seeds() -> Vec<Vec<u8>> {
    let feature = |kind: &str, coordinates: &str, properties: &str| {
        let geometry = format!(r#"{{"type":"{kind}","coordinates":{coordinates}}}"#);
        format!(r#"{{"type":"Feature","id":"{kind}","properties":{properties},"geometry":{geometry}}}"#)
    };
    let square = "[[0,0],[0.0002,0],[0.0002,0.0002],[0,0.0002],[0,0]]";
    let hole = "[[0.0001,0.0001],[0.00015,0.0001],[0.0001,0.00015],[0.0001,0.0001]]";
    let road = r#"{"class":"primary","subclass":"link","road_flags":[{"values":["is_bridge"],"between":null}],
        "road_surface":[{"value":"gravel"}],"speed_limits":[{"max_speed":{"value":35,"unit":"mph"}}],
        "access_restrictions":[{"access_type":"denied","when":{"heading":"backward"}}],"names":{"primary":"A"}}"#;
    let house = r##"{"class":"house","height":7.5,"num_floors":2,"roof_shape":"hipped","facade_color":"#a05030"}"##;
    let overture = [
        feature("LineString", "[[0,0],[0.0005,0.0001,3]]", road),
        feature("MultiPolygon", &format!("[[{square},{hole}]]"), house),
    ];
    let own = [
        feature("MultiLineString", "[[[0,0],[0.001,0]]]", r#"{"highway":"service","lanes":"2","oneway":true}"#),
        feature("Polygon", &format!("[{square}]"), r#"{"building":"yes","height":-1}"#),
        feature("Point", "[0.001,0]", r#"{"highway":"stop"}"#),
    ];
    let crs = r#""crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:OGC:1.3:CRS84"}}"#;
    let collection = |features: &[String]| {
        let features = features.join(",");
        format!(r#"{{"type":"FeatureCollection","license":"ODbL",{crs},"features":[{features}]}}"#).into_bytes()
    };
    let lines =
        overture.iter().chain(&own).map(|feature| feature.replace('\n', " ") + "\n").collect::<String>().into_bytes();
    vec![collection(&overture), collection(&own), lines]
}

pub(crate) fn pbf_seeds() -> Vec<Vec<u8>> {
    let words = ["", "building", "yes", "natural", "tree", "type", "multipolygon", "highway", "residential"];
    let strings: Vec<u8> = words.iter().flat_map(|s| bytes(1, s.as_bytes())).collect();
    let dense = [
        deltas(1, &[1, 2, 3, 4]),
        deltas(8, &[0, 0, 900, 900]),
        deltas(9, &[0, 900, 900, 0]),
        packed(10, &[3, 4, 0, 0, 0, 0]),
    ];
    let way = |id: u64, key: u64, value: u64, nodes: &[i64]| {
        bytes(3, &[varint(1 << 3), varint(id), packed(2, &[key]), packed(3, &[value]), deltas(8, nodes)].concat())
    };
    let members = [packed(8, &[0]), deltas(9, &[9]), packed(10, &[1])].concat();
    let relation = [varint(1 << 3), varint(12), packed(2, &[5, 1]), packed(3, &[6, 2]), members].concat();
    let group =
        [bytes(2, &dense.concat()), way(9, 1, 2, &[1, 2, 3, 4, 1]), way(10, 7, 8, &[1, 2, 3]), bytes(4, &relation)];
    vec![[bytes(1, &strings), bytes(2, &group.concat()), varint(17 << 3), varint(100)].concat()]
}
