//! Argoverse 2: a small valid log of which one file is replaced.

use std::path::Path;

use trove_model::Report;

#[allow(clippy::unwrap_used, dead_code, unreachable_pub)] // the reader's tests use the rest
#[path = "../../crates/trove-read/tests/argoverse2/fixture.rs"]
mod fixture;

use fixture::{HEIGHT, Log, MAP, SIMILARITY, load, put};

fn files(is_wanted: impl Fn(&str) -> bool) -> Vec<(&'static str, Vec<u8>)> {
    Log::small().files().into_iter().filter(|(name, _)| is_wanted(name)).collect()
}

fn seeds_of(name: &str) -> Vec<Vec<u8>> {
    files(|file| file == name).into_iter().map(|(_, bytes)| bytes).collect()
}

pub(crate) fn prepare(folder: &Path) {
    files(|_| true).into_iter().for_each(|(name, bytes)| put(folder, name, &bytes));
}

fn feed(folder: &Path, file: &str, data: &[u8]) {
    put(folder, file, data);
    let _ = load(folder, &Report::default());
}

/// The first byte says which table it is.
pub(crate) fn feed_feather(folder: &Path, data: &[u8]) {
    let Some((&which, bytes)) = data.split_first() else { return };
    let tables = files(|name| name.ends_with(".feather"));
    let (name, whole) = &tables[usize::from(which) % tables.len()];
    feed(folder, name, bytes);
    put(folder, name, whole);
}

pub(crate) fn feather_seeds() -> Vec<Vec<u8>> {
    let tables = files(|name| name.ends_with(".feather")).into_iter().enumerate();
    tables.map(|(i, (_, bytes))| [vec![i as u8], bytes].concat()).collect()
}

pub(crate) fn feed_height(folder: &Path, data: &[u8]) {
    feed(folder, HEIGHT, data);
}

pub(crate) fn height_seeds() -> Vec<Vec<u8>> {
    vec![fixture::npy(6, &[69.7; 24])]
}

/// The vector map, or the similarity of its ground height.
pub(crate) fn feed_map(folder: &Path, data: &[u8]) {
    feed(folder, if data.starts_with(b"{\"R\"") { SIMILARITY } else { MAP }, data);
}

pub(crate) fn map_seeds() -> Vec<Vec<u8>> {
    [seeds_of(MAP), seeds_of(SIMILARITY)].concat()
}
