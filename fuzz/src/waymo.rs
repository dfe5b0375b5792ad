//! Waymo: a small valid segment of which one file is replaced.

use std::path::Path;

use trove_model::Report;
use trove_read::waymo::Waymo;

use parquet_writer::Packing;
use waymo_writer::{Segment, put, record};

#[allow(clippy::unwrap_used, dead_code, unreachable_pub)] // the reader's tests use the rest
#[path = "../../crates/trove-read/tests/waymo/parquet_writer.rs"]
mod parquet_writer;
#[allow(clippy::unwrap_used, dead_code, unreachable_pub)] // the reader's tests use the rest
#[path = "../../crates/trove-read/tests/waymo/writer.rs"]
mod waymo_writer;

const FILE: &str = "a.tfrecord";

fn read(folder: &Path) {
    let report = Report::default();
    if let Ok(waymo) = Waymo::open(folder, 1, &report) {
        for listing in waymo.segments() {
            let _ = waymo.drive(&listing.name, &report);
            let _ = waymo.labels(&listing.name, &report, &mut |_| ());
        }
    }
}

/// As a whole file where the first byte is even; else as a frame, with checksums that are right.
pub(crate) fn feed_tfrecord(folder: &Path, data: &[u8]) {
    let Some((&which, bytes)) = data.split_first() else { return };
    let bytes = if which % 2 == 0 { bytes.to_vec() } else { record(bytes) };
    put(folder, FILE, &bytes);
    read(folder);
}

pub(crate) fn tfrecord_seeds() -> Vec<Vec<u8>> {
    let small = Segment::small();
    vec![[vec![0], small.v1()].concat(), [vec![1], small.frame_message(&small.frames[0], true)].concat()]
}

pub(crate) fn prepare_components(folder: &Path) {
    for (name, bytes) in Segment::small().v2(Packing::None) {
        put(folder, &format!("{name}/small.parquet"), &bytes);
    }
}

/// The first byte says which component it is.
pub(crate) fn feed_component(folder: &Path, data: &[u8]) {
    let Some((&which, bytes)) = data.split_first() else { return };
    let components = Segment::small().v2(Packing::None);
    let (name, whole) = &components[usize::from(which) % components.len()];
    let file = format!("{name}/small.parquet");
    put(folder, &file, bytes);
    read(folder);
    put(folder, &file, whole);
}

pub(crate) fn component_seeds() -> Vec<Vec<u8>> {
    let seeds = |packing| {
        let components = Segment::small().v2(packing).into_iter().enumerate();
        components.map(|(i, (_, bytes))| [vec![i as u8], bytes].concat())
    };
    seeds(Packing::None).chain(seeds(Packing::Snappy)).chain(seeds(Packing::Zstd)).collect()
}
