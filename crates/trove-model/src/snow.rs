//! Snow that lies.

use std::sync::Arc;

use glam::DVec2;

use crate::Raster;

/// Snow on whatever faces up under the open sky.
#[derive(Clone, Debug, PartialEq)]
pub struct Snow {
    /// Share of level surfaces that it covers, 0 to 1.
    pub cover: f64,
    /// What wheels and feet have left of it on roads, sidewalks and the ground beside them; `None`: it lies as it fell.
    pub left: Option<Arc<SnowLeft>>,
}

/// Shares of snow that are left on the ground, over World's plane; all of it outside.
#[derive(Clone, Debug, PartialEq)]
pub struct SnowLeft {
    /// World position of the south-west corner, metres; rows run north.
    pub origin: DVec2,
    /// Side of a cell, metres.
    pub cell_m: f64,
    /// 255: all of it.
    pub shares: Raster<u8>,
}
