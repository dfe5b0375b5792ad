//! Where a picture shows the points of a person, and what hides them.

use glam::DVec3;
use trove_model::{Keypoints, SeenKeypoint, SensorRay, Shot};

use crate::PreparedScene;
use crate::prepare::Carrier;
use crate::sight;

/// How deep a point lies in the body and its clothes at most, metres, in the order of `KEYPOINTS`: points of the face on the
/// skin, joints in the middle of limbs and coats.
#[rustfmt::skip]
const DEPTH_M: Keypoints<f64> =
    [0.03, 0.03, 0.03, 0.04, 0.04, 0.14, 0.14, 0.1, 0.1, 0.08, 0.08, 0.2, 0.2, 0.13, 0.13, 0.1, 0.1];

/// The points of the person that an instance shows.
pub(super) fn seen(
    scene: &PreparedScene,
    carrier: &Carrier,
    shot: &Shot,
    instance: u32,
    points_world: &Keypoints<DVec3>,
) -> Keypoints<Option<SeenKeypoint>> {
    let camera_from_world = shot.world_from_camera.inverse();
    let eye = shot.world_from_camera.translation;
    let seen = |point: DVec3, depth_m: f64| {
        let pixel = shot.lens.project(camera_from_world.point(point)).filter(|pixel| shot.lens.contains(*pixel))?;
        let first = sight::seen_by_one(scene, carrier, &SensorRay::new(eye, point - eye, 0.0)?);
        let hides = |first: &sight::Seen| {
            let own_m = if first.hit.instance == instance { depth_m } else { 0.0 };
            first.range_m < point.distance(eye) - own_m
        };
        Some(SeenKeypoint { pixel, is_visible: !first.as_ref().is_some_and(hides) })
    };
    std::array::from_fn(|i| seen(points_world[i], DEPTH_M[i]))
}
