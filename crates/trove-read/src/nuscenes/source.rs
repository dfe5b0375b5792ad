//! nuScenes as a source of drives, with the options that are its own.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use trove_model::{Drive, Report};

use super::{NuScenes, tables};
use crate::ReadError;
use crate::drive_source::{Dataset, DriveListing, DriveSource, Opener};

pub(crate) const DATASET: Dataset =
    Dataset { name: "nuscenes", is_at: |root| !NuScenes::versions(root).is_empty(), configure };

/// The keys of a recipe's `[drive]` that only nuScenes has.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Options {
    /// The folder of tables, such as `v1.0-mini`; without it the only one that is there.
    version: Option<String>,
}

fn configure(options: toml::Table) -> Result<Opener, toml::de::Error> {
    let Options { version } = options.try_into()?;
    Ok(Box::new(move |root, cache_dir, report| {
        let version = version.clone().map_or_else(|| only_version(root), Ok)?;
        Ok(Box::new(NuScenes::open(root, &version, cache_dir, report)?))
    }))
}

fn only_version(root: &Path) -> Result<String, ReadError> {
    let versions = NuScenes::versions(root);
    let missing = |expected: &str, found: String, remedy: &str| ReadError::Missing {
        path: root.to_owned(),
        expected: expected.into(),
        found,
        remedy: remedy.into(),
    };
    match versions.as_slice() {
        [only] => Ok(only.clone()),
        [] => Err(missing(
            "a nuScenes root with a folder of tables, such as v1.0-mini",
            "none".into(),
            "give the folder that contains v1.0-trainval or v1.0-mini as the root",
        )),
        several => Err(missing("one version", several.join(", "), "name one as the dataset's version")),
    }
}

impl DriveSource for NuScenes {
    fn drives(&self) -> Vec<DriveListing> {
        self.scenes().into_iter().map(|s| DriveListing { name: s.name, keyframes: s.keyframes }).collect()
    }

    fn read(&self, name: &str, report: &Report) -> Result<Drive, ReadError> {
        self.drive(name, report)
    }

    fn tables(&self) -> Vec<PathBuf> {
        tables::all(&self.folder)
    }

    fn recording(&self, name: &str) -> Result<Vec<PathBuf>, ReadError> {
        self.recorded_files(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_without_a_version_or_with_several_says_what_to_do() {
        let root = tempfile::tempdir().unwrap();
        let error = || only_version(root.path()).unwrap_err().to_string();
        assert!(!(DATASET.is_at)(root.path()) && error().contains("v1.0-mini as the root"));
        for version in ["v1.0-mini", "v1.0-trainval"] {
            std::fs::create_dir(root.path().join(version)).unwrap();
            std::fs::write(root.path().join(version).join("sample_data.json"), "[]").unwrap();
        }
        assert!((DATASET.is_at)(root.path()));
        assert!(error().contains("one version, found v1.0-mini, v1.0-trainval"), "{}", error());
    }

    #[test]
    fn an_option_of_another_dataset_is_refused() {
        let refused = |text: &str| configure(text.parse().unwrap()).err().map(|error| error.message().to_owned());
        assert_eq!(refused("version = 'v1.0-mini'"), None);
        assert!(refused("sequence = 3").unwrap().contains("`version`"));
        assert!(refused("version = 3").unwrap().contains("string"));
    }
}
