//! The real files in `TROVE_TEST_DATA`: a whole v1 frame, one with labels only, and two v2 components.

use std::collections::BTreeMap;
use std::path::PathBuf;

use glam::{DVec2, DVec3};
use trove_model::{Drive, Report};
use trove_read::waymo::Waymo;

fn open(folder: &str) -> Waymo {
    let data = std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA");
    Waymo::open(&PathBuf::from(data).join(folder), 1, &Report::default()).unwrap()
}

fn drive(folder: &str, name: &str) -> (Drive, Report) {
    let report = Report::default();
    let drive = open(folder).drive(name, &report).unwrap();
    (drive, report)
}

fn boxes_by_kind(drive: &Drive) -> BTreeMap<&'static str, usize> {
    let mut counts = BTreeMap::new();
    drive.keyframes.iter().flat_map(|k| &k.boxes).for_each(|b| *counts.entry(b.kind.name()).or_default() += 1);
    counts
}

/// Boxes of the frame with labels, all of which are used but for signs that hang high.
const LABELS: usize = 18;
const WHOLE: &str = "1024360143612057520_3580_000_3600_000";

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_the_whole_frame_is_read_without_a_complaint() {
    let names: Vec<_> = open("waymo").segments().into_iter().map(|s| (s.name, s.keyframes)).collect();
    let expected = [(WHOLE.to_owned(), 1), ("1071392229495085036_1844_790_1864_790".to_owned(), 1)];
    assert_eq!(names, expected);
    let (drive, report) = drive("waymo", WHOLE);
    // One sign is too high, and the others get poles.
    let told: Vec<_> = report.entries().into_iter().map(|e| (e.what, e.count)).collect();
    let expected = [
        ("Waymo label: sign high above the road, on what is not told".to_owned(), 1),
        ("pole of a Waymo sign, whose box is its panel's".to_owned(), 23),
    ];
    assert_eq!(told, expected);
    assert_eq!(drive.place, "location_sf");
    let names: Vec<_> = drive.rig.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["FRONT", "FRONT_LEFT", "FRONT_RIGHT", "SIDE_LEFT", "SIDE_RIGHT"]);
    assert_eq!(drive.keyframes[0].exposures.len(), 5);
    let counts = boxes_by_kind(&drive);
    let vehicles = ["car", "truck", "bus"].iter().filter_map(|kind| counts.get(kind)).sum::<usize>();
    assert_eq!((vehicles, counts["adult"], counts["traffic_sign"], counts["bicycle_with_rider"]), (37, 12, 24, 1));
    // The cameras look where their names say.
    let yaw_deg = |name: &str| {
        let camera = drive.rig.iter().find(|c| c.name == name).unwrap();
        let ahead = camera.ego_from_camera.vector(DVec3::Z);
        ahead.y.atan2(ahead.x).to_degrees()
    };
    for (name, expected) in [("FRONT", 0.0), ("FRONT_LEFT", 45.0), ("SIDE_LEFT", 90.0), ("SIDE_RIGHT", -90.0)] {
        assert!((yaw_deg(name) - expected).abs() < 3.0, "{name} {}", yaw_deg(name));
    }
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_speeds_are_along_the_headings_in_the_global_frame() {
    let (drive, _) = drive("waymo", WHOLE);
    let moving = drive.keyframes[0].boxes.iter().filter(|b| b.velocity_mps.is_some_and(|v| v.length() > 0.8));
    let ahead: Vec<f64> =
        moving.map(|b| b.cuboid.world_from_body.vector(DVec3::X).dot(b.velocity_mps.unwrap().normalize())).collect();
    assert!(ahead.len() > 8 && ahead.iter().all(|cos| *cos > 0.95), "{ahead:?}");
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_boxes_fall_where_the_dataset_projects_them() {
    // Frame.projected_lidar_labels of the front camera: of a bus and a pedestrian, centre and size as the file has them.
    let (drive, _) = drive("waymo", WHOLE);
    let keyframe = &drive.keyframes[0];
    let front = keyframe.exposures.iter().find(|e| drive.rig[e.camera].name == "FRONT").unwrap();
    let cases = [
        ("1AWbv02zSxVMDWy29bhytw", DVec2::new(1197.386, 614.823), DVec2::new(323.900, 139.855)),
        ("-zRacoa4APhIbgKYpgbiDQ", DVec2::new(474.276, 938.401), DVec2::new(296.034, 408.411)),
    ];
    for (id, centre, size) in cases {
        let object = keyframe.boxes.iter().find(|b| b.token.ends_with(id)).unwrap();
        let camera_from_world = front.world_from_camera().inverse();
        let corners = object.cuboid.corners_world().map(|c| front.lens.project_onto_rim(camera_from_world.point(c)));
        let low = corners.iter().copied().fold(DVec2::INFINITY, DVec2::min).max(DVec2::ZERO);
        let high = corners.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max).min(DVec2::new(1920.0, 1280.0));
        let (a, b) = (centre - size / 2.0, centre + size / 2.0);
        let shared = (high.min(b) - low.max(a)).max(DVec2::ZERO);
        let union = (high - low).element_product() + size.element_product() - shared.element_product();
        let iou = shared.element_product() / union;
        assert!(iou > 0.95, "{id}: {low} {high} against {a} {b}");
    }
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_the_frame_with_labels_has_no_pictures() {
    let (drive, report) = drive("waymo", "1071392229495085036_1844_790_1864_790");
    assert!(report.entries().iter().all(|e| e.what.contains("sign")), "{:?}", report.entries());
    assert_eq!((drive.keyframes[0].boxes.len(), drive.keyframes[0].exposures.len(), drive.rig.len()), (LABELS, 0, 5));
    assert_eq!(drive.place, "location_phx");
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_vehicle_poses_of_v2_are_a_drive_of_twenty_seconds() {
    let (drive, report) = drive("waymo/v2", "10023947602400723454_1120_000_1140_000");
    assert_eq!(drive.keyframes.len(), 199);
    let times = || drive.keyframes.iter().map(|k| k.time_ns);
    assert_eq!(times().next(), Some(1_552_440_195_362_591_000));
    assert_eq!(times().next_back(), Some(1_552_440_215_162_553_000));
    let steps =
        drive.keyframes.windows(2).map(|w| w[1].world_from_ego.translation.distance(w[0].world_from_ego.translation));
    assert!(steps.fold(0.0, f64::max) < 2.0);
    // pyarrow 25 gives 860.5947875976562, 15568.6748046875, −651.4409790039062 for the first, of which whole metres are
    // taken off.
    let first = drive.keyframes[0].world_from_ego.translation;
    assert!((first - DVec3::new(-0.4052124, -0.3251953, -0.440979)).length() < 1e-6, "{first}");
    let is_expected = |what: &str| what.contains("without the component") || what.contains("place of unknown origin");
    assert!(report.entries().iter().all(|e| is_expected(&e.what)), "{:?}", report.entries());
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_the_keypoints_component_is_refused_by_name_where_boxes_are_expected() {
    // Its 15,844 rows with dictionaries are read as far as the column that boxes have and it has not.
    let data = PathBuf::from(std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA")).join("waymo/v2");
    let (root, name) = (tempfile::tempdir().unwrap(), "10023947602400723454_1120_000_1140_000.parquet");
    for (from, to) in [("vehicle_pose", "vehicle_pose"), ("camera_hkp", "lidar_box")] {
        std::fs::create_dir(root.path().join(to)).unwrap();
        std::fs::copy(data.join(from).join(name), root.path().join(to).join(name)).unwrap();
    }
    let waymo = Waymo::open(root.path(), 1, &Report::default()).unwrap();
    let error = waymo.drive(&waymo.segments()[0].name, &Report::default()).unwrap_err().to_string();
    assert!(error.contains("column 'key.laser_object_id'") && error.contains("key.camera_object_id"), "{error}");
}
