//! The drive that every dataset's form is tested with.
//!
//! Six keyframes at 2 Hz, in Pittsburgh, through a bend and up a slope; two cameras that fire before and after the
//! keyframe; four tracks of different kinds at constant velocities; one LiDAR sweep on a regular grid of beams at a keyframe and
//! one between two; and the vehicle's pose twenty times a second. Boxes are
//! upright in Ego, which is all that KITTI and Waymo can say of their orientation. A test changes what its dataset cannot
//! say before it compares.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DQuat, DVec2, DVec3, EulerRot};
use trove_model::{
    Camera, Cuboid, Distortion, Drive, DriveOrigin, Ego, EgoBody, Exposure, Keyframe, Kind, Lens, LidarSweep,
    MapProjection, ObjectBox, Pose, RigCamera, SensorFrame, Sweep, Track, Trajectory, World,
};

/// Where World's origin lies.
pub(crate) const LAT_DEG: f64 = 40.4418;
pub(crate) const LON_DEG: f64 = -80.0129;
/// The first keyframe, nanoseconds since 1970 UTC.
pub(crate) const START_NS: i64 = 1_600_000_000_500_000_000;
/// From one keyframe to the next.
pub(crate) const PERIOD_NS: i64 = 500_000_000;
/// The keyframe with a LiDAR sweep.
pub(crate) const SWEPT: usize = 2;
/// Between two poses of the path.
pub(crate) const STEP_NS: i64 = 50_000_000;
/// The pose of the path with a LiDAR sweep between keyframes.
pub(crate) const SWEPT_BETWEEN: i64 = 26;
/// Beams, and columns of a revolution: azimuths fall from π (backwards) in equal steps, the first by half a step.
pub(crate) const INCLINATIONS_RAD: [f64; 4] = [-0.35, -0.25, -0.15, -0.1];
pub(crate) const COLUMNS: usize = 90;

const SPEED_MPS: f64 = 8.0;
const RADIUS_M: f64 = 40.0;
const SLOPE: f64 = 0.06;
const SIDE_TILT_RAD: f64 = 0.012;

/// The vehicle so many seconds after the first keyframe: a left bend, uphill.
fn world_from_ego(time_s: f64) -> Pose<World, Ego> {
    let (start_rad, turned_rad) = (0.7, SPEED_MPS * time_s / RADIUS_M);
    let yaw_rad: f64 = start_rad + turned_rad;
    let centre = DVec2::new(3.25, -4.5) + RADIUS_M * DVec2::new(-start_rad.sin(), start_rad.cos());
    let position = centre + RADIUS_M * DVec2::new(yaw_rad.sin(), -yaw_rad.cos());
    let rotation = DQuat::from_euler(EulerRot::ZYX, yaw_rad, -SLOPE.atan(), SIDE_TILT_RAD);
    Pose::new(rotation, position.extend(SLOPE * SPEED_MPS * time_s + 0.5))
}

/// Where the LiDAR is mounted.
pub(crate) fn ego_from_lidar() -> Pose<Ego, SensorFrame> {
    Pose::from_yaw(0.02, DVec3::new(0.9, 0.0, 1.85))
}

/// The grid of beams on the ground that the vehicle stands on, beam by beam, in the LiDAR's own axes.
pub(crate) fn points_sensor() -> Vec<DVec3> {
    let height_m = ego_from_lidar().translation.z;
    let point = |inclination: f64, column: usize| {
        let azimuth = PI - (column as f64 + 0.5) / COLUMNS as f64 * TAU;
        let flat_m = height_m / -inclination.tan();
        DVec3::new(flat_m * azimuth.cos(), flat_m * azimuth.sin(), -height_m)
    };
    INCLINATIONS_RAD.iter().flat_map(|&i| (0..COLUMNS).map(move |c| point(i, c))).collect()
}

/// A pinhole that looks ahead, and a distorted camera that looks to the left and a little down.
fn rig() -> Vec<RigCamera> {
    let looking = |yaw_rad: f64, pitch_rad: f64| {
        let forward = DQuat::from_mat3(&DMat3::from_cols(-DVec3::Y, -DVec3::Z, DVec3::X));
        DQuat::from_rotation_z(yaw_rad) * DQuat::from_rotation_y(pitch_rad) * forward
    };
    let camera = |name: &str, lens, rotation, position| RigCamera {
        name: name.to_owned(),
        lens,
        ego_from_camera: Pose::<Ego, Camera>::new(rotation, position),
    };
    let (width_px, height_px) = (1600, 900);
    let pinhole = Lens {
        width_px,
        height_px,
        fx_px: 1266.4,
        fy_px: 1262.1,
        cx_px: 816.3,
        cy_px: 441.5,
        distortion: Distortion::None,
    };
    let distortion = Distortion::brown_conrady(&[-0.2636, -0.05866, 0.0004, -0.0007, 0.0944]).unwrap();
    let distorted =
        Lens { width_px: 1024, height_px: 775, fx_px: 841.7, fy_px: 841.7, cx_px: 512.7, cy_px: 388.0, distortion };
    vec![
        camera("CAM_FRONT", pinhole, looking(0.0, 0.0), DVec3::new(1.7, 0.02, 1.51)),
        camera("CAM_LEFT", distorted, looking(1.2, 0.1), DVec3::new(1.4, 0.48, 1.55)),
    ]
}

/// Kind, category, position at the first keyframe (in Ego then), yaw in Ego then, size, velocity in World.
fn objects() -> [(Kind, &'static str, DVec3, f64, DVec3, DVec3); 4] {
    [
        (Kind::Car, "car", DVec3::new(18.0, -1.5, 0.8), 0.0, DVec3::new(4.5, 1.9, 1.6), DVec3::new(5.0, 4.0, 0.3)),
        (Kind::Adult, "adult", DVec3::new(12.0, 6.0, 0.9), 2.4, DVec3::new(0.6, 0.7, 1.75), DVec3::new(-0.9, 0.8, 0.0)),
        (
            Kind::BicycleWithRider,
            "cyclist",
            DVec3::new(9.0, 3.0, 0.85),
            0.1,
            DVec3::new(1.8, 0.6, 1.7),
            DVec3::new(3.0, 3.5, 0.25),
        ),
        (Kind::Truck, "truck", DVec3::new(25.0, -6.0, 1.7), 0.3, DVec3::new(8.2, 2.5, 3.4), DVec3::ZERO),
    ]
}

/// The drive.
pub(crate) fn drive() -> Drive {
    let rig = rig();
    let mut tracks: Vec<Track> = objects()
        .iter()
        .enumerate()
        .map(|(i, object)| Track { token: format!("track-{i}"), kind: object.0, boxes: Vec::new() })
        .collect();
    let keyframes = (0..6).map(|k| keyframe(k, &rig, &mut tracks)).collect();
    Drive {
        id: "canonical".into(),
        dataset: "canonical".into(),
        origin: DriveOrigin::Recorded,
        place: String::new(),
        projection: MapProjection::ellipsoidal(LAT_DEG, LON_DEG, DVec2::ZERO),
        is_georeferenced: true,
        rig,
        ego_body: EgoBody { centre_ego: DVec3::new(1.35, 0.0, 0.75), size_m: DVec3::new(4.6, 1.8, 1.5) },
        keyframes,
        path: Trajectory::new((0..=50).map(on_path).collect()).0,
        lidars: Vec::new(),
        sweeps: vec![Sweep { time_ns: on_path(SWEPT_BETWEEN).0, lidar: sweep(&on_path(SWEPT_BETWEEN).1) }],
        tracks,
        lane_map: None,
        licence: "CC0".into(),
    }
}

fn on_path(i: i64) -> (i64, Pose<World, Ego>) {
    (START_NS + i * STEP_NS, world_from_ego((i * STEP_NS) as f64 * 1e-9))
}

fn sweep(world_from_ego: &Pose<World, Ego>) -> LidarSweep {
    let world_from_sensor = *world_from_ego * ego_from_lidar();
    LidarSweep {
        origin_world: world_from_sensor.translation,
        points_world: points_sensor().into_iter().map(|p| world_from_sensor.point(p).as_vec3()).collect(),
        classes: Vec::new(),
    }
}

/// A drive of which no more is known than its keyframes.
pub(crate) fn without_between(mut drive: Drive) -> Drive {
    drive.path = Trajectory::default();
    drive.sweeps.clear();
    drive
}

fn keyframe(k: usize, rig: &[RigCamera], tracks: &mut [Track]) -> Keyframe {
    let time_s = k as f64 * 0.5;
    let time_ns = START_NS + k as i64 * PERIOD_NS;
    let ego = world_from_ego(time_s);
    let exposure = |(camera, fixed): (usize, &RigCamera)| {
        let late_ms = [-10, 15][camera];
        Exposure {
            camera,
            time_ns: time_ns + late_ms * 1_000_000,
            world_from_ego: world_from_ego(time_s + late_ms as f64 * 1e-3),
            lens: fixed.lens,
            ego_from_camera: fixed.ego_from_camera,
            token: Some(format!("{}-{k}", fixed.name)),
            file: None,
        }
    };
    let boxes = objects().into_iter().zip(tracks).enumerate().map(|(i, (object, track))| {
        let (kind, category, start_ego, yaw_rad, size_m, velocity_mps) = object;
        let start = world_from_ego(0.0);
        let centre = start.point(start_ego) + velocity_mps * time_s;
        // Upright in Ego, at a heading in World that does not change.
        let ahead = ego.inverse().vector(start.vector(DVec3::new(yaw_rad.cos(), yaw_rad.sin(), 0.0)));
        let upright = DQuat::from_rotation_z(ahead.y.atan2(ahead.x));
        let cuboid = Cuboid { world_from_body: Pose::new(ego.rotation * upright, centre), size_m };
        track.boxes.push((k, cuboid));
        ObjectBox {
            track: i,
            kind,
            category: category.to_owned(),
            token: format!("box-{k}-{i}"),
            cuboid,
            velocity_mps: Some(velocity_mps),
            is_parked: None,
            attributes: Vec::new(),
            lidar_points: Some(10 * i as u32),
            visibility: None,
        }
    });
    let boxes = boxes.collect();
    let lidar = (k == SWEPT).then(|| sweep(&ego));
    let exposures = rig.iter().enumerate().map(exposure).collect();
    Keyframe { time_ns, token: format!("keyframe-{k}"), world_from_ego: ego, exposures, boxes, lidar }
}

/// The same drive with its cameras called otherwise, in the order of the new names.
pub(crate) fn with_cameras(mut drive: Drive, names: [&str; 2]) -> Drive {
    drive.rig.iter_mut().zip(names).for_each(|(camera, name)| camera.name = name.to_owned());
    if names[0] > names[1] {
        drive.rig.reverse();
        for exposures in drive.keyframes.iter_mut().map(|k| &mut k.exposures) {
            exposures.reverse();
            exposures.iter_mut().enumerate().for_each(|(i, exposure)| exposure.camera = i);
        }
    }
    drive
}

#[test]
fn cameras_with_other_names_stand_in_the_order_of_these() {
    let named = with_cameras(drive(), ["b", "a"]);
    assert_eq!(named.rig.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
    assert!(named.rig[0].lens == drive().rig[1].lens && named.keyframes[0].exposures[0].lens == named.rig[0].lens);
    assert_eq!(with_cameras(drive(), ["CAM_FRONT", "CAM_LEFT"]), drive());
}
