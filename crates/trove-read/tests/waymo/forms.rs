//! What both forms hold, on a small segment.

use std::path::Path;

use glam::{DVec2, DVec3};
use trove_model::{Drive, Kind, Outcome, Report};
use trove_read::ReadError;
use trove_read::waymo::Waymo;

use crate::parquet_writer::Packing;
use crate::waymo_writer::{Label, Message, Segment, put};

/// Opens a folder and reads its only segment.
pub(crate) fn load(root: &Path, report: &Report) -> Result<Drive, ReadError> {
    let waymo = Waymo::open(root, 1, report)?;
    waymo.drive(&waymo.segments()[0].name, report)
}

/// What was noted, without the outcomes' examples.
pub(crate) fn notes(report: &Report) -> Vec<(Outcome, String, u64)> {
    report.entries().into_iter().map(|e| (e.outcome, e.what, e.count)).collect()
}

#[test]
fn pages_may_be_packed_in_any_way_that_pyarrow_offers_by_default() {
    let segment = Segment::small();
    let read = |packing| {
        let (root, report) = (tempfile::tempdir().unwrap(), Report::default());
        for (component, bytes) in segment.v2(packing) {
            put(root.path(), &format!("{component}/small.parquet"), &bytes);
        }
        load(root.path(), &report).unwrap()
    };
    let plain = read(Packing::None);
    assert!(plain.keyframes.len() == 3 && plain.keyframes[2].lidar.as_ref().unwrap().points_world.len() == 8);
    for packing in [Packing::Snappy, Packing::Gzip, Packing::Zstd] {
        assert_eq!(read(packing), plain, "{packing:?}");
    }
}

#[test]
fn both_forms_are_the_same_drive() {
    let root = tempfile::tempdir().unwrap();
    Segment::small().write(root.path());
    let read = |form: &str| load(&root.path().join(form), &Report::default()).unwrap();
    let drive = read("v1");
    assert_eq!(drive, read("v2"));
    assert_eq!((drive.id.as_str(), drive.dataset.as_str(), drive.place.as_str()), ("small", "waymo", "location_phx"));
    assert!(!drive.is_georeferenced && (drive.projection.geo_from_world(DVec2::ZERO).0 - 33.4).abs() < 0.1);
    assert_eq!((drive.tracks.len(), drive.tracks[0].kind), (1, Kind::Car));
    assert_eq!(drive.keyframes[0].boxes[0].lidar_points, Some(40));
    assert!(drive.licence.contains("Waymo Dataset License Agreement for Non-Commercial Use"));
}

#[test]
fn a_pictures_pose_is_that_of_the_middle_of_its_exposure() {
    let mut segment = Segment::small();
    let picture = &mut segment.frames[0].pictures[0];
    (picture.pose_s, picture.velocity, picture.turning) = (1_600_000_000.05, [10.0, 2.0, 0.0], [0.0, 0.0, 0.5]);
    let root = tempfile::tempdir().unwrap();
    segment.write(root.path());
    for form in ["v1", "v2"] {
        let drive = load(&root.path().join(form), &Report::default()).unwrap();
        let exposure = &drive.keyframes[0].exposures[0];
        assert!((exposure.time_ns - 1_600_000_000_020_000_000).abs() < 1000, "{form}");
        // 30 ms before its pose was taken.
        let expected = DVec3::new(-0.3, -0.06, 0.0);
        assert!((exposure.world_from_ego.translation - expected).length() < 1e-5, "{form} {exposure:?}");
        assert!((exposure.world_from_ego.yaw_rad() + 0.015).abs() < 1e-6, "{form}");
        assert!(exposure.token.is_some() && exposure.file.is_none());
    }
}

#[test]
fn the_lidar_is_read_of_every_so_many_frames() {
    let root = tempfile::tempdir().unwrap();
    Segment::small().write(root.path());
    for form in ["v1", "v2"] {
        let report = Report::default();
        let drive = Waymo::open(&root.path().join(form), 2, &report).unwrap().drive("small", &report).unwrap();
        let swept: Vec<_> = drive.keyframes.iter().map(|k| k.lidar.is_some()).collect();
        assert_eq!(swept, [true, false, true], "{form}");
    }
}

#[test]
fn the_map_of_the_first_frame_is_the_drives() {
    let point = |x: f64, y: f64| Message::default().double(1, x).double(2, y).double(3, 7.0);
    let line = |field: u32, y: f64| {
        (0..20).fold(Message::default(), |line, i| line.message(field, point(100.0 + f64::from(i), y)))
    };
    let feature = |id: i64, field: u32, form: Message| Message::default().varint(1, id).message(field, form).0;
    let square = [(110.0, -2.0), (113.0, -2.0), (113.0, 2.0), (110.0, 2.0)];
    let crosswalk = square.iter().fold(Message::default(), |area, (x, y)| area.message(1, point(*x, *y)));
    let mut segment = Segment::small();
    segment.map = vec![
        feature(1, 3, line(8, 0.0).varint(2, 2)),
        feature(2, 4, line(2, 1.6).varint(1, 7)),
        feature(3, 5, line(2, -4.0).varint(1, 1)),
        feature(4, 8, crosswalk),
        feature(5, 7, Message::default()),
    ];
    let root = tempfile::tempdir().unwrap();
    segment.write(root.path());
    let report = Report::default();
    let map = load(&root.path().join("v1"), &report).unwrap().lane_map.unwrap();
    assert_eq!((map.lanes.len(), map.crossings.len(), map.road_dividers.len(), map.drivable.len()), (1, 1, 1, 1));
    // World begins at the first vehicle.
    assert!(map.lanes[0].centreline[0].length() < 1e-9 && map.lanes[0].polygon.contains(DVec2::new(5.0, 1.5)));
    assert!(map.drivable[0].contains(DVec2::new(5.0, -3.9)) && map.crossings[0].contains(DVec2::new(11.0, 0.0)));
    let dropped = (Outcome::Dropped, "Waymo map feature that is not used".to_owned(), 1);
    assert!(notes(&report).contains(&dropped), "{:?}", report.entries());
}

#[test]
fn a_sign_gets_a_pole_and_one_high_above_the_road_is_left_out() {
    let mut segment = Segment::small();
    let sign = |id: &str, z: f64| Label {
        id: id.into(),
        kind: 3,
        centre: [10.0, -4.0, z],
        size: [0.1, 0.6, 0.8],
        ..Segment::small().frames[0].labels[0].clone()
    };
    segment.frames[0].labels = vec![sign("low", 2.2), sign("high", 6.0)];
    let (root, report) = (tempfile::tempdir().unwrap(), Report::default());
    put(root.path(), "a.tfrecord", &segment.v1());
    let drive = load(root.path(), &report).unwrap();
    let boxes = &drive.keyframes[0].boxes;
    assert_eq!((boxes.len(), boxes[0].kind), (1, Kind::TrafficSign));
    assert!((boxes[0].cuboid.size_m.z - 2.6).abs() < 1e-9);
    assert!((boxes[0].cuboid.world_from_body.translation.z - 1.3).abs() < 1e-9);
    assert_eq!(notes(&report).len(), 2, "{:?}", report.entries());
}
