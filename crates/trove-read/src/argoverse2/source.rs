//! Argoverse 2 as a source of drives; it has no options of its own.

use std::path::PathBuf;

use rayon::prelude::*;
use serde::Deserialize;
use trove_model::{Drive, Report};

use super::dataset::{Argoverse2, count_keyframes};
use crate::ReadError;
use crate::drive_source::{Dataset, DriveListing, DriveSource, Opener};

pub(crate) const DATASET: Dataset = Dataset { name: "argoverse2", is_at: Argoverse2::is_at, configure };

/// The keys of a recipe's `[drive]` that only Argoverse 2 has: none.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Options {}

fn configure(options: toml::Table) -> Result<Opener, toml::de::Error> {
    let Options {} = options.try_into()?;
    Ok(Box::new(|root, _, report| Ok(Box::new(Argoverse2::open(root, report)?))))
}

impl DriveSource for Argoverse2 {
    fn drives(&self) -> Vec<DriveListing> {
        let listing = |(name, folder): (&String, &PathBuf)| DriveListing {
            name: name.clone(),
            keyframes: count_keyframes(folder),
        };
        self.logs.par_iter().map(listing).collect()
    }

    fn read(&self, name: &str, report: &Report) -> Result<Drive, ReadError> {
        self.drive(name, report)
    }

    fn tables(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    fn recording(&self, name: &str) -> Result<Vec<PathBuf>, ReadError> {
        self.files(name)
    }
}
