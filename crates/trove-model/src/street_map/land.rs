//! Land use and cover.

use crate::Polygon;

/// What a piece of land is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)] // the names are the definition
pub enum LandKind {
    Grass,
    Park,
    Garden,
    Wood,
    Scrub,
    Farmland,
    Sand,
    Water,
    Parking,
    /// Square or pedestrian area.
    Paved,
    /// Raised above the carriageway within it.
    TrafficIsland,
    Pitch,
    Construction,
    Residential,
    Commercial,
    Industrial,
}

/// A piece of land.
#[derive(Clone, Debug, PartialEq)]
pub struct Land {
    /// OpenStreetMap's id; negative for a relation.
    pub id: i64,
    /// What it is.
    pub kind: LandKind,
    /// Outline.
    pub polygon: Polygon,
}
