//! An opened dataset: which scenes it has.

use std::path::{Path, PathBuf};

use trove_model::{Outcome, Report};

use super::files::Files;
use super::index::Index;
use super::index_file::IndexFile;
use super::records::{LogRecord, SceneRecord};
use super::tables::Tables;
use crate::ReadError;

/// Tables whose change makes an index stale.
const INDEXED: [&str; 7] =
    ["scene", "sample", "sample_data", "ego_pose", "sample_annotation", "calibrated_sensor", "sensor"];

/// An opened dataset: its root folder and one version of its tables.
pub struct NuScenes {
    pub(super) root: PathBuf,
    /// Holds the version's tables.
    pub(super) folder: PathBuf,
    pub(super) tables: Tables,
    pub(super) index: Index,
}

/// What a scene is, before it is loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneSummary {
    /// `scene-0103`.
    pub name: String,
    /// The map that it lies on (`boston-seaport`); empty where the log does not say.
    pub place: String,
    /// Day of the recording (`2018-08-01`); empty where the log does not say.
    pub date_captured: String,
    /// The dataset's words for it; may be empty.
    pub description: String,
    /// Annotated moments.
    pub keyframes: usize,
    /// The dataset's token of it.
    pub token: String,
}

impl NuScenes {
    /// Opens a version (`v1.0-mini`) below a root folder; the index of the big tables is kept in `cache_dir`, or
    /// made anew and not kept where that is `None`.
    ///
    /// # Errors
    /// A folder without that version, or a table that is missing or damaged.
    pub fn open(root: &Path, version: &str, cache_dir: Option<&Path>, report: &Report) -> Result<Self, ReadError> {
        let folder = root.join(version);
        if !folder.is_dir() || version.is_empty() {
            return Err(no_such_version(root, version));
        }
        refuse_nuimages(&folder)?;
        let tables = Tables::read(&folder, report)?;
        let file = cache_dir.map(|dir| IndexFile::new(dir, &folder, &INDEXED));
        let kept = file.as_ref().and_then(IndexFile::read).filter(|i| i.scenes.len() == tables.scenes.len());
        let index = match kept {
            Some(index) => index,
            None => {
                let index = Index::build(&folder, &tables)?;
                if let Some((file, Err(e))) = file.map(|f| {
                    let kept = f.write(&index);
                    (f, kept)
                }) {
                    let example = format!("{}: {e}", file.path().display());
                    report.note(Outcome::Warned, "index of the nuScenes tables could not be saved", example);
                }
                index
            }
        };
        index.replay(report);
        Ok(Self { root: root.to_owned(), folder, tables, index })
    }

    /// The versions below a root folder (`v1.0-mini`): the folders with tables, sorted.
    pub fn versions(root: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(root).into_iter().flatten().flatten();
        let has_tables = |folder: &Path| ["scene.json", "sample_data.json"].iter().any(|t| folder.join(t).is_file());
        let folders = entries.filter(|e| has_tables(&e.path()));
        let mut names: Vec<_> = folders.filter_map(|e| e.file_name().into_string().ok()).collect();
        names.sort();
        names
    }

    /// The scenes, sorted by name.
    pub fn scenes(&self) -> Vec<SceneSummary> {
        let summary = |(scene, samples): (&SceneRecord, &Vec<String>)| {
            let log = self.log(scene);
            SceneSummary {
                name: scene.name.clone(),
                place: log.map_or_else(String::new, |l| l.location.clone()),
                date_captured: log.map_or_else(String::new, |l| l.date_captured.clone()),
                description: scene.description.clone(),
                keyframes: samples.len(),
                token: scene.token.clone(),
            }
        };
        let mut scenes: Vec<_> = self.tables.scenes.iter().zip(&self.tables.samples_of_scene).map(summary).collect();
        scenes.sort_by(|a, b| (&a.name, &a.token).cmp(&(&b.name, &b.token)));
        scenes
    }

    /// The recordings that the tables name.
    pub(super) fn files(&self) -> Files<'_> {
        Files::of(&self.root, self.folder.file_name().and_then(|name| name.to_str()).unwrap_or_default())
    }

    pub(super) fn log(&self, scene: &SceneRecord) -> Option<&LogRecord> {
        self.tables.logs.get(&scene.log_token)
    }

    pub(super) fn no_such_scene(&self, name: &str) -> ReadError {
        let mut names: Vec<_> = self.tables.scenes.iter().map(|s| s.name.as_str()).collect();
        names.sort_by_key(|n| (strsim::damerau_levenshtein(n, name), *n));
        names.truncate(3);
        ReadError::Missing {
            path: self.folder.join("scene.json"),
            expected: format!("a scene named '{name}'"),
            found: format!("{} others", self.tables.scenes.len()),
            remedy: match names.as_slice() {
                [] => "choose another version".to_owned(),
                nearest => format!("the nearest names are {}", nearest.join(", ")),
            },
        }
    }
}

/// nuImages has tables of the same form, of labels that lie in the picture.
fn refuse_nuimages(folder: &Path) -> Result<(), ReadError> {
    let is_there = |table: &str| folder.join(table).is_file();
    if !is_there("object_ann.json") || is_there("sample_annotation.json") {
        return Ok(());
    }
    Err(ReadError::Missing {
        path: folder.to_owned(),
        expected: "recorded scenes with 3D boxes (scene.json, sample_annotation.json)".to_owned(),
        found: "nuImages: outlines in single pictures (object_ann.json), without objects' places or sizes".to_owned(),
        remedy: "no virtual scene can be built from it: use nuScenes, whose pictures are of the same cameras"
            .to_owned(),
    })
}

fn no_such_version(root: &Path, version: &str) -> ReadError {
    let versions = NuScenes::versions(root);
    let (found, remedy) = match versions.as_slice() {
        [] => ("none", "give the folder that contains v1.0-trainval or v1.0-mini as the root".to_owned()),
        some => ("others", format!("choose one of {}", some.join(", "))),
    };
    ReadError::Missing {
        path: root.to_owned(),
        expected: format!("a folder '{version}' with the tables of a version"),
        found: found.to_owned(),
        remedy,
    }
}
