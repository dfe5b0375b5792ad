//! Where a dataset's recordings lie.

use std::path::{Component, Path, PathBuf};

use trove_model::{Outcome, Report};

/// The files below a root that the tables of one version name.
pub(super) struct Files<'a> {
    pub(super) root: &'a Path,
    /// What the folders of recordings begin with where they are not named as in the tables: `train_` beside `train_data`.
    prefix: Option<&'a str>,
}

impl<'a> Files<'a> {
    /// Of a version, by the name of its folder.
    pub(super) fn of(root: &'a Path, version: &'a str) -> Self {
        Self { root, prefix: version.strip_suffix("data").filter(|prefix| !prefix.is_empty()) }
    }

    /// A file's path below the root; `None` where it is not at hand. Paths that leave the root are not followed.
    pub(super) fn existing(&self, file: &str, report: &Report) -> Option<String> {
        if !Path::new(file).components().all(|c| matches!(c, Component::Normal(_))) {
            report.note(Outcome::Dropped, "file name outside the dataset's folder", file);
            return None;
        }
        let prefixed = self.prefix.map(|prefix| format!("{prefix}{file}"));
        [Some(file.to_owned()), prefixed]
            .into_iter()
            .flatten()
            .find(|file| !file.is_empty() && self.path(file).is_file())
    }

    /// Where a path below the root is.
    pub(super) fn path(&self, file: &str) -> PathBuf {
        self.root.join(file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_found_as_named_or_beside_its_tables() {
        let root = tempfile::tempdir().unwrap();
        for folder in ["lidar", "train_images"] {
            std::fs::create_dir(root.path().join(folder)).unwrap();
            std::fs::write(root.path().join(folder).join("a"), "").unwrap();
        }
        let (train, plain) = (Files::of(root.path(), "train_data"), Files::of(root.path(), "v1.02-train"));
        let found = |files: &Files, name: &str| files.existing(name, &Report::default());
        assert_eq!(found(&train, "images/a").as_deref(), Some("train_images/a"));
        assert_eq!(found(&plain, "images/a"), None);
        assert_eq!(
            (found(&train, "lidar/a"), found(&plain, "lidar/a")),
            (Some("lidar/a".into()), Some("lidar/a".into()))
        );
        let report = Report::default();
        assert_eq!((train.existing("../a", &report), train.existing("", &report)), (None, None));
        assert_eq!(report.entries().len(), 1);
    }
}
