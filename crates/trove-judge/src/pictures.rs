//! Folders of pictures that belong together.

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufReader, Cursor};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use image::imageops::{FilterType, resize};
use image::{DynamicImage, ImageReader};
use png::{BitDepth, ColorType};
use rayon::prelude::*;
use trove_files::{LARGEST_FILE, open_regular, read_regular};
use trove_model::{ClassMap, Raster};

use crate::JudgeError;

/// 8192 × 8192: larger than any road camera's.
const MOST_PIXELS: u64 = 1 << 26;

/// Told how many pictures are done, and of how many; answers whether to go on.
pub type OnProgress<'a> = &'a (dyn Fn(usize, usize) -> bool + Sync);

/// Does something with each of many pictures, in parallel; the answers are in their order.
pub(crate) fn each<T: Sync, R: Send>(
    items: &[T],
    progress: OnProgress,
    of: impl Fn(&T) -> Result<R, JudgeError> + Sync,
) -> Result<Vec<R>, JudgeError> {
    let done = AtomicUsize::new(0);
    let one = |item: &T| {
        let answer = of(item)?;
        let goes_on = progress(done.fetch_add(1, Ordering::Relaxed) + 1, items.len());
        if goes_on { Ok(answer) } else { Err(JudgeError::Ended) }
    };
    items.par_iter().map(one).collect()
}

/// Files below a folder with one of some endings, in the order of their paths; what is hidden is in the making.
pub(crate) fn files(root: &Path, endings: &[&str]) -> Result<Vec<PathBuf>, JudgeError> {
    let (mut found, mut folders) = (Vec::new(), vec![root.to_owned()]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).map_err(JudgeError::io(&folder))? {
            let path = entry.map_err(JudgeError::io(&folder))?.path();
            let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
            if name(&path).starts_with('.') {
                continue;
            } else if path.is_dir() {
                folders.push(path);
            } else if endings.contains(&ending.as_str()) {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

/// Files by what two folders' files of the same thing have in common: the path below the folder without its ending, of
/// our own frames that of the frame, and for Cityscapes' files city, sequence and frame alone.
pub(crate) fn by_key(root: &Path, files: Vec<PathBuf>) -> Result<BTreeMap<String, PathBuf>, JudgeError> {
    let mut found: BTreeMap<String, PathBuf> = BTreeMap::new();
    for path in files {
        let below = path.strip_prefix(root).unwrap_or(&path);
        let below = match (name(&path).as_str(), below.parent()) {
            ("class.png" | "rgb.png", Some(frame)) => frame.to_owned(),
            _ => below.with_extension(""),
        };
        let key = cityscapes_key(&name(&path)).unwrap_or_else(|| below.to_string_lossy().replace('\\', "/"));
        if let Some(other) = found.get(&key) {
            let two = format!("{} and {}", other.display(), path.display());
            return Err(JudgeError::unexpected(root, format!("one image of {key}"), two, "remove one of them"));
        }
        found.insert(key, path);
    }
    Ok(found)
}

/// Ends of the names of files with labels: our own, and Cityscapes' in ids and in training ids.
pub(crate) const OURS: &str = "class.png";
pub(crate) const BY_ID: &str = "_labelIds.png";
pub(crate) const BY_TRAIN_ID: &str = "_labelTrainIds.png";

/// Pictures of labels below a folder: of our own and of Cityscapes' files those with classes, else every PNG. Where
/// Cityscapes' files are there in both numberings, those of the wanted one are taken.
pub(crate) fn label_files(root: &Path, wanted: Option<&ClassMap>) -> Result<Vec<PathBuf>, JudgeError> {
    let all = files(root, &["png"])?;
    let by_train_id = wanted.is_some_and(|map| map.name == "cityscapes-train");
    let endings = if by_train_id { [OURS, BY_TRAIN_ID, BY_ID] } else { [OURS, BY_ID, BY_TRAIN_ID] };
    for ending in endings {
        let named: Vec<PathBuf> = all.iter().filter(|path| name(path).ends_with(ending)).cloned().collect();
        if !named.is_empty() {
            return Ok(named);
        }
    }
    match all.is_empty() {
        true => Err(JudgeError::unexpected(root, "label images (.png)", "none", "give the folder that contains them")),
        false => Ok(all),
    }
}

/// Pictures below a folder that show something: where there is an `rgb.png` of ours those alone.
pub(crate) fn photographs(root: &Path) -> Result<Vec<PathBuf>, JudgeError> {
    let all = files(root, &["png", "jpg", "jpeg"])?;
    let ours: Vec<PathBuf> = all.iter().filter(|path| name(path) == "rgb.png").cloned().collect();
    match (ours.is_empty(), all.is_empty()) {
        (false, _) => Ok(ours),
        (true, false) => Ok(all),
        (true, true) => {
            Err(JudgeError::unexpected(root, "PNG or JPEG images", "none", "give the folder that contains them"))
        }
    }
}

pub(crate) fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// What a folder is called on a page: its name, or its path where that ends in none, such as `..`.
pub(crate) fn title(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// `aachen_000000_000019` of `aachen_000000_000019_gtFine_labelIds.png`.
fn cityscapes_key(name: &str) -> Option<String> {
    let parts: Vec<&str> = name.split(['_', '.']).collect();
    let number = |part: &&str| part.len() == 6 && part.bytes().all(|b| b.is_ascii_digit());
    (parts.len() > 3 && number(&parts[1]) && number(&parts[2])).then(|| parts[..3].join("_"))
}

/// Columns and rows of a picture, as its header tells; `None` for a file that is no picture.
pub(crate) fn dimensions(path: &Path) -> Option<(u32, u32)> {
    let file = BufReader::new(open_regular(path).ok()?);
    ImageReader::new(file).with_guessed_format().ok()?.into_dimensions().ok()
}

/// A picture's pixels as its file has them.
pub(crate) fn read(path: &Path) -> Result<DynamicImage, JudgeError> {
    let bytes = read_regular(path, LARGEST_FILE).map_err(JudgeError::io(path))?;
    let open = || ImageReader::new(Cursor::new(&bytes)).with_guessed_format().map_err(JudgeError::io(path));
    let broken = |e: image::ImageError| {
        JudgeError::unexpected(path, "a PNG or JPEG image", e.to_string(), "write the file again")
    };
    let (width, height) = open()?.into_dimensions().map_err(broken)?;
    check_size(path, width, height)?;
    open()?.decode().map_err(broken)
}

/// A picture's pixels as 8-bit sRGB.
pub(crate) fn read_raster(path: &Path) -> Result<Raster<[u8; 3]>, JudgeError> {
    let picture = read(path)?.into_rgb8();
    let (width, height) = picture.dimensions();
    Ok(Raster { width, height, data: picture.into_raw().as_chunks().0.to_vec() })
}

/// Before anything is unpacked: a header of a few bytes may ask for any amount of memory.
fn check_size(path: &Path, width: u32, height: u32) -> Result<(), JudgeError> {
    if u64::from(width) * u64::from(height) <= MOST_PIXELS {
        return Ok(());
    }
    let expected = format!("an image of at most {MOST_PIXELS} pixels");
    Err(JudgeError::unexpected(path, &expected, format!("{width} × {height}"), "scale it down, or leave it out"))
}

/// A small picture of a picture, `width` pixels wide.
///
/// # Errors
/// A file that is missing or is not a picture that can be decoded.
pub fn thumbnail(path: &Path, width: u32) -> Result<Raster<[u8; 3]>, JudgeError> {
    let picture = read(path)?.into_rgb8();
    let height = ((picture.height() * width + picture.width() / 2) / picture.width().max(1)).max(1);
    let small = resize(&picture, width, height, FilterType::Triangle);
    Ok(Raster::from_fn(width, height, |x, y| small.get_pixel(x, y).0))
}

/// Reads labels, one number a pixel: a PNG of greys, or of indices into a palette.
pub(crate) fn read_labels(path: &Path) -> Result<Raster<u8>, JudgeError> {
    let bad =
        |found: String, remedy| JudgeError::unexpected(path, "8-bit labels, one class id per pixel", found, remedy);
    let broken = |e: png::DecodingError| bad(e.to_string(), "write the file again, as PNG");
    let mut decoder = png::Decoder::new(BufReader::new(open_regular(path).map_err(JudgeError::io(path))?));
    decoder.set_transformations(png::Transformations::IDENTITY);
    let mut reader = decoder.read_info().map_err(broken)?;
    let (width, height) = reader.info().size();
    check_size(path, width, height)?;
    let (color, depth) = reader.output_color_type();
    let bits = match (color, depth) {
        (ColorType::Grayscale | ColorType::Indexed, BitDepth::One) => 1,
        (ColorType::Grayscale | ColorType::Indexed, BitDepth::Two) => 2,
        (ColorType::Grayscale | ColorType::Indexed, BitDepth::Four) => 4,
        (ColorType::Grayscale | ColorType::Indexed, BitDepth::Eight) => 8,
        _ => {
            let found = format!("{color:?} of {} bits", depth as u8);
            return Err(bad(found, "write the ids themselves as 8-bit greyscale instead of colours"));
        }
    };
    let bytes =
        reader.output_buffer_size().ok_or_else(|| bad("an image that is too large".into(), "make it smaller"))?;
    let mut ids = vec![0; bytes];
    let line = reader.next_frame(&mut ids).map_err(broken)?.line_size;
    if bits < 8 {
        // Greys of few bits stand for 0 to 255, indices for themselves.
        let scale = if color == ColorType::Grayscale { 255 / ((1u16 << bits) - 1) as u8 } else { 1 };
        let (per_byte, mask) = (8 / bits as usize, ((1u16 << bits) - 1) as u8);
        let unpack = |row: &[u8]| -> Vec<u8> {
            let id = |x: usize| (row[x / per_byte] >> (8 - bits - bits * (x % per_byte) as u32)) & mask;
            (0..width as usize).map(|x| id(x) * scale).collect()
        };
        ids = ids.chunks(line).flat_map(unpack).collect();
    }
    Ok(Raster { width, height, data: ids })
}

/// What a PNG's header says of its pixels.
pub(crate) fn color_type(path: &Path) -> Result<(ColorType, BitDepth), JudgeError> {
    let file = BufReader::new(open_regular(path).map_err(JudgeError::io(path))?);
    let mut decoder = png::Decoder::new(file);
    decoder.set_transformations(png::Transformations::IDENTITY);
    let reader = decoder.read_info();
    let broken = |e: png::DecodingError| {
        JudgeError::unexpected(path, "labels as a PNG image", e.to_string(), "write the file again, as PNG")
    };
    Ok(reader.map_err(broken)?.output_color_type())
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

    #[test]
    fn indices_into_a_palette_are_ids_and_greys_of_few_bits_are_greys() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("labels.png");
        let write = |color: ColorType, depth: BitDepth, width: u32, bytes: &[u8]| {
            let mut encoder = png::Encoder::new(fs::File::create(&path).unwrap(), width, 2);
            encoder.set_color(color);
            encoder.set_depth(depth);
            if color == ColorType::Indexed {
                encoder.set_palette((0..16 * 3).map(|i| 200 - i).collect::<Vec<u8>>());
            }
            encoder.write_header().unwrap().write_image_data(bytes).unwrap();
            read_labels(&path).map(|labels| labels.data)
        };
        assert_eq!(write(ColorType::Indexed, BitDepth::Eight, 2, &[7, 8, 9, 10]).unwrap(), [7, 8, 9, 10]);
        // Three pixels of four bits take two bytes a row.
        let packed = [0x12, 0x30, 0x45, 0x60];
        assert_eq!(write(ColorType::Indexed, BitDepth::Four, 3, &packed).unwrap(), [1, 2, 3, 4, 5, 6]);
        assert_eq!(write(ColorType::Grayscale, BitDepth::One, 2, &[0b0100_0000, 0]).unwrap(), [0, 255, 0, 0]);
        let deep = write(ColorType::Grayscale, BitDepth::Sixteen, 1, &[0, 7, 0, 8]).unwrap_err().to_string();
        assert!(deep.contains("Grayscale of 16 bits"), "{deep}");
    }

    #[test]
    fn a_header_does_not_choose_how_much_memory_is_taken() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("labels.png");
        for (width, height) in [(200_000, 100_000), (16_384, 30_000)] {
            let mut encoder = png::Encoder::new(fs::File::create(&path).unwrap(), width, height);
            encoder.set_color(ColorType::Grayscale);
            drop(encoder.write_header());
            // Signature and header, after which pixels seem to follow.
            let empty = b"\0\0\0\0IDAT\x35\xaf\x06\x1e";
            fs::write(&path, [&fs::read(&path).unwrap()[..33], empty].concat()).unwrap();
            let labels = read_labels(&path).err().map(|e| e.to_string()).unwrap_or_default();
            let picture = read(&path).err().map(|e| e.to_string()).unwrap_or_default();
            for message in [labels, picture] {
                assert!(
                    message.contains("at most 67108864 pixels") && message.contains(&format!("{width}")),
                    "{message}"
                );
            }
        }
    }
}
