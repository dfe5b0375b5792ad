//! What is broken is an error that says where, or is left out and reported; never a panic.

use std::path::Path;

use proptest::prelude::*;
use trove_model::{Drive, Report};
use trove_read::ReadError;
use trove_read::drive_source::DriveSource;
use trove_read::kitti::Kitti;

use super::{synced, writer};

const DRIVE: &str = "2020_09_13/2020_09_13_drive_0007_sync";
const LABELS: &str = "training/label_02/0003.txt";
const OXTS: &str = "training/oxts/0003.txt";
const CALIBRATION: &str = "training/calib/0003.txt";

fn load(root: &Path, report: &Report) -> Result<Drive, ReadError> {
    let kitti = Kitti::open(root, None)?;
    let name = kitti.drives().into_iter().next().map(|drive| drive.name).unwrap_or_default();
    kitti.read(&name, report)
}

/// The form whose file it is, with one file changed.
fn changed(file: &str, change: impl FnOnce(String) -> String) -> tempfile::TempDir {
    let root = tempfile::tempdir().unwrap();
    if file.starts_with("training") {
        writer::tracking(&synced(), root.path())
    } else {
        writer::raw(&synced(), root.path(), true)
    }
    let path = root.path().join(file);
    let text = change(std::fs::read_to_string(&path).unwrap());
    std::fs::write(path, text).unwrap();
    root
}

/// A change leaves a drive with so many keyframes and boxes, and this in the report.
fn check(file: &str, change: impl FnOnce(String) -> String, keyframes_boxes: (usize, usize), expect: &str) {
    let (root, report) = (changed(file, change), Report::default());
    let drive = load(root.path(), &report).unwrap();
    let boxes = drive.keyframes.iter().map(|k| k.boxes.len()).sum::<usize>();
    assert_eq!((drive.keyframes.len(), boxes), keyframes_boxes, "{expect}");
    let said: Vec<_> = report.entries().into_iter().map(|e| e.what).collect();
    assert!(said.iter().any(|what| what.contains(expect)), "expected '{expect}' in {said:?}");
}

/// A change leaves nothing to read, and the error says this.
fn refused(file: &str, change: impl FnOnce(String) -> String, expect: &[&str]) {
    let root = changed(file, change);
    let message = load(root.path(), &Report::default()).unwrap_err().to_string();
    assert!(expect.iter().all(|part| message.contains(part)), "expected {expect:?} in {message}");
}

/// With a line of a file changed.
fn line(number: usize, change: impl Fn(&str) -> String) -> impl FnOnce(String) -> String {
    move |text| {
        let lines = text.lines().enumerate();
        lines.map(|(i, line)| if i == number { change(line) } else { line.to_owned() } + "\n").collect()
    }
}

fn word(number: usize, to: &'static str) -> impl Fn(&str) -> String {
    move |line| {
        let words = line.split(' ').enumerate().map(|(i, word)| if i == number { to } else { word });
        words.collect::<Vec<_>>().join(" ")
    }
}

#[test]
fn a_broken_label_is_left_out_and_reported() {
    check(LABELS, line(1, |_| "0 10 Car 0".into()), (6, 23), "KITTI label: fewer than 15 columns");
    check(LABELS, line(1, |_| "0".into()), (6, 23), "KITTI label: fewer than 15 columns");
    check(LABELS, line(1, |l| format!("{l} 0.9 1")), (6, 23), "KITTI label: not 15 columns");
    check(LABELS, line(1, word(2, "Hovercraft")), (6, 23), "KITTI label: unknown class 'Hovercraft'");
    check(LABELS, line(1, word(12, "NaN")), (6, 23), "KITTI label: a column that is not a number");
    check(LABELS, line(1, word(12, "1e300")), (6, 23), "KITTI label: box longer than 200 m");
    check(LABELS, line(1, word(12, "-4")), (6, 23), "KITTI label: box of zero or negative size");
    check(LABELS, line(1, word(13, "1e300")), (6, 23), "KITTI label: box without a valid pose");
    check(LABELS, line(1, word(0, "6")), (6, 23), "KITTI label: of no frame");
    check(LABELS, line(1, word(0, "-1")), (6, 23), "KITTI label: of no frame");
    check(LABELS, line(2, word(1, "10")), (6, 23), "KITTI label: second of its object in a frame");
    check(LABELS, |text| text[..text.len() - 40].to_owned(), (6, 23), "KITTI label: ");
    check(LABELS, |_| String::new(), (6, 0), "time of a KITTI benchmark's frames");
}

#[test]
fn a_broken_fix_leaves_its_frame_out() {
    check(OXTS, line(2, |_| String::new()), (5, 20), "OXTS line that cannot be read");
    check(OXTS, line(2, word(0, "nan")), (5, 20), "OXTS line that cannot be read");
    check(OXTS, line(2, word(5, "1e6")), (5, 20), "OXTS line that cannot be read");
    check(OXTS, line(2, word(0, "-33.9")), (5, 20), "OXTS fix far from the drive's first");
    let last = |text: &str| text.trim_end().rfind('\n').unwrap();
    check(OXTS, |text| text[..last(&text) + 30].to_owned(), (5, 20), "OXTS line that cannot be read");
    let times = format!("{DRIVE}/oxts/timestamps.txt");
    check(&times, line(3, |_| "yesterday".into()), (5, 20), "KITTI frame: no time");
    check(&times, line(3, |_| "2020-09-13 14:26:40.0".into()), (5, 20), "KITTI frame: time runs backwards");
}

#[test]
fn a_drive_without_anything_usable_is_an_error_that_says_where() {
    refused(
        &format!("{DRIVE}/oxts/timestamps.txt"),
        |_| String::new(),
        &["oxts/data", "at least one fix", "none among 6"],
    );
    refused(OXTS, |_| String::new(), &["oxts/0003.txt", "at least one fix"]);
    refused(CALIBRATION, |_| String::new(), &["calib/0003.txt", "Tr_imu_to_velo or Tr_imu_velo", "unpack"]);
    refused(CALIBRATION, |t| t.replace("R_rect 1", "R_rect 2"), &["a rotation"]);
    refused(CALIBRATION, |t| t.replace("R_rect 1", "R_rect nan"), &["R_rect", "no such line of numbers"]);
    refused(CALIBRATION, |t| t.replace("P0: ", "P0: 7 "), &["P0", "13 numbers"]);
    refused(CALIBRATION, |t| t.replace("P0: ", "P0: 0 7 ").replacen(" 1 ", " ", 1), &["P0"]);
    let imu = "2020_09_13/calib_imu_to_velo.txt";
    refused(imu, |t| t.replace("T: ", "T: 1e9"), &["calib_imu_to_velo.txt"]);
    let cameras = "2020_09_13/calib_cam_to_cam.txt";
    refused(cameras, |t| t.replace("S_rect_00: 1600", "S_rect_00: 0"), &["S_rect_00", "size of an image"]);
    let tracklets = format!("{DRIVE}/tracklet_labels.xml");
    refused(&tracklets, |t| t[..t.len() / 2].to_owned(), &["tracklet_labels.xml", "byte", "unpack"]);
    refused(&tracklets, |_| String::new(), &["no element at all"]);
    refused(&tracklets, |t| t.replace("<h>", &"<x>".repeat(30)), &["tracklet_labels.xml"]);
}

#[test]
fn a_missing_file_is_named_with_what_to_do() {
    for (file, expect) in [
        (CALIBRATION, "training or testing as the root"),
        (OXTS, "unpack data_tracking_oxts.zip"),
        ("2020_09_13/calib_velo_to_cam.txt", "calib_velo_to_cam.txt"),
    ] {
        let root = changed(file, |text| text);
        std::fs::remove_file(root.path().join(file)).unwrap();
        let message = load(root.path(), &Report::default()).unwrap_err().to_string();
        assert!(message.contains(expect), "{message}");
    }
    let root = changed(LABELS, |text| text);
    std::fs::remove_file(root.path().join(LABELS)).unwrap();
    let report = Report::default();
    assert_eq!(load(root.path(), &report).unwrap().tracks, []);
    assert!(report.entries().iter().any(|e| e.what == "KITTI recording without labels"));
    let message = Kitti::open(root.path(), None).unwrap().read("0004", &report).unwrap_err().to_string();
    assert!(message.contains("the nearest name is 0003"), "{message}");
}

#[test]
fn a_broken_tracklet_is_left_out_and_reported() {
    let file = format!("{DRIVE}/tracklet_labels.xml");
    let once = |from: &'static str, to: &'static str| move |text: String| text.replacen(from, to, 1);
    check(&file, once("<h>1.6</h>", "<h>NaN</h>"), (6, 18), "KITTI tracklet: box without a valid size");
    check(&file, once("<first_frame>0", "<first_frame>-1"), (6, 18), "KITTI tracklet: no first frame");
    check(&file, once("<first_frame>0", "<first_frame>3"), (6, 21), "KITTI tracklet: pose in no frame");
    check(&file, once("<first_frame>0", "<first_frame>99999999999"), (6, 18), "KITTI tracklet: no first frame");
    check(&file, once("<rx>0", "<rx>x"), (6, 23), "KITTI tracklet: pose that cannot be read");
    check(&file, once("Cyclist", "Hovercraft"), (6, 18), "KITTI tracklet: unknown class");
}

#[test]
fn a_damaged_sweep_or_picture_is_reported_and_the_drive_stands() {
    let root = changed(LABELS, |text| text);
    std::fs::write(root.path().join("training/velodyne/0003/000002.bin"), [0; 33]).unwrap();
    for camera in ["image_00", "image_01"] {
        std::fs::write(root.path().join(format!("training/{camera}/0003/000001.png")), "no picture").unwrap();
    }
    let report = Report::default();
    let drive = load(root.path(), &report).unwrap();
    assert!(drive.keyframes.len() == 6 && drive.keyframes.iter().all(|k| k.lidar.is_none()));
    let said: Vec<_> = report.entries().into_iter().map(|e| e.what).collect();
    for expect in [
        "truncated LiDAR sweep",
        "KITTI picture that cannot be read",
        "size of KITTI pictures that are not there, from the lens",
    ] {
        assert!(said.iter().any(|what| what == expect), "expected '{expect}' in {said:?}");
    }
    assert_eq!((drive.rig[0].lens.width_px, drive.rig[0].lens.height_px), (1631, 882), "twice the principal point");
}

#[test]
fn a_hundred_times_the_frames_take_seconds_at_most() {
    let root = changed(OXTS, |text| text.repeat(100));
    let path = root.path().join(LABELS);
    let labels = std::fs::read_to_string(&path).unwrap();
    let later = |i: usize| {
        let shifted = labels.lines().map(move |line| {
            let (frame, rest) = line.split_once(' ').unwrap();
            format!("{} {rest}\n", frame.parse::<usize>().unwrap() + 6 * i)
        });
        shifted.collect::<String>()
    };
    std::fs::write(&path, (0..100).map(later).collect::<String>()).unwrap();
    let start = std::time::Instant::now();
    let drive = load(root.path(), &Report::default()).unwrap();
    assert_eq!((drive.keyframes.len(), drive.tracks.len(), drive.tracks[0].boxes.len()), (600, 4, 600));
    assert!(start.elapsed().as_secs() < 120, "{:?}", start.elapsed());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]
    #[test]
    fn damaged_files_never_panic(
        file in prop::sample::select(&[
            CALIBRATION, OXTS, LABELS,
            "2020_09_13/calib_cam_to_cam.txt",
            "2020_09_13/2020_09_13_drive_0007_sync/tracklet_labels.xml",
            "2020_09_13/2020_09_13_drive_0007_sync/oxts/timestamps.txt",
        ][..]),
        at in 0.0..1.0f64,
        insert in prop::option::of(prop::sample::select(
            &["-", "1e999", "NaN", "\0", "é", "\n", "<item>", "</item>", "<!--", "99999999999999999999"][..],
        )),
        remove in 0usize..60,
    ) {
        let root = changed(file, |mut text| {
            let mut at = (at * text.len() as f64) as usize;
            while !text.is_char_boundary(at) { at -= 1; }
            let end = (at + remove).min(text.len());
            text.replace_range(at..end, insert.unwrap_or(""));
            text
        });
        if let Ok(drive) = load(root.path(), &Report::default()) {
            prop_assert!(!drive.keyframes.is_empty());
        }
    }
}
