//! What holds of the paint on made-up streets.

use glam::DVec2;
use trove_model::{
    Bounds, Drive, Furniture, FurnitureKind, HeightField, Polygon, Report, RoadKind, Seed, Sides, StreetMap, Turns,
};

use super::*;
use crate::ground::Spans;
use crate::roads::decks::Lift;
use crate::roads::layout::layout;
use crate::testing;

fn bounds() -> Bounds {
    Bounds::square(DVec2::ZERO, 400.0)
}

const UNITED_STATES: &str = "US";
const SINGAPORE: &str = "SG";

/// A road of four lanes along x that ends at a road along y, with signals.
fn junction() -> StreetMap {
    let mut main = testing::road(1, RoadKind::Secondary, &[[-150.0, 0.0], [0.0, 0.0]]);
    main.lanes = Some(4);
    let turn = |left, right| Turns { left, right, ..Turns::default() };
    main.turns_forward = vec![turn(true, false), turn(false, true)];
    let across = testing::road(2, RoadKind::Secondary, &[[0.0, -150.0], [0.0, 0.0], [0.0, 150.0]]);
    let signal = Furniture::new(5, FurnitureKind::TrafficSignal, DVec2::new(4.0, 4.0));
    StreetMap { roads: vec![main, across], furniture: vec![signal], ..StreetMap::default() }
}

fn painted(country: &str, map: &StreetMap) -> (Markings, Vec<Polygon>) {
    let (drive, locale) = (Drive { lane_map: None, ..testing::drive() }, testing::locale(country));
    let (flat, spans) = (HeightField::flat(bounds(), 0.0), Spans::default());
    let lift = Lift { ground: &flat, spans: &spans };
    let layout = layout(&drive, Some(map), locale.driving_side, bounds(), &lift, &Report::default());
    let near = [crate::geometry::plane::rectangle(bounds())];
    let found = markings(&drive, Some(map), &layout, &near, &locale.markings, Seed(3), &Report::default());
    (found, layout.carriageway.clone())
}

fn area_m2(area: &[Polygon]) -> f64 {
    area.iter().map(Polygon::area_m2).sum()
}

fn all(markings: &Markings) -> Vec<Polygon> {
    markings.paints.values().flatten().cloned().collect()
}

/// Pieces of white paint within a rectangle.
fn within(markings: &Markings, low: [f64; 2], high: [f64; 2]) -> Vec<Polygon> {
    let window =
        crate::geometry::plane::rectangle(Bounds { min: DVec2::from_array(low), max: DVec2::from_array(high) });
    intersection(&markings.paints[&Paint::White], &[window])
}

#[test]
fn nothing_is_painted_beside_the_carriageway_or_twice() {
    for place in [UNITED_STATES, SINGAPORE, "DE", "TW"] {
        let (markings, carriageway) = painted(place, &junction());
        let paint = all(&markings);
        let sum_m2 = area_m2(&paint);
        assert!(sum_m2 > 20.0);
        assert!(area_m2(&difference(&union(&paint), &grown(&carriageway, 0.01))) < 0.01, "{place:?}");
        assert!((area_m2(&union(&paint)) - sum_m2).abs() < 0.01 * sum_m2, "{place:?}");
    }
}

#[test]
fn directions_are_parted_by_yellow_in_boston_and_by_white_in_singapore() {
    let yellow = |place| {
        painted(place, &junction()).0.paints.get(&Paint::Yellow).map_or(0.0, |y| {
            let middle = crate::geometry::plane::rectangle(Bounds {
                min: DVec2::new(-120.0, -1.0),
                max: DVec2::new(-40.0, 1.0),
            });
            area_m2(&intersection(y, &[middle]))
        })
    };
    // Two lines of 12 cm over 80 m.
    assert!((yellow(UNITED_STATES) - 2.0 * 0.12 * 80.0).abs() < 0.5, "{}", yellow(UNITED_STATES));
    assert_eq!(yellow(SINGAPORE), 0.0);
}

#[test]
fn arrows_stand_in_their_lanes_and_point_ahead_on_both_sides_of_the_road() {
    // Traffic towards +x has the lanes south of the line where it keeps right, and north of it where it keeps left.
    for (place, side) in [(UNITED_STATES, -1.0), (SINGAPORE, 1.0)] {
        let (markings, _) = painted(place, &junction());
        // Seen towards +x, the left lane is the northern one; its arrow leans north.
        let (left_y, right_y) = if side < 0.0 { (-1.7, -5.1) } else { (5.1, 1.7) };
        for (y, leans) in [(left_y, 1.0), (right_y, -1.0)] {
            let near = within(&markings, [-40.0, y - 1.3], [-9.0, y + 1.3]);
            let arrow = near.iter().find(|p| (0.3..1.6).contains(&p.area_m2())).expect("an arrow");
            assert!((arrow.centroid().y - y) * leans > 0.05, "{place:?} {y}: {}", arrow.centroid());
        }
        // Nothing points against the traffic that comes.
        let other = within(&markings, [-60.0, -side * 0.8 - 3.0 * side - 2.0], [-14.0, -side * 3.8 + 2.0]);
        assert!(other.iter().all(|p| p.bounds().unwrap().size_m().x > 1.0 || p.area_m2() < 0.3));
    }
}

#[test]
fn the_stop_line_crosses_the_lanes_that_wait_and_no_others() {
    for (place, side, depth_m) in [(UNITED_STATES, -1.0, 0.45), (SINGAPORE, 1.0, 0.3)] {
        let (markings, _) = painted(place, &junction());
        let lines = |sign: f64| -> f64 {
            let (low, high) = if sign < 0.0 { (-6.5, -0.5) } else { (0.5, 6.5) };
            let pieces = within(&markings, [-12.0, low], [-4.0, high]);
            pieces.iter().filter(|p| p.bounds().unwrap().size_m().y > 4.0).map(Polygon::area_m2).sum()
        };
        assert!((lines(side) - 6.0 * depth_m).abs() < 1.0, "{place:?}: {}", lines(side));
        assert_eq!(lines(-side), 0.0, "{place:?}");
    }
}

#[test]
fn cycle_lanes_have_a_line_and_bicycles() {
    let mut map = junction();
    let without = area_m2(&all(&painted(UNITED_STATES, &map).0));
    map.roads[0].cycleway = Sides { left: None, right: Some(trove_model::Cycleway::Lane) };
    let with = area_m2(&all(&painted(UNITED_STATES, &map).0));
    assert!(with > without + 15.0, "{with} {without}");
}

#[test]
fn where_few_streets_have_paint_whole_streets_and_crossings_go_without() {
    // Apart from each other, each crossed in the middle.
    let street = |i: u32| {
        let (id, y) = (i64::from(i) + 1, f64::from(i) * 24.0 - 168.0);
        let road = testing::road(id, RoadKind::Tertiary, &[[-150.0, y], [0.0, y], [150.0, y]]);
        (road, Furniture::new(100 + id, FurnitureKind::Crossing, DVec2::new(0.0, y)))
    };
    let (roads, furniture): (Vec<_>, Vec<_>) = (0..15).map(street).unzip();
    let map = StreetMap { roads, furniture, ..StreetMap::default() };
    let painted = |country: &str| {
        let (markings, _) = painted(country, &map);
        let count = |from: f64, to: f64| {
            let of = |road: &trove_model::Road| {
                let y = road.centreline[0].y;
                !within(&markings, [from, y - 8.0], [to, y + 8.0]).is_empty()
            };
            map.roads.iter().filter(|road| of(road)).count()
        };
        [count(20.0, 140.0), count(-2.0, 2.0)]
    };
    assert_eq!(painted(SINGAPORE), [15, 15]);
    let [streets, crossings] = painted("IN");
    assert!((1..11).contains(&streets) && (1..11).contains(&crossings), "{streets} {crossings}");
}

#[test]
fn lines_that_are_told_are_painted_where_they_are_told() {
    let (markings, _) = painted(UNITED_STATES, &junction());
    let mut told = 0;
    for line in &markings.lines {
        // The two of a double line are so far to its sides.
        let aside_m = match line.pattern {
            MarkPattern::Solid => 0.0,
            MarkPattern::DoubleSolid => 1.1 * line.width_m,
            _ => continue,
        };
        for pair in line.line.windows(2) {
            let side = (pair[1] - pair[0]).normalize().perp() * aside_m;
            for p in [pair[0].midpoint(pair[1]) + side, pair[0].midpoint(pair[1]) - side] {
                assert!(markings.paints[&line.paint].iter().any(|area| area.contains(p)), "{p}");
                told += 1;
            }
        }
    }
    assert!(told > 100, "{told}");
    let centre = |line: &&Line| line.paint == Paint::Yellow && line.line.iter().all(|p| p.y.abs() < 0.5 && p.x < 0.0);
    let centre: Vec<&Line> = markings.lines.iter().filter(centre).collect();
    assert_eq!(centre.iter().map(|line| line.pattern).collect::<Vec<_>>(), [MarkPattern::DoubleSolid]);
}
