//! Pictures of what is wrong.

use std::path::Path;

use image::DynamicImage;
use trove_model::{Class, Raster};

use super::finding::{Audit, Check, Finding};
use crate::JudgeError;
use crate::pictures::read;

/// Marks are seen from afar, pixels.
const MARK: i64 = 1;
const MAGENTA: [u8; 3] = [255, 0, 255];

/// The findings, the worst of each check in turn, then the second of each, and so on.
pub fn worst_in_turn(audit: &Audit) -> impl Iterator<Item = &Finding> {
    let of = |check: Check| audit.findings.iter().filter(move |finding| finding.check == check);
    (0..Audit::MOST).flat_map(move |nth| Check::ALL.into_iter().filter_map(move |check| of(check).nth(nth)))
}

/// The image of a finding, darkened, with what is wrong in magenta; `None` where no image shows it.
///
/// # Errors
/// An image that cannot be read.
pub fn picture(root: &Path, finding: &Finding) -> Result<Option<Raster<[u8; 3]>>, JudgeError> {
    let Some(path) = finding.image.as_ref().map(|image| root.join(image)).filter(|path| path.is_file()) else {
        return Ok(None);
    };
    let image = read(&path)?;
    // Numbers of classes would be all but black.
    let is_numbers = matches!(image, DynamicImage::ImageLuma8(_));
    let image = image.into_rgb8();
    let color = |[r, g, b]: [u8; 3]| match Class::from_id(r).filter(|_| is_numbers) {
        Some(class) => class.row().rgb,
        None => [r, g, b],
    };
    let dim = |value: u8| value / 2;
    let mut raster = Raster::from_fn(image.width(), image.height(), |x, y| color(image.get_pixel(x, y).0).map(dim));
    for [x, y] in &finding.pixels {
        for (dx, dy) in (-MARK..=MARK).flat_map(|dy| (-MARK..=MARK).map(move |dx| (dx, dy))) {
            let (x, y) = (i64::from(*x) + dx, i64::from(*y) + dy);
            if (0..i64::from(raster.width)).contains(&x) && (0..i64::from(raster.height)).contains(&y) {
                *raster.at_mut(x as u32, y as u32) = MAGENTA;
            }
        }
    }
    Ok(Some(raster))
}
