//! Images of which only some rows are known.

use crate::Raster;

/// Rows that are looked at: every so-manieth strip of [`Strips::ROWS`] rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Strips {
    every: u32,
    first: u32,
}

impl Strips {
    /// OpenEXR packs so many rows together (`ZIP`): fewer cost as much to read.
    pub const ROWS: u32 = 16;

    /// Every row.
    pub const ALL: Self = Self { every: 1, first: 0 };

    /// Of every `every` strips the one with the number `turn`, which may count on and on; 0 of them are taken for one.
    pub fn one_of(every: u32, turn: u32) -> Self {
        let every = every.max(1);
        Self { every, first: turn % every }
    }

    /// Whether a row is among them.
    pub fn holds(self, y: u32) -> bool {
        y / Self::ROWS % self.every == self.first
    }
}

/// An image of which those rows are known.
#[derive(Clone, Debug, PartialEq)]
pub struct InStrips<T> {
    /// The whole image; what its other rows hold means nothing.
    pub raster: Raster<T>,
    /// The rows that are known.
    pub strips: Strips,
}

impl<T> InStrips<T> {
    /// The value at (x, y); `None` where it is not known.
    ///
    /// # Panics
    /// Outside the image.
    pub fn at(&self, x: u32, y: u32) -> Option<&T> {
        self.strips.holds(y).then(|| self.raster.at(x, y))
    }

    /// Pixels that are known (column, row), with their values.
    pub fn pixels(&self) -> impl Iterator<Item = ([u32; 2], &T)> {
        let rows = (0..).zip(self.raster.data.chunks(self.raster.width.max(1) as usize));
        let known = rows.filter(|(y, _)| self.strips.holds(*y));
        known.flat_map(|(y, row)| (0..).zip(row).map(move |(x, value)| ([x, y], value)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_take_turns_and_cover_every_row_once() {
        let known = |turn| {
            let raster = Raster::from_fn(3, 70, |x, y| (x, y));
            InStrips { raster, strips: Strips::one_of(4, turn) }
        };
        let rows = |turn| {
            let rows: Vec<u32> = (0..70).filter(|y| known(turn).at(1, *y).is_some()).collect();
            rows
        };
        assert_eq!(rows(0), [(0..16).collect::<Vec<_>>(), (64..70).collect()].concat());
        assert_eq!(rows(5), (16..32).collect::<Vec<_>>());
        let all: Vec<_> = (0..4).flat_map(|turn| known(turn).pixels().map(|(at, v)| (at, *v)).collect::<Vec<_>>()).collect();
        assert_eq!(all.len(), 210);
        assert!(all.iter().all(|([x, y], value)| (*x, *y) == *value));
        assert!((0..70).all(|y| Strips::ALL.holds(y)) && Strips::one_of(0, 3) == Strips::ALL);
    }
}
