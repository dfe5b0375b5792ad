//! KITTI: the canonical drive as a raw recording (synced and extracted), a tracking sequence and object frames.

mod bad_input;
mod writer;

use std::path::Path;

use glam::DVec3;
use trove_model::{Distortion, Drive, Pose, Report};
use trove_read::drive_source::DriveSource;
use trove_read::kitti::Kitti;

use crate::canonical;
use crate::comparison::{TIGHT, Tolerances, differences};

/// The first frame of a benchmark, which has no times, and from one to the next.
const START_NS: i64 = 1_317_034_800_000_000_000;
const FRAME_NS: i64 = 100_000_000;

/// With cameras of numbers.
fn whole() -> Drive {
    canonical::with_cameras(canonical::drive(), ["image_00", "image_01"])
}

/// Extracted recordings have all but boxes, which are numbered by synced frames.
fn extracted() -> Drive {
    let mut drive = whole();
    drive.sweeps.clear();
    drive.tracks.clear();
    drive.keyframes.iter_mut().for_each(|k| k.boxes.clear());
    drive
}

/// Rectified cameras look the same way, and share the vehicle's pose with the frame.
fn synced() -> Drive {
    let mut drive = canonical::without_between(whole());
    let rotation = drive.rig[0].ego_from_camera.rotation;
    for camera in &mut drive.rig {
        camera.ego_from_camera.rotation = rotation;
        camera.lens.distortion = Distortion::None;
    }
    for keyframe in &mut drive.keyframes {
        for exposure in &mut keyframe.exposures {
            exposure.world_from_ego = keyframe.world_from_ego;
            exposure.ego_from_camera.rotation = rotation;
            exposure.lens.distortion = Distortion::None;
        }
    }
    drive
}

/// As a synced one, ten frames a second from a time that is guessed.
fn tracking() -> Drive {
    let mut drive = synced();
    for (keyframe, k) in drive.keyframes.iter_mut().zip(0..) {
        keyframe.time_ns = START_NS + k * FRAME_NS;
        keyframe.exposures.iter_mut().for_each(|e| e.time_ns = keyframe.time_ns);
        let faster = canonical::PERIOD_NS as f64 / FRAME_NS as f64;
        keyframe.boxes.iter_mut().for_each(|b| b.velocity_mps = b.velocity_mps.map(|v| v * faster));
    }
    drive
}

/// One keyframe, where World is its Ego.
fn object(keyframe: usize) -> Drive {
    let mut drive = tracking();
    drive.is_georeferenced = false;
    let mut alone = drive.keyframes.swap_remove(keyframe);
    let ego_from_world = alone.world_from_ego.inverse();
    alone.time_ns = START_NS;
    alone.world_from_ego = Pose::IDENTITY;
    for exposure in &mut alone.exposures {
        (exposure.time_ns, exposure.world_from_ego) = (START_NS, Pose::IDENTITY);
    }
    for (track, object) in alone.boxes.iter_mut().enumerate() {
        let in_ego = ego_from_world.rotation * object.cuboid.world_from_body.rotation;
        let centre = ego_from_world.point(object.cuboid.world_from_body.translation);
        object.cuboid.world_from_body = Pose::new(in_ego, centre);
        object.velocity_mps = None;
        drive.tracks[track].boxes = vec![(0, object.cuboid)];
    }
    if let Some(sweep) = &mut alone.lidar {
        sweep.origin_world = ego_from_world.point(sweep.origin_world);
        sweep.points_world.iter_mut().for_each(|p| *p = ego_from_world.point(p.as_dvec3()).as_vec3());
    }
    drive.keyframes = vec![alone];
    drive
}

fn read(root: &Path, name: &str, report: &Report) -> Drive {
    Kitti::open(root, None).unwrap().read(name, report).unwrap()
}

fn check(write: impl FnOnce(&Path), expected: &Drive, name: &str) -> Report {
    let (root, report) = (tempfile::tempdir().unwrap(), Report::default());
    write(root.path());
    let drive = read(root.path(), name, &report);
    assert_eq!(differences(expected, &drive, &TIGHT), [""; 0], "{name}");
    assert_eq!((drive.dataset.as_str(), drive.id.as_str()), ("kitti", name));
    let listed = Kitti::open(root.path(), None).unwrap().drives();
    assert!(listed.iter().any(|d| d.name == name && d.keyframes == drive.keyframes.len()), "{listed:?}");
    // What is listed as read is there.
    let files = Kitti::open(root.path(), None).unwrap().recording(name).unwrap();
    assert!(files.len() > 3 && files.iter().all(|file| file.is_file()));
    report
}

#[test]
fn a_synced_recording_comes_back() {
    let report = check(|root| writer::raw(&synced(), root, true), &synced(), writer::SYNCED);
    assert!(report.entries().is_empty(), "{:?}", report.entries());
}

#[test]
fn an_extracted_recording_comes_back_with_its_cameras_own_lenses_times_and_poses() {
    let report = check(|root| writer::raw(&whole(), root, false), &extracted(), writer::EXTRACTED);
    assert!(report.entries().is_empty(), "{:?}", report.entries());
}

#[test]
fn a_tracking_sequence_comes_back() {
    let report = check(|root| writer::tracking(&synced(), root), &tracking(), "0003");
    let said: Vec<_> = report.entries().into_iter().map(|e| e.what).collect();
    assert_eq!(
        said,
        ["KITTI DontCare region, which is no object", "time of a KITTI benchmark's frames, which have none"]
    );
}

#[test]
fn object_frames_come_back_each_as_a_drive_of_its_own() {
    for k in 0..6 {
        check(|root| writer::object(&synced(), root), &object(k), &format!("{k:06}"));
    }
}

#[test]
fn truncation_and_occlusion_are_kept_as_the_annotators_had_them() {
    let root = tempfile::tempdir().unwrap();
    writer::tracking(&synced(), root.path());
    let drive = read(root.path(), "0003", &Report::default());
    let boxes = &drive.keyframes[0].boxes;
    let kept: Vec<_> = boxes.iter().map(|b| (b.category.as_str(), b.attributes.join(" "), b.visibility)).collect();
    let expected = [
        ("Car", "truncation=0 occlusion=0", Some(1.0)),
        ("Pedestrian", "truncation=1 occlusion=1", Some(0.75)),
        ("Cyclist", "truncation=0 occlusion=2", Some(0.25)),
        ("Truck", "truncation=1 occlusion=3", None),
    ];
    assert_eq!(kept, expected.map(|(category, attributes, visible)| (category, attributes.to_owned(), visible)));
}

#[test]
fn a_height_that_drifts_is_levelled_by_what_stands() {
    let root = tempfile::tempdir().unwrap();
    // The GPS rises by a decimetre a second while some trucks stand.
    let drift_m = |k: usize| 0.05 * k as f64;
    let mut drifting = synced();
    for row in 1..6 {
        let beside = DVec3::new(-3.0, 4.0, 0.0) * f64::from(row);
        let mut track = drifting.tracks[3].clone();
        track.boxes.iter_mut().for_each(|(_, cuboid)| cuboid.world_from_body.translation += beside);
        drifting.tracks.push(track);
    }
    for (k, keyframe) in drifting.keyframes.iter_mut().enumerate() {
        keyframe.world_from_ego.translation.z += drift_m(k);
    }
    for (k, cuboid) in drifting.tracks.iter_mut().flat_map(|track| &mut track.boxes) {
        cuboid.world_from_body.translation.z += drift_m(*k);
    }
    writer::raw(&drifting, root.path(), true);
    let report = Report::default();
    let drive = read(root.path(), writer::SYNCED, &report);
    let position =
        |d: &Drive, k: usize| d.keyframes[k].world_from_ego.translation - d.keyframes[0].world_from_ego.translation;
    let error_m = (1..6).map(|k| (position(&drive, k) - position(&synced(), k)).z.abs()).fold(0.0, f64::max);
    assert!(error_m < 0.05, "{error_m} m of {} m", drift_m(5));
    let measured: Vec<_> = report.measurements().into_iter().map(|m| (m.name, m.value)).collect();
    assert!(measured[0].1 < 0.3 * measured[1].1, "{measured:?}");
}

#[test]
fn of_ten_sweeps_a_second_two_are_read() {
    let root = tempfile::tempdir().unwrap();
    writer::tracking(&synced(), root.path());
    for k in 0..6 {
        writer::sweep(root.path(), &format!("training/velodyne/0003/{k:06}.bin"));
    }
    let report = Report::default();
    let drive = read(root.path(), "0003", &report);
    let swept: Vec<usize> = (0..6).filter(|&k| drive.keyframes[k].lidar.is_some()).collect();
    assert_eq!(swept, [0, 5]);
    assert!(report.entries().iter().any(|e| e.what.contains("closer in time") && e.examples == ["2 of 6 are read"]));
}

#[test]
fn pictures_of_kitti_step_stand_in_for_trackings() {
    let root = tempfile::tempdir().unwrap();
    writer::tracking(&synced(), root.path());
    writer::picture(root.path(), "images/val/0003/000002.png", [1600, 900]);
    let drive = read(root.path(), "0003", &Report::default());
    assert!(
        drive.keyframes.iter().flat_map(|k| &k.exposures).all(|e| !e.file.as_deref().unwrap_or("").contains("images/"))
    );
    // Of the left colour camera alone, which the canonical drive does not have.
    let calibration = root.path().join("training/calib/0003.txt");
    let text = std::fs::read_to_string(&calibration).unwrap().replace("P0:", "P2:");
    std::fs::write(&calibration, text).unwrap();
    let drive = read(root.path(), "0003", &Report::default());
    let camera = drive.rig.iter().position(|c| c.name == "image_02").unwrap();
    let file = |k: usize| drive.keyframes[k].exposures.iter().find(|e| e.camera == camera).unwrap().file.clone();
    assert_eq!((file(1), file(2)), (None, Some("images/val/0003/000002.png".to_owned())));
}

/// A looser comparison finds nothing that the tight one does not: the writer's numbers are whole.
#[test]
fn a_changed_fix_is_found() {
    let root = tempfile::tempdir().unwrap();
    let mut moved = synced();
    moved.keyframes[4].world_from_ego.translation += DVec3::new(0.004, 0.0, 0.0);
    writer::raw(&moved, root.path(), true);
    let drive = read(root.path(), writer::SYNCED, &Report::default());
    let loose = Tolerances { position_m: 0.003, ..TIGHT };
    let told = differences(&synced(), &drive, &loose);
    assert!(told.iter().any(|line| line.starts_with("keyframe 4: vehicle: 0.004")), "{told:#?}");
}
