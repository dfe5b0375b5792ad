//! Pictures of any kind → `Texture`, within bounds of memory.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;
use std::sync::{Arc, Mutex};

use image::{ImageFormat, ImageReader, Limits};
use trove_files::Folder;
use trove_model::{ColorSpace, Texture};

use trove_files::Budget;

/// Wider or higher pictures are refused: decoding one takes over 2 GB.
const LARGEST: u32 = 16_384;
/// Bytes a pixel that decoding takes.
const PIXEL_BYTES: usize = 4;
/// Pictures of more pixels are decoded one at a time.
const LARGE: u64 = 4096 * 4096;

/// A decoded picture.
#[derive(Clone, Debug)]
pub(super) struct Pixels {
    pub(super) width: u32,
    pub(super) height: u32,
    /// Row 0 is the top.
    pub(super) rgba: Vec<[u8; 4]>,
    /// What was done to it, where something was.
    pub(super) notice: Option<String>,
}

/// The textures of a library by name, so that a picture that several models share is there once.
#[derive(Debug)]
pub(super) struct Pictures {
    /// Starts every texture's name.
    prefix: String,
    /// The library's folder.
    pub(super) folder: Folder,
    /// The largest side that a texture may have, pixels.
    pub(super) limit: u32,
    made: Mutex<BTreeMap<String, Arc<Texture>>>,
}

/// One large picture at a time.
static LARGE_ONES: Mutex<()> = Mutex::new(());

impl Pictures {
    pub(super) fn new(prefix: &str, folder: &Path, limit: u32) -> Self {
        Self { prefix: prefix.to_owned(), folder: Folder::new(folder), limit, made: Mutex::default() }
    }

    /// What a file is called in the names of textures: its path from the library's folder.
    pub(super) fn name_of(&self, path: &Path) -> String {
        path.strip_prefix(self.folder.path()).unwrap_or(path).to_string_lossy().replace('\\', "/")
    }

    /// The texture of a name, made now if it is not there.
    pub(super) fn texture(
        &self,
        name: &str,
        color_space: ColorSpace,
        make: impl FnOnce() -> Result<Pixels, String>,
    ) -> Result<Arc<Texture>, String> {
        let lock = || self.made.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(texture) = lock().get(name) {
            return Ok(texture.clone());
        }
        let Pixels { width, height, rgba, .. } = make()?;
        let texture = Texture { name: format!("{}/{name}", self.prefix), width, height, rgba, color_space };
        Ok(lock().entry(name.to_owned()).or_insert(Arc::new(texture)).clone())
    }
}

/// Decodes PNG, JPEG, WebP, BMP, TGA (by `name`'s ending), Radiance HDR and OpenEXR to at most `limit` pixels a side.
/// The error says what is there instead and what to do.
pub(super) fn decode(bytes: &[u8], name: &str, limit: u32) -> Result<Pixels, String> {
    let ending = name.rsplit('.').next().unwrap_or_default().to_lowercase();
    let pixels = if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        decode_exr(bytes)?
    } else {
        let format = match image::guess_format(bytes) {
            Ok(format) => format,
            Err(_) if ending == "tga" => ImageFormat::Tga,
            Err(_) => return Err(unknown(bytes)),
        };
        let open = || ImageReader::with_format(Cursor::new(bytes), format);
        let (width, height) = open().into_dimensions().map_err(|e| e.to_string())?;
        check(width, height, bytes.len())?;
        let alone = u64::from(width) * u64::from(height) > LARGE;
        let _alone = alone.then(|| LARGE_ONES.lock().unwrap_or_else(std::sync::PoisonError::into_inner));
        let mut reader = open();
        let mut limits = Limits::default();
        limits.max_alloc = Some(Budget::of_file(bytes.len() as u64).left());
        reader.limits(limits);
        let rgba = reader.decode().map_err(|e| format!("{e}; save it again as PNG or JPEG"))?.into_rgba8();
        // Shrunk while no other large one is decoded.
        let rgba = rgba.into_raw().chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]).collect();
        return Ok(shrunk(Pixels { width, height, rgba, notice: None }, limit));
    };
    Ok(shrunk(pixels, limit))
}

fn unknown(bytes: &[u8]) -> String {
    let what = match bytes {
        [0xab, b'K', b'T', b'X', ..] => "KTX; unpack it: `npx @gltf-transform/cli ktxdecompress in.glb out.glb`",
        [b'D', b'D', b'S', ..] => "DDS; save it as PNG",
        [b'I', b'I', 42, ..] | [b'M', b'M', 0, 42, ..] => "TIFF; save it as PNG",
        [b'8', b'B', b'P', b'S', ..] => "a Photoshop file; save it as PNG",
        [] => "an empty file; download it again",
        _ => "not an image; save it as PNG or JPEG",
    };
    what.to_owned()
}

fn check(width: u32, height: u32, bytes: usize) -> Result<(), String> {
    if width == 0 || height == 0 {
        return Err("an image without pixels".into());
    }
    if width > LARGEST || height > LARGEST {
        return Err(format!("{width} × {height} pixels; scale it to at most {LARGEST}"));
    }
    // A plain picture may well be small as a file, but not one that is larger than any texture.
    let pixels = width as usize * height as usize;
    Budget::of_file(bytes as u64).take(pixels, PIXEL_BYTES).map_err(|_| {
        format!("{width} × {height} pixels in {bytes} bytes, as in a file made to fill the memory; scale it to at most 8192 × 8192")
    })
}

/// Mean of whole squares of pixels, so that neither side is longer than `limit`.
fn shrunk(pixels: Pixels, limit: u32) -> Pixels {
    let Pixels { width, height, rgba, notice } = pixels;
    let step = width.max(height).div_ceil(limit.max(1));
    if step <= 1 {
        return Pixels { width, height, rgba, notice };
    }
    let (w, h) = ((width / step).max(1), (height / step).max(1));
    let mut small = Vec::with_capacity((w * h) as usize);
    for y in 0..h {
        for x in 0..w {
            let mut sum = [0u32; 4];
            let (mut weight, mut count) = (0u32, 0u32);
            for (dy, dx) in (0..step).flat_map(|dy| (0..step).map(move |dx| (dy, dx))) {
                let (px, py) = ((x * step + dx).min(width - 1), (y * step + dy).min(height - 1));
                let p = rgba[(py * width + px) as usize];
                // Colours count as far as they are seen.
                let alpha = u32::from(p[3]).max(1);
                (0..3).for_each(|c| sum[c] += u32::from(p[c]) * alpha);
                sum[3] += u32::from(p[3]);
                weight += alpha;
                count += 1;
            }
            small.push([0, 1, 2, 3].map(|c| (sum[c] / if c < 3 { weight } else { count }) as u8));
        }
    }
    let notice = Some(format!("{width} × {height} pixels became {w} × {h}"));
    Pixels { width: w, height: h, rgba: small, notice }
}

/// OpenEXR's first layer, scaled so that its largest value is 1 where it exceeds 1: heights and masks.
fn decode_exr(bytes: &[u8]) -> Result<Pixels, String> {
    use exr::prelude::*;
    let text = |e: exr::error::Error| format!("{e}; save it as PNG");
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(text)?;
    for header in &meta.headers {
        let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        check(side(header.layer_size.x()), side(header.layer_size.y()), bytes.len())?;
        if header.layer_size.area() as u64 > LARGE * 4 {
            return Err("an OpenEXR file above 8K; save it as PNG".into());
        }
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(text)?;
    let size = image.layer_data.size;
    let list = &image.layer_data.channel_data.list;
    let find = |name: &str| list.iter().find(|c| c.name.to_string().eq_ignore_ascii_case(name));
    let first = list.first().ok_or("an OpenEXR file without channels")?;
    let channels = ["R", "G", "B"].map(|name| find(name).unwrap_or(find("Y").unwrap_or(first)));
    let values = |i: usize| channels.map(|c| c.sample_data.value_by_flat_index(i).to_f32());
    let highest = (0..size.area()).flat_map(values).filter(|v| v.is_finite()).fold(1.0f32, f32::max);
    let byte = |v: f32| if v.is_finite() { (v / highest * 255.0).clamp(0.0, 255.0).round() as u8 } else { 0 };
    let rgba = (0..size.area()).map(|i| values(i).map(byte)).map(|[r, g, b]| [r, g, b, 255]).collect();
    Ok(Pixels { width: size.x() as u32, height: size.y() as u32, rgba, notice: None })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_pictures_shrink_to_whole_fractions() {
        let rgba = (0..8 * 4).map(|i| [i as u8, 100, 0, 255]).collect();
        let small = shrunk(Pixels { width: 8, height: 4, rgba, notice: None }, 4);
        assert_eq!((small.width, small.height, small.rgba.len()), (4, 2, 8));
        assert_eq!(small.rgba[0], [4, 100, 0, 255]);
        assert!(small.notice.is_some());
    }

    #[test]
    fn what_is_no_picture_is_named() {
        assert!(decode(b"", "a.png", 64).unwrap_err().contains("empty"));
        assert!(decode(b"hello world", "a.png", 64).unwrap_err().contains("not an image"));
        assert!(decode(&[0xab, b'K', b'T', b'X', b' '], "a.ktx2", 64).unwrap_err().contains("ktxdecompress"));
    }
}
