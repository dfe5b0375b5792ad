//! Folders of pictures that belong together.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use image::imageops::{FilterType, resize};
use image::{DynamicImage, ImageReader};
use trove_model::Raster;

use crate::JudgeError;

/// Endings of the names of pictures.
const PICTURES: [&str; 3] = ["png", "jpg", "jpeg"];

/// Pictures below a folder by what two folders' pictures of the same thing have in common: the path below the folder
/// without its ending, and for Cityscapes' files city, sequence and frame alone. `wanted` chooses by file name.
pub(crate) fn pictures(root: &Path, wanted: impl Fn(&str) -> bool) -> Result<BTreeMap<String, PathBuf>, JudgeError> {
    let mut found = BTreeMap::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).map_err(JudgeError::io(&folder))? {
            let path = entry.map_err(JudgeError::io(&folder))?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
            if path.is_dir() {
                // Hidden folders hold what is being made.
                if !name.starts_with('.') {
                    folders.push(path);
                }
            } else if PICTURES.contains(&ending.as_str()) && wanted(&name) {
                let below = path.strip_prefix(root).unwrap_or(&path).with_extension("");
                let key = cityscapes_key(&name).unwrap_or_else(|| below.to_string_lossy().replace('\\', "/"));
                found.insert(key, path);
            }
        }
    }
    Ok(found)
}

/// `aachen_000000_000019` of `aachen_000000_000019_gtFine_labelIds.png`.
fn cityscapes_key(name: &str) -> Option<String> {
    let parts: Vec<&str> = name.split(['_', '.']).collect();
    let number = |part: &&str| part.len() == 6 && part.bytes().all(|b| b.is_ascii_digit());
    (parts.len() > 3 && number(&parts[1]) && number(&parts[2])).then(|| parts[..3].join("_"))
}

/// A picture's pixels as its file has them.
pub(crate) fn read(path: &Path) -> Result<DynamicImage, JudgeError> {
    let reader = ImageReader::open(path).map_err(JudgeError::io(path))?;
    reader
        .decode()
        .map_err(|e| JudgeError::unexpected(path, "a PNG or JPEG picture", e.to_string(), "make the file again"))
}

/// A small picture of a picture, `width` pixels wide.
pub fn thumbnail(path: &Path, width: u32) -> Result<Raster<[u8; 3]>, JudgeError> {
    let picture = read(path)?.into_rgb8();
    let height = (picture.height() * width / picture.width().max(1)).max(1);
    let small = resize(&picture, width, height, FilterType::Triangle);
    Ok(Raster::from_fn(width, height, |x, y| small.get_pixel(x, y).0))
}

/// A picture of labels: one number a pixel.
pub(crate) struct Labels {
    pub width: u32,
    pub ids: Vec<u8>,
}

/// Reads labels; a picture in colours holds no numbers.
pub(crate) fn read_labels(path: &Path) -> Result<Labels, JudgeError> {
    match read(path)? {
        DynamicImage::ImageLuma8(grey) => Ok(Labels { width: grey.width(), ids: grey.into_raw() }),
        other => Err(JudgeError::unexpected(
            path,
            "8-bit grey labels, a class id a pixel",
            format!("{:?}", other.color()),
            "write the ids themselves rather than colours",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cityscapes_names_are_known_by_city_sequence_and_frame() {
        let key = cityscapes_key("aachen_000000_000019_gtFine_labelIds.png");
        assert_eq!(key.as_deref(), Some("aachen_000000_000019"));
        assert_eq!(cityscapes_key("0001TP_006690.png"), None);
        assert_eq!(cityscapes_key("class.png"), None);
    }
}
