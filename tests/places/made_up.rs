//! A made-up town with everything that a street map can hold.

use glam::DVec2;
use trove_model::{
    Building, BuildingKind, Cycleway, Furniture, FurnitureKind, Land, LandKind, LineKind, MapLine, Parking,
    ParkingOrientation, Polygon, Road, RoadKind, RoofShape, Sides, SidewalkSides, StreetMap, Turns,
};

fn points(xy: &[(f64, f64)]) -> Vec<DVec2> {
    xy.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
}

fn rectangle(x: f64, y: f64, width: f64, depth: f64) -> Polygon {
    Polygon::simple(points(&[(x, y), (x + width, y), (x + width, y + depth), (x, y + depth)]))
}

/// 240 m of streets: a crossing of a primary and a residential road, a roundabout, a dual carriageway under a bridge,
/// rows of houses with every roof, a park, and furniture.
pub(crate) fn town() -> StreetMap {
    StreetMap {
        roads: roads(),
        buildings: buildings(),
        land: land(),
        furniture: furniture(),
        lines: lines(),
        relief: None,
        licence: "made up".into(),
    }
}

fn roads() -> Vec<Road> {
    let both = SidewalkSides { left: Some(true), right: Some(true) };
    let turns = |left, through, right| Turns { left, through, right, reverse: false };
    let main = |id, line: &[(f64, f64)]| Road {
        lanes: Some(4),
        lanes_backward: Some(2),
        sidewalk: both,
        turns_forward: vec![turns(true, false, false), turns(false, true, true)],
        turns_backward: vec![turns(true, false, false), turns(false, true, true)],
        name: Some("High Street".into()),
        speed_limit_kmh: Some(50.0),
        ..Road::new(id, RoadKind::Primary, points(line))
    };
    let parking = Some(Parking::Lane(ParkingOrientation::Parallel));
    let mut roads = vec![
        main(1, &[(-160.0, 0.0), (-60.0, 0.0), (0.0, 0.0)]),
        main(2, &[(0.0, 0.0), (70.0, 4.0), (86.0, 5.0)]),
        Road {
            sidewalk: both,
            parking: Sides { left: parking, right: Some(Parking::Bays(ParkingOrientation::Perpendicular)) },
            name: Some("Side Street".into()),
            ..Road::new(3, RoadKind::Residential, points(&[(0.0, -130.0), (0.0, -40.0), (0.0, 0.0)]))
        },
        Road {
            sidewalk: both,
            cycleway: Sides { left: Some(Cycleway::Lane), right: Some(Cycleway::Lane) },
            ..Road::new(4, RoadKind::Tertiary, points(&[(0.0, 0.0), (-6.0, 50.0), (-20.0, 130.0)]))
        },
        Road::new(5, RoadKind::Service, points(&[(-60.0, 0.0), (-60.0, -45.0)])),
    ];
    // A roundabout with four arms.
    let ring: Vec<(f64, f64)> = (0..=16)
        .map(|i| {
            (
                100.0 + 14.0 * (f64::from(i) * std::f64::consts::TAU / 16.0 + std::f64::consts::PI).cos(),
                5.0 + 14.0 * (f64::from(i) * std::f64::consts::TAU / 16.0 + std::f64::consts::PI).sin(),
            )
        })
        .collect();
    roads.push(Road {
        roundabout: true,
        oneway: true,
        lanes: Some(1),
        ..Road::new(6, RoadKind::Primary, points(&ring))
    });
    for (id, arm) in
        [(7, [(114.0, 5.0), (160.0, 5.0)]), (8, [(100.0, 19.0), (100.0, 130.0)]), (9, [(100.0, -9.0), (100.0, -130.0)])]
    {
        roads.push(Road { sidewalk: both, ..Road::new(id, RoadKind::Secondary, points(&arm)) });
    }
    // A dual carriageway below a bridge.
    for (id, x, from, to) in [(10, 56.0, -130.0, 130.0), (11, 66.0, 130.0, -130.0)] {
        let line = points(&[(x, from), (x, to)]);
        if id == 10 {
            roads.push(Road {
                oneway: true,
                lanes: Some(2),
                layer: -1,
                tunnel: true,
                ..Road::new(id, RoadKind::Trunk, line)
            });
        } else {
            roads.push(Road {
                oneway: true,
                lanes: Some(1),
                ..Road::new(id, RoadKind::Minor, points(&[(-110.0, 100.0), (-40.0, 110.0)]))
            });
        }
    }
    roads.push(Road {
        bridge: true,
        layer: 1,
        ..Road::new(12, RoadKind::Minor, points(&[(-100.0, -40.0), (-100.0, 50.0)]))
    });
    roads.push(Road::new(13, RoadKind::Crossing, points(&[(-24.0, -10.0), (-24.0, 10.0)])));
    roads.push(Road::new(14, RoadKind::Footway, points(&[(20.0, 30.0), (50.0, 90.0), (90.0, 100.0)])));
    roads
}

fn buildings() -> Vec<Building> {
    const ROOFS: [RoofShape; 12] = [
        RoofShape::Flat,
        RoofShape::Gabled,
        RoofShape::Hipped,
        RoofShape::HalfHipped,
        RoofShape::Pyramidal,
        RoofShape::Gambrel,
        RoofShape::Mansard,
        RoofShape::Skillion,
        RoofShape::Dome,
        RoofShape::Cone,
        RoofShape::Onion,
        RoofShape::Round,
    ];
    use BuildingKind as K;
    const KINDS: [Option<K>; 6] =
        [Some(K::House), Some(K::Apartments), Some(K::Office), Some(K::Retail), Some(K::Warehouse), None];
    let mut buildings: Vec<Building> = ROOFS
        .iter()
        .enumerate()
        .map(|(i, &roof)| Building {
            roof: Some(roof),
            levels: Some(1.0 + i as f64 % 5.0),
            shop: i % 3 == 0,
            // Side by side, wall to wall.
            ..Building::new(100 + i as i64, rectangle(-155.0 + 12.0 * i as f64, 14.0, 12.0, 14.0), KINDS[i % 6])
        })
        .collect();
    let l = Polygon::simple(points(&[
        (20.0, -60.0),
        (45.0, -60.0),
        (45.0, -48.0),
        (32.0, -48.0),
        (32.0, -20.0),
        (20.0, -20.0),
    ]));
    buildings.push(Building {
        roof: Some(RoofShape::Hipped),
        levels: Some(4.0),
        ..Building::new(120, l, Some(K::Apartments))
    });
    let court =
        Polygon { holes: vec![rectangle(30.0, -110.0, 12.0, 10.0).exterior], ..rectangle(20.0, -120.0, 30.0, 30.0) };
    buildings.push(Building {
        levels: Some(6.0),
        roof: Some(RoofShape::Mansard),
        ..Building::new(121, court, Some(K::Residential))
    });
    // A tower made of parts, one of them in the air, and two that overlap.
    buildings.push(Building {
        height_m: Some(60.0),
        ..Building::new(122, rectangle(-50.0, -60.0, 30.0, 30.0), Some(K::Office))
    });
    for (id, part, low, high) in [
        (123, rectangle(-50.0, -60.0, 30.0, 30.0), 0.0, 12.0),
        (124, rectangle(-45.0, -55.0, 20.0, 20.0), 12.0, 60.0),
        (125, rectangle(-28.0, -50.0, 14.0, 8.0), 20.0, 24.0),
    ] {
        let part = Building {
            part: true,
            min_height_m: low,
            height_m: Some(high),
            ..Building::new(id, part, Some(K::Office))
        };
        buildings.push(part);
    }
    buildings.push(Building::new(126, rectangle(24.0, 40.0, 10.0, 8.0), Some(K::Garage)));
    buildings.push(Building::new(127, rectangle(28.0, 44.0, 12.0, 9.0), Some(K::Shed)));
    buildings
}

fn land() -> Vec<Land> {
    let land = |id, kind, polygon| Land { id, kind, polygon };
    vec![
        land(200, LandKind::Park, rectangle(15.0, 60.0, 30.0, 60.0)),
        land(201, LandKind::Wood, rectangle(-155.0, 60.0, 40.0, 50.0)),
        land(202, LandKind::Grass, rectangle(-150.0, -100.0, 40.0, 50.0)),
        land(203, LandKind::Water, rectangle(-140.0, -130.0, 30.0, 20.0)),
        land(204, LandKind::Parking, rectangle(110.0, -60.0, 40.0, 30.0)),
    ]
}

fn furniture() -> Vec<Furniture> {
    let mut furniture: Vec<Furniture> = [
        (FurnitureKind::TrafficSignal, 0.0, 0.0),
        (FurnitureKind::StreetLamp, -40.0, 9.0),
        (FurnitureKind::Bench, 22.0, 66.0),
        (FurnitureKind::BusStop, -80.0, -9.0),
        (FurnitureKind::Hydrant, 9.0, -30.0),
        (FurnitureKind::StopSign, -57.0, -10.0),
        (FurnitureKind::Crossing, -24.0, 0.0),
        (FurnitureKind::BicycleParking, 12.0, -14.0),
    ]
    .iter()
    .enumerate()
    .map(|(i, &(kind, x, y))| Furniture::new(300 + i as i64, kind, DVec2::new(x, y)))
    .collect();
    furniture.extend(
        (0..8).map(|i| Furniture::new(320 + i, FurnitureKind::Tree, DVec2::new(-140.0 + 12.0 * i as f64, 10.5))),
    );
    furniture
}

fn lines() -> Vec<MapLine> {
    [
        (LineKind::Fence, vec![(15.0, 60.0), (45.0, 60.0), (45.0, 120.0)]),
        (LineKind::Wall, vec![(-110.0, -50.0), (-110.0, -100.0)]),
        (LineKind::Hedge, vec![(16.0, 62.0), (16.0, 118.0)]),
        (LineKind::GuardRail, vec![(110.0, 30.0), (110.0, 90.0)]),
        (LineKind::PowerLine, vec![(-150.0, -70.0), (-120.0, -75.0), (-70.0, -80.0)]),
    ]
    .into_iter()
    .enumerate()
    .map(|(i, (kind, line))| MapLine { id: 400 + i as i64, kind, line: points(&line), height_m: None, style: None })
    .collect()
}
