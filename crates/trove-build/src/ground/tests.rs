use glam::DVec2;
use trove_model::{
    Bounds, Drive, DriveOrigin, DrivingSide, HeightField, Land as MappedLand, LandKind, MapProjection, Polygon, Raster,
    Relief, Report, Road, RoadKind, StreetMap,
};

use super::*;
use crate::testing;

fn relief(height_m: impl Fn(DVec2) -> f64) -> Relief {
    let (origin, cell_m) = (DVec2::splat(-1500.0), DVec2::splat(30.0));
    let node = |x, y| height_m(origin + DVec2::new(f64::from(x), f64::from(y)) * cell_m) as f32;
    Relief { origin, cell_m, nodes: Raster::from_fn(101, 101, node), sources: Vec::new() }
}

fn bounds() -> Bounds {
    Bounds::square(DVec2::ZERO, 500.0)
}

fn nobodys() -> Drive {
    Drive { origin: DriveOrigin::MadeUp, lane_map: None, ..testing::drive() }
}

/// Heights over a relief that nobody recorded, from World's 0 at the relief's.
fn heights(map: &StreetMap, height_m: impl Fn(DVec2) -> f64) -> HeightField {
    let relief = relief(height_m);
    let ground = ground(&nobodys(), Some(map), Some(&relief), 0.12, bounds(), &Report::default());
    let mut field = ground.heights;
    field.nodes.data.iter_mut().for_each(|z| *z -= ground.land.unwrap().datum_m as f32);
    field
}

#[test]
fn the_ground_of_a_place_that_nobody_recorded_is_its_relief() {
    let plane = |p: DVec2| 300.0 + 0.2 * p.x - 0.1 * p.y;
    let map = StreetMap {
        roads: vec![testing::road(1, RoadKind::Residential, &[[-400.0, -200.0], [0.0, 0.0], [400.0, 200.0]])],
        ..StreetMap::default()
    };
    let field = heights(&map, plane);
    for i in 0..300 {
        let p = DVec2::new(f64::from(i * 7 % 49) - 24.0, f64::from(i * 11 % 47) - 23.0) * 10.0;
        let off_m = field.height_m(p) - plane(p);
        // The road's cross fall is taken out, and its end is the relief's edge.
        assert!(off_m.abs() < 2.0, "{p}: {off_m}");
        if (p - DVec2::new(2.0, 1.0) * p.dot(DVec2::new(2.0, 1.0)) / 5.0).length() > 60.0 {
            assert!(off_m.abs() < 0.02, "{p}: {off_m}");
        }
    }
}

#[test]
fn a_road_along_a_steep_slope_is_level_across_and_no_steeper_than_roads_are() {
    // 40 % to the north, and noise as coarse reliefs have it.
    let slope = |p: DVec2| 0.4 * p.y + 3.0 * (p.x / 21.0).sin() * (p.y / 17.0).cos();
    let line = [[-400.0, -60.0], [-100.0, -30.0], [150.0, 30.0], [400.0, 40.0]];
    let map = StreetMap { roads: vec![testing::road(1, RoadKind::Residential, &line)], ..StreetMap::default() };
    let field = heights(&map, slope);
    let line = line.map(DVec2::from_array);
    for pair in line.windows(2) {
        let along = (pair[1] - pair[0]).normalize();
        for i in 1..20 {
            let p = pair[0].lerp(pair[1], f64::from(i) / 20.0);
            if p.abs().max_element() > 240.0 || line.iter().any(|corner| corner.distance(p) < 15.0) {
                continue;
            }
            let rise = |way: DVec2| (field.height_m(p + 3.0 * way) - field.height_m(p - 3.0 * way)) / 6.0;
            assert!(rise(along).abs() < 0.19, "{p}: {}", rise(along));
            assert!(rise(along.perp()).abs() < 0.03, "{p}: {}", rise(along.perp()));
        }
    }
}

#[test]
fn roads_side_by_side_on_a_slope_keep_their_own_heights() {
    let roads = [0.0, 16.0].map(|y| testing::road(y as i64 + 1, RoadKind::Residential, &[[-400.0, y], [400.0, y]]));
    let map = StreetMap { roads: roads.to_vec(), ..StreetMap::default() };
    let field = heights(&map, |p| 0.4 * p.y);
    let [low, high] = [0.0, 16.0].map(|y| field.height_m(DVec2::new(20.0, y)));
    assert!((high - low - 6.4).abs() < 0.6, "{low} {high}");
}

#[test]
fn water_is_flat_and_its_banks_rise_from_it() {
    let pond =
        Polygon::simple([[-60.0, -40.0], [60.0, -40.0], [60.0, 40.0], [-60.0, 40.0]].map(DVec2::from_array).to_vec());
    let water = MappedLand { id: 1, kind: LandKind::Water, polygon: pond.clone() };
    let map = StreetMap { land: vec![water], ..StreetMap::default() };
    let field = heights(&map, |p| 0.02 * p.x + 0.01 * p.y);
    let level_m = field.height_m(DVec2::ZERO);
    for (x, y) in [(-59.0, -39.0), (59.0, 39.0), (0.0, -40.0), (61.0, 0.0)] {
        let off_m = field.height_m(DVec2::new(x, y)) - level_m;
        assert!(off_m.abs() < 0.011, "{x}, {y}: {off_m}");
    }
    assert!((field.height_m(DVec2::new(150.0, 0.0)) - 3.0).abs() < 0.05);
}

#[test]
fn the_recording_tells_the_ground_that_it_knows_and_the_relief_what_lies_beyond() {
    // Everything of the drive stands at 0; the relief counts from elsewhere and has a hill to the north.
    let hill = |p: DVec2| 47.0 + if p.y > 100.0 { 0.3 * (p.y - 100.0) } else { 0.0 };
    let relief = relief(hill);
    let (drive, report) = (testing::drive(), Report::default());
    let ground = ground(&drive, None, Some(&relief), 0.0, bounds(), &report);
    let alone = super::ground(&drive, None, None, 0.0, bounds(), &Report::default());
    assert_eq!(
        (alone.land.is_none(), alone.spans.height_m(&Road::new(1, RoadKind::Minor, Vec::new()), DVec2::ZERO)),
        (true, None)
    );
    for x in [0.0, 20.0, 45.0] {
        let p = DVec2::new(x, 1.0);
        assert!((ground.heights.height_m(p) - alone.heights.height_m(p)).abs() < 0.02, "{x}");
    }
    assert!((ground.land.unwrap().datum_m + 47.0).abs() < 0.3);
    let far = DVec2::new(20.0, 230.0);
    assert!((ground.heights.height_m(far) - (hill(far) - 47.0)).abs() < 0.4, "{}", ground.heights.height_m(far));
    // Nowhere is there a step.
    let heights: Vec<f64> = (0..240).map(|y| ground.heights.height_m(DVec2::new(20.0, f64::from(y)))).collect();
    assert!(heights.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.4));
    assert!(report.measurements().iter().any(|m| m.name == "relief.shift_m"));
}

#[test]
fn ground_that_the_relief_lacks_goes_on_at_its_edge_and_is_reported() {
    let mut half = relief(|p| 0.1 * p.y);
    for (i, z) in half.nodes.data.iter_mut().enumerate() {
        if i % 101 > 50 {
            *z = f32::NAN;
        }
    }
    let report = Report::default();
    let ground = ground(&nobodys(), None, Some(&half), 0.12, bounds(), &report);
    let at = |x: f64| ground.heights.height_m(DVec2::new(x, 100.0));
    assert!((at(200.0) - at(-10.0)).abs() < 0.1 && (at(-10.0) - 10.0).abs() < 0.1);
    assert!(report.entries().iter().any(|e| e.what.contains("beyond the elevation files")));
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_monaco_is_steep_its_roads_can_be_driven_and_its_sea_is_flat() {
    let data = std::path::PathBuf::from(std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA"));
    let projection = MapProjection::spherical(43.7385, 7.4240, DVec2::ZERO);
    let (bounds, report) = (Bounds::square(DVec2::ZERO, 700.0), Report::default());
    let extract = data.join("osm/monaco-latest.osm.pbf");
    let map = trove_read::osm::read(&extract, &projection, bounds, DrivingSide::Right, &report).unwrap();
    let tiles = [data.join("relief/N43E007.hgt.zip")];
    let relief = trove_read::relief::read(&tiles, &projection, bounds.grown(2000.0), &report).unwrap().unwrap();
    let ground = ground(&nobodys(), Some(&map), Some(&relief), 0.12, bounds, &report);
    let field = &ground.heights;
    let heights = field.nodes.data.iter();
    let (low, high) = heights.fold((f32::MAX, f32::MIN), |(low, high), &z| (low.min(z), high.max(z)));
    assert!(high - low > 120.0, "{low} to {high}");

    let inner = bounds.grown(-10.0);
    let (mut along, mut across) = (Vec::new(), Vec::new());
    let on_ground = |r: &&Road| r.kind.is_for_cars() && !r.bridge && !r.tunnel && r.layer == 0;
    for pair in map.roads.iter().filter(on_ground).flat_map(|r| r.centreline.windows(2)) {
        let way = (pair[1] - pair[0]).normalize_or_zero();
        for i in 0..(pair[0].distance(pair[1]) / 2.0) as usize {
            let p = pair[0] + way * (2.0 * i as f64 + 1.0);
            if inner.contains(p) {
                let slope = |way: DVec2| (field.height_m(p + way * 1.5) - field.height_m(p - way * 1.5)).abs() / 3.0;
                along.push(slope(way));
                across.push(slope(way.perp()));
            }
        }
    }
    let share = |values: &mut Vec<f64>, share: f64| {
        values.sort_by(f64::total_cmp);
        values[((values.len() - 1) as f64 * share) as usize]
    };
    let shares = [0.5, 0.9, 0.99, 1.0];
    let (along, across) = (shares.map(|s| share(&mut along, s)), shares.map(|s| share(&mut across, s)));
    println!("{low} to {high} m; slopes of roads {along:.3?} along, {across:.3?} across");
    assert!(along[1] < 0.19 && along[2] < 0.3 && across[0] < 0.03 && across[1] < 0.1, "{along:?} {across:?}");

    let sea = map.land.iter().filter(|l| l.kind == LandKind::Water && l.polygon.area_m2() > 2000.0);
    let mut is_flat = 0;
    for water in sea {
        let inside: Vec<f32> = (0..field.nodes.data.len() as u32)
            .map(|i| (i % field.nodes.width, i / field.nodes.width))
            .filter(|&(x, y)| {
                water.polygon.contains(field.origin + DVec2::new(f64::from(x), f64::from(y)) * field.cell_m)
            })
            .map(|(x, y)| *field.nodes.at(x, y))
            .collect();
        let (low, high) = inside.iter().fold((f32::MAX, f32::MIN), |(low, high), &z| (low.min(z), high.max(z)));
        assert!(inside.is_empty() || high - low < 0.02, "{}: {low} to {high}", water.id);
        is_flat += usize::from(!inside.is_empty());
    }
    assert!(is_flat > 0, "the harbour");
}
