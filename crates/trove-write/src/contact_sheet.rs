//! Many frames at a glance: for each its picture, its classes over the picture, its instances and its depth.
//!
//! The sheet is made from finished frames' files, so it is the same whatever order they were made in, by how many
//! runs, and it can be made again at any time. One frame is in memory at once.

mod tiles;

use std::path::{Path, PathBuf};

use trove_format::FrameTable;

use crate::WriteError;
use crate::sheet::{CAPTION_PX, GAP_PX, Sheet};
use tiles::Tiles;

/// Width of one picture on the sheet, pixels.
const TILE_WIDTH_PX: u32 = 320;
/// Frames at most: a few seconds of reading, and a sheet of a few megabytes.
const FRAMES: usize = 24;

/// A frame to show.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Frame {
    /// What is written over it (`scene-0103/v00/k005/ego.CAM_FRONT`); frames stand in the order of their names.
    pub name: String,
    /// Its finished folder.
    pub dir: PathBuf,
}

/// Writes the sheet: all frames where they are few, else some spread evenly over the names in alphabetical order.
///
/// # Errors
/// A frame whose files cannot be read, or a sheet that cannot be written.
pub fn write(path: &Path, frames: &[Frame]) -> Result<(), WriteError> {
    let chosen = chosen(frames);
    let mut columns = 1;
    let mut drawn = Vec::new();
    for frame in chosen {
        drawn.push((frame.name.as_str(), Tiles::read(&frame.dir, TILE_WIDTH_PX)?));
    }
    // Few frames stand below each other, many in two columns: closer to a screen's form.
    if drawn.len() > 4 {
        columns = 2;
    }
    let cell_height = drawn.iter().map(|(_, t)| t.height).max().unwrap_or(0) + CAPTION_PX + GAP_PX;
    let cell_width = 4 * (TILE_WIDTH_PX + 2) + GAP_PX;
    let rows = (drawn.len() as u32).div_ceil(columns);
    let mut sheet = Sheet::new(GAP_PX + columns * cell_width, GAP_PX + rows.max(1) * cell_height);
    for (i, (name, tiles)) in drawn.iter().enumerate() {
        let (column, row) = (i as u32 % columns, i as u32 / columns);
        let (x, y) = (GAP_PX + column * cell_width, GAP_PX + row * cell_height);
        sheet.write_line(x, y, name);
        for (t, tile) in tiles.pictures.iter().enumerate() {
            sheet.paste(x + t as u32 * (TILE_WIDTH_PX + 2), y + CAPTION_PX, TILE_WIDTH_PX, tile);
        }
    }
    sheet.write(path)
}

/// Whether a file of a frame is read for the sheet.
pub fn is_read(name: &str) -> bool {
    name == FrameTable::NAME || tiles::READ.iter().any(|file| file.name() == name)
}

/// Those that the sheet shows, in the order of their names: at most 24 of the frames, the first and the last among them.
pub fn chosen<T: Ord>(frames: &[T]) -> Vec<&T> {
    let mut sorted: Vec<&T> = frames.iter().collect();
    sorted.sort();
    sorted.dedup();
    if sorted.len() <= FRAMES {
        return sorted;
    }
    (0..FRAMES).map(|i| sorted[i * (sorted.len() - 1) / (FRAMES - 1)]).collect()
}
