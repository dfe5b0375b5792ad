//! What holds for all plants and all undergrowth of a place on a slope.

use std::sync::Arc;

use glam::{DVec2, Vec3};
use trove_model::{
    AssetLibrary, Bounds, Class, CoverKind, Furniture, FurnitureKind, GroundCover, HeightField, Kind, Land, LandKind,
    LineKind, MapLine, Material, Mesh, Polygon, Raster, Report, Seed, Slot, StreetMap,
};

use super::{undergrowth, vegetation};
use crate::geometry::plane;
use crate::pieces::Piece;
use crate::placement::Stand;
use crate::roads::Footing;
use crate::surroundings::Clearance;
use crate::surroundings::Kerbs;
use crate::surroundings::Surroundings;
use crate::testing;

/// A flat square of two triangles for every kind of cover.
fn library() -> AssetLibrary {
    let cover = |(kind, side_m): (CoverKind, f64)| {
        let h = side_m as f32 / 2.0;
        let mesh = Mesh {
            positions: vec![Vec3::new(-h, -h, 0.0), Vec3::new(h, -h, 0.0), Vec3::new(h, h, 0.0), Vec3::new(-h, h, 0.0)],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        };
        let slot = Slot::new(Material::plain("cover", Vec3::ONE, 0.9), vec![Vec3::X, Vec3::Y]);
        GroundCover { id: format!("{kind:?}-{side_m}"), kind, side_m, mesh: Arc::new(mesh), slots: vec![slot] }
    };
    let grass = [CoverKind::GrassNear, CoverKind::GrassMiddle, CoverKind::GrassFar]
        .into_iter()
        .flat_map(|kind| [2.0, 1.0, 0.5, 0.25].map(|side_m| (kind, side_m)));
    let others =
        [(CoverKind::Weeds, 0.3), (CoverKind::Flowers, 0.5), (CoverKind::Leaves, 0.5), (CoverKind::TreePit, 1.3)];
    AssetLibrary { covers: grass.chain(others).map(cover).collect(), ..testing::library() }
}

/// A park with a hedge, an avenue and a house beside the road.
fn map() -> (StreetMap, Polygon) {
    let rectangle = |low: [f64; 2], high: [f64; 2]| {
        plane::rectangle(Bounds { min: DVec2::from_array(low), max: DVec2::from_array(high) })
    };
    let tree = |i: i64| Furniture::new(i, FurnitureKind::Tree, DVec2::new(20.0 + 9.0 * i as f64, -16.0));
    let house = rectangle([10.0, -60.0], [40.0, -30.0]);
    let hedge = MapLine {
        id: 1,
        kind: LineKind::Hedge,
        line: vec![DVec2::new(-50.0, -12.0), DVec2::new(-20.0, -13.0)],
        height_m: Some(1.1),
        style: None,
    };
    let map = StreetMap {
        land: vec![Land { id: 1, kind: LandKind::Park, polygon: rectangle([-100.0, -120.0], [150.0, -8.0]) }],
        furniture: (0..9).map(tree).collect(),
        lines: vec![hedge],
        ..StreetMap::default()
    };
    (map, house)
}

/// Calls with everything that grows on ground which rises eastwards by 6 %.
fn on_a_slope(check: impl FnOnce(&Surroundings, &[crate::pieces::Scenery], &[Piece], &Polygon)) {
    let (drive, library, report) = (testing::drive(), library(), Report::default());
    let (map, house) = map();
    let bounds = crate::area(&drive).unwrap();
    let cells = (bounds.size_m().x / 2.0) as u32 + 1;
    let nodes = Raster::from_fn(cells, cells, |x, _| 0.12 * x as f32);
    let ground = HeightField { origin: bounds.min, cell_m: 2.0, nodes };
    let surfaces = testing::surfaces(&drive, &ground);
    let mut clearance = Clearance::new(&drive, &surfaces, std::slice::from_ref(&house), bounds);
    let kerbs = Kerbs::new(&drive, None, &surfaces, bounds);
    let stand = Stand { ground: &ground, surfaces: &surfaces };
    let seeds = Seed(0).into();
    let place = testing::place(&drive, Some(&map), bounds, &ground, &library, &seeds, &report);
    let around = Surroundings { place: &place, kerbs: &kerbs, stand };
    let plants = vegetation(&around, &mut clearance, Seed(3));
    let pieces = undergrowth(&around, &clearance, &plants, Seed(4));
    check(&around, &plants, &pieces, &house);
}

#[test]
fn plants_stand_on_the_ground_off_the_road_and_out_of_houses_and_not_in_each_other() {
    on_a_slope(|around, plants, _, house| {
        let trees = plants.iter().filter(|p| p.asset.kind == Kind::Tree);
        assert!(trees.clone().count() > 60 && plants.len() > 150, "{}", plants.len());
        for plant in plants {
            let foot = plant.foot_world.truncate();
            assert_ne!(around.stand.surfaces.footing(foot), Footing::Carriageway, "{plant:?}");
            assert!(!house.contains(foot) || house.edge_distance_m(foot) < 0.05, "{plant:?}");
            let above_m = plant.foot_world.z - around.stand.surface_m(foot);
            assert!((-0.03..0.03).contains(&above_m), "{above_m}");
        }
        let feet: Vec<DVec2> = trees.map(|t| t.foot_world.truncate()).collect();
        for (i, p) in feet.iter().enumerate() {
            assert!(feet[..i].iter().all(|q| q.distance(*p) > 1.9), "{p}");
        }
    });
}

#[test]
fn crowns_go_through_no_wall_and_hang_over_the_road_only_high_up() {
    on_a_slope(|around, plants, _, house| {
        let mut beside = 0;
        for tree in plants.iter().filter(|p| p.asset.kind == Kind::Tree) {
            let foot = tree.foot_world.truncate();
            for p in &tree.asset.mesh.positions {
                let world = tree.world_from_mesh().transform_point3(p.as_dvec3());
                // Single twigs touch, and distances are known to a quarter of a metre.
                let out = world.truncate() - foot;
                let reached = foot + out.clamp_length_max((out.length() - 0.5).max(0.0));
                beside += usize::from(house.edge_distance_m(reached) < 2.0);
                assert!(!house.contains(reached), "{tree:?}");
                let above_m = world.z - tree.foot_world.z;
                let over_road = around.stand.surfaces.footing(reached) == Footing::Carriageway;
                assert!(!over_road || above_m > 4.0, "{tree:?}");
            }
        }
        assert!(beside > 0);
    });
}

#[test]
fn a_mapped_hedge_has_no_gaps() {
    on_a_slope(|_, plants, _, _| {
        let (from, along) = (DVec2::new(-50.0, -12.0), DVec2::new(30.0, -1.0).normalize());
        let mut ends: Vec<[f64; 2]> = plants
            .iter()
            .filter(|p| p.asset.kind == Kind::Bush)
            .map(|p| (p, p.foot_world.truncate() - from))
            .filter(|(_, off)| off.perp_dot(along).abs() < 0.05 && (0.0..30.1).contains(&off.dot(along)))
            .map(|(p, off)| (off.dot(along), p.asset.size_m.x * p.scale.x / 2.0))
            .map(|(at, half)| [at - half, at + half])
            .collect();
        ends.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert!(ends.len() > 10 && ends[0][0] < 0.1 && ends[ends.len() - 1][1] > 29.9, "{ends:?}");
        assert!(ends.windows(2).all(|pair| pair[1][0] < pair[0][1]), "{ends:?}");
    });
}

#[test]
fn undergrowth_lies_on_the_ground_and_grass_grows_on_lawns_alone() {
    on_a_slope(|around, plants, pieces, house| {
        let lawns = &around.stand.surfaces.lawns;
        let of = |name: &str| pieces.iter().filter(move |p| p.materials[0].name == name && !name.is_empty()).count();
        assert!(of("cover") == pieces.len() && pieces.len() > 1000, "{}", pieces.len());
        for piece in pieces {
            assert_eq!((piece.kind, piece.materials.len()), (None, 1));
            let corners: Vec<_> =
                piece.mesh.positions.iter().map(|p| piece.world_from_mesh.transform_point3(p.as_dvec3())).collect();
            let footing = around.stand.surfaces.footing(piece.world_from_mesh.translation.truncate());
            for corner in &corners {
                let above_m = corner.z - around.stand.ground.height_m(corner.truncate());
                let expected_m = around.stand.surfaces.elevation_m(piece.world_from_mesh.translation.truncate());
                assert!((above_m - expected_m).abs() < 0.03, "{above_m} for {expected_m}");
                assert!(!house.contains(corner.truncate()), "{corner}");
            }
            let side_m = corners[0].distance(corners[1]);
            let is_grass = [2.0, 1.0, 0.5, 0.25].iter().any(|s| (side_m - s).abs() < 0.02 * s);
            if is_grass && piece.class == Class::Ground && footing == Footing::Land {
                let middle = piece.world_from_mesh.translation.truncate();
                assert!(lawns.iter().any(|l| l.contains(middle)), "{middle}");
            }
        }
        let pits = pieces.iter().filter(|p| p.mesh.positions[0].x < -0.64 && p.mesh.positions[0].x > -0.66);
        let on_sidewalk = plants.iter().filter(|p| {
            p.asset.kind == Kind::Tree && around.stand.surfaces.footing(p.foot_world.truncate()) == Footing::Sidewalk
        });
        assert!(pits.count() <= on_sidewalk.count());
    });
}

#[test]
fn the_same_grows_with_any_number_of_threads() {
    let grown = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut text = String::new();
            on_a_slope(|_, plants, pieces, _| {
                let laid: Vec<_> = pieces.iter().map(|p| (p.world_from_mesh, &p.materials, p.class)).collect();
                text = format!("{plants:?} {laid:?}");
            });
            text
        })
    };
    assert_eq!(grown(1), grown(3));
}
