//! What holds for the furniture of made-up places.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use trove_model::{
    Asset, AssetLibrary, Bounds, Building, Drive, HeightField, Kind, LineKind, Locale, MapLine, Mesh, Polygon, Report,
    Road, RoadKind, Seed, SidewalkSides, Slot, StreetMap,
};

use super::furniture;
use crate::ground::Spans;
use crate::pieces::Piece;
use crate::place::Place;
use crate::placement::Stand;
use crate::roads::{self, Footing};
use crate::surroundings::Clearance;
use crate::surroundings::Kerbs;
use crate::surroundings::Surroundings;
use crate::testing;

const BRITAIN: &str = "GB";
const GERMANY: &str = "DE";
const SINGAPORE: &str = "SG";
const UNITED_STATES: &str = "US";

/// What a test looks at: models with their places, and what was built.
struct Furnished {
    scenery: Vec<(String, DVec3, f64)>,
    pieces: Vec<Piece>,
    on_carriageway: usize,
    off_ground_m: f64,
}

/// Furnishes a map of roads, buildings and lines in a country.
fn furnished(country: &str, map: &StreetMap) -> Furnished {
    furnished_from(&library(), country, map)
}

/// The same with the models of a library.
fn furnished_from(library: &AssetLibrary, country: &str, map: &StreetMap) -> Furnished {
    furnished_by(library, &testing::locale(country), map)
}

/// The same by other customs.
fn furnished_by(library: &AssetLibrary, locale: &Locale, map: &StreetMap) -> Furnished {
    let mut drive = Drive { lane_map: None, tracks: Vec::new(), ..testing::drive() };
    for keyframe in &mut drive.keyframes {
        keyframe.boxes.clear();
    }
    let report = Report::default();
    let bounds = Bounds::square(DVec2::ZERO, 400.0);
    let ground = HeightField::flat(bounds.grown(20.0), 0.0);
    let seeds = Seed(0).into();
    let place = Place { locale, ..testing::place(&drive, Some(map), bounds, &ground, library, &seeds, &report) };
    let surfaces = roads::surfaces(&place, &Spans::default(), None);
    let footprints: Vec<Polygon> = map.buildings.iter().map(|b| b.footprint.clone()).collect();
    let mut clearance = Clearance::new(&drive, &surfaces, &footprints, bounds);
    let kerbs = Kerbs::new(&drive, Some(map), &surfaces, bounds);
    let stand = Stand { ground: &ground, surfaces: &surfaces };
    let around = Surroundings { place: &place, kerbs: &kerbs, stand };
    let found = furniture(&around, &mut clearance, Seed(1));
    let feet = || found.scenery.iter().map(|s| s.foot_world);
    Furnished {
        on_carriageway: feet().filter(|p| surfaces.footing(p.truncate()) == Footing::Carriageway).count(),
        off_ground_m: feet().map(|p| (p.z - stand.surface_m(p.truncate())).abs()).fold(0.0, f64::max),
        scenery: found.scenery.iter().map(|s| (s.asset.id.clone(), s.foot_world, s.yaw_rad)).collect(),
        pieces: found.pieces,
    }
}

/// Blocks for the models that are asked for, and a pole with two insulators.
fn library() -> AssetLibrary {
    let mut assets: Vec<Asset> = [
        ("gives way", Kind::TrafficSign, &["vienna", "give-way"][..]),
        ("stops", Kind::TrafficSign, &["us", "stop"]),
        ("25 mph", Kind::TrafficSign, &["us", "speed-25"]),
        ("50 km/h", Kind::TrafficSign, &["vienna", "speed-50"]),
        ("lamp", Kind::StreetLamp, &["cobra"]),
        ("bench", Kind::Bench, &[]),
    ]
    .map(|(id, kind, tags)| testing::asset(id, kind, [0.1, 0.1, 2.5]).tagged(tags))
    .to_vec();
    for hand in ["right", "left"] {
        for state in ["red", "green"] {
            for make in ["post", "arm", "us-arm", "us-long-arm"] {
                let id = format!("signal {make} {hand} {state}");
                let asset = testing::asset(&id, Kind::TrafficSignal, [0.2, 0.2, 4.0]);
                assets.push(asset.tagged([make, hand, state]));
            }
        }
    }
    let pole = testing::asset("pole", Kind::UtilityPole, [0.2, 0.2, 9.0]);
    let mut mesh: Mesh = (*pole.mesh).clone();
    mesh.slots = vec![0; mesh.triangles.len()];
    for y in [-1.0, 1.0] {
        let base = mesh.positions.len() as u32;
        mesh.positions.extend([[0.0, y, 8.6], [0.05, y, 8.6], [0.0, y, 8.7]].map(glam::Vec3::from_array));
        mesh.triangles.push([base, base + 1, base + 2]);
        mesh.slots.push(1);
    }
    let mut insulator = pole.slots[0].material.clone();
    insulator.role = Some(trove_model::Role::Insulator);
    let slots = vec![pole.slots[0].clone(), Slot::new(insulator, Vec::new())];
    assets.push(Asset { mesh: Arc::new(mesh), slots, ..pole });
    for (make, size_m) in [
        ("bars", [2.4, 0.06, 1.3]),
        ("wood", [2.0, 0.1, 1.7]),
        ("chain-link", [2.5, 0.06, 1.8]),
        ("picket", [2.0, 0.1, 1.0]),
    ] {
        assets.push(testing::asset(&format!("fence {make}"), Kind::Fence, size_m).tagged([make]));
    }
    for make in ["railed", "garden", "brick"] {
        assets.push(testing::asset(&format!("wall {make}"), Kind::Wall, [2.0, 0.24, 1.6]).tagged([make]));
    }
    assets.sort_by(|a, b| a.id.cmp(&b.id));
    AssetLibrary { assets, ..AssetLibrary::default() }
}

/// A main road along x, and a lesser one that comes to it from the south.
fn junction(main: RoadKind, lesser: RoadKind) -> StreetMap {
    let limit = |road| Road { speed_limit_kmh: Some(if main == RoadKind::Primary { 50.0 } else { 40.2 }), ..road };
    let roads = vec![
        limit(testing::road(1, main, &[[-190.0, 0.0], [0.0, 0.0], [190.0, 0.0]])),
        limit(testing::road(2, lesser, &[[0.0, -190.0], [0.0, 0.0]])),
    ];
    StreetMap { roads, ..StreetMap::default() }
}

fn line(kind: LineKind, line: &[[f64; 2]]) -> MapLine {
    let line = line.iter().copied().map(DVec2::from_array).collect();
    MapLine { id: 1, kind, line, height_m: None, style: None }
}

#[test]
fn a_sign_faces_its_traffic_where_traffic_keeps_right_and_where_it_keeps_left() {
    for (place, side) in [(GERMANY, 1.0), (SINGAPORE, -1.0)] {
        let found = furnished(place, &junction(RoadKind::Primary, RoadKind::Residential));
        let gives_way: Vec<_> = found.scenery.iter().filter(|(id, ..)| id == "gives way").collect();
        assert_eq!(gives_way.len(), 1, "{:?}", found.scenery);
        let (_, foot, yaw_rad) = gives_way[0];
        // Those who come from the south see it from the south, at their side of the road.
        assert!((yaw_rad + std::f64::consts::FRAC_PI_2).abs() < 0.05, "{yaw_rad}");
        assert!(foot.x * side > 1.0 && (-30.0..-3.0).contains(&foot.y), "{foot}");
    }
}

#[test]
fn signals_of_one_axis_are_green_while_the_other_s_are_red() {
    for place in [GERMANY, SINGAPORE, UNITED_STATES] {
        let found = furnished(place, &junction(RoadKind::Primary, RoadKind::Secondary));
        let along_x = |yaw_rad: f64| yaw_rad.cos().abs() > 0.7;
        let states: Vec<(bool, bool)> = found
            .scenery
            .iter()
            .filter(|(id, ..)| id.starts_with("signal "))
            .map(|(id, _, yaw_rad)| (along_x(*yaw_rad), id.ends_with("green")))
            .collect();
        assert_eq!(states.len(), 3, "{:?}", found.scenery);
        assert!(states.iter().all(|(x, green)| (*x == states[0].0) == (*green == states[0].1)), "{states:?}");
    }
}

#[test]
fn limits_are_in_the_country_s_unit_and_nothing_stands_on_the_carriageway_or_off_the_ground() {
    for (place, main, sign) in [(GERMANY, RoadKind::Primary, "50 km/h"), (UNITED_STATES, RoadKind::Tertiary, "25 mph")]
    {
        let found = furnished(place, &junction(main, RoadKind::Residential));
        let limits: Vec<&str> =
            found.scenery.iter().map(|(id, ..)| id.as_str()).filter(|id| ["25 mph", "50 km/h"].contains(id)).collect();
        assert!(!limits.is_empty() && limits.iter().all(|id| *id == sign), "{limits:?}");
        assert!(found.scenery.len() > 20, "{}", found.scenery.len());
        assert_eq!(found.on_carriageway, 0);
        assert!(found.off_ground_m < 0.03);
    }
}

#[test]
fn wires_hang_from_pole_to_pole_above_five_metres_and_through_no_building() {
    let house = [[30.0, -62.0], [50.0, -62.0], [50.0, -48.0], [30.0, -48.0]].map(DVec2::from_array);
    let house = Building::new(9, Polygon::simple(house.to_vec()), Some(trove_model::BuildingKind::House));
    let power = line(LineKind::PowerLine, &[[-60.0, -55.0], [-20.0, -55.0], [20.0, -55.0], [60.0, -55.0]]);
    let map = StreetMap {
        buildings: vec![house],
        lines: vec![power],
        ..junction(RoadKind::Secondary, RoadKind::Residential)
    };
    let found = furnished(GERMANY, &map);
    let poles = found.scenery.iter().filter(|(id, ..)| id == "pole").count();
    assert_eq!(poles, 4, "{:?}", found.scenery);
    let wires = found.pieces.iter().find(|p| p.kind.is_none()).unwrap();
    let points: Vec<DVec3> =
        wires.mesh.positions.iter().map(|p| wires.world_from_mesh.transform_point3(p.as_dvec3())).collect();
    // Two spans of two wires; the third would pass the house.
    assert!(points.iter().all(|p| (-60.1..20.1).contains(&p.x) && p.z > 5.0 && (p.y + 55.0).abs() < 1.1));
    for x in [-60.0, -20.0, 20.0] {
        assert!(points.iter().any(|p| (p.x - x).abs() < 0.1 && (p.z - 8.7).abs() < 0.25), "{x}");
    }
}

#[test]
fn a_tram_s_wire_follows_its_track_between_poles_on_both_sides() {
    let mut map = junction(RoadKind::Secondary, RoadKind::Residential);
    map.lines = vec![line(LineKind::Tram, &[[-150.0, 0.0], [150.0, 0.0]])];
    let found = furnished(GERMANY, &map);
    let poles: Vec<DVec3> = found.scenery.iter().filter(|(id, ..)| id == "pole").map(|s| s.1).collect();
    assert!(poles.iter().any(|p| p.y > 3.0) && poles.iter().any(|p| p.y < -3.0), "{poles:?}");
    let wires = found.pieces.iter().find(|p| p.kind.is_none()).unwrap();
    let points = wires.mesh.positions.iter().map(|p| wires.world_from_mesh.transform_point3(p.as_dvec3()));
    assert!(points.clone().all(|p| p.z > 5.0));
    assert!(points.filter(|p| p.y.abs() < 0.02).count() > 30);
}

#[test]
fn a_fence_stands_along_its_line_and_is_open_where_a_path_crosses_it() {
    let mut map = junction(RoadKind::Secondary, RoadKind::Residential);
    map.lines = vec![line(LineKind::Fence, &[[-60.0, 40.0], [60.0, 40.0], [60.0, 80.0]])];
    map.roads.push(testing::road(3, RoadKind::Footway, &[[10.0, 5.0], [10.0, 90.0]]));
    let found = furnished(GERMANY, &map);
    let fences: Vec<&Piece> = found.pieces.iter().filter(|p| p.kind == Some(Kind::Fence)).collect();
    assert!(fences.len() >= 3);
    let points =
        fences.iter().flat_map(|f| f.mesh.positions.iter().map(|p| f.world_from_mesh.transform_point3(p.as_dvec3())));
    // Not what bounds the street's own land.
    for p in points.filter(|p| p.y > 20.0) {
        let beside_m = (p.y - 40.0).abs().min((p.x - 60.0).abs());
        assert!(beside_m < 0.1 && (p.x - 10.0).abs() > 0.9, "{p}");
    }
}

#[test]
fn open_land_behind_a_sidewalk_is_bounded_but_not_before_houses_nor_across_paths() {
    let house = [[-80.0, 6.5], [-30.0, 6.5], [-30.0, 20.0], [-80.0, 20.0]].map(DVec2::from_array);
    let sidewalk = SidewalkSides { left: Some(true), right: Some(true) };
    let street = testing::road(1, RoadKind::Tertiary, &[[-190.0, 0.0], [190.0, 0.0]]);
    let map = StreetMap {
        roads: vec![Road { sidewalk, ..street }, testing::road(2, RoadKind::Footway, &[[10.0, 3.0], [10.0, 90.0]])],
        buildings: vec![Building::new(9, Polygon::simple(house.to_vec()), Some(trove_model::BuildingKind::House))],
        ..StreetMap::default()
    };
    let found = furnished(BRITAIN, &map);
    let lines = found.pieces.iter().filter(|p| matches!(p.kind, Some(Kind::Fence | Kind::Wall)));
    let points: Vec<DVec3> = lines
        .flat_map(|f| f.mesh.positions.iter().map(|p| f.world_from_mesh.transform_point3(p.as_dvec3())))
        .filter(|p| p.x.abs() < 150.0)
        .collect();
    for north in [false, true] {
        let metres: std::collections::BTreeSet<i64> =
            points.iter().filter(|p| (p.y > 0.0) == north).map(|p| (p.x / 3.0).floor() as i64).collect();
        assert!(metres.len() > 25, "{north}: {metres:?}");
    }
    let nearest_m = points.iter().map(|p| p.y.abs()).fold(f64::INFINITY, f64::min);
    for p in points {
        assert!(nearest_m > 4.0 && p.y.abs() < nearest_m + 0.4, "{p}");
        assert!(p.y < 0.0 || !(-80.0..-30.0).contains(&p.x) && (p.x - 10.0).abs() > 0.9, "{p}");
    }
}

/// Houses on both sides of a street, those in the north with shops.
fn shopping_street() -> StreetMap {
    let sidewalk = SidewalkSides { left: Some(true), right: Some(true) };
    let street = testing::road(1, RoadKind::Tertiary, &[[-190.0, 0.0], [190.0, 0.0]]);
    let house = |i: i64| {
        let (x, y) = ((i / 2) as f64 * 16.0 - 96.0, if i % 2 == 0 { 9.5 } else { -21.5 });
        let corners = [[x, y], [x + 14.0, y], [x + 14.0, y + 12.0], [x, y + 12.0]].map(DVec2::from_array);
        let house = Building::new(100 + i, Polygon::simple(corners.to_vec()), None);
        Building { shop: i % 2 == 0, levels: Some(3.0), ..house }
    };
    StreetMap {
        roads: vec![Road { sidewalk, width_m: Some(7.0), ..street }],
        buildings: (0..24).map(house).collect(),
        ..StreetMap::default()
    }
}

#[test]
fn shops_put_out_tables_goods_and_boards_and_homes_do_not() {
    let mut library = library();
    for (id, tags) in [
        ("out table", &["cafe", "table"][..]),
        ("out parasol", &["cafe", "parasol"]),
        ("out goods", &["goods", "open"]),
        ("out stall", &["goods", "stall"]),
        ("out board", &["advertising", "board"]),
    ] {
        library.assets.push(testing::asset(id, Kind::StreetFurniture, [0.8, 0.8, 1.0]).tagged(tags));
    }
    // Germany's sidewalks have none of them, so what stands there stands in for nothing.
    let found = furnished_from(&library, GERMANY, &shopping_street());
    let before_walls = |y: f64| {
        let out = found.scenery.iter().filter(|(id, at, _)| id.starts_with("out ") && (at.y - y).abs() < 0.3);
        out.map(|(id, ..)| id.as_str()).collect::<std::collections::BTreeSet<_>>().len()
    };
    // 1.15 m before the walls.
    assert!(before_walls(9.5 - 1.15) > 3 && before_walls(-9.5 + 1.15) == 0, "{:?}", found.scenery);
}

#[test]
fn scaffolding_stands_before_houses_that_are_built_as_high_as_they_are() {
    let mut library = library();
    for lifts in 2..=6 {
        let (id, tag) = (format!("scaffolding {lifts}"), format!("lifts-{lifts}"));
        let asset = testing::asset(&id, Kind::StreetFurniture, [1.1, 4.7, 2.0 * f64::from(lifts)]);
        library.assets.push(asset.tagged(["scaffolding", tag.as_str(), "bare", "netted"]));
    }
    let mut map = shopping_street();
    let scaffolds = |map: &StreetMap| {
        let found = furnished_from(&library, GERMANY, map);
        // Before the wall in the middle of its depth; what stands in for other things stands at the kerb.
        let is_before_wall = |at: &DVec3| (at.y.abs() - (9.5 - 0.8)).abs() < 0.05;
        found
            .scenery
            .into_iter()
            .filter(|(id, at, _)| id.starts_with("scaff") && is_before_wall(at))
            .collect::<Vec<_>>()
    };
    let few = scaffolds(&map).len();
    map.buildings.iter_mut().for_each(|b| b.kind = Some(trove_model::BuildingKind::Construction));
    let many = scaffolds(&map);
    assert!(many.len() > 3 * few && many.len() > 16, "{few} {}", many.len());
    // Nine metres of house.
    assert!(many.iter().all(|(id, ..)| id == "scaffolding 4"), "{many:?}");
}

/// A library with a model for everything that stands on Germany's sidewalks.
fn library_of_small_things() -> AssetLibrary {
    let mut library = library();
    let other = testing::asset("other", Kind::StreetFurniture, [0.3, 0.3, 1.0]);
    for small in &testing::locale(GERMANY).street.small {
        library.assets.push(Asset { id: format!("other {:?}", small.tags), ..other.clone() }.tagged(&small.tags));
    }
    library
}

#[test]
fn small_things_stand_as_close_as_a_country_has_them() {
    let library = library_of_small_things();
    let count = |small_spacing_m: [f64; 2]| {
        let mut locale = testing::locale(GERMANY);
        locale.street.small_spacing_m = small_spacing_m;
        let found = furnished_by(&library, &locale, &shopping_street());
        found.scenery.iter().filter(|(id, ..)| id.starts_with("other")).count()
    };
    let (few, many) = (count([40.0, 60.0]), count([4.0, 8.0]));
    // What stands before shops is among them.
    assert!(many > few + 10, "{few} {many}");
}

#[test]
fn litter_lies_on_sidewalks_only() {
    // Without the others litter would stand in for what else stands on sidewalks.
    let mut library = library_of_small_things();
    library.assets.push(testing::asset("litter", Kind::StreetFurniture, [0.1, 0.1, 0.05]).tagged(["litter"]));
    let found = furnished_from(&library, GERMANY, &shopping_street());
    let litter: Vec<&DVec3> = found.scenery.iter().filter(|(id, ..)| id == "litter").map(|(_, at, _)| at).collect();
    assert!(litter.len() > 4 && litter.iter().all(|at| (3.5..9.5).contains(&at.y.abs())), "{litter:?}");
    assert_eq!(found.on_carriageway, 0);
}
