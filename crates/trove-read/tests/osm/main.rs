//! OpenStreetMap extracts, made up, damaged and real.
#![allow(clippy::unwrap_used)]

mod geojson;
mod hostile;
mod wire;

use std::path::{Path, PathBuf};

use glam::DVec2;
use proptest::prelude::*;
use trove_model::{
    BarrierStyle, Bounds, BuildingKind, CrossingMarking, Cycleway, DrivingSide, FurnitureDetail, FurnitureKind,
    LampMount, LandKind, LeafType, LineKind, MapProjection, MappedPlant, MappedSign, Outcome, Parking,
    ParkingOrientation, Report, RoadKind, RoadSurface, RoofMaterial, RoofShape, StreetMap, Turns, WallMaterial,
};
use trove_read::{ReadError, osm};

use wire::{blob, bytes, deltas, header, packed, varint};

/// Around latitude and longitude 0.
fn origin() -> MapProjection {
    MapProjection::spherical(0.0, 0.0, DVec2::ZERO)
}

/// Degrees of a metre at the origin.
const METRE_DEG: f64 = 360.0 / (std::f64::consts::TAU * 6_378_137.0);

/// Nodes by their ids and places in metres.
fn nodes(places: &[(i64, f64, f64)]) -> String {
    let node =
        |(id, x, y): &(i64, f64, f64)| format!("<node id='{id}' lat='{}' lon='{}'/>\n", y * METRE_DEG, x * METRE_DEG);
    places.iter().map(node).collect()
}

fn element(head: &str, children: &str, tags: &str) -> String {
    let name = head.split(' ').next().unwrap();
    let tag = |tag: &str| tag.split_once('=').map(|(k, v)| format!("<tag k='{k}' v='{v}'/>")).unwrap();
    format!("<{head}>{children}{}</{name}>\n", tags.split('|').filter(|t| !t.is_empty()).map(tag).collect::<String>())
}

fn way(id: i64, nodes: &[i64], tags: &str) -> String {
    let nodes: String = nodes.iter().map(|n| format!("<nd ref='{n}'/>")).collect();
    element(&format!("way id='{id}'"), &nodes, tags)
}

fn multipolygon(id: i64, members: &[i64], tags: &str) -> String {
    let members: String = members.iter().map(|w| format!("<member type='way' ref='{w}' role='outer'/>")).collect();
    element(&format!("relation id='{id}'"), &members, &format!("type=multipolygon|{tags}"))
}

/// Nodes 1 to 4 of a square of 10 m, 5 to 8 of one of 2 m in its middle.
fn squares() -> String {
    let corners = |first: i64, low: f64, high: f64| {
        [(first, low, low), (first + 1, high, low), (first + 2, high, high), (first + 3, low, high)]
    };
    nodes(&corners(1, 0.0, 10.0)) + &nodes(&corners(5, 4.0, 6.0))
}

fn file(dir: &tempfile::TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = dir.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn read_bytes(bytes: &[u8]) -> (Result<StreetMap, ReadError>, Report) {
    let (dir, report) = (tempfile::tempdir().unwrap(), Report::default());
    let path = file(&dir, "map.osm", bytes);
    let area = Bounds::square(DVec2::ZERO, 2000.0);
    (osm::read(&path, &origin(), area, DrivingSide::Right, &report), report)
}

fn read(content: &str) -> (StreetMap, Report) {
    let (map, report) = read_bytes(format!("<?xml version='1.0'?>\n<osm version='0.6'>\n{content}</osm>\n").as_bytes());
    (map.unwrap(), report)
}

fn noted(report: &Report, outcome: Outcome, what: &str) -> bool {
    report.entries().iter().any(|e| e.outcome == outcome && e.what.contains(what))
}

#[test]
fn a_building_has_what_its_tags_say() {
    let tags = "building=apartments|height=40&apos;|building:levels=3,5|roof:shape=half-hipped|roof:height=2 m\
                |building:colour=#FFFFFF|roof:colour=Grey|building:material=brick|min_height=3|name=A &amp; B";
    let (map, report) = read(&(squares() + &way(9, &[4, 3, 2, 1, 4], tags)));
    let building = &map.buildings[0];
    assert_eq!((building.id, building.kind, building.part), (9, Some(BuildingKind::Apartments), false));
    assert!((building.height_m.unwrap() - 12.192).abs() < 1e-9);
    assert_eq!((building.levels, building.roof_height_m, building.min_height_m), (Some(3.5), Some(2.0), 3.0));
    assert_eq!(building.roof, Some(RoofShape::HalfHipped));
    assert_eq!(building.color, Some(glam::Vec3::ONE));
    assert!((building.roof_color.unwrap().x - 0.2159).abs() < 1e-3);
    assert_eq!((building.material, building.name.as_str()), (Some(WallMaterial::Brick), "A & B"));
    assert!((building.footprint.area_m2() - 100.0).abs() < 1e-6);
    assert_eq!(report.entries(), []);
    assert_eq!(map.licence, "© OpenStreetMap contributors, ODbL 1.0");
}

#[test]
fn a_road_has_what_its_tags_say() {
    let content = squares()
        + &way(1, &[1, 2, 3], "highway=primary|lanes=4|width=12.5|sidewalk=left|oneway=-1|bridge=yes|surface=asphalt")
        + &way(2, &[1, 2, 3, 4, 1], "highway=residential|junction=roundabout|sidewalk:both=separate")
        + &way(3, &[1, 3], "highway=footway|footway=crossing|lanes=many");
    let (map, report) = read(&content);
    let road = &map.roads[0];
    assert_eq!((road.kind, road.lanes, road.width_m), (RoadKind::Primary, Some(4), Some(12.5)));
    assert!(road.oneway && road.bridge && road.layer == 1 && road.surface == Some(RoadSurface::Asphalt));
    assert!((road.centreline[0] - DVec2::splat(10.0)).length() < 1e-6, "oneway=-1 runs the other way");
    assert_eq!((road.sidewalk.left, road.sidewalk.right), (Some(false), Some(true)));
    assert!(map.roads[1].oneway && map.roads[1].centreline.len() == 5);
    assert_eq!(map.roads[1].sidewalk.left, Some(false));
    assert_eq!(map.roads[2].kind, RoadKind::Crossing);
    assert!(noted(&report, Outcome::Dropped, "lanes that cannot be used"));
}

#[test]
fn lanes_parking_and_cycle_lanes_are_those_of_each_side() {
    let tags = "highway=secondary_link|lanes=3|lanes:forward=2|turn:lanes:forward=left;through&#124;right\
                |parking:left=street_side|parking:left:orientation=diagonal|parking:right=no|cycleway:right=lane\
                |lit=yes|maxspeed=30 mph|oneway=";
    let content = squares()
        + &way(1, &[1, 2, 3], &format!("{tags}no"))
        + &way(2, &[1, 2, 3], &format!("{tags}-1").replace("turn:lanes:forward", "turn:lanes"))
        + &way(3, &[1, 2], "highway=residential|parking:lane:both=parallel|parking:lane:both:parallel=half_on_kerb")
        + &way(4, &[1, 2], "highway=residential|oneway=yes|cycleway=opposite_lane|turn:lanes=up|lit=maybe")
        + &way(5, &[1, 2], "highway=steps");
    let (map, report) = read(&content);
    let [both, against, old, one_way, steps] = &map.roads[..] else { panic!("{:?}", map.roads) };
    let (left_or_on, right) =
        (Turns { left: true, through: true, ..Turns::default() }, Turns { right: true, ..Turns::default() });
    assert_eq!((both.lanes, both.lanes_backward, both.link, both.lit), (Some(3), Some(1), true, Some(true)));
    assert_eq!((&both.turns_forward, &both.turns_backward), (&vec![left_or_on, right], &vec![]));
    assert_eq!(both.parking.left, Some(Parking::Bays(ParkingOrientation::Diagonal)));
    assert_eq!((both.parking.right, both.cycleway.right), (Some(Parking::No), Some(Cycleway::Lane)));
    assert!((both.speed_limit_kmh.unwrap() - 48.28).abs() < 0.01);
    // Drawn the other way, left is right.
    assert_eq!((&against.turns_forward, against.lanes_backward), (&vec![left_or_on, right], Some(0)));
    assert_eq!((against.parking.left, against.parking.right), (both.parking.right, both.parking.left));
    assert_eq!(against.cycleway.left, Some(Cycleway::Lane));
    assert_eq!(old.parking.left, Some(Parking::Kerb(ParkingOrientation::Parallel)));
    assert_eq!((one_way.cycleway.left, one_way.cycleway.right), (Some(Cycleway::Lane), None));
    assert!(steps.steps);
    for what in ["turn:lanes that cannot be used", "lit that cannot be used"] {
        assert!(noted(&report, Outcome::Dropped, what), "{what}: {:?}", report.entries());
    }
}

#[test]
fn roofs_dates_and_shops_are_read() {
    let tags =
        "building=yes|roof:material=roof_tiles|roof:levels=2|roof:direction=S|roof:orientation=across|start_date=C19";
    let shop = |tags: &str| {
        let place = format!("node id='9' lat='{}' lon='{}'", 5.0 * METRE_DEG, -0.5 * METRE_DEG);
        read(&(squares() + &element(&place, "", tags) + &way(1, &[1, 2, 3, 4, 1], "building=yes"))).0.buildings[0].shop
    };
    let (map, _) = read(&(squares() + &way(1, &[1, 2, 3, 4, 1], tags)));
    let building = &map.buildings[0];
    assert_eq!((building.roof_material, building.roof_levels), (Some(RoofMaterial::Tiles), Some(2.0)));
    assert!((building.roof_direction_rad.unwrap().to_degrees() - 270.0).abs() < 1e-9);
    assert_eq!((building.ridge_across, building.year, building.shop), (true, Some(1850), false));
    assert!(shop("shop=bakery") && shop("amenity=cafe") && !shop("shop=bakery|level=3") && !shop("amenity=bench"));
}

#[test]
fn a_word_that_no_table_has_is_reported_with_its_place() {
    let content = squares()
        + &way(
            1,
            &[1, 2, 3, 4, 1],
            "building=pagoda|building:material=jelly|roof:material=marzipan|roof:shape=twisted",
        )
        + &way(2, &[1, 2], "highway=residential|surface=lava")
        + &way(3, &[1, 2], "barrier=fence|fence_type=moat")
        + &way(4, &[1, 3], "highway=footway|footway=crossing|crossing=leap")
        + &way(5, &[5, 6, 7, 8, 5], "building=yes");
    let (map, report) = read(&content);
    let [pagoda, plain] = &map.buildings[..] else { panic!("{:?}", map.buildings) };
    assert_eq!((pagoda.kind, pagoda.material, pagoda.roof_material), (Some(BuildingKind::Other), None, None));
    assert_eq!((plain.kind, map.roads[0].surface, map.lines[0].style, map.roads[1].crossing), (None, None, None, None));
    let entries = report.entries();
    let examples = entries.iter().filter(|e| e.what.contains("unknown")).flat_map(|e| e.examples.clone());
    let mut examples: Vec<String> = examples.collect();
    examples.sort();
    let expected = [
        "way 1: jelly",
        "way 1: marzipan",
        "way 1: pagoda",
        "way 1: twisted",
        "way 2: lava",
        "way 3: moat",
        "way 4: leap",
    ];
    assert_eq!(examples, expected);
}

#[test]
fn a_crossing_is_marked_as_the_word_that_says_most() {
    let marking = |tags: &str| {
        let (map, _) = read(&(squares() + &way(1, &[1, 3], &format!("highway=footway|footway=crossing|{tags}"))));
        map.roads[0].crossing
    };
    assert_eq!(marking(""), None);
    assert_eq!(marking("crossing=marked"), Some(CrossingMarking::Usual));
    assert_eq!(marking("crossing:markings=yes|crossing=traffic_signals"), Some(CrossingMarking::Signals));
    assert_eq!(marking("crossing:markings=no|crossing=traffic_signals"), Some(CrossingMarking::Unmarked));
    assert_eq!(marking("crossing_ref=pelican|crossing=uncontrolled"), Some(CrossingMarking::Signals));
    assert_eq!(marking("crossing:markings=dots;surface"), Some(CrossingMarking::Dashes));
}

#[test]
fn single_things_have_what_their_words_say() {
    let detail = |tags: &str| {
        let (map, _) = read(&element("node id='1' lat='0' lon='0'", "", tags));
        map.furniture[0].detail.clone()
    };
    let plant = |species: Option<&str>, leaves| {
        Some(FurnitureDetail::Plant(MappedPlant { species: species.map(str::to_owned), leaves }))
    };
    assert_eq!(detail("natural=tree"), None);
    assert_eq!(
        detail("natural=tree|species=Tilia cordata|leaf_type=broadleaved"),
        plant(Some("tilia cordata"), Some(LeafType::Broad))
    );
    assert_eq!(detail("natural=tree|leaf_type=needleleaved"), plant(None, Some(LeafType::Needle)));
    assert_eq!(detail("natural=tree|taxon=Royal palm"), plant(Some("royal palm"), Some(LeafType::Frond)));
    assert_eq!(detail("natural=tree|leaf_type=mixed"), None);
    assert_eq!(detail("traffic_sign=DE:298,DE:206"), Some(FurnitureDetail::Sign(MappedSign::Stop)));
    assert_eq!(detail("traffic_sign=DE:298"), Some(FurnitureDetail::Sign(MappedSign::Other)));
    assert_eq!(detail("traffic_sign=yes"), None);
    let limit = MappedSign::SpeedLimit { limit_kmh: 30.0 };
    assert_eq!(detail("traffic_sign=maxspeed|maxspeed=30"), Some(FurnitureDetail::Sign(limit)));
    assert_eq!(detail("highway=street_lamp|lamp_mount=bent_mast"), Some(FurnitureDetail::Lamp(LampMount::BentMast)));
    assert_eq!(detail("highway=crossing|crossing=zebra"), Some(FurnitureDetail::Crossing(CrossingMarking::Zebra)));
}

#[test]
fn fences_and_rows_are_drawn_along_their_ways() {
    let content = squares()
        + &way(1, &[1, 2, 3, 4, 1], "leisure=garden|barrier=fence|height=1.2|fence_type=railing")
        + &way(2, &[1, 2], "barrier=bollard")
        + &way(3, &[1, 2], "railway=tram|highway=residential");
    let (map, _) = read(&content);
    let lines: Vec<_> = map.lines.iter().map(|l| (l.kind, l.line.len(), l.height_m, l.style)).collect();
    assert_eq!(lines, [(LineKind::Fence, 5, Some(1.2), Some(BarrierStyle::Bars)), (LineKind::Tram, 2, None, None)]);
    assert_eq!((map.land.len(), map.roads.len(), map.furniture.len()), (1, 1, 7));
}

#[test]
fn every_way_and_relation_is_used_or_reported() {
    let content = squares()
        + &way(1, &[1, 2, 3, 4, 1], "building=yes")
        + &way(2, &[1, 2], "highway=proposed")
        + &way(3, &[1, 2], "")
        + &way(4, &[1, 2, 1], "landuse=grass")
        + &way(5, &[1, 2, 3, 4, 1], "shop=bakery")
        + &way(6, &[5, 6, 7], "")
        + &way(7, &[7, 8, 5], "")
        + &multipolygon(1, &[6, 7], "natural=water")
        + &multipolygon(2, &[6], "natural=water")
        + &multipolygon(3, &[6, 7], "leisure=nothing")
        + &multipolygon(4, &[6, 7], "").replace("multipolygon", "route")
        + &multipolygon(5, &[6, 7], "leisure=park").replace("multipolygon", "boundary")
        + &multipolygon(6, &[1], "").replace("multipolygon", "building")
        + &multipolygon(7, &[99], "natural=water");
    let (_, report) = read(&content);
    assert_eq!((accounts("way", &report), accounts("relation", &report)), ([4, 3, 7], [3, 3, 6]));
}

#[test]
fn multipolygons_have_holes_whatever_their_ways_order_direction_and_style() {
    let hole = way(12, &[5, 8, 7, 6, 5], "natural=water");
    let pieces = way(10, &[3, 2, 1], "") + &way(11, &[3, 4, 1], "");
    for content in [
        squares() + &pieces + &hole + &multipolygon(1, &[12, 11, 10], "building=yes"),
        // Old style: the outer way carries the tags.
        squares() + &way(10, &[1, 2, 3, 4, 1], "building=yes") + &hole + &multipolygon(1, &[10, 12], ""),
        // Both: the outer way's tags must not fill the hole.
        squares() + &way(10, &[1, 2, 3, 4, 1], "building=yes") + &hole + &multipolygon(1, &[10, 12], "building=yes"),
    ] {
        let (map, _) = read(&content);
        let areas: Vec<_> = map.buildings.iter().map(|b| (b.id, b.footprint.area_m2().round())).collect();
        assert_eq!(areas, [(-1, 96.0)], "{content}");
        assert_eq!((map.land.len(), map.land[0].kind, map.land[0].id), (1, LandKind::Water, 12), "{content}");
    }
}

#[test]
fn a_building_in_a_courtyard_stands_beside_the_one_around_it() {
    let content = squares()
        + &way(10, &[1, 2, 3, 4, 1], "")
        + &way(12, &[5, 8, 7, 6, 5], "building=yes")
        + &multipolygon(1, &[10, 12], "building=yes");
    let areas: Vec<_> = read(&content).0.buildings.iter().map(|b| b.footprint.area_m2().round()).collect();
    assert_eq!(areas, [96.0, 4.0]);
}

#[test]
fn the_sea_surrounds_islands() {
    let island = way(10, &[1, 2, 3, 4, 1], "natural=coastline");
    let (map, report) = read(&(squares() + &island));
    assert_eq!(map.land.len(), 1);
    assert_eq!((map.land[0].kind, map.land[0].polygon.holes.len()), (LandKind::Water, 1));
    assert!((map.land[0].polygon.area_m2() - (2000.0 * 2000.0 - 100.0)).abs() < 1e-3);
    assert_eq!(report.entries(), []);
}

#[test]
fn broken_rings_are_reported_and_the_closed_ones_used() {
    let content = squares()
        + &way(10, &[1, 2, 3, 4, 1], "")
        + &way(11, &[5, 6, 7], "")
        + &multipolygon(1, &[10, 11, 99], "landuse=grass");
    let (map, report) = read(&content);
    assert_eq!(map.land.len(), 1);
    assert!(noted(&report, Outcome::Warned, "rings do not all close"));
    assert!(noted(&report, Outcome::Warned, "ways that are not in the file"));
}

#[test]
fn broken_ways_are_reported_and_the_rest_is_used() {
    let content = squares()
        + "<node id='20' lat='95' lon='0'/><node id='21' lat='nan' lon='0'/><node id='22'/><node lat='1' lon='1'/>"
        + &way(1, &[1, 2, 777, 3, 4], "highway=service")
        + &way(2, &[1], "highway=service")
        + &way(3, &[777, 778], "highway=service")
        + &way(4, &[1, 2, 2, 3], "highway=service")
        + &way(5, &[1, 3, 2, 4, 1], "building=yes")
        + &way(6, &[1, 2, 1], "building=yes")
        + &way(7, &[1, 2, 3], "railway=abandoned");
    let (map, report) = read(&content);
    assert_eq!(map.roads.iter().map(|r| (r.id, r.centreline.len())).collect::<Vec<_>>(), [(1, 2), (1, 2), (4, 3)]);
    assert_eq!(map.buildings.iter().map(|b| b.footprint.area_m2().round()).collect::<Vec<_>>(), [25.0, 25.0]);
    for what in [
        "impossible coordinates",
        "node without coordinates",
        "whose id is not a number",
        "road with a single point",
        "way without nodes in the file",
        "railway that is not used",
        "outline is not closed",
    ] {
        assert!(noted(&report, Outcome::Dropped, what), "{what}: {:?}", report.entries());
    }
    assert!(noted(&report, Outcome::Warned, "nodes that are not in the file"));
    assert!(noted(&report, Outcome::Warned, "same point twice"));
    assert!(noted(&report, Outcome::Substituted, "self-intersecting"));
}

#[test]
fn furniture_stands_where_its_node_is_and_faces_the_traffic() {
    let thing = |id: i64, x: f64, tags: &str| {
        element(&format!("node id='{id}' lat='{}' lon='{}'", 5.0 * METRE_DEG, x * METRE_DEG), "", tags)
    };
    let content = thing(1, 0.0, "highway=street_lamp|direction=E")
        + &thing(2, 10.0, "highway=stop|direction=forward")
        + &thing(3, 20.0, "natural=tree")
        + &thing(4, 9000.0, "amenity=bench")
        // The end of its road is near: that is where traffic has to give way.
        + &thing(5, 8.0, "highway=give_way|height=2.5")
        + &way(1, &[1, 2, 3], "highway=residential")
        + &way(2, &[1, 5, 2], "highway=residential");
    let (map, _) = read(&content);
    let degrees = |rad: Option<f64>| rad.map(|rad| rad.to_degrees().round());
    let found: Vec<_> = map.furniture.iter().map(|f| (f.kind, f.position.x.round(), degrees(f.heading_rad))).collect();
    let expected = [
        (FurnitureKind::StreetLamp, 0.0, Some(0.0)),
        (FurnitureKind::StopSign, 10.0, Some(180.0)),
        (FurnitureKind::Tree, 20.0, None),
        (FurnitureKind::GiveWaySign, 8.0, Some(180.0)),
    ];
    assert_eq!((&found[..], map.furniture[3].height_m), (&expected[..], Some(2.5)));
}

#[test]
fn an_extract_of_another_city_is_an_error_that_says_where_both_are() {
    let (dir, report) = (tempfile::tempdir().unwrap(), Report::default());
    let path = file(&dir, "map.osm", format!("<osm>{}</osm>", squares()).as_bytes());
    let boston = MapProjection::spherical(42.3368, -71.0579, DVec2::ZERO);
    let error = osm::read(&path, &boston, Bounds::square(DVec2::ZERO, 500.0), DrivingSide::Right, &report).unwrap_err();
    assert!(matches!(error, ReadError::Elsewhere { .. }), "{error:?}");
    let error = error.to_string();
    assert!(error.contains("42.33") && error.contains("latitude 0.0000°") && error.contains("km away"), "{error}");
    let extent = osm::extent(&path).unwrap();
    assert!((extent.bounds(&origin()).size_m() - DVec2::splat(10.0)).length() < 1e-6);
}

#[test]
fn an_extract_covers_what_its_bounds_say_and_not_where_its_ways_lead() {
    // The road leads on for a kilometre, into what another extract covers.
    let content = nodes(&[(1, 0.0, 0.0), (2, 1000.0, 0.0)]) + &way(1, &[1, 2], "highway=primary");
    let bounds = |low: f64, high: f64| {
        let [low, high] = [low, high].map(|m| m * METRE_DEG);
        format!("<bounds minlat='{low}' minlon='{low}' maxlat='{high}' maxlon='{high}'/>")
    };
    let there = Bounds { min: DVec2::new(800.0, -50.0), max: DVec2::new(900.0, 50.0) };
    let (dir, report) = (tempfile::tempdir().unwrap(), Report::default());
    let read = |bounds: &str| {
        let path = file(&dir, "map.osm", format!("<osm>{bounds}{content}</osm>").as_bytes());
        osm::read(&path, &origin(), there, DrivingSide::Right, &report)
    };
    assert_eq!(read("").unwrap().roads.len(), 1);
    assert!(matches!(read(&bounds(-100.0, 100.0)).unwrap_err(), ReadError::Elsewhere { .. }));
    assert_eq!(read(&(bounds(-100.0, 100.0) + &bounds(700.0, 1000.0))).unwrap().roads.len(), 1);
    // What is no rectangle says nothing.
    for odd in ["<bounds minlat='a'/>", "<bounds minlat='9' maxlat='1' minlon='0' maxlon='1'/>", "<bounds/>"] {
        assert_eq!(read(odd).unwrap().roads.len(), 1, "{odd}");
    }
}

#[test]
fn an_empty_extract_is_an_error_and_an_empty_part_of_one_an_empty_map() {
    assert!(read_bytes(b"<osm></osm>").0.unwrap_err().to_string().contains("nodes that have coordinates"));
    // All around the area, but nothing in it.
    let (map, report) = read(&nodes(&[(1, -5000.0, -5000.0), (2, -5000.0, 5000.0), (3, 5000.0, 5000.0)]));
    assert_eq!(map, StreetMap { licence: map.licence.clone(), ..StreetMap::default() });
    assert_eq!((accounts("way", &report), accounts("relation", &report)), ([0; 3], [0; 3]));
}

#[test]
fn a_place_at_the_antimeridian_is_whole() {
    let node = |id: i64, x_m: f64, y_m: f64| {
        let lon_deg = (360.0 + x_m * METRE_DEG) % 360.0 - 180.0;
        format!("<node id='{id}' lat='{}' lon='{lon_deg}'/>", y_m * METRE_DEG)
    };
    let nodes: String =
        [(1, -40.0, 0.0), (2, 40.0, 0.0), (3, 40.0, 30.0), (4, -40.0, 30.0)].map(|(i, x, y)| node(i, x, y)).concat();
    let content = nodes + &way(1, &[1, 2, 3, 4, 1], "building=yes") + &way(2, &[1, 2], "highway=residential");
    let dir = tempfile::tempdir().unwrap();
    let path = file(&dir, "map.osm", format!("<osm>{content}</osm>").as_bytes());
    for origin_lon_deg in [180.0, -180.0, 179.9999, -179.9999] {
        let projection = MapProjection { origin_lon_deg, ..origin() };
        let area = Bounds::square(DVec2::ZERO, 500.0);
        let map = osm::read(&path, &projection, area, DrivingSide::Right, &Report::default()).unwrap();
        assert!((map.buildings[0].footprint.area_m2() - 80.0 * 30.0).abs() < 1e-3, "{origin_lon_deg}");
        assert!((map.roads[0].centreline[0].distance(map.roads[0].centreline[1]) - 80.0).abs() < 1e-6);
    }
}

#[test]
fn files_that_are_no_extract_are_named_with_their_place() {
    let refused = |bytes: &[u8]| read_bytes(bytes).0.unwrap_err().to_string();
    let check = |bytes: &[u8], parts: &[&str]| {
        let error = refused(bytes);
        assert!(parts.iter().all(|part| error.contains(part)), "{error}: expected {parts:?}");
    };
    check(b"", &["map.osm", "</osm>"]);
    check(b"<html>\n<body>busy</body></html>", &["<osm>", "<html>", "line 1"]);
    check(b"<osm>\n<node id='1' lat='1' lon='1'/>\n<way id='2'>\n<nd ref='1'/>\n", &["line 5", "cut off"]);
    check(b"<osm>\n<node id='1' lat='1 lon='1'/>\n</osm>", &["line", "well-formed"]);
    check(b"<osm>\n</way>\n</osm>", &["line 2", "well-formed"]);
    check(b"\x1f\x8b\x08\x00", &["gzip", "decompress"]);
    check(b"<osm></osm>", &["without nodes", "none"].map(|_| "none"));
    let whole = pbf();
    check(&whole[..whole.len() - 3], &["byte", "cut off"]);
    check(&whole[..2 + whole.len() / 2], &["byte"]);
}

/// A block with four nodes in dense form and a building of them, unpacked, as the format's specification lays it out.
fn pbf() -> Vec<u8> {
    let strings = ["", "building", "yes", "natural", "tree"].map(|s| bytes(1, s.as_bytes())).concat();
    let ten_m = (10.0 * METRE_DEG * 1e7).round() as i64;
    let dense = [
        deltas(1, &[1, 2, 3, 4]),
        deltas(8, &[0, 0, ten_m, ten_m]),
        deltas(9, &[0, ten_m, ten_m, 0]),
        packed(10, &[3, 4, 0, 0, 0, 0]),
    ];
    let way = [varint(1 << 3), varint(9), packed(2, &[1]), packed(3, &[2]), deltas(8, &[1, 2, 3, 4, 1])];
    let group = [bytes(2, &dense.concat()), bytes(3, &way.concat())].concat();
    let block = [bytes(1, &strings), bytes(2, &group)].concat();
    [header(), blob("OSMData", &block)].concat()
}

#[test]
fn pbf_and_xml_of_the_same_place_are_the_same() {
    let (map, report) = read_bytes(&pbf());
    let map = map.unwrap();
    assert_eq!((map.buildings[0].id, map.furniture[0].kind), (9, FurnitureKind::Tree));
    assert!((map.buildings[0].footprint.area_m2() - 100.0).abs() < 0.2);
    assert_eq!(report.entries(), []);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn damaged_bytes_never_panic(
        xml in any::<bool>(),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut bytes = if xml {
            let content = squares() + &way(10, &[1, 2, 3, 4, 1], "building=yes|height=4") + &way(11, &[5, 6, 7, 8, 5], "")
                + &multipolygon(1, &[10, 11], "natural=water");
            format!("<osm>{content}</osm>").into_bytes()
        } else {
            pbf()
        };
        for (index, byte) in damage {
            let i = index.index(bytes.len());
            bytes[i] = byte;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        let _ = read_bytes(&bytes);
    }

    #[test]
    fn any_words_never_panic(words in prop::collection::vec("[^<>&'\u{0}-\u{1f}|=\u{fffe}\u{ffff}]{0,12}", 12)) {
        const KEYS: [&str; 12] = [
            "building:material", "roof:material", "roof:shape", "surface", "crossing", "fence_type", "species",
            "leaf_type", "traffic_sign", "maxspeed", "lamp_mount", "crossing:markings",
        ];
        let tags: String = KEYS.iter().zip(&words).map(|(key, word)| format!("|{key}={word}")).collect();
        let things = ["highway=crossing", "highway=street_lamp", "natural=tree", "highway=traffic_sign"];
        let nodes: String = (20..).zip(things).map(|(id, thing)| {
            element(&format!("node id='{id}' lat='0' lon='0'"), "", &format!("{thing}{tags}"))
        }).collect();
        let content = squares() + &nodes
            + &way(1, &[1, 2, 3, 4, 1], &format!("building={}{tags}", words[0]))
            + &way(2, &[1, 2], &format!("highway=residential{tags}"))
            + &way(3, &[1, 2], &format!("barrier=fence{tags}"));
        let (map, _) = read(&content);
        // A node with a sign besides stands for both.
        prop_assert!(map.furniture.len() >= 4 && map.lines.len() == 1);
    }

    #[test]
    fn any_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..200), as_pbf in any::<bool>()) {
        let head = if as_pbf { &pbf()[..17] } else { b"<osm>" };
        let _ = read_bytes(&[head, &bytes].concat());
    }
}

/// A real extract, or a folder of them.
fn real(name: &str) -> PathBuf {
    let path = PathBuf::from(std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA")).join("osm").join(name);
    assert!(path.exists(), "{}", path.display());
    path
}

/// Everything of a real extract.
fn read_real(path: &Path) -> (StreetMap, Report) {
    let extent = osm::extent(path).unwrap();
    let projection = MapProjection::spherical(
        (extent.min_lat_deg + extent.max_lat_deg) / 2.0,
        (extent.min_lon_deg + extent.max_lon_deg) / 2.0,
        DVec2::ZERO,
    );
    let report = Report::default();
    let map = osm::read(path, &projection, extent.bounds(&projection).grown(1.0), DrivingSide::Right, &report).unwrap();
    (map, report)
}

/// How many of the ways or relations in the area were used, were not and said why, and are there.
fn accounts(what: &str, report: &Report) -> [u64; 3] {
    let measured = |name: String| report.measurements().iter().find(|m| m.name == name).unwrap().value as u64;
    let unused = format!("osm: {what} not used: ");
    let reported = report.entries().iter().filter(|e| e.what.starts_with(&unused)).map(|e| e.count).sum();
    [measured(format!("osm.{what}s_used")), reported, measured(format!("osm.{what}s_in_area"))]
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_places_are_read_with_every_way_and_relation_used_or_reported() {
    // Roads, buildings, land, furniture, lines; ways and relations: used, reported, in the area.
    let check = |name: &str, counts: [usize; 5], ways: [u64; 3], relations: [u64; 3]| {
        let path = real(name);
        let (map, report) = read_real(&path);
        let found = [map.roads.len(), map.buildings.len(), map.land.len(), map.furniture.len(), map.lines.len()];
        let accounted = (accounts("way", &report), accounts("relation", &report));
        assert_eq!((found, accounted), (counts, (ways, relations)), "{name}: {:#?}", report.entries());
        assert_sound(&map, &report, &path);
    };
    check("boston-seaport.osm", [1780, 936, 0, 6, 0], [2742, 1, 2743], [22, 0, 22]);
    check("singapore-onenorth.osm", [1537, 0, 0, 0, 0], [1537, 0, 1537], [0; 3]);
    check("neukolln.osm", [210, 210, 84, 539, 59], [589, 111, 700], [5, 13, 18]);
    check("taipei.osm", [49, 63, 5, 168, 1], [120, 7, 127], [0, 74, 74]);
    check("monaco-latest.osm.pbf", [2330, 1218, 222, 1319, 60], [3886, 220, 4106], [31, 178, 209]);
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_odd_files_give_a_sound_map_or_a_clear_error() {
    let folder = real("edge-cases");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    for path in files {
        // Around the first of its places, as a drive there would ask for it.
        let Ok(extent) = osm::extent(&path) else { continue };
        let projection = MapProjection::spherical(extent.min_lat_deg, extent.min_lon_deg, DVec2::ZERO);
        for side_m in [600.0, 3000.0] {
            let report = Report::default();
            match osm::read(&path, &projection, Bounds::square(DVec2::ZERO, side_m), DrivingSide::Right, &report) {
                Ok(map) => assert_sound(&map, &report, &path),
                Err(error) => assert!(error.to_string().contains("expected"), "{error}"),
            }
        }
        let (map, report) = read_real(&path);
        assert_sound(&map, &report, &path);
    }
}

fn assert_sound(map: &StreetMap, report: &Report, path: &Path) {
    for [used, reported, all] in [accounts("way", report), accounts("relation", report)] {
        assert_eq!(used + reported, all, "{}", path.display());
    }
    for polygon in map.buildings.iter().map(|b| &b.footprint).chain(map.land.iter().map(|l| &l.polygon)) {
        let is_ring = |ring: &Vec<DVec2>| ring.len() > 2 && ring.iter().all(|p| p.is_finite());
        assert!(polygon.area_m2() > 0.0 && polygon.rings().all(is_ring), "{}", path.display());
    }
    assert!(map.roads.iter().all(|road| road.centreline.len() > 1), "{}", path.display());
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_odd_multipolygons_and_outlines_are_read() {
    let check = |name: &str, expect: &[(&str, i64)]| {
        let path = real(&format!("edge-cases/{name}"));
        let (map, _) = read_real(&path);
        let area = |kind: &str, polygon: &trove_model::Polygon| {
            (format!("{kind} with {} holes", polygon.holes.len()), polygon.area_m2().round() as i64)
        };
        let buildings = map.buildings.iter().map(|b| area("building", &b.footprint));
        let land = map.land.iter().map(|l| area(&format!("{:?}", l.kind), &l.polygon));
        let roads = map.roads.iter().map(|r| (format!("{:?} vertices", r.kind), r.centreline.len() as i64));
        let found: Vec<(String, i64)> = buildings.chain(land).chain(roads).collect();
        let expect: Vec<(String, i64)> = expect.iter().map(|(what, n)| ((*what).to_owned(), *n)).collect();
        assert_eq!(found, expect, "{name}");
    };
    check("mp_two_holes.osm", &[("Paved with 2 holes", 213)]);
    check("mp_two_holes_advanced.osm", &[("Paved with 2 holes", 213)]);
    check("mp_two_holes_advanced2.osm", &[("Paved with 2 holes", 213)]);
    check("mp_two_holes_outer_tagged.osm", &[("Paved with 2 holes", 213)]);
    check("mp_two_holes_touching_inners.osm", &[("Paved with 2 holes", 213)]);
    check("mp_broken.osm", &[("Paved with 1 holes", 269)]);
    check("mp_two_outer_roof.osm", &[("building with 1 holes", 56_782), ("building with 2 holes", 60_331)]);
    check(
        "self_intersection.osm",
        &[("building with 0 holes", 11), ("building with 0 holes", 13), ("building with 0 holes", 2662)],
    );
    check("simpleTest01.osm", &[("building with 1 holes", 1486), ("Tertiary vertices", 3)]);
    check("simpleTest01.osm.pbf", &[("building with 1 holes", 1486), ("Tertiary vertices", 3)]);
    check("issue-203.osm", &[555, 185, 201, 168, 81].map(|area| ("building with 0 holes", area)));
    check("josmTest01.osm", &[("Footway vertices", 4)]);
    check("validFile.osm", &[("Residential vertices", 3)]);
    check("coastline_big_island.osm", &[("Water with 1 holes", 9_357_029)]);
    check("coastline_islands.osm", &[("Water with 2 holes", 6_049_178)]);
    check("coastline_multiple_coasts.osm", &[("Water with 0 holes", 3_266_383)]);
    // Its mainland's coast ends within: nobody can say where the sea is.
    check("coastline_islands_and_coast.osm", &[]);
    check("josm_emoji.osm", &[]);
    check("sameCoordNodes.osm", &[]);
}
