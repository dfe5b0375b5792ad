//! Masks of objects, and COCO's run lengths of them.

use trove_model::Raster;

/// The pixels of one object within its box.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mask {
    /// First column and first row.
    pub min: [u32; 2],
    /// Whether each pixel of the box belongs to it.
    pub pixels: Raster<bool>,
}

impl Mask {
    /// Of pixels that all lie within bounds: first column, first row, last column, last row.
    pub(crate) fn of([x0, y0, x1, y1]: [u32; 4], belongs: impl Fn(u32, u32) -> bool) -> Self {
        Self { min: [x0, y0], pixels: Raster::from_fn(x1 + 1 - x0, y1 + 1 - y0, |x, y| belongs(x0 + x, y0 + y)) }
    }

    /// COCO's run lengths in an image of so many rows and columns: down the columns, first those outside.
    pub(crate) fn run_lengths(&self, width: u32, height: u32) -> Vec<u32> {
        let (mut runs, mut inside, mut since) = (Vec::new(), false, 0);
        let at = |x: u32, y: u32| (self.min[0] + x) * height + self.min[1] + y;
        let mut turn = |place: u32, is_in: bool| {
            if is_in != inside {
                runs.push(place - since);
                (inside, since) = (is_in, place);
            }
        };
        for x in 0..self.pixels.width {
            for y in 0..self.pixels.height {
                turn(at(x, y), *self.pixels.at(x, y));
            }
            // Below the box, above it in the next column, and behind its last column nothing belongs to it.
            if self.pixels.height < height || x + 1 == self.pixels.width {
                turn(at(x, self.pixels.height), false);
            }
        }
        runs.push(width * height - since);
        runs
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn run_lengths_go_down_the_columns() {
        // .1.
        // 11.
        let mask = Mask::of([0, 0, 1, 1], |x, y| (x, y) != (0, 0));
        assert_eq!(mask.run_lengths(3, 2), [1, 3, 2]);
        assert_eq!(Mask::of([0, 1, 1, 1], |_, _| true).run_lengths(2, 2), [1, 1, 1, 1, 0], "down to the last row");
        assert_eq!(Mask::of([0, 0, 1, 1], |_, _| true).run_lengths(3, 2), [0, 4, 2], "whole columns");
        assert_eq!(Mask::of([1, 2, 1, 2], |_, _| true).run_lengths(2, 3), [5, 1, 0]);
        assert_eq!(Mask::of([0, 0, 1, 0], |_, _| true).run_lengths(2, 3), [0, 1, 2, 1, 2]);
    }

    #[test]
    fn strings_are_those_of_pycocotools() {
        // Written down from pycocotools' maskApi for these runs.
        assert_eq!(packed(&[1, 3, 2]), "132");
        assert_eq!(packed(&[0, 1, 2, 1, 2]), "01200");
        assert_eq!(packed(&[100, 40, 7]), "T3X17");
    }
}
