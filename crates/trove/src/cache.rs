//! Where what can be made again is kept.

use std::path::PathBuf;

/// `TROVE_CACHE`, else `trove` in the user's cache folder; `None` where there is neither. As its specification asks,
/// `XDG_CACHE_HOME` counts only where it is absolute, so that nothing is written to the working folder by accident.
pub(crate) fn folder() -> Option<PathBuf> {
    let set = |name| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    set("TROVE_CACHE")
        .or_else(|| set("XDG_CACHE_HOME").filter(|cache| cache.is_absolute()).map(|cache| cache.join("trove")))
        .or_else(|| set("HOME").map(|home| home.join(".cache").join("trove")))
}
