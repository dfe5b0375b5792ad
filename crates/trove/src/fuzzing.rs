//! What fuzz targets need of this crate's inside.

use crate::library;

/// Reads a file of the cache of generated libraries; whether it is whole.
pub fn cached_library(bytes: &[u8]) -> bool {
    library::is_whole(bytes)
}

/// A small file of that cache.
pub fn small_cached_library() -> Vec<u8> {
    library::small()
}
