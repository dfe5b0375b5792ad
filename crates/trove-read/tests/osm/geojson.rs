//! GeoJSON as a map: the forms that others write, damage, and a real file.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use glam::DVec2;
use proptest::prelude::*;
use trove_model::{
    Bounds, BuildingKind, DrivingSide, FurnitureKind, LandKind, MapProjection, Outcome, Report, RoadKind, RoadSurface,
    RoofShape, StreetMap,
};
use trove_read::ReadError;
use trove_read::osm::{self, GeoJsonFrame};

use crate::{METRE_DEG, file, nodes, noted, origin, read_bytes, way};

/// Far more than any of these takes.
const PATIENCE: Duration = Duration::from_secs(300);

/// Coordinates from metres, as a list.
fn line(places: &[[f64; 2]]) -> String {
    let position = |[x, y]: &[f64; 2]| format!("[{}, {}]", x * METRE_DEG, y * METRE_DEG);
    format!("[{}]", places.iter().map(position).collect::<Vec<_>>().join(", "))
}

fn square(low: f64, high: f64) -> String {
    line(&[[low, low], [high, low], [high, high], [low, high], [low, low]])
}

fn feature(kind: &str, coordinates: &str, properties: &str) -> String {
    format!(
        r#"{{"type": "Feature", "properties": {properties}, "geometry": {{"type": "{kind}", "coordinates": {coordinates}}}}}"#
    )
}

fn collection(features: &[String]) -> String {
    format!(r#"{{"type": "FeatureCollection", "features": [{}]}}"#, features.join(",\n"))
}

fn read(content: &str) -> (StreetMap, Report) {
    let (map, report) = read_bytes(content.as_bytes());
    (map.unwrap(), report)
}

fn refused(content: &str) -> String {
    read_bytes(content.as_bytes()).0.unwrap_err().to_string()
}

#[test]
fn a_place_is_the_same_as_geojson_and_as_openstreetmaps_own_xml() {
    let road = "highway=primary|lanes=4|width=12.5|oneway=yes|name=A|surface=asphalt";
    let content = nodes(&[(1, 0., 0.), (2, 10., 0.), (3, 10., 10.), (4, 0., 10.), (5, 30., 0.), (6, 60., 5.)])
        + &way(1, &[1, 2, 5, 6], road)
        + &way(2, &[1, 2, 3, 4, 1], "building=house|height=7.5|roof:shape=gabled|area=yes")
        + &way(3, &[1, 2, 3, 4, 1], "natural=wood|area=yes")
        + &way(4, &[3, 4], "barrier=fence")
        + "<node id='7' lat='0.0001' lon='0.0001'><tag k='natural' v='tree'/><tag k='height' v='8'/></node>\n";
    let (mut expect, _) = crate::read(&content);
    let properties =
        r#"{"highway": "primary", "lanes": 4, "width": "12.5", "oneway": true, "name": "A", "surface": "asphalt"}"#;
    let (mut found, report) = read(&collection(&[
        feature("LineString", &line(&[[0., 0.], [10., 0.], [30., 0.], [60., 5.]]), properties),
        feature(
            "Polygon",
            &format!("[{}]", square(0., 10.)),
            r#"{"building": "house", "height": 7.5, "roof:shape": "gabled"}"#,
        ),
        feature("Polygon", &format!("[{}]", square(0., 10.)), r#"{"natural": "wood"}"#),
        feature("LineString", &line(&[[10., 10.], [0., 10.]]), r#"{"barrier": "fence"}"#),
        feature("Point", "[0.0001, 0.0001]", r#"{"natural": "tree", "height": 8}"#),
    ]));
    assert_eq!(found.licence, "map.osm: licence not stated; ask whoever published it");
    found.licence.clone_from(&expect.licence);
    // Nodes have no numbers in GeoJSON.
    expect.furniture.iter_mut().chain(&mut found.furniture).for_each(|thing| thing.id = 0);
    assert_eq!(found, expect);
    assert_eq!((found.roads.len(), found.buildings.len(), found.land.len(), found.lines.len()), (1, 1, 1, 1));
    assert_eq!(found.furniture[0].kind, FurnitureKind::Tree);
    assert_eq!(report.entries(), []);
}

#[test]
fn outlines_have_holes_parts_and_close() {
    let with_hole = format!("[{}, {}]", square(0., 10.), square(4., 6.));
    let open = line(&[[20., 20.], [30., 20.], [30., 30.], [20., 30.]]);
    let (map, report) = read(&collection(&[
        feature("Polygon", &with_hole, r#"{"building": "yes"}"#),
        feature("MultiPolygon", &format!("[[{}], {}, []]", square(40., 50.), with_hole), r#"{"building": "yes"}"#),
        feature("Polygon", &format!("[{open}]"), r#"{"building": "yes"}"#),
        feature("Polygon", &with_hole, r#"{"highway": "pedestrian", "type": "x"}"#),
        feature("Polygon", &format!("[{}]", square(60., 70.)), r#"{"highway": "pedestrian"}"#),
        feature("LineString", &square(60., 70.), r#"{"highway": "residential"}"#),
        feature(
            "MultiLineString",
            &format!("[{}, {}]", line(&[[0., 0.], [9., 0.]]), line(&[[0., 5.], [9., 5.]])),
            r#"{"highway": "service"}"#,
        ),
    ]));
    let mut areas: Vec<f64> = map.buildings.iter().map(|b| b.footprint.area_m2().round()).collect();
    areas.sort_by(f64::total_cmp);
    assert_eq!(areas, [96.0, 96.0, 100.0, 100.0]);
    let mut land: Vec<(LandKind, f64)> = map.land.iter().map(|l| (l.kind, l.polygon.area_m2().round())).collect();
    land.sort_by(|a, b| a.1.total_cmp(&b.1));
    assert_eq!(land, [(LandKind::Paved, 96.0), (LandKind::Paved, 100.0)]);
    let kinds: Vec<RoadKind> = map.roads.iter().map(|road| road.kind).collect();
    assert_eq!(kinds, [RoadKind::Residential, RoadKind::Service, RoadKind::Service]);
    assert!(noted(&report, Outcome::Substituted, "ring that does not close"));
    assert_eq!(report.entries().len(), 1, "{:?}", report.entries());
}

#[test]
fn microsofts_footprints_are_buildings_whose_height_may_be_unknown() {
    let footprint = |low: f64, height: &str| {
        let coordinates = format!("[{}]", square(low, low + 10.));
        let properties = format!(r#"{{"height": {height}, "confidence": -1.0}}"#);
        // One a line, and no line of their own within.
        feature("Polygon", &coordinates, &properties)
    };
    let lines =
        [footprint(0., "5.25"), footprint(20., "-1"), "{\"type\": \"Feature\", \"prop".into(), footprint(40., "-1.0")];
    for content in [lines.join("\n"), lines.join("\r\n") + "\n\n", format!("\u{feff}{}", lines.join("\n"))] {
        let (map, report) = read(&content);
        let heights: Vec<Option<f64>> = map.buildings.iter().map(|building| building.height_m).collect();
        assert_eq!(heights, [Some(5.25), None, None]);
        let entry = |what: &str| report.entries().into_iter().find(|e| e.what.contains(what)).unwrap();
        assert!(entry("line that is no JSON").examples[0].starts_with("line 3: "));
        assert_eq!(entry("line that is no JSON").count, 1);
        assert_eq!((entry("taken for a building").outcome, entry("taken for a building").count), (Outcome::Guessed, 3));
    }
}

#[test]
fn overtures_buildings_and_segments_are_told_in_openstreetmaps_words() {
    let (map, report) = read(&collection(&[
        feature(
            "Polygon",
            &format!("[{}]", square(0., 10.)),
            r##"{"id": "08b", "subtype": "residential", "class": "apartments", "height": 12.5, "num_floors": 4,
                "roof_shape": "hipped", "facade_color": "#ffffff", "names": {"primary": "A"}}"##,
        ),
        feature("Polygon", &format!("[{}]", square(20., 30.)), r#"{"subtype": null, "class": null, "height": null}"#),
        feature("Polygon", &format!("[{}]", square(40., 50.)), r#"{"height": 9, "is_underground": true}"#),
        feature(
            "LineString",
            &line(&[[0., 0.], [50., 0.]]),
            r#"{"subtype": "road", "class": "primary", "subclass": "link", "names": {"primary": "B"},
                "road_surface": [{"value": "gravel"}], "road_flags": [{"values": ["is_bridge"]}]}"#,
        ),
    ]));
    let building = &map.buildings[0];
    assert_eq!(
        (building.kind, building.height_m, building.levels),
        (Some(BuildingKind::Apartments), Some(12.5), Some(4.0))
    );
    assert_eq!((building.roof, building.color), (Some(RoofShape::Hipped), Some(glam::Vec3::ONE)));
    assert_eq!((building.name.as_str(), map.buildings.len()), ("A", 2));
    let road = &map.roads[0];
    assert_eq!((road.kind, road.link, road.bridge), (RoadKind::Primary, true, true));
    assert_eq!((road.surface, road.name.as_deref()), (Some(RoadSurface::Gravel), Some("B")));
    assert!(noted(&report, Outcome::Dropped, "underground"));
}

#[test]
fn what_does_not_say_what_it_is_is_guessed_only_where_nothing_does() {
    let bare = feature("LineString", &line(&[[0., 0.], [50., 0.]]), "{}");
    let (map, report) = read(&collection(&[bare.clone(), bare.replace("\"properties\": {}, ", "")]));
    assert_eq!(map.roads.iter().map(|road| road.kind).collect::<Vec<_>>(), [RoadKind::Minor; 2]);
    assert!(noted(&report, Outcome::Guessed, "taken for a road"));
    let tree = feature("Point", "[0, 0]", r#"{"natural": "tree"}"#);
    let (map, report) = read(&collection(&[bare, tree]));
    assert_eq!((map.roads.len(), map.furniture.len()), (0, 1));
    assert!(noted(&report, Outcome::Dropped, "no tag says what it looks like"));
}

#[test]
fn lines_that_share_a_position_share_a_node() {
    // The sign stands at the end of its road, and faces who comes from there.
    let (map, _) = read(&collection(&[
        feature("LineString", &line(&[[0., 0.], [50., 0.]]), r#"{"highway": "residential"}"#),
        feature("Point", &line(&[[50., 0.]])[1..].replace("]]", "]"), r#"{"highway": "stop"}"#),
        feature("MultiPoint", &line(&[[50., 0.], [60., 0.]]), r#"{"natural": "tree"}"#),
    ]));
    let found: Vec<(FurnitureKind, Option<f64>)> =
        map.furniture.iter().map(|f| (f.kind, f.heading_rad.map(|h| h.to_degrees().round()))).collect();
    assert_eq!(
        found,
        [(FurnitureKind::StopSign, Some(180.0)), (FurnitureKind::Tree, None), (FurnitureKind::Tree, None)]
    );
}

#[test]
fn damaged_features_are_dropped_and_said_so() {
    let good = feature("LineString", &line(&[[0., 0.], [50., 0.]]), r#"{"highway": "residential"}"#);
    let check = |bad: &str, what: &str| {
        let (map, report) = read(&collection(&[good.clone(), bad.into(), good.clone()]));
        assert_eq!(map.roads.len(), 2, "{bad}");
        let entry = report.entries().into_iter().find(|entry| entry.what.contains(what));
        assert!(entry.is_some_and(|entry| entry.examples[0].contains('2')), "{bad}: {:?}", report.entries());
    };
    check("7", "object that is no Feature");
    check("null", "object that is no Feature");
    check("[[1, 2]]", "object that is no Feature");
    check(r#"{"type": "Point", "coordinates": [0, 0]}"#, "object that is no Feature");
    check(r#"{"type": "Feature", "properties": {}, "geometry": null}"#, "without a geometry");
    check(r#"{"type": "Feature", "geometry": 7}"#, "coordinates are not those of its type");
    check(r#"{"type": "Feature", "geometry": {"type": "LineString"}}"#, "coordinates are not those of its type");
    check(&feature("LineString", "[0, 0]", "{}"), "coordinates are not those of its type");
    check(&feature("LineString", "[[0, \"0\"], [1, null]]", "{}"), "coordinates are not those of its type");
    check(&feature("Polygon", "[[[0, 0], [1]]]", "{}"), "coordinates are not those of its type");
    check(&feature("GeometryCollection", "[]", "{}"), "type is not read");
    check(&feature("LineString", "[[0, 0], [0.0001, 0]]", "7"), "properties that are no object");
    check(&feature("LineString", "[[0, 0]]", r#"{"highway": "service"}"#), "road with a single point");
    check(&feature("Polygon", "[[[0, 0], [0.0001, 0]]]", r#"{"building": "yes"}"#), "outline");
    check(
        &feature("LineString", &format!("[{}[0, 0]]", "[0, 0], ".repeat(50_001)), "{}"),
        "way with more nodes than ways may have",
    );
    let with_id = |id: &str| good.replacen('{', &format!("{{\"id\": {id}, "), 1);
    let (map, report) =
        read(&collection(&[with_id("7"), with_id("\"a\""), with_id("\"7\""), with_id("null"), good.clone()]));
    assert_eq!(map.roads.iter().map(|road| road.id).collect::<Vec<_>>(), [1, 2, 4, 5]);
    assert!(noted(&report, Outcome::Dropped, "feature with the id of another one"));
}

#[test]
fn files_that_are_no_geojson_say_where_and_what_to_do() {
    let check = |content: &str, parts: &[&str]| {
        let error = refused(content);
        assert!(parts.iter().all(|part| error.contains(part)), "{error}: expected {parts:?}");
    };
    let good = feature("LineString", "[[0, 0], [1, 0]]", "{}");
    let whole = collection(std::slice::from_ref(&good));
    check(&whole[..whole.len() - 3], &["map.osm: line 1: ", "cut off", "download it again"]);
    check(&whole[..40], &["cut off"]);
    check("{\"type\": \"FeatureCollection\",\n \"features\": [}", &["line 2", "expected value at column"]);
    check("{\"features\": [\n{\"properties\": {\"height\": NaN}}]}", &["line 2", "NaN", "write null"]);
    check("{\"features\": [\n\n{\"coordinates\": [-Infinity]}]}", &["line 3", "Infinity", "write null"]);
    check("{\"features\": [{\"geometry\": {\"coordinates\": [1e999]}}]}", &["number out of range"]);
    check("{\"features\": [{\"height\": \"\u{7}\"}]}", &["control character"]);
    check("{}", &["nodes that have coordinates"]);
    check("{\"type\": \"FeatureCollection\", \"features\": []}", &["nodes that have coordinates"]);
    check("{\"type\": \"FeatureCollection\", \"features\": 7}", &["nodes that have coordinates"]);
    check(&(whole.clone() + "}"), &["trailing characters"]);
    let crs = |name: &str| whole.replacen('{', &format!(r#"{{"crs": {{"properties": {{"name": "{name}"}}}}, "#), 1);
    check(&crs("urn:ogc:def:crs:EPSG::32632"), &["EPSG::32632", "ogr2ogr -t_srs EPSG:4326"]);
    read(&crs("urn:ogc:def:crs:OGC:1.3:CRS84"));
    read(&crs("EPSG:4326"));
    let metres = feature("LineString", "[[674.369, -40.14], [684.843, -38.534]]", "{}");
    check(&collection(&[good, metres]), &["[674.369, -40.14]", "map.geojson_frame = \"dataset\"", "ogr2ogr"]);
}

#[test]
fn metres_in_the_datasets_plane_lie_where_the_dataset_has_them() {
    let projection = MapProjection::spherical(40.44, -79.99, DVec2::new(1000.0, 2000.0));
    let metres = feature("LineString", "[[1010, 2020.5], [990.25, 1900]]", "{}");
    let far = feature("LineString", "[[1e300, 0], [-3e7, 1]]", "{}");
    let plain = collection(&[metres, far]);
    let stated = plain.replacen('{', r#"{"crs": {"type": "name", "properties": {"name": "trove:dataset"}}, "#, 1);
    let other = plain.replacen('{', r#"{"crs": {"type": "name", "properties": {"name": "EPSG:4326"}}, "#, 1);
    let dir = tempfile::tempdir().unwrap();
    let read = |frame, content: &str| {
        let path = file(&dir, "map.geojson", content.as_bytes());
        let (area, report) = (Bounds::square(DVec2::ZERO, 500.0), Report::default());
        osm::read_in(frame, &path, &projection, area, DrivingSide::Right, &report).map(|map| (map, report))
    };
    for (frame, content) in
        [(GeoJsonFrame::Dataset, &plain), (GeoJsonFrame::Dataset, &stated), (GeoJsonFrame::Wgs84, &stated)]
    {
        let (map, report) = read(frame, content).unwrap();
        let expect = [DVec2::new(10.0, 20.5), DVec2::new(-9.75, -100.0)];
        assert!(map.roads[0].centreline.iter().zip(expect).all(|(a, b)| a.distance(b) < 1e-6), "{:?}", map.roads);
        assert_eq!(map.roads.len(), 1);
        assert!(noted(&report, Outcome::Dropped, "position that lies in no plane"));
    }
    let error = read(GeoJsonFrame::Dataset, &other).unwrap_err().to_string();
    assert!(error.contains("EPSG:4326") && error.contains("remove map.geojson_frame"), "{error}");
    let path = file(&dir, "map.geojson", stated.as_bytes());
    assert!(osm::extent(&path).unwrap_err().to_string().contains("together with the drive"));
}

#[test]
fn a_licence_is_named_where_the_file_states_it() {
    let good = collection(&[feature("LineString", "[[0, 0], [1, 0]]", "{}")]);
    for key in ["copyright", "attribution", "license", "licence"] {
        let (map, _) = read(&good.replacen('{', &format!("{{\"{key}\": \"ODbL, © them\", "), 1));
        assert_eq!(map.licence, "map.osm: ODbL, © them");
    }
}

/// What reading gives, in time.
fn in_time(content: String) -> (Result<StreetMap, ReadError>, Report) {
    let (give, take) = mpsc::channel();
    thread::spawn(move || drop(give.send(read_bytes(content.as_bytes()))));
    take.recv_timeout(PATIENCE).expect("the map is read in time")
}

#[test]
fn nesting_a_million_deep_is_skipped_or_refused() {
    let good = feature("LineString", &line(&[[0., 0.], [50., 0.]]), "{}");
    let (open, close) = ("[".repeat(1_000_000), "]".repeat(1_000_000));
    let nested = format!("{open}{close}");
    let objects = format!("{}7{}", "{\"a\":".repeat(1_000_000), "}".repeat(1_000_000));
    for bad in [
        feature("LineString", &nested, "{}"),
        feature("LineString", &objects, "{}"),
        feature("Polygon", "[]", &format!(r#"{{"height": {nested}, "names": {objects}}}"#)),
        format!(r#"{{"type": {objects}, "x": {nested}}}"#),
    ] {
        let (map, report) = in_time(collection(&[good.clone(), bad.clone()]));
        assert_eq!(map.unwrap().roads.len(), 1);
        assert!(noted(&report, Outcome::Dropped, "geojson: "), "{}", &bad[..60]);
    }
    for bad in [collection(std::slice::from_ref(&open)), "{\"features\":".repeat(200_000), "{\"a\":\n".repeat(200_000)]
    {
        assert!(in_time(bad).0.is_err());
    }
}

#[test]
fn a_hundred_times_the_size_takes_seconds() {
    let footprint = |i: usize| {
        let low = (i % 1000) as f64 * 20.0 + 5.0;
        feature("Polygon", &format!("[{}]", square(low, low + 10.)), r#"{"height": 5, "confidence": 0.5}"#)
    };
    let started = Instant::now();
    let (map, _) = in_time((0..100_000).map(footprint).collect::<Vec<_>>().join("\n"));
    assert_eq!(map.unwrap().buildings.len(), 5000, "50 of each 1000 lie in the area");
    assert!(started.elapsed() < PATIENCE);
    // One line may be no longer than ways are, one feature no larger than its file.
    let lines = format!("[{}]", vec![line(&[[0., 0.], [50., 0.]]); 200_000].join(","));
    let (map, _) = in_time(collection(&[feature("MultiLineString", &lines, "{}")]));
    let map = map.unwrap();
    assert_eq!(map.roads.len(), 200_000);
    assert_eq!(map.roads.iter().map(|road| road.id).collect::<BTreeSet<_>>().len(), 200_000);
}

proptest! {
    #[test]
    fn any_bytes_in_geojson_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..200), at in 0..400usize) {
        let whole = collection(&[
            feature("Polygon", &format!("[{}]", square(0., 10.)), r#"{"class": "house", "height": 3}"#),
            feature("LineString", "[[0, 0], [1, 0]]", r#"{"road_flags": [{"values": ["is_bridge"]}]}"#),
        ]);
        let at = at.min(whole.len());
        let _ = read_bytes(&[&whole.as_bytes()[..at], &bytes, &whole.as_bytes()[at..]].concat());
        let _ = read_bytes(&[b"{\"features\":[", &bytes[..]].concat());
    }
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_roads_of_pittsburgh_lie_where_the_file_has_them() {
    let data = PathBuf::from(std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA"));
    let path = data.join("argoverse2/osm_roads_PIT_cityframe.geojson");
    let text = std::fs::read_to_string(&path).unwrap();
    // Counted without the reader.
    let lines = text.matches("\"type\": \"LineString\"").count();
    let positions = text.matches("[[").count() + text.matches("], [").count();
    assert_eq!((lines, positions), (1111, 4403), "as the file was when this was written");
    let middle_m = DVec2::new(4200.0, 1500.0);
    let projection = MapProjection::spherical(40.44, -79.99, middle_m);
    let report = Report::default();
    let area = Bounds::square(DVec2::ZERO, 10_000.0);
    let map = osm::read_in(GeoJsonFrame::Dataset, &path, &projection, area, DrivingSide::Right, &report).unwrap();
    assert_eq!(map.roads.len(), lines);
    assert_eq!(map.roads.iter().map(|road| road.centreline.len()).sum::<usize>(), positions);
    assert!(map.roads.iter().all(|road| road.kind == RoadKind::Minor));
    let first = map.roads.iter().find(|road| road.id == 1).unwrap();
    assert!((first.centreline[0] + middle_m).distance(DVec2::new(674.369, -40.14)) < 1e-6);
    let guessed = report.entries().into_iter().find(|e| e.what.contains("taken for a road")).unwrap();
    assert_eq!(guessed.count as usize, lines);
    let as_degrees = osm::read(&path, &origin(), area, DrivingSide::Right, &report).unwrap_err().to_string();
    assert!(as_degrees.contains("map.geojson_frame = \"dataset\""), "{as_degrees}");
}
