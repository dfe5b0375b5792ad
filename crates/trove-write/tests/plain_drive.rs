//! What is written in the plain form is read back the same.

#![allow(clippy::unwrap_used)] // the lint knows test functions, not the functions that they share

#[path = "../../trove-read/tests/drives/canonical.rs"]
mod canonical;
#[path = "../../trove-read/tests/drives/comparison.rs"]
mod comparison;

use std::path::{Path, PathBuf};

use comparison::{TIGHT, differences};
use glam::DVec2;
use trove_model::{Drive, Lane, LaneMap, LidarClass, Polygon, Report};
use trove_read::DATASETS;
use trove_read::nuscenes::NuScenes;
use trove_write::{PlainFiles, write_plain_drive};

/// What a drive becomes.
fn there_and_back(drive: &Drive, root: &Path, files: PlainFiles) -> (Drive, Report) {
    let (out, report) = (tempfile::tempdir().unwrap(), Report::default());
    write_plain_drive(drive, root, &out.path().join(&drive.id), files, &report).unwrap();
    let dataset = DATASETS.iter().find(|dataset| dataset.name == "trove").unwrap();
    assert!((dataset.is_at)(out.path()));
    let source = (dataset.configure)(toml::Table::new()).unwrap()(out.path(), None, &report).unwrap();
    assert_eq!(source.drives()[0].keyframes, drive.keyframes.len());
    (source.read(&drive.id, &report).unwrap(), report)
}

/// All that a comparison of what can be seen leaves out.
fn assert_same_names(drive: &Drive, found: &Drive) {
    let what = |d: &Drive| (d.id.clone(), d.place.clone(), d.licence.clone(), d.origin, d.ego_body, d.lane_map.clone());
    assert_eq!(what(drive), what(found));
    for (a, b) in drive.keyframes.iter().zip(&found.keyframes) {
        assert_eq!(a.token, b.token);
        let pictures = |k: &trove_model::Keyframe| k.exposures.iter().map(|e| e.token.clone()).collect::<Vec<_>>();
        assert_eq!(pictures(a), pictures(b));
        for (a, b) in a.boxes.iter().zip(&b.boxes) {
            assert_eq!(
                (a.track, &a.category, &a.token, &a.attributes, a.is_parked),
                (b.track, &b.category, &b.token, &b.attributes, b.is_parked)
            );
            assert_eq!((a.lidar_points, a.visibility), (b.lidar_points, b.visibility));
        }
    }
    let tokens = |d: &Drive| d.tracks.iter().map(|t| (t.token.clone(), t.kind)).collect::<Vec<_>>();
    assert_eq!(tokens(drive), tokens(found));
}

#[test]
fn the_canonical_drive_comes_back_with_its_files_and_its_map() {
    let mut drive = canonical::drive();
    drive.projection.anchor_m = DVec2::new(1234.5, -77.25);
    let square = Polygon {
        exterior: [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]].map(DVec2::from_array).into(),
        holes: vec![[[1.0, 0.5], [2.0, 1.0], [2.0, 0.5]].map(DVec2::from_array).into()],
    };
    let line = vec![DVec2::ZERO, DVec2::new(4.25, 5.125)];
    drive.lane_map = Some(LaneMap {
        drivable: vec![square.clone()],
        lanes: vec![Lane { token: "lane".into(), polygon: square.clone(), centreline: line.clone() }],
        crossings: vec![square],
        road_dividers: vec![line],
        ..LaneMap::default()
    });
    let first = drive.keyframes[0].world_from_ego.translation.round();
    let pictures = tempfile::tempdir().unwrap();
    std::fs::write(pictures.path().join("a.png"), "picture").unwrap();
    drive.keyframes[3].exposures[0].file = Some("a.png".into());
    drive.keyframes[1].exposures[1].lens.fx_px += 2.0;
    drive.keyframes[5].exposures.pop();
    let sweep = drive.keyframes[canonical::SWEPT].lidar.as_mut().unwrap();
    sweep.classes = vec![LidarClass::Road; sweep.points_world.len()];
    sweep.classes[3] = LidarClass::Vegetation;

    let (found, report) = there_and_back(&drive, pictures.path(), PlainFiles { lidar: true, pictures: true });
    assert_eq!(differences(&drive, &found, &TIGHT), [""; 0]);
    assert_eq!(report.entries(), []);
    let sweep = |d: &Drive| d.keyframes[canonical::SWEPT].lidar.clone().unwrap().classes;
    assert_eq!(sweep(&drive), sweep(&found));
    let files: Vec<_> = found.keyframes.iter().flat_map(|k| &k.exposures).filter_map(|e| e.file.clone()).collect();
    assert_eq!(files, ["canonical/pictures/CAM_FRONT/000003.png"]);
    // World begins at the first vehicle, rounded; the map moves with it.
    let moved = found.lane_map.as_ref().unwrap().lanes[0].centreline[1];
    assert_eq!(moved, DVec2::new(4.25, 5.125) - first.truncate());

    let alone = canonical::without_between(drive.clone());
    let (found, _) = there_and_back(&alone, pictures.path(), PlainFiles { lidar: true, pictures: true });
    assert_eq!(differences(&alone, &found, &TIGHT), [""; 0]);

    let (bare, report) = there_and_back(&drive, pictures.path(), PlainFiles::default());
    assert!(
        bare.sweeps.is_empty()
            && bare.keyframes.iter().all(|k| k.lidar.is_none() && k.exposures.iter().all(|e| e.file.is_none()))
    );
    assert_eq!(report.entries(), []);
}

#[test]
fn a_drive_that_lies_nowhere_stays_nowhere() {
    let mut drive = canonical::drive();
    drive.is_georeferenced = false;
    let (found, _) = there_and_back(&drive, Path::new(""), PlainFiles { lidar: true, pictures: true });
    assert_eq!(differences(&drive, &found, &TIGHT), [""; 0]);
    assert!((found.projection.origin_lat_deg - canonical::LAT_DEG).abs() < 1e-9, "its whereabouts are kept");
}

#[test]
#[ignore = "needs TROVE_TEST_DATA"]
fn real_scenes_of_nuscenes_come_back_from_the_plain_form() {
    let data = std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA");
    let root = PathBuf::from(data).join("nuscenes");
    for (scene, boxes, pictures) in [("scene-0103", 2090, 0), ("scene-0061", 4664, 6)] {
        let report = Report::default();
        let drive = NuScenes::open(&root, "v1.0-mini", None, &report).unwrap().drive(scene, &report).unwrap();
        let started = std::time::Instant::now();
        let (found, report) = there_and_back(&drive, &root, PlainFiles { lidar: true, pictures: true });
        println!("{scene}: written and read in {:?}", started.elapsed());
        assert_eq!(differences(&drive, &found, &TIGHT), [""; 0]);
        assert_same_names(&drive, &found);
        assert_eq!(report.entries(), []);
        assert_eq!(found.keyframes.iter().map(|k| k.boxes.len()).sum::<usize>(), boxes);
        let files = found.keyframes.iter().flat_map(|k| &k.exposures).filter(|e| e.file.is_some());
        assert_eq!(files.count(), pictures);
    }
}
