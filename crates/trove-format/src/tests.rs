use std::collections::BTreeMap;

use serde_json::{Value, json};
use trove_model::{Kind, Outcome, Report, Season};

use crate::*;

fn site() -> SiteFile {
    let report = Report::default();
    report.note(Outcome::Guessed, "height", "way 7");
    report.measure("map.path_to_road_median_m", 0.25);
    report.measure("map.nothing_to_measure_m", f64::NAN);
    SiteFile {
        drive: DriveRow {
            scene: "scene-0103".into(),
            dataset: "nuscenes".into(),
            place: "boston-seaport".into(),
            keyframes: 40,
            licence: "CC BY-NC-SA 4.0".into(),
            projection: DriveProjection {
                kind: ProjectionKind::Equirectangular,
                projection: Projection {
                    origin_lat_deg: 42.3,
                    origin_lon_deg: -71.1,
                    anchor_m: [1.5, 2.5],
                    metres_per_rad: None,
                },
            },
        },
        recording: None,
        planned: json!({ "drive.keyframes": [0] }),
        sources: vec![Source { source: "a.osm".into(), licence: "ODbL 1.0".into() }],
        report: (&report).into(),
        fits: vec![FitRow {
            track: "t".into(),
            kind: Kind::BicycleWithRider,
            size_m: [1.8, 0.6, 1.7],
            chosen: AssetFitRow { asset: "bicycle/city".into(), quality_m: 1.5, iou3d: 0.75 },
            runners_up: vec![],
        }],
        factors: Factors {
            assets: 1,
            paint: 1,
            people: 1,
            facades: 0,
            materials: 0,
            furniture: 0,
            vegetation: 0,
            place: [42.3, -71.1],
            season: Season::Autumn,
            light: LightFactor::Picture { environment: "noon.hdr".into(), rotation_deg: 90.0 },
            traffic: 1.0,
            wetness: 0.0,
            visibility_m: None,
            rain_mm_h: None,
            snowfall_mm_h: None,
            snow: None,
            exposure_ev: 0.0,
            camera_height_m: 0.0,
            camera_pitch_deg: 0.0,
            other_vehicles: 1,
        },
        locale: Some(LocaleRow { country: Some("US".into()), driving_side: "right".into(), speed_unit: "mph".into() }),
        frames: vec![(0, "ego.CAM_FRONT".into())],
        sweeps: vec![],
        grids: vec![],
        radars: vec![],
    }
}

fn value(bytes: &[u8]) -> Value {
    serde_json::from_slice(bytes).unwrap()
}

#[test]
fn what_is_written_is_read_back_the_same() {
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(SiteFile::read(dir.path()).unwrap(), None);
    let mut site = site();
    for light in [
        site.factors.light.clone(),
        LightFactor::Sky {
            environment: "sky".into(),
            sun_elevation_deg: 40.0,
            sun_azimuth_deg: 180.0,
            turbidity: 3.0,
            clouds: 0.5,
        },
    ] {
        site.factors.light = light;
        std::fs::write(dir.path().join(SiteFile::NAME), site.to_json()).unwrap();
        assert_eq!(SiteFile::read(dir.path()).unwrap().as_ref(), Some(&site));
    }
}

#[test]
fn names_are_the_same_in_every_file() {
    let written = value(&site().to_json());
    assert_eq!(written["fits"][0]["kind"], "bicycle_with_rider");
    assert_eq!(written["factors"]["season"], "autumn");
    assert_eq!(written["report"]["entries"][0]["outcome"], "guessed");
    assert_eq!(written["drive"]["projection"]["kind"], "equirectangular");
    assert_eq!(written["report"]["measurements"]["map.nothing_to_measure_m"], Value::Null);
}

#[test]
fn unknown_fields_are_passed_over_and_optional_ones_may_be_missing() {
    let dir = tempfile::tempdir().unwrap();
    let mut later = value(&site().to_json());
    later["drive"]["weather"] = json!("fair");
    later["drive"].as_object_mut().unwrap().remove("place");
    std::fs::write(dir.path().join(SiteFile::NAME), later.to_string()).unwrap();
    let read = SiteFile::read(dir.path()).unwrap().unwrap();
    assert_eq!((read.drive.place.as_str(), read.fits), ("", site().fits));
}

#[test]
fn a_damaged_file_is_told_with_its_place() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join(SiteFile::NAME);
    let text = String::from_utf8(site().to_json()).unwrap();
    for (damaged, expect) in [
        (text[..text.len() / 2].to_owned(), "EOF"),
        (text.replace("bicycle_with_rider", "BicycleWithRider"), "expected a kind out of adult, child"),
        (text.replace("\"variation\"", "x").replace("40,", "-1,"), "site.json:6:"),
    ] {
        std::fs::write(&path, damaged).unwrap();
        let message = SiteFile::read(dir.path()).unwrap_err().to_string();
        assert!(message.contains("site.json:") && message.contains(expect), "{message}");
        assert!(message.contains("delete it and rerun"), "{message}");
    }
}

fn manifest() -> Manifest {
    let site = site();
    Manifest {
        format: FORMAT,
        seed: 7,
        recipe: json!({ "seed": 7 }),
        versions: Versions {
            trove: "0".into(),
            build: "0".into(),
            assets: vec![],
            kernel: "obvhs".into(),
            denoiser: None,
            device: None,
            card: None,
        },
        classes: ClassEntry::all(),
        parts: PartEntry::all(),
        drives: vec![ManifestDrive { drive: site.drive, sources: site.sources.clone() }],
        licences: site.sources,
        frames: vec![FrameRow {
            path: "scene-0103/v00/k000/ego.CAM_FRONT".into(),
            scene: "scene-0103".into(),
            variation: 0,
            keyframe: 0,
            view: "ego.CAM_FRONT".into(),
            factors: site.factors,
            files: BTreeMap::from([("class.png".into(), "00".into())]),
            counterfactual: None,
        }],
        sweeps: vec![],
        grids: vec![],
        radars: vec![],
    }
}

#[test]
fn a_manifest_is_written_with_rows_that_are_made_meanwhile() {
    let mut manifest = manifest();
    assert_eq!(manifest.to_json(), crate::file::pretty(&manifest));
    manifest.grids.clone_from(&manifest.frames);
    assert_eq!(manifest.to_json(), crate::file::pretty(&manifest));
    let none = || -> MadeRows<'_> { Box::new(std::iter::empty()) };
    let broken = Box::new([Ok(manifest.frames[0].clone()), Err("removed during the run".into())].into_iter());
    let rows = ManifestRows { frames: broken, sweeps: none(), radars: none(), grids: none() };
    let error = manifest.write(rows, Vec::new()).unwrap_err();
    assert!(error.to_string().contains("removed during the run"), "{error}");
}

#[test]
fn a_manifest_of_another_version_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let manifest = manifest();
    assert_eq!(Manifest::read(dir.path()).unwrap(), None);
    let path = dir.path().join(Manifest::NAME);
    std::fs::write(&path, manifest.to_json()).unwrap();
    assert_eq!(Manifest::read(dir.path()).unwrap(), Some(manifest.clone()));
    let mut outside = manifest.clone();
    outside.frames[0].path = "../../secret".into();
    std::fs::write(&path, outside.to_json()).unwrap();
    assert!(Manifest::read(dir.path()).unwrap_err().to_string().contains("the name \"..\""));
    // What follows the number is not even looked at.
    std::fs::write(&path, r#"{"format": 3, "frames": "elsewhere"}"#).unwrap();
    let message = Manifest::read(dir.path()).unwrap_err().to_string();
    assert!(message.contains("manifest.json: expected format 2, found format 3"), "{message}");
}

#[test]
fn a_torn_line_of_the_journal_is_passed_over() {
    let dir = tempfile::tempdir().unwrap();
    let file = WrittenFile { name: "class.png".into(), sha256: "00".into(), bytes: 3 };
    let line = FrameLine { frame: "a".into(), files: vec![file] };
    let plan = PlanLine { planned: 2, of: 9, started_unix_s: 1_700_000_000 };
    let outside = FrameLine { frame: "../a".into(), ..line.clone() };
    let torn = JournalLine::Frame(FrameLine { frame: "b".into(), ..line.clone() }).to_json();
    let lines = [JournalLine::Plan(plan), JournalLine::Frame(line.clone()), JournalLine::Frame(outside)];
    let mut journal: Vec<u8> = lines.iter().flat_map(JournalLine::to_json).collect();
    journal.extend(&torn[..20]);
    let path = dir.path().join(FrameLine::JOURNAL);
    std::fs::write(&path, &journal).unwrap();
    assert_eq!(FrameLine::journal(dir.path()).unwrap(), Journal::from([("a".into(), line.files)]));
    let mut told = Vec::new();
    FrameLine::each(&path, |line, at| told.push((line, at))).unwrap();
    assert_eq!(told.iter().map(|(line, _)| line).collect::<Vec<_>>(), [&lines[0], &lines[1]]);
    let at = told[1].1.start as usize..told[1].1.end as usize;
    assert_eq!(journal[at], lines[1].to_json());
}
