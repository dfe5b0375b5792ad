//! Images of which only some parts are known.

use std::ops::Range;

use crate::Raster;

/// Squares of an image that are looked at: one of so many, spread over it like bricks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patches {
    every: u32,
    first: u32,
}

impl Patches {
    /// The sides of a square: our OpenEXR files pack so many pixels together, and fewer cost as much to read.
    pub const SIDE: u32 = 64;

    /// All of it.
    pub const ALL: Self = Self { every: 1, first: 0 };

    /// One of `every` squares; `turn` says which, and counts on and on. 0 of them are taken for one.
    pub fn one_of(every: u32, turn: u32) -> Self {
        let every = every.max(1);
        Self { every, first: turn % every }
    }

    /// Whether a pixel is in one.
    pub fn hold(self, x: u32, y: u32) -> bool {
        self.hold_square(x / Self::SIDE, y / Self::SIDE)
    }

    /// Every second row of squares is shifted by half of the way to the next.
    fn hold_square(self, column: u32, row: u32) -> bool {
        (column + row % 2 * (self.every / 2)) % self.every == self.first
    }

    /// Columns below `width` of a row of pixels that are in one.
    pub fn columns(self, width: u32, y: u32) -> impl Iterator<Item = u32> {
        self.runs(width, y).flatten()
    }

    /// The same, each square's as one run.
    fn runs(self, width: u32, y: u32) -> impl Iterator<Item = Range<u32>> {
        let squares = (0..width.div_ceil(Self::SIDE)).filter(move |column| self.hold_square(*column, y / Self::SIDE));
        squares.map(move |column| column * Self::SIDE..((column + 1) * Self::SIDE).min(width))
    }
}

/// An image of which those parts are known.
#[derive(Clone, Debug, PartialEq)]
pub struct InPatches<T> {
    /// The whole image; what its other pixels hold means nothing.
    pub raster: Raster<T>,
    /// What is known of it.
    pub patches: Patches,
}

impl<T> InPatches<T> {
    /// The value at (x, y); `None` where it is not known.
    ///
    /// # Panics
    /// Outside the image.
    pub fn at(&self, x: u32, y: u32) -> Option<&T> {
        self.patches.hold(x, y).then(|| self.raster.at(x, y))
    }

    /// Pixels that are known (column, row), with their values.
    pub fn pixels(&self) -> impl Iterator<Item = ([u32; 2], &T)> {
        let rows = (0..).zip(self.raster.data.chunks(self.raster.width.max(1) as usize));
        rows.flat_map(|(y, row)| {
            let runs = self.patches.runs(self.raster.width, y);
            runs.flat_map(move |run| {
                run.clone().zip(&row[run.start as usize..run.end as usize]).map(move |(x, value)| ([x, y], value))
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_take_turns_and_cover_every_pixel_once() {
        for every in [0, 1, 2, 3, 4, 7] {
            let mut times = Raster::filled(300, 200, 0);
            for turn in 10..10 + every.max(1) {
                let known = InPatches { raster: times.map(|_| ()), patches: Patches::one_of(every, turn) };
                let found: Vec<[u32; 2]> = known.pixels().map(|(pixel, ())| pixel).collect();
                for [x, y] in found {
                    assert!(known.at(x, y).is_some());
                    *times.at_mut(x, y) += 1;
                }
            }
            assert!(times.data.iter().all(|times| *times == 1), "{every}");
        }
        assert_eq!(Patches::one_of(1, 5), Patches::ALL);
        let squares = |y| (0..8).filter(move |column| Patches::one_of(4, 1).hold(column * 64, y)).collect::<Vec<_>>();
        assert_eq!([squares(0), squares(64), squares(128)], [vec![1, 5], vec![3, 7], vec![1, 5]]);
    }
}
