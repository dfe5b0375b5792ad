//! One wall: its corners, how its bays and storeys are divided, and what is behind it.

use glam::DVec2;
use trove_model::{FacadeDesign, Surface};

use super::shell::Slot;
use super::sight::Detail;

/// Of a wall narrower than this share of a bay only the pier between two bays is shown.
const NARROWEST_BAY: f64 = 0.55;
/// Places along a wall at which it is known how far the wall behind it is.
pub(super) const STATIONS: usize = 24;

/// How a surface's texture is divided.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    pub bay_m: f64,
    pub storey_m: f64,
}

impl Grid {
    pub(super) fn of(surface: &Surface) -> Self {
        let cell = |i: usize| f64::from(surface.size_m[i]) / f64::from(surface.cells[i].max(1));
        Self { bay_m: cell(0).max(0.1), storey_m: cell(1).max(0.1) }
    }

    /// Bays of a wall; none where it is too narrow for one.
    pub(super) fn bays(&self, length_m: f64) -> usize {
        if length_m < NARROWEST_BAY * self.bay_m { 0 } else { (length_m / self.bay_m).round().max(1.0) as usize }
    }

    /// Texture coordinate of both ends of a wall: an integer number of bays, or a pier.
    pub(super) fn along(&self, length_m: f64, first_bay: f64) -> (f64, f64) {
        if length_m < NARROWEST_BAY * self.bay_m {
            return (first_bay * self.bay_m - length_m / 2.0, first_bay * self.bay_m + length_m / 2.0);
        }
        (first_bay * self.bay_m, (first_bay + self.bays(length_m) as f64) * self.bay_m)
    }
}

/// A horizontal strip of walls.
pub(super) struct Band<'a> {
    pub slot: Slot,
    /// Of the wall between its openings.
    pub wall: Slot,
    pub grid: Grid,
    /// Its rules, where they are known.
    pub design: Option<&'a FacadeDesign>,
    pub bottom_m: f64,
    /// The texture starts here; below it, in the ground, its lowest row goes on.
    pub floor_m: f64,
    pub top_m: f64,
    /// Storeys between floor and top; as many of the texture's are shown.
    pub storeys: f64,
    /// Storey of the texture that comes first.
    pub first_storey: usize,
    /// It reaches up to the eaves.
    pub is_uppermost: bool,
}

impl Band<'_> {
    pub(super) fn v(&self, z: f64) -> f64 {
        let share = if self.top_m > self.floor_m { (z - self.floor_m) / (self.top_m - self.floor_m) } else { 0.0 };
        (self.first_storey as f64 + share.max(0.0) * self.storeys) * self.grid.storey_m
    }
}

/// One wall of a volume.
#[derive(Clone, Debug)]
pub(super) struct Wall {
    /// Its corners, the building on the left.
    pub line: Vec<DVec2>,
    /// A number among the volume's walls.
    pub number: u64,
    /// Bay of the texture that comes first: a house's sides differ.
    pub first_bay: usize,
    pub detail: Detail,
    /// Towards a neighbour: no windows.
    pub is_blank: bool,
    /// Towards a street.
    pub is_front: bool,
    /// How much of its length rooms lose at its ends for each metre that they are deep.
    pub corner: [f64; 2],
    /// How far ledges reach beyond its ends for each metre that they stand out, where they go on around the corner.
    pub mitre: [Option<f64>; 2],
    /// From its middle to the wall behind it, metres.
    pub thick_m: f64,
    /// The same from places evenly along it.
    pub thicknesses_m: [f64; STATIONS],
}

impl Wall {
    /// The least distance to the wall behind a stretch of it, metres.
    pub(super) fn thick_behind_m(&self, from_m: f64, to_m: f64, length_m: f64) -> f64 {
        let at = |x: f64| ((x / length_m * STATIONS as f64) as usize).min(STATIONS - 1);
        self.thicknesses_m[at(from_m)..=at(to_m).max(at(from_m))].iter().copied().fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_shows_whole_bays() {
        let grid = Grid { bay_m: 3.0, storey_m: 3.2 };
        assert_eq!(grid.along(10.0, 0.0), (0.0, 9.0));
        assert_eq!(grid.along(11.0, 2.0), (6.0, 18.0));
        assert_eq!(grid.along(1.0, 1.0), (2.5, 3.5));
    }
}
