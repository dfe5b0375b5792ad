//! The plain form: the example of its documentation, and what is wrong with files.

#![allow(clippy::unwrap_used)] // the lint knows test functions, not the functions that they share

mod bad_input;
mod documentation;
mod files;
mod traces;

use std::path::Path;

use trove_model::{Drive, Report};
use trove_read::drive_source::DriveSource;
use trove_read::{DATASETS, ReadError};

/// Opens a dataset by its name.
fn open(name: &str, options: &str, root: &Path, report: &Report) -> Result<Box<dyn DriveSource>, ReadError> {
    let dataset = DATASETS.iter().find(|dataset| dataset.name == name).unwrap();
    (dataset.configure)(options.parse().unwrap()).unwrap()(root, None, report)
}

/// The only drive of a folder.
fn read(root: &Path, report: &Report) -> Result<Drive, ReadError> {
    let source = open("trove", "", root, report)?;
    source.read(&source.drives()[0].name, report)
}

fn put(root: &Path, file: &str, bytes: impl AsRef<[u8]>) {
    std::fs::create_dir_all(root.join(file).parent().unwrap()).unwrap();
    std::fs::write(root.join(file), bytes).unwrap();
}

/// What was noted, without the examples.
fn notes(report: &Report) -> Vec<(String, u64)> {
    report.entries().into_iter().map(|e| (e.what, e.count)).collect()
}
