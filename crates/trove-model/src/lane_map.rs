//! A dataset's own map of the road.

use glam::DVec2;

use crate::Polygon;

/// A lane of a dataset's map.
#[derive(Clone, Debug, PartialEq)]
pub struct Lane {
    /// The dataset's own name of it.
    pub token: String,
    /// Surface.
    pub polygon: Polygon,
    /// Centre line in driving direction; empty where the map has none.
    pub centreline: Vec<DVec2>,
}

/// What a dataset's map says around a drive, in World's plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LaneMap {
    /// Where vehicles can drive.
    pub drivable: Vec<Polygon>,
    /// Lanes.
    pub lanes: Vec<Lane>,
    /// Walkways.
    pub walkways: Vec<Polygon>,
    /// Pedestrian crossings.
    pub crossings: Vec<Polygon>,
    /// Stop lines.
    pub stop_lines: Vec<Polygon>,
    /// Parking areas.
    pub carparks: Vec<Polygon>,
    /// Lines between directions of traffic.
    pub road_dividers: Vec<Vec<DVec2>>,
    /// Lines between lanes of one direction.
    pub lane_dividers: Vec<Vec<DVec2>>,
}
