use glam::DVec2;
use trove_model::{Building, Mesh, Polygon, Report, RoofShape, Seed};

use super::{edges, pitched, roof};
use crate::buildings::shell::{Shell, Slot};
use crate::buildings::volumes::{Beside, House, Volume};
use crate::testing::open_edges_and_volume;

const SHAPES: [RoofShape; 12] = [
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
const BOTTOM_M: f64 = 10.0;
const EAVES_M: f64 = 14.0;
const TOP_M: f64 = 18.0;

fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
    points.iter().map(|&(x, y)| DVec2::from_angle(0.3).rotate(DVec2::new(x, y))).collect()
}

/// By name: plain and bent outlines, one with a court, one all but flat, one as small as a shed.
fn footprints() -> Vec<(&'static str, Polygon)> {
    let simple = |points: &[(f64, f64)]| Polygon::simple(ring(points));
    let mut court = ring(&[(7., 6.), (17., 6.), (17., 14.), (7., 14.)]);
    court.reverse();
    let round: Vec<(f64, f64)> =
        (0..20).map(|i| (f64::from(i) * 0.314_159).sin_cos()).map(|(s, c)| (8. * c, 8. * s)).collect();
    vec![
        ("rectangle", simple(&[(0., 0.), (20., 0.), (20., 12.), (0., 12.)])),
        ("square", simple(&[(0., 0.), (9., 0.), (9., 9.), (0., 9.)])),
        ("L", simple(&[(0., 0.), (20., 0.), (20., 8.), (8., 8.), (8., 22.), (0., 22.)])),
        ("U", simple(&[(0., 0.), (24., 0.), (24., 18.), (16., 18.), (16., 7.), (7., 7.), (7., 20.), (0., 20.)])),
        ("T", simple(&[(0., 0.), (24., 0.), (24., 8.), (16., 8.), (16., 20.), (8., 20.), (8., 8.), (0., 8.)])),
        ("court", Polygon { exterior: ring(&[(0., 0.), (24., 0.), (24., 20.), (0., 20.)]), holes: vec![court] }),
        (
            "irregular",
            simple(&[(0., 0.), (9., -3.), (17., 1.), (15., 9.), (19., 14.), (8., 11.), (3., 15.), (-2., 6.)]),
        ),
        ("round", simple(&round)),
        ("straight points", simple(&[(0., 0.), (7., 0.002), (20., 0.), (20., 6.), (20.01, 8.), (20., 12.), (0., 12.)])),
        ("sliver", simple(&[(0., 0.), (30., 0.), (30., 0.4), (0., 0.5)])),
        (
            "notch",
            simple(&[(0., 0.), (20., 0.), (20., 12.), (10.5, 12.), (10.5, 9.), (10., 9.), (10., 12.), (0., 12.)]),
        ),
        ("tiny", simple(&[(0., 0.), (1.1, 0.), (1.1, 1.), (0., 1.)])),
    ]
}

/// From 10 to 18 m, with nothing near it.
fn volume<'a>(building: &'a Building, footprint: &Polygon, shape: RoofShape) -> Volume<'a> {
    let eaves_m = if shape == RoofShape::Flat { TOP_M } else { EAVES_M };
    let sides = footprint.edges().map(|(a, b)| Beside { covers: Vec::new(), length_m: a.distance(b), room_m: 0.8 });
    Volume {
        footprint: footprint.clone(),
        sides: sides.collect(),
        ..Volume::new(building, BOTTOM_M, eaves_m, TOP_M, shape)
    }
}

/// Such a volume with its walls, as far from the driven path as given.
fn body(footprint: &Polygon, shape: RoofShape, path_m: f64) -> (Mesh, usize) {
    let building = Building::new(1, Polygon::default(), None);
    let house = House { path_m, ..House::alone(&building, vec![volume(&building, footprint, shape)]) };
    let mut shell = Shell::default();
    let top = roof(&mut shell, &house.volumes[0], &house, &mut Seed(3).random(), &Report::default());
    for (a, b) in footprint.edges() {
        shell.slope(Slot::Facade, &[a.extend(BOTTOM_M), b.extend(BOTTOM_M), b.extend(top), a.extend(top)]);
    }
    shell.cover(Slot::Trim, std::slice::from_ref(footprint), |_| BOTTOM_M, false);
    let mesh = shell.finish();
    let triangles = mesh.triangles.len();
    (mesh, triangles)
}

#[test]
fn every_roof_closes_every_outline_and_looks_outwards() {
    for (name, footprint) in footprints() {
        let footprint = crate::geometry::plane::union(&[footprint]).remove(0);
        let area_m2 = footprint.area_m2();
        for shape in SHAPES {
            let (mesh, _) = body(&footprint, shape, 400.0);
            assert_eq!(mesh.defect(), None);
            let (open, volume) = open_edges_and_volume(&mesh);
            let open = open.len();
            assert_eq!(open, 0, "{shape:?} on {name}");
            let (least, most) = (area_m2 * (EAVES_M - BOTTOM_M) * 0.99, area_m2 * (TOP_M - BOTTOM_M) * 1.12);
            assert!((least..most).contains(&volume), "{shape:?} on {name}: {volume} m³ of {least} to {most}");
            let highest = mesh.positions.iter().map(|p| p.z).fold(0.0, f32::max);
            assert!(f64::from(highest) < TOP_M + 1e-3, "{shape:?} on {name}: up to {highest} m");
        }
    }
}

#[test]
fn what_is_put_on_a_roof_is_closed_too_and_only_near_the_path() {
    for (name, footprint) in footprints() {
        let footprint = crate::geometry::plane::union(&[footprint]).remove(0);
        for shape in SHAPES {
            let (mesh, near) = body(&footprint, shape, 0.0);
            let open = open_edges_and_volume(&mesh).0.len();
            assert_eq!((mesh.defect(), open), (None, 0), "{shape:?} on {name}");
            let (_, far) = body(&footprint, shape, 400.0);
            assert!(far <= near && far < 700, "{shape:?} on {name}: {far} triangles, {near} near");
        }
    }
}

#[test]
fn every_body_along_a_roofs_edges_looks_outwards() {
    let building = Building::new(1, Polygon::default(), None);
    let mut bodies = 0;
    for (name, footprint) in footprints() {
        let footprint = crate::geometry::plane::union(&[footprint]).remove(0);
        for shape in SHAPES {
            let volume = volume(&building, &footprint, shape);
            let Some(roof) = pitched::pitched(&volume, shape, EAVES_M, TOP_M) else { continue };
            let mut shell = Shell::default();
            edges::edges(&mut shell, &roof, &volume, true);
            // One after another each is closed: where no edge is open one ends.
            let mut rest = shell.finish();
            let triangles = std::mem::take(&mut rest.triangles);
            for triangle in triangles {
                rest.triangles.push(triangle);
                let (open, volume_m3) = open_edges_and_volume(&rest);
                if open.is_empty() {
                    assert!(volume_m3 > 0.0, "{shape:?} on {name}: {volume_m3} m³");
                    rest.triangles.clear();
                    bodies += 1;
                }
            }
            assert!(rest.triangles.is_empty(), "{shape:?} on {name}");
        }
    }
    assert!(bodies > 300, "{bodies}");
}

#[test]
fn the_ends_of_wings_carry_gables_and_party_walls_too() {
    let gables = |footprint: &Polygon, shape| {
        let (mesh, _) = body(footprint, shape, 400.0);
        mesh.slots.iter().filter(|s| **s == Slot::Gable as u16).count()
    };
    let of = |name: &str| footprints().into_iter().find(|(n, _)| *n == name).unwrap().1;
    assert_eq!(gables(&of("rectangle"), RoofShape::Gabled), 2);
    assert_eq!(gables(&of("L"), RoofShape::Gabled), 2);
    assert_eq!(gables(&of("T"), RoofShape::Gabled), 3);
    assert_eq!(gables(&of("rectangle"), RoofShape::Hipped), 0);
    assert!(gables(&of("U"), RoofShape::HalfHipped) > 2);
}
