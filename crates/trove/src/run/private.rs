//! The part of an output folder that only trove reads.

use std::time::{SystemTime, UNIX_EPOCH};

/// Its folder: the run's identity, its lock and the journal of finished frames.
pub(crate) const PRIVATE: &str = ".trove";
/// Below it, a folder a share: its lock and its journal.
pub(super) const PARTS: &str = "parts";

/// Nanoseconds since 1970 UTC.
pub(super) fn now_ns() -> u128 {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos()
}
