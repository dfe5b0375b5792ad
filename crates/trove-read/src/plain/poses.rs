//! Poses as the file has them.

use glam::{DMat3, DQuat, DVec3};
use trove_format::PlainPose;
use trove_model::{Camera, Ego, Frame, Pose};

/// No coordinate is larger: northings go to 10,000 km, metres.
const FARTHEST_M: f64 = 1e8;

/// A pose; the error says what is wrong with it. `key` is its name in the file.
pub(super) fn pose<Dst: Frame, Src: Frame>(key: &str, pose: &PlainPose) -> Result<Pose<Dst, Src>, String> {
    let rotation = rotation(key, pose.rotation_wxyz, pose.yaw_rad)?;
    Ok(Pose::new(rotation, position(key, pose.translation_m)?))
}

/// A camera's mounting: its yaw is where it looks, level.
pub(super) fn mounting(key: &str, mounted: &PlainPose) -> Result<Pose<Ego, Camera>, String> {
    let ahead = DQuat::from_mat3(&DMat3::from_cols(-DVec3::Y, -DVec3::Z, DVec3::X));
    let mut pose = pose(key, mounted)?;
    if mounted.rotation_wxyz.is_none() {
        pose.rotation *= ahead;
    }
    Ok(pose)
}

/// A rotation given as a quaternion, as a yaw or not at all.
pub(super) fn rotation(key: &str, wxyz: Option<[f64; 4]>, yaw_rad: Option<f64>) -> Result<DQuat, String> {
    match (wxyz, yaw_rad) {
        (Some(_), Some(_)) => Err(format!("{key}: expected rotation_wxyz or yaw_rad, found both")),
        (Some([w, x, y, z]), None) => {
            let rotation = DQuat::from_xyzw(x, y, z, w);
            let length = rotation.length();
            let is_unit = (length - 1.0).abs() < 0.01;
            let what = "expected a unit quaternion, w first, found one of length";
            is_unit.then(|| rotation.normalize()).ok_or_else(|| format!("{key}.rotation_wxyz: {what} {length:.3}"))
        }
        (None, yaw_rad) => {
            let yaw_rad = yaw_rad.unwrap_or(0.0);
            let is_angle = yaw_rad.abs() <= 10.0;
            let what = "expected radians from −2π to 2π, found";
            is_angle.then(|| DQuat::from_rotation_z(yaw_rad)).ok_or_else(|| format!("{key}.yaw_rad: {what} {yaw_rad}"))
        }
    }
}

/// A position, metres.
pub(super) fn position(key: &str, position_m: [f64; 3]) -> Result<DVec3, String> {
    let position = DVec3::from_array(position_m);
    let is_near = position.abs().cmplt(DVec3::splat(FARTHEST_M)).all();
    is_near.then_some(position).ok_or_else(|| format!("{key}.translation_m: expected metres, found {position_m:?}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::{Body, World};

    fn turned(rotation_wxyz: Option<[f64; 4]>, yaw_rad: Option<f64>) -> PlainPose {
        PlainPose { translation_m: [1.0, 2.0, 3.0], rotation_wxyz, yaw_rad }
    }

    #[test]
    fn a_rotation_is_a_quaternion_or_a_yaw() {
        let half = 0.5f64.sqrt();
        let quaternion: Pose<World, Body> = pose("p", &turned(Some([half, 0.0, 0.0, half]), None)).unwrap();
        let yaw: Pose<World, Body> = pose("p", &turned(None, Some(std::f64::consts::FRAC_PI_2))).unwrap();
        assert!(quaternion.rotation.angle_between(yaw.rotation) < 1e-7);
        let error = |p: &PlainPose| pose::<World, Body>("p", p).unwrap_err();
        assert!(error(&turned(Some([0.0; 4]), None)).contains("unit quaternion"));
        assert!(error(&turned(Some([1.0, 0.0, 0.0, 0.0]), Some(0.0))).contains("found both"));
        assert!(error(&turned(None, Some(90.0))).contains("radians"));
        assert!(error(&PlainPose { translation_m: [1e300, 0.0, 0.0], ..turned(None, None) }).contains("translation_m"));
    }

    #[test]
    fn a_camera_without_a_rotation_looks_ahead() {
        let camera = mounting("c", &turned(None, None)).unwrap();
        assert!(camera.vector(DVec3::Z).distance(DVec3::X) < 1e-12, "it looks along x");
        assert!(camera.vector(DVec3::Y).distance(-DVec3::Z) < 1e-12, "down is down");
        let left = mounting("c", &turned(None, Some(std::f64::consts::FRAC_PI_2))).unwrap();
        assert!(left.vector(DVec3::Z).distance(DVec3::Y) < 1e-12);
    }
}
