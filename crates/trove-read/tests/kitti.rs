//! The real recordings in `TROVE_TEST_DATA`, against what else is known of them.

#![allow(clippy::unwrap_used)] // the lint knows test functions, not the functions that they share

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::{DVec2, DVec3};
use quick_xml::XmlVersion;
use quick_xml::events::Event;
use trove_model::{Cuboid, Drive, Exposure, Keyframe, Report};
use trove_read::drive_source::DriveSource;
use trove_read::kitti::Kitti;

fn data() -> PathBuf {
    std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA").into()
}

fn read(root: &Path, name: &str) -> (Drive, Report) {
    let report = Report::default();
    let drive = Kitti::open(root, None).unwrap().read(name, &report).unwrap();
    (drive, report)
}

fn tracking(sequence: &str) -> (Drive, Report) {
    read(&data().join("kitti/tracking"), sequence)
}

fn median(mut values: Vec<f64>) -> f64 {
    assert!(!values.is_empty());
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Left and right borders of Lanelet2 lanes, as latitudes and longitudes.
fn borders(path: &Path) -> Vec<Vec<[f64; 2]>> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut reader = quick_xml::Reader::from_str(&text);
    let (mut nodes, mut ways) = (BTreeMap::new(), BTreeMap::<String, Vec<String>>::new());
    let (mut borders, mut way) = (BTreeSet::new(), String::new());
    loop {
        let event = reader.read_event().unwrap();
        let (Event::Start(element) | Event::Empty(element)) = &event else {
            if matches!(event, Event::Eof) {
                break;
            }
            continue;
        };
        let value = |key: &str| {
            let attribute = element.attributes().flatten().find(|a| a.key.as_ref() == key)?;
            Some(attribute.normalized_value(XmlVersion::Implicit1_0).unwrap().into_owned())
        };
        match element.name().as_ref() {
            "node" => {
                let degrees = |key: &str| value(key).unwrap().parse::<f64>().unwrap();
                nodes.insert(value("id").unwrap(), [degrees("lat"), degrees("lon")]);
            }
            "way" => way = value("id").unwrap(),
            "nd" => ways.entry(way.clone()).or_default().push(value("ref").unwrap()),
            "member" if matches!(value("role").as_deref(), Some("left" | "right")) => {
                borders.insert(value("ref").unwrap());
            }
            _ => {}
        }
    }
    borders.iter().filter_map(|id| ways.get(id)).map(|refs| refs.iter().map(|id| nodes[id]).collect()).collect()
}

fn distance_m(line: &[DVec2], to: DVec2) -> f64 {
    let segment_m = |ends: &[DVec2]| {
        let along = ends[1] - ends[0];
        let share = ((to - ends[0]).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
        to.distance(ends[0] + along * share)
    };
    line.windows(2).map(segment_m).fold(f64::INFINITY, f64::min)
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_tracking_0000_lies_on_the_lanes_of_karlsruhe() {
    let (drive, _) = tracking("0000");
    let in_world = |line: Vec<[f64; 2]>| -> Vec<DVec2> {
        line.into_iter().map(|[lat, lon]| drive.projection.world_from_geo(lat, lon)).collect()
    };
    let borders: Vec<_> = borders(&data().join("osm-lanelet/karlsruhe.osm")).into_iter().map(in_world).collect();
    assert!(borders.len() > 500, "{} borders", borders.len());
    let nearest_m = |at: DVec2| borders.iter().map(|line| distance_m(line, at)).fold(f64::INFINITY, f64::min);
    let position = |k: &Keyframe| k.world_from_ego.translation.truncate();
    let found_m = median(drive.keyframes.iter().map(|k| nearest_m(position(k))).collect());
    // 20 m to the side the same path is farther from lanes: the check can fail.
    let aside_m = median(drive.keyframes.iter().map(|k| nearest_m(position(k) + DVec2::new(20.0, 0.0))).collect());
    println!("median to a lane's border: {found_m:.2} m; 20 m aside {aside_m:.2} m");
    assert!(found_m <= 3.0, "{found_m} m");
}

/// Points on and around a box: within 0.5 m of it in plane, above the ground; and how many of them are within 0.3 m.
fn points_at(cuboid: &Cuboid, keyframe: &Keyframe) -> (usize, usize) {
    let sweep = keyframe.lidar.as_ref().unwrap();
    let half = cuboid.size_m / 2.0;
    let body_from_world = cuboid.world_from_body.inverse();
    let in_body = sweep.points_world.iter().map(|p| body_from_world.point(p.as_dvec3()));
    let around: Vec<DVec3> = in_body
        .filter(|p| p.x.abs() < half.x + 0.5 && p.y.abs() < half.y + 0.5)
        .filter(|p| p.z > 0.2 - half.z && p.z < half.z + 0.5)
        .collect();
    let near = around.iter().filter(|p| (p.abs() - half).max(DVec3::ZERO).length() <= 0.3).count();
    (around.len(), near)
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_lidar_points_at_boxes_fall_on_them() {
    // Frame 0 of tracking 0000 has its sweep in the raw drive.
    let (root, kitti) = (tempfile::tempdir().unwrap(), data().join("kitti"));
    let copy = |from: &str, to: &str| {
        let to = root.path().join(to);
        std::fs::create_dir_all(to.parent().unwrap()).unwrap();
        std::fs::copy(kitti.join(from), to).unwrap();
    };
    for folder in ["calib", "oxts", "label_02"] {
        copy(&format!("tracking/training/{folder}/0000.txt"), &format!("training/{folder}/0000.txt"));
    }
    let raw = "raw/2011_09_26/2011_09_26_drive_0005_sync/velodyne_points/data/0000000000.bin";
    copy(raw, "training/velodyne/0000/000000.bin");
    let object = kitti.join("object");
    let (mut around, mut near, mut boxes) = (0, 0, 0);
    for drive in [read(&object, "000000").0, read(&object, "000001").0, read(root.path(), "0000").0] {
        for object in &drive.keyframes[0].boxes {
            let (a, n) = points_at(&object.cuboid, &drive.keyframes[0]);
            println!("{} {}: {n} of {a} points", drive.id, object.category);
            (around, near, boxes) = (around + a, near + n, boxes + usize::from(a > 0));
        }
    }
    let share = near as f64 / around as f64;
    println!("{:.1} % of {around} points at {boxes} boxes within 0.3 m", 100.0 * share);
    assert!(boxes >= 6 && around > 1000 && share >= 0.9, "{near} of {around} at {boxes}");
}

fn iou(a: [f64; 4], b: [f64; 4]) -> f64 {
    let area = |r: [f64; 4]| (r[2] - r[0]).max(0.0) * (r[3] - r[1]).max(0.0);
    let both = area([a[0].max(b[0]), a[1].max(b[1]), a[2].min(b[2]), a[3].min(b[3])]);
    both / (area(a) + area(b) - both)
}

/// The rectangle around a box's corners in a picture; `None` where one lies behind the camera.
fn projected_px(exposure: &Exposure, cuboid: &Cuboid) -> Option<[f64; 4]> {
    let camera_from_world = exposure.world_from_camera().inverse();
    let corners = cuboid.corners_world().map(|c| exposure.lens.project(camera_from_world.point(c)));
    let corners: Vec<DVec2> = corners.into_iter().collect::<Option<_>>()?;
    let low = corners.iter().copied().reduce(DVec2::min)?.max(DVec2::ZERO);
    let size = DVec2::new(f64::from(exposure.lens.width_px), f64::from(exposure.lens.height_px));
    let high = corners.iter().copied().reduce(DVec2::max)?.min(size);
    Some([low.x, low.y, high.x, high.y])
}

/// The annotators' rectangles of whole, unhidden cars by the numbers of their lines, of which `skip` words come first.
fn annotated_px(path: &Path, skip: usize) -> BTreeMap<usize, [f64; 4]> {
    let text = std::fs::read_to_string(path).unwrap();
    let of_line = |(i, line): (usize, &str)| {
        let words: Vec<&str> = line.split_whitespace().skip(skip).collect();
        let number = |i: usize| words[i].parse::<f64>().unwrap();
        // Their pixels have their centres at whole numbers.
        let rectangle = [4, 5, 6, 7].map(|i| number(i) + 0.5);
        (words[0] == "Car" && number(1) == 0.0 && number(2) == 0.0).then_some((i + 1, rectangle))
    };
    text.lines().enumerate().filter_map(of_line).collect()
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_boxes_project_onto_the_annotators_rectangles() {
    let kitti = data().join("kitti");
    let mut ious = Vec::new();
    let recordings =
        [("object", "label_2", "000001", 0), ("tracking", "label_02", "0000", 2), ("tracking", "label_02", "0001", 2)];
    for (benchmark, labels, name, skip) in recordings {
        let (drive, _) = read(&kitti.join(benchmark), name);
        let rectangles = annotated_px(&kitti.join(format!("{benchmark}/training/{labels}/{name}.txt")), skip);
        let camera = drive.rig.iter().position(|c| c.name == "image_02").unwrap();
        let mut own = Vec::new();
        for keyframe in &drive.keyframes {
            let exposure = &keyframe.exposures[camera];
            for object in &keyframe.boxes {
                let line: usize = object.token.rsplit(':').next().unwrap().parse().unwrap();
                let Some(&rectangle) = rectangles.get(&line) else { continue };
                own.extend(projected_px(exposure, &object.cuboid).map(|found| iou(found, rectangle)));
            }
        }
        let mean = own.iter().sum::<f64>() / own.len().max(1) as f64;
        println!("{benchmark} {name}: IoU {mean:.3} in the mean of {} of {}", own.len(), rectangles.len());
        assert_eq!(own.len(), rectangles.len());
        ious.extend(own);
    }
    let mean = ious.iter().sum::<f64>() / ious.len() as f64;
    println!("IoU {mean:.3} in the mean of {}", ious.len());
    assert!(ious.len() > 300 && mean >= 0.75, "{mean} of {}", ious.len());
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_tracking_sequences_are_read_within_a_second() {
    for (sequence, keyframes, boxes, tracks) in [("0000", 154, 711, 15), ("0001", 447, 3030, 98)] {
        let start = Instant::now();
        let (drive, report) = tracking(sequence);
        let seconds = start.elapsed().as_secs_f64();
        let found = drive.keyframes.iter().map(|k| k.boxes.len()).sum::<usize>();
        println!(
            "{sequence}: {seconds:.3} s, {found} boxes, {} tracks, {:?}",
            drive.tracks.len(),
            report.measurements()
        );
        assert_eq!((drive.keyframes.len(), found, drive.tracks.len()), (keyframes, boxes, tracks));
        assert!(seconds < 1.0, "{seconds} s");
    }
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_raw_drives_are_what_their_files_say() {
    let root = data().join("kitti/raw");
    let (drive, report) = read(&root, "2011_09_26_drive_0001_sync");
    println!("{:?} {:?}", report.entries(), report.measurements());
    let mut counts = BTreeMap::<&str, usize>::new();
    for track in &drive.tracks {
        let (keyframe, _) = track.boxes[0];
        let category =
            &drive.keyframes[keyframe].boxes.iter().find(|b| drive.tracks[b.track] == *track).unwrap().category;
        *counts.entry(category).or_default() += 1;
    }
    assert_eq!(drive.keyframes.len(), 108);
    assert_eq!(counts.into_iter().collect::<Vec<_>>(), [("Car", 12), ("Cyclist", 2), ("Tram", 1)]);
    let path_m: f64 = drive
        .keyframes
        .windows(2)
        .map(|w| w[0].world_from_ego.translation.distance(w[1].world_from_ego.translation))
        .sum();
    println!("path {path_m:.1} m");

    let (raw, _) = read(&root, "2011_09_26_drive_0005_sync");
    let first = &raw.keyframes[0];
    assert!(raw.keyframes.len() == 154 && raw.rig.len() == 4 && first.exposures.iter().all(|e| e.file.is_some()));
    let sweep = first.lidar.as_ref().unwrap();
    assert_eq!(sweep.points_world.len(), 123_397);
    // The road before the car is at the height of its wheels.
    let ego_from_world = first.world_from_ego.inverse();
    let in_ego = sweep.points_world.iter().map(|p| ego_from_world.point(p.as_dvec3()));
    let road: Vec<f64> =
        in_ego.filter(|p| p.x > 3.0 && p.x < 12.0 && p.y.abs() < 2.0 && p.z.abs() < 0.5).map(|p| p.z).collect();
    let height_m = median(road);
    println!("road at {height_m:.3} m");
    assert!(height_m.abs() < 0.06, "{height_m} m");

    // Tracking 0000 is the same drive, moved a little by what stands.
    let (tracking, _) = tracking("0000");
    for (a, b) in raw.keyframes.iter().zip(&tracking.keyframes) {
        let apart = b.world_from_ego.translation - a.world_from_ego.translation;
        assert!(apart.truncate().length() < 0.05 && apart.z.abs() < 0.5, "{}: {apart}", a.token);
    }
}
