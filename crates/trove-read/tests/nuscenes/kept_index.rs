//! The index that is kept changes nothing but the time that opening takes.

use serde_json::json;
use trove_model::{Drive, Entry, Report};
use trove_read::nuscenes::NuScenes;

use super::fixture::{Dataset, SCENE, VERSION, notes};

fn load(root: &std::path::Path, cache: &std::path::Path) -> (Drive, Vec<Entry>) {
    let report = Report::default();
    let drive = NuScenes::open(root, VERSION, Some(cache), &report).unwrap().drive(SCENE, &report).unwrap();
    (drive, report.entries())
}

#[test]
fn a_kept_index_gives_the_same_drive_and_the_same_report() {
    let orphan = |rows: &mut Vec<serde_json::Value>| rows[5]["sample_token"] = json!("?");
    let root = Dataset::small().with("sample_annotation", orphan).write();
    let cache = tempfile::tempdir().unwrap();
    let first = load(root.path(), cache.path());
    assert!(first.1.iter().any(|e| e.what.contains("of an unknown sample")));
    assert_eq!(std::fs::read_dir(cache.path()).unwrap().count(), 1);
    assert_eq!(load(root.path(), cache.path()), first);
}

#[test]
fn an_index_of_other_tables_or_a_damaged_one_is_made_anew() {
    let (root, cache) = (Dataset::small().write(), tempfile::tempdir().unwrap());
    let first = load(root.path(), cache.path());
    let index = std::fs::read_dir(cache.path()).unwrap().next().unwrap().unwrap().path();
    let bytes = std::fs::read(&index).unwrap();
    std::fs::write(&index, &bytes[..bytes.len() / 2]).unwrap();
    assert_eq!(load(root.path(), cache.path()), first);
    assert_eq!(std::fs::read(&index).unwrap(), bytes);
    let path = root.path().join(VERSION).join("sample_annotation.json");
    let longer = std::fs::read_to_string(&path).unwrap().replacen('[', "[      ", 1);
    std::fs::write(&path, longer).unwrap();
    assert_eq!(load(root.path(), cache.path()), first);
    assert_ne!(std::fs::read(&index).unwrap(), bytes);
}

#[test]
fn a_cache_folder_that_cannot_be_written_is_only_warned_about() {
    let (root, report) = (Dataset::small().write(), Report::default());
    let not_a_folder = root.path().join(VERSION).join("scene.json");
    let dataset = NuScenes::open(root.path(), VERSION, Some(&not_a_folder), &report).unwrap();
    assert!(dataset.drive(SCENE, &report).is_ok());
    assert!(notes(&report).iter().any(|(_, what, _)| what.contains("could not be saved")));
}
