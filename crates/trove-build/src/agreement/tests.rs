use glam::{DVec2, DVec3};
use trove_model::{
    Building, Drive, Entry, Lane, LaneMap, LidarSweep, MapProjection, Polygon, Report, Road, RoadKind, Seed, StreetMap,
};

use super::correction::Correction;
use super::*;
use crate::testing;

/// Ten keyframes along x, and the lanes of some two-way streets.
fn drive(streets: &[[[f64; 2]; 2]]) -> Drive {
    let lane = |(i, ends): (usize, [DVec2; 2])| Lane {
        token: i.to_string(),
        polygon: Polygon::default(),
        centreline: ends.to_vec(),
    };
    let lanes = streets.iter().flat_map(|ends| {
        let [a, b] = ends.map(DVec2::from_array);
        let right = -(b - a).normalize().perp() * 1.75;
        [[a + right, b + right], [b - right, a - right]]
    });
    let lane_map = LaneMap { lanes: lanes.enumerate().map(lane).collect(), ..LaneMap::default() };
    Drive { lane_map: Some(lane_map), ..on_the_right() }
}

/// A drive where traffic keeps right, as the made-up lanes do.
fn on_the_right() -> Drive {
    let drive = testing::drive();
    let projection = MapProjection::spherical(42.3, -71.0, drive.projection.anchor_m);
    Drive { projection, ..drive }
}

/// A crossroads with a slanting street, 1.75 m to the left of the driven path.
const STREETS: [[[f64; 2]; 2]; 3] =
    [[[-200.0, 1.75], [200.0, 1.75]], [[60.0, -200.0], [60.0, 200.0]], [[-150.0, -180.0], [-90.0, 190.0]]];

/// The map of some streets, each drawn off its place by some noise.
fn map(streets: &[[[f64; 2]; 2]], noise_m: f64) -> StreetMap {
    let mut random = Seed(3).random();
    let mut road = |i: usize, ends: &[[f64; 2]; 2]| {
        let [a, b] = ends.map(DVec2::from_array);
        let place =
            |k: usize| a.lerp(b, k as f64 / 20.0) + (b - a).normalize().perp() * random.range(-noise_m, noise_m);
        Road::new(i as i64, RoadKind::Residential, (0..=20).map(place).collect())
    };
    StreetMap { roads: streets.iter().enumerate().map(|(i, ends)| road(i, ends)).collect(), ..StreetMap::default() }
}

fn moved(map: &StreetMap, east_m: f64, north_m: f64, turn_deg: f64) -> StreetMap {
    let shift_m = DVec2::new(east_m, north_m);
    Correction { pivot: DVec2::new(22.5, 0.0), turn_rad: turn_deg.to_radians(), shift_m }.corrected(map)
}

fn checked(drive: &Drive, map: &StreetMap) -> (StreetMap, Report) {
    checked_on(DrivingSide::Right, drive, map)
}

fn checked_on(side: DrivingSide, drive: &Drive, map: &StreetMap) -> (StreetMap, Report) {
    let report = Report::default();
    let bounds = crate::area(drive).unwrap();
    (agreed(drive, map, side, bounds, OnDisagreement::default(), &report).unwrap(), report)
}

fn measured(report: &Report, name: &str) -> Option<f64> {
    report.measurements().iter().find(|m| m.name == name).map(|m| m.value)
}

/// The largest distance of the roads' places near the path from where they were.
fn apart_m(a: &StreetMap, b: &StreetMap) -> f64 {
    let places = |map: &StreetMap| map.roads.iter().flat_map(|r| r.centreline.clone()).collect::<Vec<_>>();
    let pairs = places(a).into_iter().zip(places(b)).filter(|(p, _)| p.length() < 120.0);
    pairs.map(|(p, q)| p.distance(q)).fold(0.0, f64::max)
}

#[test]
fn a_shifted_and_turned_map_is_laid_back_on_the_lanes() {
    let drive = drive(&STREETS);
    let right = map(&STREETS, 0.0);
    let (found, report) = checked(&drive, &moved(&right, 2.4, -1.8, 0.5));
    assert!(apart_m(&found, &right) < 0.1, "{} m, {:?}", apart_m(&found, &right), report.measurements());
    assert!((measured(&report, "map.correction.turn_deg").unwrap() + 0.5).abs() < 0.1);
    assert!(measured(&report, "map.before_correction.road_offset_median_m").unwrap() > 1.0);
    assert!(measured(&report, "map.road_offset_median_m").unwrap() < 0.05);
    let (found, _) = checked(&drive, &moved(&map(&STREETS, 1.0), -2.0, 2.0, -0.4));
    assert!(apart_m(&found, &map(&STREETS, 1.0)) < 0.5, "{}", apart_m(&found, &map(&STREETS, 1.0)));
}

#[test]
fn a_map_that_lies_right_stays_where_it_is() {
    for noise_m in [0.0, 0.5, 1.0] {
        let map = map(&STREETS, noise_m);
        let (found, report) = checked(&drive(&STREETS), &map);
        assert_eq!((found == map, measured(&report, "map.correction.east_m")), (true, None), "{noise_m}");
    }
}

#[test]
fn a_map_does_not_slide_along_a_straight_road() {
    let right = map(&STREETS[..1], 0.3);
    let (found, _) = checked(&drive(&STREETS[..1]), &moved(&right, 2.0, 3.0, 0.0));
    let slid = found.roads[0].centreline[10] - right.roads[0].centreline[10];
    assert!((slid.x - 2.0).abs() < 0.05 && slid.y.abs() < 0.2, "{slid}");
}

#[test]
fn a_map_is_laid_between_the_edges_of_what_can_be_driven_on() {
    let mut drive = drive(&STREETS);
    let lane_map = drive.lane_map.as_mut().unwrap();
    lane_map.lanes.clear();
    lane_map.drivable = STREETS[..2]
        .iter()
        .map(|ends| {
            let [a, b] = ends.map(DVec2::from_array);
            let side = (b - a).normalize().perp() * 5.0;
            Polygon::simple(vec![a - side, b - side, b + side, a + side])
        })
        .collect();
    let right = map(&STREETS[..2], 0.0);
    let (found, _) = checked(&drive, &moved(&right, 2.0, -1.5, 0.4));
    assert!(apart_m(&found, &right) < 0.15, "{}", apart_m(&found, &right));
}

#[test]
fn a_map_is_laid_on_the_walls_that_the_lidar_saw() {
    let mut drive = Drive { lane_map: None, ..on_the_right() };
    let mut random = Seed(5).random();
    // Two walls of one house, seen from the street, and one of another.
    let walls = [([0.0, 12.0], [30.0, 12.0]), ([30.0, 12.0], [30.0, 30.0]), ([-10.0, -14.0], [40.0, -14.0])];
    let mut points = Vec::new();
    for (a, b) in walls {
        let [a, b] = [a, b].map(DVec2::from_array);
        points.extend((0..4000).map(|_| a.lerp(b, random.unit()).extend(random.range(0.2, 6.0)).as_vec3()));
    }
    let origin_world = DVec3::new(10.0, 0.0, 1.8);
    drive.keyframes[2].lidar = Some(LidarSweep { origin_world, points_world: points, classes: Vec::new() });
    let house = |id: i64, low: [f64; 2], high: [f64; 2]| {
        let ring = [low, [high[0], low[1]], high, [low[0], high[1]]].map(DVec2::from_array).to_vec();
        Building::new(id, Polygon::simple(ring), None)
    };
    let buildings = vec![house(1, [0.0, 12.0], [30.0, 30.0]), house(2, [-10.0, -30.0], [40.0, -14.0])];
    let right = StreetMap { buildings, ..map(&STREETS[..1], 0.0) };
    let (found, report) = checked(&drive, &moved(&right, 1.5, -1.2, 0.3));
    let corner = |map: &StreetMap| map.buildings[0].footprint.exterior[0];
    assert!(corner(&found).distance(corner(&right)) < 0.3, "{} {:?}", corner(&found), report.measurements());
    assert!(measured(&report, "map.facade_offset_median_m").unwrap() < 0.2);
}

#[test]
fn what_becomes_of_a_map_that_does_not_agree_is_the_users_choice() {
    let drive = testing::drive();
    let mut map = testing::map_with_road([[-300.0, -12.0], [300.0, -12.0]]);
    map.buildings.push(Building::new(
        1,
        Polygon::simple([[0.0, 30.0], [9.0, 30.0], [9.0, 40.0]].map(DVec2::from_array).to_vec()),
        None,
    ));
    let bounds = crate::area(&drive).unwrap();
    let check = |on_disagreement| {
        let report = Report::default();
        let kept = agreed(&drive, &map, DrivingSide::Right, bounds, on_disagreement, &report)
            .map(|m| (m.roads.len(), m.buildings.len()));
        let said = report.entries().iter().any(|e: &Entry| e.what.contains("do not match"));
        (kept, said)
    };
    assert_eq!(check(OnDisagreement::Warn), (Some((1, 1)), true));
    assert_eq!(check(OnDisagreement::BuildingsOnly), (Some((0, 1)), true));
    assert_eq!(check(OnDisagreement::Refuse), (None, true));
}

#[test]
fn distances_of_path_and_lanes_to_the_roads_are_measured() {
    let map = testing::map_with_road([[-300.0, -1.5], [300.0, -1.5]]);
    let (_, report) = checked_on(DrivingSide::Left, &testing::drive(), &map);
    assert!((measured(&report, "map.path_to_road_median_m").unwrap() - 1.5).abs() < 0.1);
    let (_, report) = checked(&testing::drive(), &StreetMap::default());
    assert!(report.measurements().is_empty());
    assert!(report.entries().iter().any(|e| e.what.contains("no road for cars")));
}
