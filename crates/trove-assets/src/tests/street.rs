//! What stands along streets.

use trove_model::{Asset, Kind};

use crate::plans::Plans;
use crate::street;

fn assets() -> Vec<Asset> {
    street::assets(&Plans::built_in().street)
}

#[test]
fn every_kind_of_furniture_has_its_models() {
    let assets = assets();
    #[rustfmt::skip]
    let wanted = [
        (Kind::TrafficCone, 9), (Kind::Barrier, 7), (Kind::PushablePullable, 8), (Kind::Debris, 8), (Kind::Animal, 6),
        (Kind::BicycleRack, 2), (Kind::TrafficSign, 6), (Kind::TrafficSignal, 2), (Kind::StreetLamp, 3),
        (Kind::UtilityPole, 1), (Kind::Bollard, 5), (Kind::Hydrant, 1), (Kind::Bin, 6), (Kind::Bench, 4),
        (Kind::Shelter, 1), (Kind::StreetFurniture, 22), (Kind::Fence, 6), (Kind::Wall, 3), (Kind::GuardRail, 3),
    ];
    for (kind, least) in wanted {
        let found = assets.iter().filter(|a| a.kind == kind).count();
        assert!(found >= least, "{found} of {least} models of {kind:?}");
    }
    assert!(assets.iter().all(|a| a.mesh.triangles.len() < 10_000));
}

#[test]
fn things_have_the_sizes_that_nuscenes_annotates() {
    // Length, width and height between the smallest and the largest of the mini set, a little wider.
    for asset in &assets() {
        let ranges = match asset.kind {
            Kind::TrafficCone => [0.3..0.75, 0.3..0.75, 0.5..1.4],
            Kind::Barrier => [0.5..0.8, 1.7..2.6, 0.8..1.4],
            Kind::BicycleRack => [4.0..15.0, 0.8..2.0, 0.8..1.5],
            _ => continue,
        };
        for (range, size) in ranges.iter().zip(asset.size_m.to_array()) {
            assert!(range.contains(&size), "{} measures {}", asset.id, asset.size_m);
        }
    }
}

#[test]
fn faces_of_signs_look_along_x() {
    for asset in assets().iter().filter(|a| a.kind == Kind::TrafficSign) {
        for (t, corners) in asset.mesh.triangles.iter().enumerate() {
            let material = &asset.slots[usize::from(asset.mesh.slot(t))].material;
            if material.name.starts_with(&asset.id) {
                assert!(asset.mesh.normals[corners[0] as usize].x > 0.99, "{}", asset.id);
            }
        }
    }
}

#[test]
fn those_on_foot_walk_while_the_traffic_beside_them_waits() {
    for asset in assets().iter().filter(|a| a.kind == Kind::TrafficSignal) {
        let lit: Vec<glam::Vec3> =
            asset.slots.iter().map(|s| s.material.emission).filter(|e| e.x + e.y > 0.0).collect();
        let [traffic, walkers] = lit[..] else { panic!("{}: {lit:?}", asset.id) };
        assert_eq!(traffic.x > traffic.y, asset.id.ends_with("red"), "{}", asset.id);
        assert_eq!(walkers.x > 2.0 * walkers.y, asset.id.ends_with("green"), "{}", asset.id);
    }
}
