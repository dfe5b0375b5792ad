//! Calibrations and pictures → lenses, mountings and exposures.

use glam::{DQuat, DVec3};
use trove_model::{Camera, Distortion, Ego, Exposure, Lens, Outcome, Pose, Report, RigCamera, World};

use super::poses;
use super::records::{CameraRecord, FrameRecord, GlobalFromEgo, PictureRecord, Segment};
use super::vocabulary;

/// No image has a longer side, pixels.
const LARGEST_IMAGE_PX: i64 = 65_535;
/// A picture's pose is carried to the middle of its exposure over at most this, seconds.
const LONGEST_CARRY_S: f64 = 0.2;

/// Waymo's numbers and our rig, in the order of the cameras' names.
pub(super) fn rig(segment: &Segment, report: &Report) -> Vec<(i64, RigCamera)> {
    let mut rig = Vec::new();
    for (&number, record) in &segment.cameras {
        match camera(number, record) {
            Ok(camera) => rig.push((number, camera)),
            Err(why) => report.note(Outcome::Dropped, &format!("Waymo camera: {why}"), number),
        }
    }
    rig.sort_by(|(_, a), (_, b)| a.name.cmp(&b.name));
    rig
}

fn camera(number: i64, record: &CameraRecord) -> Result<RigCamera, &'static str> {
    let name = vocabulary::camera_name(number).ok_or("unknown number")?.to_owned();
    let ego_from_camera: Pose<Ego, Camera> =
        poses::ego_from_camera(&record.vehicle_from_camera).ok_or("calibration without a valid pose")?;
    Ok(RigCamera { name, lens: lens(record)?, ego_from_camera })
}

fn lens(record: &CameraRecord) -> Result<Lens, &'static str> {
    let side = |px: i64| (1..=LARGEST_IMAGE_PX).contains(&px).then_some(px as u32);
    let (Some(width_px), Some(height_px)) = (side(record.width), side(record.height)) else {
        return Err("image of no size");
    };
    // The order is OpenCV's: k1, k2, p1, p2, k3. Pixel 0 begins at the image's edge, so centres are at .5.
    let [fx_px, fy_px, cx_px, cy_px, coefficients @ ..] = record.intrinsics;
    let is_focal = |f: f64| f > 0.0 && f < 1e6;
    if !(is_focal(fx_px) && is_focal(fy_px) && cx_px.abs() < 1e6 && cy_px.abs() < 1e6) {
        return Err("no usable intrinsics");
    }
    let distortion = if coefficients == [0.0; 5] {
        Distortion::None
    } else {
        Distortion::brown_conrady(&coefficients).ok_or("no usable distortion")?
    };
    Ok(Lens { width_px, height_px, fx_px, fy_px, cx_px, cy_px, distortion })
}

/// A frame's pictures in the rig's order, in World. A camera that took none has no exposure.
pub(super) fn exposures(
    frame: &FrameRecord,
    rig: &[(i64, RigCamera)],
    world_pose: impl Fn(GlobalFromEgo) -> Pose<World, Ego>,
    report: &Report,
) -> Vec<Exposure> {
    let exposure = |(camera, (number, mounted)): (usize, &(i64, RigCamera))| {
        let mut pictures = frame.pictures.iter().filter(|picture| picture.camera == *number);
        let picture = pictures.next()?;
        let token = format!("{}-{}", frame.time_us, mounted.name);
        if pictures.next().is_some() {
            report.note(Outcome::Dropped, "Waymo picture: second of its camera in a frame", &token);
        }
        let (time_ns, global_from_ego) = taken(picture).or_else(|| {
            report.note(Outcome::Dropped, "Waymo picture without a usable pose or time", &token);
            None
        })?;
        Some(Exposure {
            camera,
            time_ns,
            world_from_ego: world_pose(global_from_ego),
            lens: mounted.lens,
            ego_from_camera: mounted.ego_from_camera,
            token: Some(token),
            file: None, // pictures lie inside the segment's file
        })
    };
    rig.iter().enumerate().filter_map(exposure).collect()
}

/// The middle of the exposure, which is when the middle row or column was exposed, and the vehicle then.
fn taken(picture: &PictureRecord) -> Option<(i64, GlobalFromEgo)> {
    let pose: GlobalFromEgo = poses::pose(&picture.global_from_vehicle)?;
    let middle_s = picture.trigger_s.midpoint(picture.readout_done_s);
    let carry_s = middle_s - picture.pose_s;
    let is_moving = picture.velocity_mps.is_finite() && picture.turning_rad_s.is_finite();
    let (time_s, pose) = if is_moving && carry_s.abs() <= LONGEST_CARRY_S {
        (middle_s, carried(&pose, picture.velocity_mps, picture.turning_rad_s, carry_s))
    } else {
        (picture.pose_s, pose)
    };
    // Seconds since 1970 as a double are good to a quarter of a microsecond.
    (time_s.abs() < 1e10).then(|| ((time_s * 1e6).round() as i64 * 1000, pose))
}

/// A pose some seconds later: r + v·dt, exp(W·dt)·R, as `dataset.proto` has it.
fn carried(pose: &GlobalFromEgo, velocity_mps: DVec3, turning_rad_s: DVec3, seconds: f64) -> GlobalFromEgo {
    let turn = DQuat::from_scaled_axis(turning_rad_s * seconds);
    Pose::new(turn * pose.rotation, pose.translation + velocity_mps * seconds)
}
