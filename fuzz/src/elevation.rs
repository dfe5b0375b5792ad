//! Elevation files.

use std::fs;
use std::path::Path;

use glam::DVec2;
use trove_model::{Bounds, MapProjection, Report};
use trove_read::relief;

#[allow(dead_code, clippy::unwrap_used)] // it is part of a test
#[path = "../../crates/trove-read/tests/relief/wire.rs"]
mod wire;

use wire::Tiff;

fn feed(folder: &Path, name: &str, data: &[u8]) {
    let path = folder.join(name);
    if fs::write(&path, data).is_err() {
        return;
    }
    let projection = MapProjection::spherical(0.5, 0.5, DVec2::ZERO);
    // Whatever is wrong is an error.
    let _ = relief::read(&[path], &projection, Bounds::square(DVec2::ZERO, 4000.0), &Report::default());
}

/// As a zip file and as a tile.
pub(crate) fn feed_tile(folder: &Path, data: &[u8]) {
    feed(folder, "tile.zip", data);
    feed(folder, "N00E000.hgt", data);
}

pub(crate) fn feed_picture(folder: &Path, data: &[u8]) {
    feed(folder, "picture.tif", data);
}

pub(crate) fn tile_seeds() -> Vec<Vec<u8>> {
    let tile = wire::hgt(|x, _| if x < 0.3 { i16::MIN } else { 7 });
    vec![wire::zip("N00E000.hgt", &tile, true), wire::zip("dem/N00E000.hgt", b"short", false)]
}

pub(crate) fn picture_seeds() -> Vec<Vec<u8>> {
    let tiff = |bits, format| Tiff::new([40, 40], bits, format).placed([0.0, 1.0], [0.025, 0.025]);
    let floats = wire::with_float_predictor(&vec![(0..16).map(|x| x as f32).collect(); 16]);
    let tiles = tiff(32, 3)
        .shorts(259, &[8])
        .shorts(317, &[3])
        .text(42113, "-9999")
        .tiles(16, vec![wire::deflated(&floats); 9]);
    let strips = tiff(16, 2).text(33432, "CC0").strips(10, vec![vec![1; 800]; 4]);
    vec![tiles.bytes(), strips.bytes()]
}
