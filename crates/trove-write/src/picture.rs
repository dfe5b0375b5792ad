//! A picture alone.

use std::path::Path;

use trove_model::Raster;

use crate::{WriteError, png_file, write_atomically};

/// Writes an 8-bit sRGB picture as PNG.
///
/// # Errors
/// Data that do not have the picture's size, or a file system that refuses.
pub fn write_picture(path: &Path, picture: &Raster<[u8; 3]>) -> Result<(), WriteError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    write_atomically(path, &encode_picture(&name, picture)?)
}

/// An 8-bit sRGB picture as the bytes of a PNG file; errors name it `name`.
///
/// # Errors
/// Data that do not have the picture's size.
pub fn encode_picture(name: &str, picture: &Raster<[u8; 3]>) -> Result<Vec<u8>, WriteError> {
    png_file::rgb(name, picture.width, picture.height, &picture.data)
}
