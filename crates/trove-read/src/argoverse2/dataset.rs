//! An opened dataset: which logs it has.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};

use trove_files::PathComponent;
use trove_model::{Outcome, Report};

use super::boxes;
use super::exposures::files_by_time;
use crate::ReadError;

/// Licence of the dataset's records, with whom to name.
pub const LICENCE: &str = "CC BY-NC-SA 4.0, Argoverse 2 © Argo AI, LLC";

/// The parts that the dataset comes in; a root may hold them or their logs.
const SPLITS: [&str; 3] = ["train", "val", "test"];
/// What every log has.
pub(super) const POSES: &str = "city_SE3_egovehicle.feather";
pub(super) const ANNOTATIONS: &str = "annotations.feather";

/// An opened Argoverse 2 sensor dataset: a folder of logs, or of the splits `train`, `val` and `test`.
pub struct Argoverse2 {
    pub(super) root: PathBuf,
    /// Folders by the logs' names.
    pub(super) logs: BTreeMap<String, PathBuf>,
}

impl Argoverse2 {
    /// Opens a root folder.
    ///
    /// # Errors
    /// A folder without logs.
    pub fn open(root: &Path, report: &Report) -> Result<Self, ReadError> {
        let mut logs = BTreeMap::new();
        for folder in log_folders(root) {
            let name = folder.file_name().and_then(|name| name.to_str()).unwrap_or_default().to_owned();
            if let Err(why) = PathComponent::new(&name) {
                let what = "Argoverse 2 log whose name cannot be a scene's";
                report.note(Outcome::Dropped, what, format!("{}: {why}", folder.display()));
                continue;
            }
            match logs.entry(name) {
                Entry::Vacant(slot) => {
                    slot.insert(folder);
                }
                Entry::Occupied(_) => {
                    report.note(Outcome::Dropped, "Argoverse 2 log with the name of another", folder.display());
                }
            }
        }
        if logs.is_empty() {
            return Err(ReadError::Missing {
                path: root.to_owned(),
                expected: format!(
                    "folders of Argoverse 2 logs, each with its {POSES}, or train, val or test with them"
                ),
                found: "none".to_owned(),
                remedy: "give the folder that the logs or the splits lie in as the root".to_owned(),
            });
        }
        Ok(Self { root: root.to_owned(), logs })
    }

    /// Whether a folder has a log.
    pub(super) fn is_at(root: &Path) -> bool {
        !log_folders(root).is_empty()
    }

    pub(super) fn folder(&self, name: &str) -> Result<&Path, ReadError> {
        self.logs.get(name).map(PathBuf::as_path).ok_or_else(|| {
            let mut names: Vec<_> = self.logs.keys().map(String::as_str).collect();
            names.sort_by_key(|n| (strsim::damerau_levenshtein(n, name), *n));
            names.truncate(3);
            ReadError::Missing {
                path: self.root.clone(),
                expected: format!("a log named '{name}'"),
                found: format!("{} others", self.logs.len()),
                remedy: format!("the nearest names are {}", names.join(", ")),
            }
        })
    }
}

/// The folders below a root, or below its splits, that have a log's poses, in order.
fn log_folders(root: &Path) -> Vec<PathBuf> {
    let folders = |root: &Path| {
        let entries = std::fs::read_dir(root).into_iter().flatten().flatten();
        let mut folders: Vec<_> = entries.map(|e| e.path()).filter(|path| path.join(POSES).is_file()).collect();
        folders.sort();
        folders
    };
    std::iter::once(root.to_owned())
        .chain(SPLITS.map(|split| root.join(split)))
        .flat_map(|root| folders(&root))
        .collect()
}

/// The times of a log's keyframes: those of its boxes; without any (the test split), those of its sweeps.
pub(super) fn keyframe_times(annotated: impl Iterator<Item = i64>, log: &Path) -> Vec<i64> {
    let mut times: Vec<i64> = annotated.collect();
    times.sort_unstable();
    times.dedup();
    if times.is_empty() { files_by_time(&log.join("sensors/lidar"), &["feather"]).into_keys().collect() } else { times }
}

/// How many keyframes a log has; 0 where its boxes cannot be read.
pub(super) fn count_keyframes(log: &Path) -> usize {
    let annotated = boxes::times(&log.join(ANNOTATIONS)).unwrap_or_default();
    keyframe_times(annotated.into_iter(), log).len()
}
