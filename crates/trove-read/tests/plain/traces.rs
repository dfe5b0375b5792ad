//! Traces of positions: made up, damaged and real.

use std::path::PathBuf;

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use trove_model::{Drive, MapProjection, Report};

use super::{notes, open, put};

/// East at 10 m/s from a place in Karlsruhe, at 2 Hz.
fn csv(lines: usize) -> String {
    let projection = MapProjection::ellipsoidal(49.0, 8.4, DVec2::ZERO);
    let line = |i: usize| {
        let (lat, lon) = projection.geo_from_world(DVec2::new(5.0 * i as f64, 0.0));
        format!("{:.1},{lat:.9},{lon:.9},115.0\n", 1.6e9 + 0.5 * i as f64)
    };
    format!("time,lat,lon,alt\n{}", (0..lines).map(line).collect::<String>())
}

fn gpx(lines: usize) -> String {
    let csv = csv(lines);
    let point = |line: &str| {
        let [time, lat, lon, alt] = line.split(',').collect::<Vec<_>>()[..] else { panic!("{line}") };
        format!("<trkpt lat=\"{lat}\" lon=\"{lon}\"><ele>{alt}</ele><time>{time}</time></trkpt>\n")
    };
    format!("<gpx><trk><trkseg>{}</trkseg></trk></gpx>", csv.lines().skip(1).map(point).collect::<String>())
}

fn read(file: &str, text: &str, options: &str) -> (Drive, Report) {
    let (root, report) = (tempfile::tempdir().unwrap(), Report::default());
    put(root.path(), file, text);
    let source = open("gps", options, root.path(), &report).unwrap();
    (source.read(&source.drives()[0].name, &report).unwrap(), report)
}

#[test]
fn csv_and_gpx_give_the_same_drive_along_the_way() {
    let (from_csv, _) = read("morning.csv", &csv(42), "spacing_m = 20");
    let (mut from_gpx, report) = read("morning.gpx", &gpx(42), "spacing_m = 20");
    assert_eq!(from_csv.keyframes.len(), from_gpx.keyframes.len());
    from_gpx.keyframes.clone_from(&from_csv.keyframes);
    assert_eq!(from_csv, from_gpx);
    assert_eq!((from_csv.id.as_str(), from_csv.keyframes.len(), from_csv.rig.len()), ("morning", 11, 1));
    for (i, keyframe) in from_csv.keyframes.iter().enumerate() {
        let expected = DVec3::new(20.0 * i as f64, 0.0, 0.0);
        assert!(keyframe.world_from_ego.translation.distance(expected) < 0.05, "{:?}", keyframe.world_from_ego);
        assert!(keyframe.world_from_ego.yaw_rad().abs() < 1e-3 && keyframe.exposures.len() == 1);
        assert!((keyframe.time_ns - (1_600_000_000 + 2 * i as i64) * 1_000_000_000).abs() < 20_000_000);
    }
    assert_eq!(notes(&report), [("recording vehicle's size: that of an ordinary car".to_owned(), 1)]);
}

#[test]
fn a_file_may_be_the_root_and_options_are_checked() {
    let root = tempfile::tempdir().unwrap();
    put(root.path(), "trace.csv", csv(20));
    put(root.path(), "other.csv", "a,b\n1,2\n");
    let report = Report::default();
    let source = open("gps", "interval_s = 1", &root.path().join("trace.csv"), &report).unwrap();
    assert_eq!(source.drives()[0].keyframes, 10);
    assert_eq!(source.recording("trace").unwrap(), [root.path().join("trace.csv")]);
    assert_eq!(open("gps", "", root.path(), &report).unwrap().drives().len(), 1, "the other has no positions");
    let gps = trove_read::DATASETS.iter().find(|d| d.name == "gps").unwrap();
    let refused = |options: &str| (gps.configure)(options.parse().unwrap()).err().unwrap().to_string();
    assert!(refused("spacing_m = 0").contains("more than 0"));
    assert!(refused("spacing_m = 1\ninterval_s = 1").contains("found both"));
    assert!(refused("version = 3").contains("unknown field"));
    let error = open("gps", "", &root.path().join("other.csv"), &report).err().unwrap().to_string();
    assert!(error.contains("columns time, lat and lon"), "{error}");
}

#[test]
fn what_is_wrong_in_a_trace_is_dropped_and_told() {
    let mut lines: Vec<String> = csv(60).lines().map(str::to_owned).collect();
    lines[10] = "1600000004.5,NaN,8.4,115".into();
    lines[20] = "1600000009.5,50.0,8.4,115".into(); // 111 km away
    lines.insert(30, lines[29].clone());
    lines.insert(31, lines[5].clone());
    lines.push("1600000".into()); // cut short
    let (drive, report) = read("trace.csv", &lines.join("\n"), "spacing_m = 10");
    let told = notes(&report);
    for expected in [
        ("GPS: fix of the same time as the one before", 1),
        ("GPS: fix that is older than the one before", 1),
        ("GPS: fix that nobody can have driven to", 1),
        ("GPS: line that is no position", 2),
    ] {
        assert!(told.contains(&(expected.0.to_owned(), expected.1)), "{expected:?} in {told:?}");
    }
    assert_eq!(drive.keyframes.len(), 30);
    assert!(drive.keyframes.iter().all(|k| k.world_from_ego.translation.y.abs() < 0.1));
}

#[test]
fn a_trace_without_positions_is_an_error() {
    let root = tempfile::tempdir().unwrap();
    for (file, text, expect) in [
        ("a.csv", "time,lat,lon\n", "expected positions with their times, found none"),
        ("a.csv", "time,lat,lon\n1,49,8\n2,49,8\n", "expected a trace that moves, or headings"),
        ("a.gpx", "<gpx></gpx>", "expected positions"),
        ("a.gpx", "", "expected positions"),
        ("a.gpx", &gpx(9)[..200], "expected GPX, found"),
        ("a.gpx", "<kml/>", "expected"),
    ] {
        put(root.path(), file, text);
        let report = Report::default();
        let source = open("gps", "", &root.path().join(file), &report).unwrap();
        let error = source.read("a", &report).unwrap_err().to_string();
        assert!(error.contains(expect) && error.contains(file), "{text}: {error}");
    }
}

#[test]
fn a_hundred_times_the_size_is_read_within_seconds() {
    let started = std::time::Instant::now();
    let (drive, _) = read("trace.csv", &csv(60_000), "");
    assert!((drive.keyframes.len() as i64 - 30_000).abs() < 200, "{}", drive.keyframes.len());
    assert!(started.elapsed().as_secs() < 240, "{:?}", started.elapsed());
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_a_minute_of_comma2k19_is_a_drive_on_the_motorway() {
    let data = PathBuf::from(std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA"));
    let report = Report::default();
    let source = open("gps", "", &data.join("gps"), &report).unwrap();
    let drive = source.read("comma2k19-i280", &report).unwrap();
    let (lat_deg, lon_deg) = drive.projection.geo_from_world(DVec2::ZERO);
    assert!((37.0..38.0).contains(&lat_deg) && (-123.0..-122.0).contains(&lon_deg), "{lat_deg} {lon_deg}");
    let told = notes(&report);
    assert!(!told.iter().any(|(what, _)| what.contains("headings")), "the quaternions agree with the motion: {told:?}");
    assert!(!told.iter().any(|(what, _)| what.contains("fix")), "every fix can be: {told:?}");
    let egos: Vec<_> = drive.keyframes.iter().map(|k| k.world_from_ego).collect();
    let length_m: f64 = egos.windows(2).map(|w| w[0].translation.distance(w[1].translation)).sum();
    println!("{} keyframes, {length_m:.1} m, from {lat_deg:.5}, {lon_deg:.5}", egos.len());
    assert!((1000.0..2500.0).contains(&length_m), "{length_m}");
    for pair in egos.windows(2) {
        let step = pair[1].translation - pair[0].translation;
        assert!((step.length() - 10.0).abs() < 0.2, "{step}");
        let off_rad = (pair[0].yaw_rad() - step.truncate().to_angle()).sin().abs();
        assert!(off_rad < 0.05, "it points where it goes: {off_rad}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]
    #[test]
    fn damaged_traces_never_panic(
        at in 0.0..1.0f64,
        insert in prop::sample::select(&["<", ">", "\"", ",", "-", "1e999", "NaN", "\0", "é", "\n", "</gpx>", "9999999999999999999"][..]),
        remove in 0usize..60,
        is_gpx in any::<bool>(),
    ) {
        let text = if is_gpx { gpx(20) } else { csv(20) };
        let at = (at * text.len() as f64) as usize;
        let damaged = format!("{}{insert}{}", &text[..at], &text[(at + remove).min(text.len())..]);
        let root = tempfile::tempdir().unwrap();
        let file = if is_gpx { "a.gpx" } else { "a.csv" };
        put(root.path(), file, damaged);
        let report = Report::default();
        if let Ok(drive) = open("gps", "", &root.path().join(file), &report).and_then(|source| source.read("a", &report)) {
            prop_assert!(drive.keyframes.iter().all(|k| k.world_from_ego.is_finite()));
        }
    }
}
