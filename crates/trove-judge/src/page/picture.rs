//! Pictures that lie in the page itself.

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;
use image::imageops::{FilterType, resize};
use trove_model::Raster;

use super::escape::escape;
use crate::JudgeError;

const JPEG_QUALITY: u8 = 80;

/// A small picture as JPEG.
#[derive(Clone, Debug)]
pub struct Picture {
    uri: String,
    width: u32,
    height: u32,
    alt: String,
}

impl Picture {
    /// Of sRGB pixels, `width` wide; `alt` says what it shows, and `from` where it is from.
    ///
    /// # Errors
    /// A picture that JPEG cannot hold.
    pub fn new(from: &Path, pixels: Raster<[u8; 3]>, width: u32, alt: impl Into<String>) -> Result<Self, JudgeError> {
        let bad = |found: String| JudgeError::unexpected(from, "an image that can be encoded", found, "report it");
        let (columns, rows) = (pixels.width, pixels.height);
        let whole = RgbImage::from_raw(columns, rows, pixels.data.into_flattened())
            .ok_or_else(|| bad(format!("{columns} × {rows}")))?;
        // As high as JPEG allows at the most, whatever the picture's shape.
        let height = (f64::from(rows) / f64::from(columns.max(1)) * f64::from(width)).clamp(1.0, 65_535.0) as u32;
        // Pixels of one that is enlarged stay squares.
        let filter = if columns < width { FilterType::Nearest } else { FilterType::Triangle };
        let mut jpeg = Vec::new();
        JpegEncoder::new_with_quality(&mut jpeg, JPEG_QUALITY)
            .encode_image(&resize(&whole, width, height, filter))
            .map_err(|e| bad(e.to_string()))?;
        let uri = format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg));
        Ok(Self { uri, width, height, alt: alt.into() })
    }

    pub(super) fn html(&self) -> String {
        let Self { uri, width, height, alt } = self;
        let alt = escape(alt);
        format!("<img loading=\"lazy\" width=\"{width}\" height=\"{height}\" alt=\"{alt}\" src=\"{uri}\">")
    }
}

/// Pictures side by side with what they show.
#[derive(Clone, Debug)]
pub struct Figure {
    /// One or more.
    pub pictures: Vec<Picture>,
    /// Lines below them.
    pub caption: Vec<String>,
}

/// Pictures that are wider are shown larger, pixels.
const LARGE_PX: u32 = 400;

impl Figure {
    /// How much room it takes, as a class of the list that it is in.
    pub(super) fn size(&self) -> &'static str {
        match &*self.pictures {
            [one] if one.width <= LARGE_PX => "",
            [_] => " large",
            _ => " sets",
        }
    }

    pub(super) fn html(&self) -> String {
        let pictures: String = self.pictures.iter().map(Picture::html).collect();
        let pictures = match self.pictures.len() {
            1 => pictures,
            4 => format!("<div class=\"pictures four\">{pictures}</div>"),
            _ => format!("<div class=\"pictures\">{pictures}</div>"),
        };
        let lines: Vec<String> = self.caption.iter().map(|line| escape(line)).collect();
        format!("<figure>{pictures}<figcaption>{}</figcaption></figure>", lines.join("<br>"))
    }
}
