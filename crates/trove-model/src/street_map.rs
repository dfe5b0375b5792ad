//! What a map (OpenStreetMap) knows of a place, in World.

use glam::{DVec2, Vec3};

use crate::Polygon;

/// Roads, buildings, land and furniture of a place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StreetMap {
    /// Ways that are driven or walked on.
    pub roads: Vec<Road>,
    /// Buildings and their parts.
    pub buildings: Vec<Building>,
    /// Land use and cover.
    pub land: Vec<Land>,
    /// Single things.
    pub furniture: Vec<Furniture>,
    /// Licence, with whom to name (`© OpenStreetMap contributors, ODbL 1.0`).
    pub licence: String,
}

/// What a way is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)] // OpenStreetMap's own names
pub enum RoadKind {
    Motorway,
    Trunk,
    Primary,
    Secondary,
    Tertiary,
    Residential,
    /// Unclassified and everything else for cars.
    Minor,
    Service,
    /// Shared or pedestrian street.
    Pedestrian,
    Cycleway,
    /// Footway, path, steps.
    Footway,
    /// A footway across a road.
    Crossing,
}

impl RoadKind {
    /// Whether cars drive on it.
    pub fn is_for_cars(self) -> bool {
        self <= Self::Service
    }
}

/// Which sides have a sidewalk, seen in the way's direction; `None` where the map does not say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SidewalkSides {
    /// On the left.
    pub left: Option<bool>,
    /// On the right.
    pub right: Option<bool>,
}

/// A way.
#[derive(Clone, Debug, PartialEq)]
pub struct Road {
    /// OpenStreetMap's id.
    pub id: i64,
    /// What it is for.
    pub kind: RoadKind,
    /// At least two vertices, metres.
    pub centreline: Vec<DVec2>,
    /// All lanes of both directions, where tagged.
    pub lanes: Option<u32>,
    /// Carriageway width, where tagged.
    pub width_m: Option<f64>,
    /// Traffic runs in the way's direction only.
    pub oneway: bool,
    /// Sidewalks, where tagged.
    pub sidewalk: SidewalkSides,
    /// Vertical order; 0 is the ground.
    pub layer: i32,
    /// On a bridge.
    pub bridge: bool,
    /// In a tunnel.
    pub tunnel: bool,
    /// OpenStreetMap's `surface`; empty where not tagged.
    pub surface: String,
    /// Name; empty where it has none.
    pub name: String,
}

/// A roof's form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // OpenStreetMap's own names
pub enum RoofShape {
    Flat,
    Gabled,
    Hipped,
    HalfHipped,
    Pyramidal,
    Gambrel,
    Mansard,
    Skillion,
    Dome,
    Cone,
    Onion,
    Round,
}

/// A building, or a part that stands for some of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Building {
    /// OpenStreetMap's id; negative for a relation.
    pub id: i64,
    /// Outline on the ground.
    pub footprint: Polygon,
    /// The value of `building` or `building:part` (`yes`, `apartments`, `office`, …).
    pub kind: String,
    /// A `building:part`: it stands in for the outline that it lies in.
    pub part: bool,
    /// Height of the top above ground with the roof, where tagged.
    pub height_m: Option<f64>,
    /// Height of the bottom above ground, where tagged (0 otherwise).
    pub min_height_m: f64,
    /// Storeys without the roof's, where tagged.
    pub levels: Option<f64>,
    /// Roof's form, where tagged.
    pub roof: Option<RoofShape>,
    /// Roof's own height, where tagged.
    pub roof_height_m: Option<f64>,
    /// `building:material`; empty where not tagged.
    pub material: String,
    /// `building:colour`, linear RGB.
    pub color: Option<Vec3>,
    /// `roof:colour`, linear RGB.
    pub roof_color: Option<Vec3>,
    /// Name; empty where it has none.
    pub name: String,
}

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

/// What a single mapped thing is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)] // the names are the definition
pub enum FurnitureKind {
    StreetLamp,
    TrafficSignal,
    TrafficSign,
    StopSign,
    Crossing,
    Tree,
    Bench,
    Bin,
    Hydrant,
    Bollard,
    BusStop,
    UtilityPole,
    BicycleParking,
}

/// A single mapped thing.
#[derive(Clone, Debug, PartialEq)]
pub struct Furniture {
    /// OpenStreetMap's id.
    pub id: i64,
    /// What it is.
    pub kind: FurnitureKind,
    /// Where it stands, metres.
    pub position: DVec2,
    /// Direction it faces, radians counter-clockwise from east, where tagged.
    pub heading_rad: Option<f64>,
}
