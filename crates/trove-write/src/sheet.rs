//! Small pictures with their names on one page.

use std::path::Path;

use glam::vec2;
use trove_model::{Lettering, Raster};

use crate::{WriteError, write_picture};

/// Gap around everything, pixels.
pub(crate) const GAP_PX: u32 = 6;
/// Height of the line with a name, pixels.
pub(crate) const CAPTION_PX: u32 = 14;
/// Height of capitals, pixels; marks above them take a third more.
const CAPITAL_PX: f32 = 8.0;
/// Width of their strokes, pixels.
const STROKE_PX: f32 = 1.6;
const PAPER: [u8; 3] = [24, 26, 30];
pub(crate) const INK: [u8; 3] = [205, 208, 214];

/// The page in the making.
pub(crate) struct Sheet(Raster<[u8; 3]>);

impl Sheet {
    pub(crate) fn new(width: u32, height: u32) -> Self {
        Self(Raster::from_fn(width, height, |_, _| PAPER))
    }

    /// Sets a pixel; outside the sheet nothing happens.
    pub(crate) fn set(&mut self, x: u32, y: u32, color: [u8; 3]) {
        if x < self.0.width && y < self.0.height {
            *self.0.at_mut(x, y) = color;
        }
    }

    /// Writes a line in capitals from a pixel on, which is the upper left corner of [`CAPTION_PX`] rows; what the letters
    /// do not have stays blank.
    pub(crate) fn write_line(&mut self, x: u32, y: u32, text: &str) {
        let writing = Lettering::new(text);
        let middle_px = vec2(writing.width() / 2.0 * CAPITAL_PX + STROKE_PX, CAPTION_PX as f32 / 2.0);
        for (row, column) in (0..CAPTION_PX).flat_map(|row| (0..(2.0 * middle_px.x) as u32).map(move |c| (row, c))) {
            let from_middle_px = vec2(column as f32 + 0.5, row as f32 + 0.5) - middle_px;
            let away_px = writing.distance(from_middle_px * vec2(1.0, -1.0) / CAPITAL_PX) * CAPITAL_PX;
            let covered = (STROKE_PX / 2.0 + 0.5 - away_px).clamp(0.0, 1.0);
            let mixed = |c: usize| f32::from(PAPER[c]) + covered * (f32::from(INK[c]) - f32::from(PAPER[c]));
            if covered > 0.0 {
                self.set(x + column, y + row, [0, 1, 2].map(|c| mixed(c).round() as u8));
            }
        }
    }

    pub(crate) fn paste(&mut self, x: u32, y: u32, width: u32, tile: &[[u8; 3]]) {
        for (i, &color) in tile.iter().enumerate() {
            self.set(x + i as u32 % width, y + i as u32 / width, color);
        }
    }

    pub(crate) fn write(&self, path: &Path) -> Result<(), WriteError> {
        write_picture(path, &self.0)
    }
}

/// Writes pictures of one size with their names above them, row by row in a page about as wide as high, as PNG.
///
/// # Errors
/// A page too large for a PNG, or a file system that refuses.
pub fn write_sheet(path: &Path, pictures: &[(String, Raster<[u8; 3]>)]) -> Result<(), WriteError> {
    let size = |of: fn(&Raster<[u8; 3]>) -> u32| pictures.iter().map(|(_, p)| of(p)).max().unwrap_or(0) + GAP_PX;
    let (width, height) = (size(|p| p.width), size(|p| p.height) + CAPTION_PX);
    let area_px = pictures.len() as f64 * f64::from(width) * f64::from(height);
    let columns = ((area_px.sqrt() / f64::from(width)).ceil() as u32).max(1);
    let rows = (pictures.len() as u32).div_ceil(columns);
    let mut sheet = Sheet::new(GAP_PX + columns * width, GAP_PX + rows * height);
    for (i, (name, picture)) in (0..).zip(pictures) {
        let (x, y) = (GAP_PX + i % columns * width, GAP_PX + i / columns * height);
        let fits = |text: &str| Lettering::new(text).width() * CAPITAL_PX <= (width - GAP_PX) as f32;
        let ends = name.char_indices().map(|(at, letter)| at + letter.len_utf8());
        let end = ends.take_while(|&end| fits(&name[..end])).last().unwrap_or(0);
        sheet.write_line(x, y, &name[..end]);
        sheet.paste(x, y + CAPTION_PX, picture.width, &picture.data);
    }
    sheet.write(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_picture_has_its_place_on_the_page() {
        let path = tempfile::tempdir().unwrap();
        let path = path.path().join("sheet.png");
        let pictures: Vec<_> =
            (0..5u8).map(|i| (format!("a/{i}"), Raster::from_fn(40, 30, |_, _| [50 + i, 0, 0]))).collect();
        write_sheet(&path, &pictures).unwrap();
        let sheet = image::open(&path).unwrap().into_rgb8();
        let count = |i: u8| sheet.pixels().filter(|p| p.0 == [50 + i, 0, 0]).count();
        assert!((0..5).all(|i| count(i) == 40 * 30));
        assert!(sheet.pixels().any(|p| p.0 == INK));
    }
}
