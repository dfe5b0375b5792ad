//! A reply that is a whole extract, under its name.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use trove_files::{hidden_beside, write_synced};
use trove_read::osm;

/// Larger replies are refused, bytes: 100 km² of a dense city take a third of it.
const LARGEST: u64 = 512 << 20;

/// The largest reply, bytes.
pub(super) fn largest() -> u64 {
    LARGEST
}

/// Writes an extract once our own reader has read all of it; nothing is left of one that it cannot read.
pub(super) fn settled(bytes: &[u8], file: &Path) -> Result<()> {
    ensure!(
        bytes.windows(5).any(|window| window == b"<node"),
        "expected a map, found a reply without a node: nothing is mapped there; check the place"
    );
    let partial = hidden_beside(file, &format!("{}.partial", std::process::id()));
    let written = write_synced(&partial, bytes)
        .with_context(|| format!("{}: expected a file that can be written", file.display()))
        .and_then(|()| Ok(osm::extent(&partial).map(drop)?))
        .and_then(|()| {
            fs::rename(&partial, file)
                .with_context(|| format!("{}: expected a file that can be replaced", file.display()))
        });
    if written.is_err() {
        // The first error is the one to tell of.
        let _ = fs::remove_file(&partial);
    }
    written
}
