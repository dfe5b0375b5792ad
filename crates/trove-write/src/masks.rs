//! Masks of objects as COCO has them: run lengths, and these as a string.

use trove_format::{MaskRow, MaskTable, RunLengths};
use trove_model::{Labels, Mask, ObjectLabel, PixelBox, Raster};

/// The pixels within bounds (first column, first row, last column, last row) that belong to something.
pub(crate) fn within([x0, y0, x1, y1]: [u32; 4], belongs: impl Fn(u32, u32) -> bool) -> Mask {
    Mask::of(PixelBox { min: [x0, y0], max: [x1, y1] }, belongs)
}

/// COCO's run lengths in an image of so many columns and rows: down the columns, first those outside.
pub(crate) fn run_lengths(mask: &Mask, width: u32, height: u32) -> Vec<u32> {
    let (mut runs, mut inside, mut since) = (Vec::new(), false, 0);
    let at = |x: u32, y: u32| (mask.min[0] + x) * height + mask.min[1] + y;
    let mut turn = |place: u32, is_in: bool| {
        if is_in != inside {
            runs.push(place - since);
            (inside, since) = (is_in, place);
        }
    };
    for x in 0..mask.pixels.width {
        for y in 0..mask.pixels.height {
            turn(at(x, y), *mask.pixels.at(x, y));
        }
        // Below the box, above it in the next column, and behind its last column nothing belongs to it.
        if mask.pixels.height < height || x + 1 == mask.pixels.width {
            turn(at(x, mask.pixels.height), false);
        }
    }
    runs.push(width * height - since);
    runs
}

/// What `masks.json` holds; `None` where the labels have no masks.
pub fn mask_table(labels: &Labels) -> Option<MaskTable> {
    let Raster { width, height, .. } = labels.instance;
    let coded = |mask: Option<&Mask>| {
        let runs = mask.map_or_else(|| vec![width * height], |mask| run_lengths(mask, width, height));
        RunLengths { size: [height, width], counts: packed(&runs) }
    };
    let row = |object: &ObjectLabel| {
        let amodal = coded(Some(object.amodal_mask.as_ref()?));
        let shows = |x: u32, y: u32| *labels.instance.at(x, y) == object.id.0;
        let visible = object.visible_box.map(|around| Mask::of(around, shows));
        Some(MaskRow { id: object.id.0, visible: coded(visible.as_ref()), amodal })
    };
    Some(MaskTable { objects: labels.objects.iter().map(row).collect::<Option<_>>()? })
}

/// No picture has more pixels.
const MOST_PIXELS: u64 = 1 << 28;

/// The picture that run lengths make up; `None` where they do not fill it, or it is larger than any.
pub fn painted(coded: &RunLengths) -> Option<Raster<bool>> {
    let [height, width] = coded.size;
    let area = u64::from(width) * u64::from(height);
    if area > MOST_PIXELS {
        return None;
    }
    let mut columns = Vec::new();
    for (i, run) in unpacked(&coded.counts)?.into_iter().enumerate() {
        if columns.len() as u64 + u64::from(run) > area {
            return None;
        }
        columns.resize(columns.len() + run as usize, i % 2 == 1);
    }
    let is_full = columns.len() as u64 == area;
    is_full.then(|| Raster::from_fn(width, height, |x, y| columns[x as usize * height as usize + y as usize]))
}

/// Run lengths as COCO's string: differences from the run before the last, five bits a character.
pub(crate) fn packed(runs: &[u32]) -> String {
    let mut text = String::new();
    for (i, run) in runs.iter().enumerate() {
        let mut left = i64::from(*run) - if i > 2 { i64::from(runs[i - 2]) } else { 0 };
        loop {
            let five = (left & 0x1f) as u8;
            left >>= 5;
            let is_last = if five & 0x10 == 0 { left == 0 } else { left == -1 };
            text.push(char::from(48 + five + if is_last { 0 } else { 0x20 }));
            if is_last {
                break;
            }
        }
    }
    text
}

/// The run lengths of a string; `None` where it has characters or numbers that COCO's do not have.
fn unpacked(text: &str) -> Option<Vec<u32>> {
    let mut runs: Vec<u32> = Vec::new();
    let mut characters = text.bytes();
    while let Some(first) = characters.next() {
        let (mut value, mut shift, mut character) = (0i64, 0, first);
        loop {
            let six = character.checked_sub(48).filter(|six| *six < 64)?;
            value |= i64::from(six & 0x1f) << shift;
            shift += 5;
            if six & 0x20 == 0 {
                // The highest bit is the sign.
                value |= if six & 0x10 == 0 { 0 } else { -1 << shift };
                break;
            }
            character = characters.next().filter(|_| shift < 40)?;
        }
        let before = if runs.len() > 2 { i64::from(runs[runs.len() - 2]) } else { 0 };
        runs.push(u32::try_from(value + before).ok()?);
    }
    Some(runs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn run_lengths_go_down_the_columns() {
        // .1.
        // 11.
        let mask = within([0, 0, 1, 1], |x, y| (x, y) != (0, 0));
        assert_eq!(run_lengths(&mask, 3, 2), [1, 3, 2]);
        assert_eq!(run_lengths(&within([0, 1, 1, 1], |_, _| true), 2, 2), [1, 1, 1, 1, 0], "down to the last row");
        assert_eq!(run_lengths(&within([0, 0, 1, 1], |_, _| true), 3, 2), [0, 4, 2], "whole columns");
        assert_eq!(run_lengths(&within([1, 2, 1, 2], |_, _| true), 2, 3), [5, 1, 0]);
        assert_eq!(run_lengths(&within([0, 0, 1, 0], |_, _| true), 2, 3), [0, 1, 2, 1, 2]);
    }

    #[test]
    fn strings_are_those_of_pycocotools() {
        // Written down from pycocotools' maskApi for these runs.
        assert_eq!(packed(&[1, 3, 2]), "132");
        assert_eq!(packed(&[0, 1, 2, 1, 2]), "01200");
        assert_eq!(packed(&[100, 40, 7]), "T3X17");
    }

    #[test]
    fn what_is_packed_is_painted_again() {
        let mask = within([2, 1, 6, 8], |x, y| (x * 7 + y * 3) % 5 < 2);
        let counts = packed(&run_lengths(&mask, 9, 11));
        let picture = painted(&RunLengths { size: [11, 9], counts: counts.clone() }).unwrap();
        let inside = |x: u32, y: u32| (2..=6).contains(&x) && (1..=8).contains(&y) && (x * 7 + y * 3) % 5 < 2;
        assert_eq!(picture, Raster::from_fn(9, 11, inside));
        let damaged = |counts: &str| painted(&RunLengths { size: [11, 9], counts: counts.into() }).is_none();
        for text in ["", "1", "o", "ooooooooooo", " ", "\u{7f}", &counts[1..], "_____0", "O"] {
            assert!(damaged(text), "{text}");
        }
    }
}
