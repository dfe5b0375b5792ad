//! Which recordings lie below a folder, by what is there.

use std::collections::BTreeMap;
use std::path::Path;

/// Folders of the benchmarks' pictures and labels; the first that is there counts where none is asked for.
const SPLITS: [&str; 2] = ["training", "testing"];

/// A drive, a tracking sequence or an object frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Recording {
    /// `2011_09_26_drive_0005_sync`, `0000`, `000000`.
    pub(super) name: String,
    pub(super) form: Form,
    /// The folder that it lies in, below the root, with a `/` behind it unless it is empty: the recording day's, or the
    /// benchmark's split.
    pub(super) below: String,
    /// The benchmark's folder, likewise.
    pub(super) base: String,
}

/// How a recording lies on the disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// Synced and rectified.
    Synced,
    /// As the sensors wrote it.
    Extracted,
    Tracking,
    Object,
}

/// All recordings below a root by their names. The root is that of raw recordings, one of their days, that of a benchmark,
/// or a folder of such roots.
pub(super) fn find(root: &Path, split: Option<&str>) -> BTreeMap<String, Recording> {
    let mut found = BTreeMap::new();
    let bases = || std::iter::once(String::new()).chain(folders(root));
    for base in bases() {
        let days = folders(&root.join(&base)).filter(|name| is_day(name)).map(|day| format!("{base}{day}"));
        for day in days.chain([base.clone()]) {
            for name in folders(&root.join(&day)) {
                let name = name.trim_end_matches('/');
                let form = match name.split_once("_drive_") {
                    Some((_, drive)) if drive.ends_with("_sync") => Form::Synced,
                    Some((_, drive)) if drive.ends_with("_extract") => Form::Extracted,
                    _ => continue,
                };
                let recording = Recording { name: name.into(), form, below: day.clone(), base: base.clone() };
                found.entry(name.to_owned()).or_insert(recording);
            }
        }
        let is_there = |split: &&str| root.join(format!("{base}{split}/calib")).is_dir();
        let Some(split) = split.or_else(|| SPLITS.into_iter().find(is_there)) else { continue };
        for file in names(&root.join(format!("{base}{split}/calib"))) {
            let Some(name) = file.strip_suffix(".txt").filter(|n| n.bytes().all(|b| b.is_ascii_digit())) else {
                continue;
            };
            let form = match name.len() {
                4 => Form::Tracking,
                6 => Form::Object,
                _ => continue,
            };
            let below = format!("{base}{split}/");
            let recording = Recording { name: name.into(), form, below, base: base.clone() };
            found.entry(name.to_owned()).or_insert(recording);
        }
    }
    found
}

/// Whether a root has KITTI-STEP's labels, which are no drive by themselves.
pub(super) fn has_step(root: &Path) -> bool {
    root.join("panoptic_maps").is_dir()
}

/// `2011_09_26/`.
fn is_day(folder: &str) -> bool {
    folder.len() == 11
        && folder.bytes().enumerate().all(|(i, b)| match i {
            4 | 7 => b == b'_',
            10 => b == b'/',
            _ => b.is_ascii_digit(),
        })
}

/// Names of the folders in a folder, with a `/` behind each, sorted; none where it cannot be read.
fn folders(folder: &Path) -> impl Iterator<Item = String> + use<> {
    let folder = folder.to_owned();
    let inside = names(&folder).into_iter().filter(move |name| folder.join(name).is_dir());
    inside.map(|name| format!("{name}/"))
}

/// Names of what is in a folder and not hidden, sorted.
pub(super) fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.retain(|name| !name.starts_with('.'));
    names.sort();
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(paths: &[&str], split: Option<&str>) -> Vec<(String, Form, String)> {
        let root = tempfile::tempdir().unwrap();
        for path in paths {
            let path = root.path().join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "").unwrap();
        }
        find(root.path(), split).into_values().map(|r| (r.name, r.form, r.below)).collect()
    }

    #[test]
    fn each_layout_is_known_by_what_is_there() {
        let raw = |day: &str| {
            vec![
                ("2011_09_26_drive_0001_sync".to_owned(), Form::Synced, day.to_owned()),
                ("2011_09_26_drive_0002_extract".to_owned(), Form::Extracted, day.to_owned()),
            ]
        };
        let drives = ["2011_09_26_drive_0001_sync/oxts/x", "2011_09_26_drive_0002_extract/oxts/x"];
        assert_eq!(found(&drives, None), raw(""));
        let of_days = drives.map(|drive| format!("2011_09_26/{drive}"));
        assert_eq!(found(&of_days.each_ref().map(String::as_str), None), raw("2011_09_26/"));
        let of_raw = drives.map(|drive| format!("raw/2011_09_26/{drive}"));
        assert_eq!(found(&of_raw.each_ref().map(String::as_str), None), raw("raw/2011_09_26/"));

        let tracking = ["training/calib/0003.txt", "testing/calib/0004.txt", "training/calib/x.txt"];
        assert_eq!(found(&tracking, None), [("0003".to_owned(), Form::Tracking, "training/".to_owned())]);
        assert_eq!(found(&tracking, Some("testing")), [("0004".to_owned(), Form::Tracking, "testing/".to_owned())]);
        let object = ["object/training/calib/000007.txt", "tracking/testing/calib/0001.txt"];
        let expected = [
            ("000007".to_owned(), Form::Object, "object/training/".to_owned()),
            ("0001".to_owned(), Form::Tracking, "tracking/testing/".to_owned()),
        ];
        assert_eq!(found(&object, None), expected);
        assert_eq!(found(&["v1.0-mini/scene.json", "photos/a/b.png"], None), []);
    }
}
