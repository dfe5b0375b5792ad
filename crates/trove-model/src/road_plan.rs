//! What the roads of a place are, as they were built.

use glam::DVec3;

use crate::{MarkPattern, Paint, Polygon};

/// Areas and lines of the carriageways on the ground; those on bridges and in tunnels are not told.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RoadPlan {
    /// Carriageways; polygons do not overlap.
    pub drivable: Vec<Polygon>,
    /// Sidewalks with their kerbs.
    pub walkways: Vec<Polygon>,
    /// Where people cross, on the carriageway, painted or not.
    pub crossings: Vec<Polygon>,
    /// What each part of the carriageway is for, but for junctions that no recorded lane passes.
    pub lanes: Vec<PlannedLane>,
    /// Lines painted along lanes: no stop lines, crossings and symbols, and no lines along kerbs.
    pub lines: Vec<PaintedLine>,
    /// Edges of carriageways at the foot of kerbs, World, with the carriageway on their left; at least two points.
    pub kerbs: Vec<Vec<DVec3>>,
}

/// What a place on the ground is to traffic; a place may be several of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapLayer {
    /// Carriageway.
    Drivable,
    /// Sidewalk and its kerb.
    Walkway,
    /// Where people cross, on the carriageway.
    Crossing,
    /// A line painted along a lane.
    Line,
    /// The edge of a carriageway along a kerb.
    Kerb,
}

impl MapLayer {
    /// All of them, in the order of their bits.
    pub const ALL: [Self; 5] = [Self::Drivable, Self::Walkway, Self::Crossing, Self::Line, Self::Kerb];

    /// Its name in files (`drivable`).
    pub fn name(self) -> &'static str {
        match self {
            Self::Drivable => "drivable",
            Self::Walkway => "walkway",
            Self::Crossing => "crossing",
            Self::Line => "line",
            Self::Kerb => "kerb",
        }
    }

    /// Its bit in a number that tells all layers of a place.
    pub fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// A lane.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedLane {
    /// Its middle on the road's surface in the direction in which it is driven, World; at least two points.
    pub centreline: Vec<DVec3>,
    /// From edge to edge.
    pub width_m: f64,
    /// What it is for.
    pub usage: LaneUsage,
}

/// What a lane is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaneUsage {
    /// Cars, and whoever rides among them.
    Driving,
    /// Bicycles alone.
    Cycling,
    /// Vehicles stand here.
    Parking,
}

impl LaneUsage {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Driving, Self::Cycling, Self::Parking];

    /// Its name in files (`driving`).
    pub fn name(self) -> &'static str {
        match self {
            Self::Driving => "driving",
            Self::Cycling => "cycling",
            Self::Parking => "parking",
        }
    }
}

/// A painted line, or two side by side; where it is broken, along its dashes and gaps alike.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintedLine {
    /// Its middle on the paint, World; at least two points.
    pub points: Vec<DVec3>,
    /// Its paint.
    pub paint: Paint,
    /// Its pattern, the left side first as seen along the points.
    pub pattern: MarkPattern,
    /// Width of one line.
    pub width_m: f64,
}
