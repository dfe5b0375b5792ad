use glam::DVec2;
use trove_model::{HeightField, RoadKind, Seed, StreetMap};

use super::*;
use crate::testing;

/// South of the made-up street, off its sidewalk.
fn square(id: i64, x: f64, y: f64, size: [f64; 2], height_m: f64) -> Building {
    let corners = [(x, y), (x + size[0], y), (x + size[0], y + size[1]), (x, y + size[1])];
    let footprint = Polygon::simple(corners.map(|(x, y)| DVec2::new(x, y - 60.0)).into());
    Building { height_m: Some(height_m), roof: Some(RoofShape::Flat), ..Building::new(id, footprint, None) }
}

/// What is built of some buildings: id, bottom, top and footprint of each volume.
fn built(buildings: &[Building]) -> Vec<(i64, f64, f64, Polygon, Vec<Beside>)> {
    built_on(None, buildings)
}

/// The same in a place with a street map.
fn built_on(map: Option<&StreetMap>, buildings: &[Building]) -> Vec<(i64, f64, f64, Polygon, Vec<Beside>)> {
    let drive = testing::drive();
    let bounds = crate::area(&drive).unwrap();
    let ground = HeightField::flat(bounds, 0.0);
    let streets = testing::surfaces_on(&drive, map, &ground);
    let plot = Plot {
        drive: &drive,
        customs: testing::building_customs("SG"),
        streets: &streets,
        ground: &ground,
        bounds,
        seen_m: &[],
    };
    let all: Vec<&Building> = buildings.iter().collect();
    let mut houses = houses(&all, &plot, Seed(1), &Report::default());
    beside(&mut houses);
    let volumes = houses.into_iter().flat_map(|h| h.volumes);
    volumes.map(|v| (v.building.id, v.bottom_m, v.top_m, v.footprint, v.sides)).collect()
}

fn shared_m2(a: &Polygon, b: &Polygon) -> f64 {
    intersection(std::slice::from_ref(a), std::slice::from_ref(b)).iter().map(Polygon::area_m2).sum()
}

#[test]
fn of_two_buildings_in_one_place_the_lower_is_cut() {
    let found = built(&[square(1, 0.0, 0.0, [10.0, 10.0], 9.0), square(2, 6.0, 2.0, [10.0, 6.0], 15.0)]);
    assert_eq!(found.len(), 2);
    assert!(shared_m2(&found[0].3, &found[1].3) < 1e-6);
    assert!((found[0].3.area_m2() - 76.0).abs() < 0.5, "{}", found[0].3.area_m2());
    assert!((found[1].3.area_m2() - 60.0).abs() < 0.5);
}

#[test]
fn a_building_within_another_is_left_out() {
    let found = built(&[square(1, 0.0, 0.0, [10.0, 10.0], 9.0), square(2, 2.0, 2.0, [4.0, 4.0], 5.0)]);
    assert_eq!(found.iter().map(|f| f.0).collect::<Vec<_>>(), [1]);
}

#[test]
fn a_part_on_another_leaves_what_is_below_it() {
    let whole = square(1, 0.0, 0.0, [20.0, 10.0], 30.0);
    let base = Building { part: true, ..square(2, 0.0, 0.0, [20.0, 10.0], 8.0) };
    let tower = Building { part: true, min_height_m: 8.0, ..square(3, 0.0, 0.0, [10.0, 10.0], 30.0) };
    let found = built(&[whole, base, tower]);
    let spans: Vec<(i64, f64, f64)> = found.iter().map(|f| (f.0, f.1, (f.2 * 10.0).round() / 10.0)).collect();
    assert_eq!(spans, [(2, 0.0, 8.0), (2, 0.0, 8.0), (3, 8.0, 30.0)]);
    assert!(found[1].2 < 8.0, "the roof of the base lies in the tower's floor");
}

#[test]
fn party_walls_stand_a_centimetre_apart_and_know_each_other() {
    let found = built(&[square(1, 0.0, 0.0, [8.0, 10.0], 12.0), square(2, 8.0, 0.0, [8.0, 10.0], 9.0)]);
    let gap_m = found[1].3.bounds().unwrap().min.x - found[0].3.bounds().unwrap().max.x;
    assert!((0.009..0.02).contains(&gap_m), "{gap_m}");
    for (id, _, _, footprint, sides) in &found {
        let covered: Vec<usize> = (0..4).filter(|&i| !sides[i].covers.is_empty()).collect();
        assert_eq!(covered.len(), 1, "{id}: {sides:?}");
        let (a, b) = footprint.edges().nth(covered[0]).unwrap();
        assert!((a.x - 8.0).abs() < 0.1 && (b.x - 8.0).abs() < 0.1);
        // The higher one is seen above its neighbour.
        assert!(sides[covered[0]].is_covered(9.0));
        assert_eq!(sides[covered[0]].is_covered(12.0), *id == 2, "{id}");
    }
}

#[test]
fn an_unmapped_height_is_that_of_the_neighbours() {
    let mut row: Vec<Building> =
        (0..6).map(|i| square(i, f64::from(i as i32) * 12.0, 0.0, [8.0, 10.0], 21.0)).collect();
    row[3].height_m = None;
    let found = built(&row);
    let guessed = found.iter().find(|f| f.0 == 3).unwrap();
    assert!((18.0..24.0).contains(&guessed.2), "{}", guessed.2);
}

#[test]
fn a_carport_is_a_slab_on_posts() {
    let carport = Building {
        kind: Some(trove_model::BuildingKind::Carport),
        height_m: Some(2.8),
        ..square(1, 0.0, 0.0, [6.0, 6.0], 2.8)
    };
    let drive = testing::drive();
    let bounds = crate::area(&drive).unwrap();
    let ground = HeightField::flat(bounds, 0.0);
    let streets = testing::surfaces(&drive, &ground);
    let plot = Plot {
        drive: &drive,
        customs: testing::building_customs("SG"),
        streets: &streets,
        ground: &ground,
        bounds,
        seen_m: &[],
    };
    let houses = houses(&[&carport], &plot, Seed(1), &Report::default());
    let volume = &houses[0].volumes[0];
    assert!(volume.is_canopy && volume.bottom_m > 2.2 && volume.posts.len() >= 4, "{volume:?}");
}

#[test]
fn a_road_through_a_high_building_leaves_a_passage() {
    // The made-up street runs from y = −4 to 12; the vehicle stays between x = 0 and 45.
    let across = |height_m| square(1, 60.0, 44.0, [12.0, 60.0], height_m);
    let found = built(&[across(15.0)]);
    let spans: Vec<String> = found.iter().map(|f| format!("{:.2} {:.2}", f.1, f.2)).collect();
    assert_eq!(spans, ["0.00 4.19", "0.00 4.19", "4.20 15.00"]);
    assert!(built(&[across(6.0)]).iter().all(|f| f.1 == 0.0));
}

#[test]
fn a_road_that_leads_through_the_end_of_a_house_leaves_what_is_above_it() {
    let road = testing::road(9, RoadKind::Service, &[[102.0, -4.0], [102.0, -58.0]]);
    let spans = |house: Building| {
        let map = StreetMap { roads: vec![road.clone()], buildings: vec![house], ..StreetMap::default() };
        let found = built_on(Some(&map), &map.buildings);
        found.iter().map(|f| format!("{:.2} {:.2}", f.1, f.2)).collect::<Vec<_>>()
    };
    let house = |height_m| square(1, 99.5, 20.0, [24.0, 12.0], height_m);
    assert_eq!(spans(house(15.0)), ["0.00 4.19", "4.20 15.00"]);
    assert_eq!(spans(house(5.0)), ["0.00 5.00"]);
    // A part that begins above a low storey is over the road already.
    let upper = Building { part: true, min_height_m: 3.1, ..house(15.0) };
    assert_eq!(spans(upper), ["3.10 15.00"]);
}
