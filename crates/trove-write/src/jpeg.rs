//! JPEG, as bytes, and what it leaves of a picture.

use image::ImageDecoder;
use image::codecs::jpeg::{JpegDecoder, JpegEncoder};

use crate::WriteError;

/// A picture, 8-bit sRGB, encoded with `quality` (1 to 100) and decoded again, as cameras deliver theirs.
pub(crate) fn worn(
    name: &str,
    width: u32,
    height: u32,
    pixels: &[[u8; 3]],
    quality: u8,
) -> Result<Vec<[u8; 3]>, WriteError> {
    let packed = packed(name, width, height, pixels, quality)?;
    let mut worn = vec![[0; 3]; pixels.len()];
    JpegDecoder::new(std::io::Cursor::new(&packed))
        .and_then(|decoder| decoder.read_image(worn.as_flattened_mut()))
        .map_err(|e| WriteError::Encoding { name: name.to_owned(), found: e.to_string() })?;
    Ok(worn)
}

/// A picture, 8-bit sRGB, encoded with `quality` (1 to 100); `name` is what an error calls it.
///
/// # Errors
/// A picture that JPEG cannot hold.
pub fn packed(name: &str, width: u32, height: u32, pixels: &[[u8; 3]], quality: u8) -> Result<Vec<u8>, WriteError> {
    let mut packed = Vec::new();
    JpegEncoder::new_with_quality(&mut packed, quality)
        .encode(pixels.as_flattened(), width, height, image::ExtendedColorType::Rgb8)
        .map_err(|e| WriteError::Encoding { name: name.to_owned(), found: e.to_string() })?;
    Ok(packed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_stays_what_it_was_the_more_the_better_the_quality() {
        let (w, h) = (61, 37);
        let pixels: Vec<[u8; 3]> = (0..w * h).map(|i| [i % 251, i * 7 % 253, i / w * 6].map(|c| c as u8)).collect();
        let error = |quality| {
            let worn = worn("rgb.png", w, h, &pixels, quality).unwrap();
            let pairs = worn.as_flattened().iter().zip(pixels.as_flattened());
            pairs.map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum::<f64>()
        };
        assert!(error(95) > 0.0 && error(95) < 0.5 * error(30), "{} {}", error(95), error(30));
    }
}
