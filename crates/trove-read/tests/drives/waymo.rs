//! Waymo: the canonical drive as a TFRecord and as Parquet components.

use std::f64::consts::PI;

use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};
use trove_model::{Drive, Frame, LidarSweep, Pose, Report};
use trove_read::waymo::Waymo;

use crate::canonical::{self, COLUMNS, INCLINATIONS_RAD, SWEPT};
use crate::comparison::{TIGHT, differences};
use crate::waymo_writer as writer;

/// World's origin in the dataset's global frame.
const ANCHOR_M: DVec3 = DVec3::new(1200.0, -3400.0, 55.0);
/// How far the vehicle moves ahead from one column of a revolution to the next.
const STEP_M: f64 = 0.004;

fn matrix<D: Frame, S: Frame>(pose: &Pose<D, S>, offset: DVec3) -> [f64; 16] {
    let m = DAffine3::from_rotation_translation(pose.rotation, pose.translation + offset);
    let (x, y, z, t) = (m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis, m.translation);
    [x.x, y.x, z.x, t.x, x.y, y.y, z.y, t.y, x.z, y.z, z.z, t.z, 0.0, 0.0, 0.0, 1.0]
}

/// The LiDAR of the swept keyframe: rays cast onto the ground that the vehicle stands on, while it moves ahead. Ranges,
/// poses of the vehicle at each pixel, and where the rays end in World.
fn revolution(drive: &Drive) -> (writer::Scan, LidarSweep) {
    let (ego, mounting) = (drive.keyframes[SWEPT].world_from_ego, canonical::ego_from_lidar());
    let (mut ranges, mut poses, mut points_world) = (Vec::new(), Vec::new(), Vec::new());
    for inclination in INCLINATIONS_RAD.iter().rev() {
        for column in 0..COLUMNS {
            let azimuth = PI - (column as f64 + 0.5) / COLUMNS as f64 * 2.0 * PI - mounting.yaw_rad();
            let flat = inclination.cos();
            let direction = mounting.vector(DVec3::new(azimuth.cos() * flat, azimuth.sin() * flat, inclination.sin()));
            let moved = DVec3::X * STEP_M * (column as f64 - COLUMNS as f64 / 2.0);
            let origin = mounting.translation + moved;
            let range_m = -origin.z / direction.z;
            points_world.push(ego.point(origin + direction * range_m).as_vec3());
            ranges.extend([range_m as f32, 0.5, 0.0, 0.0]);
            let (yaw, pitch, roll) = ego.rotation.to_euler(EulerRot::ZYX);
            let at = ego.point(moved) + ANCHOR_M;
            poses.extend([roll, pitch, yaw, at.x, at.y, at.z].map(|v| v as f32));
        }
    }
    let image = |channels, values| writer::Image { shape: [INCLINATIONS_RAD.len(), COLUMNS, channels], values };
    let scan = writer::Scan { number: 1, first: image(4, ranges), poses: Some(image(6, poses)) };
    (scan, LidarSweep { origin_world: (ego * mounting).translation, points_world, classes: Vec::new() })
}

/// What Waymo can say of the drive, and the segment that says it.
fn sayable() -> (Drive, writer::Segment) {
    let mut drive = canonical::with_cameras(canonical::without_between(canonical::drive()), ["FRONT", "SIDE_LEFT"]);
    drive.is_georeferenced = false;
    let (scan, sweep) = revolution(&drive);
    drive.keyframes[SWEPT].lidar = Some(sweep);
    let numbers = [1, 4];
    let axes = DQuat::from_mat3(&DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X));
    let camera = |(camera, number): (&trove_model::RigCamera, i64)| {
        let lens = camera.lens;
        let distortion = lens.distortion.coefficients();
        let k = |i: usize| distortion.get(i).copied().unwrap_or(0.0);
        let mounted = camera.ego_from_camera;
        writer::Camera {
            number,
            intrinsics: [lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px, k(0), k(1), k(2), k(3), k(4)],
            extrinsic: matrix(
                &Pose::<trove_model::Ego, trove_model::Camera>::new(
                    mounted.rotation * axes.inverse(),
                    mounted.translation,
                ),
                DVec3::ZERO,
            ),
            size: [i64::from(lens.width_px), i64::from(lens.height_px)],
        }
    };
    let frame = |(k, moment): (usize, &trove_model::Keyframe)| {
        let picture = |exposure: &trove_model::Exposure| {
            let middle_s = exposure.time_ns as f64 * 1e-9;
            writer::Picture {
                camera: numbers[exposure.camera],
                pose: matrix(&exposure.world_from_ego, ANCHOR_M),
                pose_s: middle_s,
                trigger_s: middle_s - 0.02,
                readout_done_s: middle_s + 0.02,
                velocity: [0.0; 3],
                turning: [0.0; 3],
                jpeg: vec![0; 1000],
                panoptic: None,
            }
        };
        let label = |object: &trove_model::ObjectBox| {
            let body = moment.world_from_ego.inverse() * object.cuboid.world_from_body;
            writer::Label {
                id: format!("object-{}", object.track),
                kind: match object.category.as_str() {
                    "adult" => 2,
                    "cyclist" => 4,
                    _ => 1,
                },
                centre: body.translation.to_array(),
                size: object.cuboid.size_m.to_array(),
                heading: body.yaw_rad(),
                speed: object.velocity_mps.unwrap().to_array(),
                points: i64::from(object.lidar_points.unwrap()),
            }
        };
        writer::Frame {
            time_us: moment.time_ns / 1000,
            pose: matrix(&moment.world_from_ego, ANCHOR_M),
            pictures: moment.exposures.iter().map(picture).collect(),
            labels: moment.boxes.iter().map(label).collect(),
            scans: if k == SWEPT { vec![scan.clone()] } else { Vec::new() },
        }
    };
    let segment = writer::Segment {
        name: "canonical".into(),
        location: "location_sf".into(),
        cameras: drive.rig.iter().zip(numbers).map(camera).collect(),
        lasers: vec![writer::Laser {
            number: 1,
            inclinations: INCLINATIONS_RAD.to_vec(),
            extrinsic: matrix(&canonical::ego_from_lidar(), DVec3::ZERO),
        }],
        frames: drive.keyframes.iter().enumerate().map(frame).collect(),
        map: Vec::new(),
    };
    (drive, segment)
}

#[test]
fn waymo_gives_the_canonical_drive_back_in_both_forms() {
    let (drive, segment) = sayable();
    let root = tempfile::tempdir().unwrap();
    segment.write(root.path());
    for form in ["v1", "v2"] {
        let report = Report::default();
        let waymo = Waymo::open(&root.path().join(form), 1, &report).unwrap();
        assert_eq!((waymo.segments()[0].name.as_str(), waymo.segments()[0].keyframes), ("canonical", 6));
        let found = waymo.drive("canonical", &report).unwrap();
        assert_eq!(differences(&drive, &found, &TIGHT), [""; 0], "{form} {:?}", report.entries());
        assert!(report.entries().is_empty(), "{form} {:?}", report.entries());
        // The rays were cast onto a plane, so that is where their ends lie.
        let (ego, sweep) = (found.keyframes[SWEPT].world_from_ego.inverse(), found.keyframes[SWEPT].lidar.as_ref());
        let height_m = sweep.unwrap().points_world.iter().map(|p| ego.point(p.as_dvec3()).z.abs()).fold(0.0, f64::max);
        assert!(height_m < 1e-3, "{form}: {height_m}");
    }
}
