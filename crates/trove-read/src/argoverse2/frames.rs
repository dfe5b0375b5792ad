//! The dataset's own frames.

use trove_model::Frame;

/// A city's frame: metres of its UTM zone, x east, y north along the grid, z up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct City;

impl Frame for City {
    const NAME: &'static str = "City";
}

/// The dataset's vehicle frame (`egovehicle`): x forward, y left, z up; the origin is the middle of the rear axle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Axle;

impl Frame for Axle {
    const NAME: &'static str = "Axle";
}
