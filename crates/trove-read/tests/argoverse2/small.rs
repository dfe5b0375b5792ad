//! What a small log becomes.

use arrow_ipc::CompressionType;
use glam::{DVec2, DVec3};
use trove_model::{Kind, MarkPattern, Paint, Report};
use trove_read::DATASETS;
use trove_read::argoverse2::Argoverse2;

use super::fixture::{ANNOTATIONS, LOG, Log, START_NS, SWEEP, feather, load, put};

#[test]
fn a_log_is_joined_from_its_files() {
    let (root, report) = (Log::small().write(), Report::default());
    put(root.path(), &format!("sensors/cameras/ring_rear_left/{}.jpg", START_NS + 20_000_000), b"");
    let drive = load(root.path(), &report).unwrap();
    assert_eq!((drive.id.as_str(), drive.place.as_str(), drive.is_georeferenced), (LOG, "PIT", true));
    assert_eq!((drive.keyframes.len(), drive.tracks.len(), drive.rig.len()), (3, 2, 2));
    assert_eq!(drive.keyframes[0].token, START_NS.to_string());
    // The vehicle stands on the ground, a wheel's radius below its axle.
    let ego = drive.keyframes[0].world_from_ego;
    assert!((ego.translation.z + 0.325).abs() < 1e-9 && drive.rig[0].ego_from_camera.translation.z > 1.72);
    let front = &drive.keyframes[0].exposures[0];
    assert_eq!((front.time_ns, &front.token, &front.file), (drive.keyframes[0].time_ns, &None, &None));
    let rear = &drive.keyframes[0].exposures[1];
    assert_eq!(rear.time_ns - front.time_ns, 20_000_000);
    assert!(rear.file.as_ref().unwrap().starts_with(LOG) && root.path().join(rear.file.as_ref().unwrap()).is_file());
    assert!((rear.world_from_ego.translation.distance(ego.translation) - 0.4).abs() < 1e-3);
    // Where the axle's frame has it.
    let sweep = drive.keyframes[0].lidar.as_ref().unwrap();
    assert!(sweep.points_world.len() == 40 && drive.keyframes[1].lidar.is_none());
    let first_ego = ego.inverse().point(sweep.points_world[0].as_dvec3());
    assert!((first_ego - DVec3::new(-4.0, 0.0, 0.0)).length() < 1e-5, "{first_ego}");
    let origin_ego = ego.inverse().point(sweep.origin_world);
    assert!((origin_ego - DVec3::new(1.35, 0.0, 1.965)).length() < 1e-9);
    let [car, walker] = &drive.keyframes[1].boxes[..] else { panic!("two boxes") };
    assert_eq!((car.kind, walker.kind, car.lidar_points), (Kind::Car, Kind::Adult, Some(100)));
    // The car keeps its distance to the vehicle, which makes two metres in a tenth of a second.
    assert!((car.velocity_mps.unwrap().length() - 20.0).abs() < 0.02);
    assert_eq!(drive.licence, "CC BY-NC-SA 4.0, Argoverse 2 © Argo AI, LLC");
    let said: Vec<_> = report.entries().into_iter().map(|e| e.what).collect();
    assert_eq!(said.len(), 3, "{said:?}"); // hidden date, no pictures, a bicycle lane
}

#[test]
fn the_map_becomes_lanes_paint_and_ground() {
    let drive = load(Log::small().write().path(), &Report::default()).unwrap();
    let map = drive.lane_map.unwrap();
    assert_eq!((map.lanes.len(), map.drivable.len(), map.crossings.len()), (2, 1, 1));
    // Both lanes have the same left boundary, and the bicycle lane shares its own with the second.
    let marks: Vec<_> = map.marks.iter().map(|m| (m.paint, m.pattern)).collect();
    let expected = [
        (Paint::Yellow, MarkPattern::DoubleSolid),
        (Paint::White, MarkPattern::Dashed),
        (Paint::White, MarkPattern::Solid),
    ];
    assert_eq!(marks, expected);
    // The way of driving: the vehicle goes where the first lane does.
    let along = |i: usize| -> DVec2 { map.lanes[i].centreline[1] - map.lanes[i].centreline[0] };
    let driven = drive.keyframes[2].world_from_ego.translation - drive.keyframes[0].world_from_ego.translation;
    assert!(along(0).dot(driven.truncate()) > 0.0 && along(1).dot(driven.truncate()) < 0.0);
    assert!((map.crossings[0].area_m2() - 28.5).abs() < 0.1, "its edges do not cross");
    let ground = drive.keyframes[0].world_from_ego.translation.z;
    assert!(map.ground.len() > 100 && map.ground.iter().all(|p| (p.z - ground).abs() < 1e-4));
}

#[test]
fn a_root_is_known_by_its_logs_or_its_splits() {
    let dataset = DATASETS.iter().find(|d| d.name == "argoverse2").unwrap();
    let root = Log::small().write();
    assert!((dataset.is_at)(root.path()) && !(dataset.is_at)(&root.path().join(LOG)));
    let split = root.path().join("val");
    std::fs::create_dir(&split).unwrap();
    std::fs::rename(root.path().join(LOG), split.join(LOG)).unwrap();
    assert!((dataset.is_at)(root.path()) && (dataset.is_at)(&split));
    let source = (dataset.configure)(toml::Table::new()).unwrap()(root.path(), None, &Report::default()).unwrap();
    let [listing] = &source.drives()[..] else { panic!("one log") };
    assert_eq!((listing.name.as_str(), listing.keyframes), (LOG, 3));
    assert_eq!(source.recording(LOG).unwrap().len(), 8);
    assert!((dataset.configure)("version = 'v1'".parse().unwrap()).is_err());
}

#[test]
fn a_log_without_annotations_has_its_sweeps_as_keyframes() {
    let (root, report) = (Log::small().write(), Report::default());
    std::fs::remove_file(root.path().join(LOG).join(ANNOTATIONS)).unwrap();
    let drive = load(root.path(), &report).unwrap();
    assert_eq!((drive.keyframes.len(), drive.keyframes[0].boxes.len()), (1, 0));
    assert!(report.entries().iter().any(|e| e.what.contains("keyframes are its sweeps")));
}

#[test]
fn tables_packed_with_either_codec_are_the_same() {
    let log = Log::small();
    let drives = [CompressionType::LZ4_FRAME, CompressionType::ZSTD].map(|codec| {
        let root = log.write();
        put(root.path(), SWEEP, &feather(&log.tables[SWEEP], codec));
        load(root.path(), &Report::default()).unwrap()
    });
    assert_eq!(drives[0], drives[1]);
}

#[test]
fn a_wrong_name_is_answered_with_the_nearest() {
    let (root, report) = (Log::small().write(), Report::default());
    let dataset = Argoverse2::open(root.path(), &report).unwrap();
    let message = dataset.drive("0b5142c9", &report).unwrap_err().to_string();
    assert!(message.contains(LOG), "{message}");
    let message = Argoverse2::open(&root.path().join(LOG), &report).err().unwrap().to_string();
    assert!(message.contains("the logs or the splits"), "{message}");
}
