//! Views of a place that nobody drove through, on its ground.

use glam::{DMat3, DQuat, DVec2, DVec3};
use trove_model::{Drive, Ego, HeightField, Pose, Report, StreetMap, World};

use crate::ground::ground;
use crate::site::area;

/// Half of a car's wheelbase and of its track, metres.
const WHEELS_M: DVec2 = DVec2::new(1.35, 0.75);

/// A drive of [`place_drive`](crate::place_drive) with its vehicle on the ground that [`build`](crate::build) lays over
/// the map's relief, tilted as its wheels stand; unchanged where the map has no relief.
pub fn on_relief(mut drive: Drive, map: &StreetMap) -> Drive {
    let (Some(relief), Some(bounds)) = (&map.relief, area(&drive)) else { return drive };
    // Whatever there is to report is reported when the place is built.
    let field = ground(&drive, Some(map), Some(relief), 0.0, bounds, &Report::default()).heights;
    let middle = drive.ego_body.centre_ego.truncate();
    for keyframe in &mut drive.keyframes {
        let world_from_ego = standing(&field, &keyframe.world_from_ego, middle);
        keyframe.world_from_ego = world_from_ego;
        keyframe.exposures.iter_mut().for_each(|exposure| exposure.world_from_ego = world_from_ego);
    }
    drive
}

/// A vehicle on the plane through its wheels, which stand around a `middle` in Ego; position and heading stay.
fn standing(field: &HeightField, world_from_ego: &Pose<World, Ego>, middle: DVec2) -> Pose<World, Ego> {
    let flat = Pose::<World, Ego>::from_yaw(world_from_ego.yaw_rad(), world_from_ego.translation);
    let at =
        |x: f64, y: f64| field.on_ground(flat.point((middle + DVec2::new(x, y) * WHEELS_M).extend(0.0)).truncate());
    let [front, back] = [1.0, -1.0].map(|x| (at(x, 1.0) + at(x, -1.0)) / 2.0);
    let [left, right] = [1.0, -1.0].map(|y| (at(1.0, y) + at(-1.0, y)) / 2.0);
    let up = (front - back).cross(left - right).normalize();
    let forward = (front - back).normalize();
    let rotation = DQuat::from_mat3(&DMat3::from_cols(forward, up.cross(forward), up));
    let centre = (front + back) / 2.0;
    // The plane's height below the origin of Ego.
    let offset = world_from_ego.translation - centre;
    let drop = DVec2::new(up.x, up.y).dot(offset.truncate()) / up.z;
    let translation: DVec3 = world_from_ego.translation.truncate().extend(centre.z - drop);
    Pose::new(rotation, translation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use crate::{BuildSettings, PlacePlan, build, place_drive};
    use trove_model::{AssetLibrary, DrivingSide, MapProjection, Provenance, Raster, Relief, RoadKind, Seed};

    #[test]
    fn the_vehicle_of_a_place_stands_with_all_wheels_on_the_ground_that_is_built() {
        let road = |id, ends: [[f64; 2]; 2]| testing::road(id, RoadKind::Residential, &ends);
        let (origin, cell_m) = (DVec2::splat(-1200.0), DVec2::splat(30.0));
        let height_m = |x: u32, y: u32| {
            let p = origin + DVec2::new(f64::from(x), f64::from(y)) * cell_m;
            (80.0 + 0.12 * p.x - 0.07 * p.y + 6.0 * (p.x / 90.0).sin()) as f32
        };
        let sources = vec![Provenance { source: "a.hgt".into(), licence: "public domain".into() }];
        let relief = Relief { origin, cell_m, nodes: Raster::from_fn(81, 81, height_m), sources };
        let map = StreetMap {
            roads: vec![road(1, [[-300.0, 0.0], [300.0, 0.0]]), road(2, [[0.0, -300.0], [0.0, 300.0]])],
            relief: Some(relief),
            ..StreetMap::default()
        };
        let projection = MapProjection::spherical(43.7, 7.4, DVec2::ZERO);
        let driving_side = DrivingSide::Right;
        let plan = PlacePlan { name: "p", projection, size_m: 300.0, driving_side, time_ns: 0 };
        let flat = place_drive(&map, &plan, Seed(1), &Report::default()).unwrap();
        let drive = on_relief(flat.clone(), &map);
        let settings = BuildSettings { locale: testing::locale("FR"), ..testing::settings() };
        let site = build(&drive, Some(&map), &AssetLibrary::default(), &settings, &Report::default()).unwrap();
        let heights = drive.keyframes.iter().map(|k| k.world_from_ego.translation.z);
        let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), z| (low.min(z), high.max(z)));
        assert!(high - low > 5.0, "{low} to {high}");
        for (keyframe, before) in drive.keyframes.iter().zip(&flat.keyframes) {
            let pose = keyframe.world_from_ego;
            let moved = pose.translation - before.world_from_ego.translation;
            assert!(
                moved.truncate().length() < 1e-9 && (pose.yaw_rad() - before.world_from_ego.yaw_rad()).abs() < 0.02
            );
            assert!(keyframe.exposures.iter().all(|exposure| exposure.world_from_ego == pose));
            for (x, y) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                let middle = drive.ego_body.centre_ego.truncate();
                let wheel = pose.point((middle + DVec2::new(x, y) * WHEELS_M).extend(0.0));
                let off_m = wheel.z - site.ground().height_m(wheel.truncate());
                assert!(off_m.abs() < 0.05, "{wheel}: {off_m}");
            }
        }
        assert!(site.provenance().iter().any(|p| p.source == "a.hgt"));
    }
}
