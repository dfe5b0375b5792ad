//! Latitude-longitude pictures of a sky (`.hdr`, `.exr`) → `EnvironmentMap`.
//!
//! Such a picture shows the surroundings as seen from inside: its top row is the zenith, and going right in it is
//! turning right, which is clockwise seen from above. `EnvironmentMap` runs from west through north to east, clockwise
//! too, so rows and columns are taken as they stand and writing in the picture stays readable. Nothing in a file says
//! where north is; the picture's middle looks east.

use std::io::{BufReader, Read};
use std::path::Path;

use image::{ImageFormat, ImageReader};
use trove_files::open_regular;
use trove_model::EnvironmentMap;

use crate::ReadError;
use trove_files::Budget;

/// Wider pictures are of no use for light and take over 1.6 GB, pixels.
const MAX_WIDTH: usize = 16_384;

/// Reads a picture whose width is twice its height. Values that are no radiance (NaN, infinite, negative) are repaired.
///
/// # Errors
/// A file that cannot be read, is neither Radiance HDR nor OpenEXR, or is not twice as wide as high, 16384 pixels wide at most.
pub fn read(path: &Path) -> Result<EnvironmentMap, ReadError> {
    let mut magic = [0; 4];
    let io = |source| ReadError::io(path, source);
    let mut file = open_regular(path).map_err(io)?;
    let length = file.read(&mut magic).map_err(io)?;
    let (width, height, mut rgb) = match &magic[..length] {
        [0x76, 0x2f, 0x31, 0x01] => read_exr(path)?,
        [b'#', b'?', ..] => read_hdr(path)?,
        _ => return Err(format(path, "Radiance HDR or OpenEXR", "another kind of file", "convert it to .hdr or .exr")),
    };
    repair(&mut rgb);
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(EnvironmentMap { name, width: width as u32, height: height as u32, rgb })
}

type Picture = (usize, usize, Vec<[f32; 3]>);

fn read_hdr(path: &Path) -> Result<Picture, ReadError> {
    let open = || {
        let file = open_regular(path).map_err(|source| ReadError::io(path, source))?;
        Ok::<_, ReadError>(ImageReader::with_format(BufReader::new(file), ImageFormat::Hdr))
    };
    let damaged = |e: image::ImageError| damaged(path, e.to_string());
    // Before the pixels are read: a damaged header may ask for any amount of memory.
    let (width, height) = open()?.into_dimensions().map_err(damaged)?;
    check_size(path, width as usize, height as usize)?;
    let mut reader = open()?;
    reader.no_limits();
    let pixels = reader.decode().map_err(damaged)?.into_rgb32f();
    Ok((width as usize, height as usize, pixels.pixels().map(|p| p.0).collect()))
}

fn read_exr(path: &Path) -> Result<Picture, ReadError> {
    use exr::prelude::{MetaData, ReadChannels, ReadLayers, read};
    let damaged = |e: exr::error::Error| damaged(path, e.to_string());
    let meta = MetaData::read_from_file(path, false).map_err(damaged)?;
    for header in &meta.headers {
        check_size(path, header.layer_size.x(), header.layer_size.y())?;
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| (size.x(), vec![[0.0; 3]; size.x() * size.y()]),
            |(width, pixels): &mut (usize, Vec<[f32; 3]>), at, (r, g, b): (f32, f32, f32)| {
                pixels[at.y() * *width + at.x()] = [r, g, b];
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .map_err(damaged)?;
    let size = image.layer_data.size;
    Ok((size.x(), size.y(), image.layer_data.channel_data.pixels.1))
}

fn check_size(path: &Path, width: usize, height: usize) -> Result<(), ReadError> {
    if width == 0 || width != 2 * height {
        let expected = "a latitude-longitude image, twice as wide as it is high";
        let remedy = "give a full equirectangular panorama";
        return Err(format(path, expected, &format!("{width}×{height} pixels"), remedy));
    }
    if width > MAX_WIDTH {
        let expected = format!("an image at most {MAX_WIDTH} pixels wide");
        return Err(format(path, &expected, &format!("{width} pixels"), "scale it down"));
    }
    let bytes = std::fs::metadata(path).map_err(|source| ReadError::io(path, source))?.len();
    Budget::of_file(bytes)
        .take(width * height, size_of::<[f32; 3]>())
        .map_err(|exceeded| format(path, &exceeded.expected(), &format!("{width} × {height} pixels"), "scale it down"))
}

/// A value that is no number becomes its left neighbour's, an infinite one the picture's brightest, a negative one 0.
fn repair(rgb: &mut [[f32; 3]]) {
    let values = || rgb.iter().flatten().copied();
    if values().all(|v| v.is_finite() && v >= 0.0) {
        return;
    }
    let brightest = values().filter(|v| v.is_finite()).fold(0.0, f32::max);
    let mut last = [0.0; 3];
    for pixel in rgb {
        for (value, last) in pixel.iter_mut().zip(&mut last) {
            *value = match *value {
                v if v.is_nan() => *last,
                v => v.clamp(0.0, brightest),
            };
            *last = *value;
        }
    }
}

fn damaged(path: &Path, found: String) -> ReadError {
    format(path, "a complete image", &found, "download it again")
}

fn format(path: &Path, expected: &str, found: &str, remedy: &str) -> ReadError {
    ReadError::Format {
        path: path.to_owned(),
        place: "picture".into(),
        expected: expected.into(),
        found: found.into(),
        remedy: remedy.into(),
    }
}
