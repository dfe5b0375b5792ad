//! What a map (OpenStreetMap) knows of a place, in World.

mod building;
mod furniture;
mod land;
mod line;
mod road;

pub use building::{Building, BuildingKind, RoofMaterial, RoofShape, WallMaterial};
pub use furniture::{Furniture, FurnitureDetail, FurnitureKind, LampMount, MappedPlant, MappedSign};
pub use land::{Land, LandKind};
pub use line::{BarrierStyle, LineKind, MapLine};
pub use road::{
    CrossingMarking, Cycleway, Parking, ParkingOrientation, Road, RoadKind, RoadSurface, Sides, SidewalkSides, Turns,
};

use crate::Relief;

/// Roads, buildings, land, furniture and relief of a place.
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
    /// Things drawn as lines.
    pub lines: Vec<MapLine>,
    /// How high its land lies; `None` where no elevation model tells.
    pub relief: Option<Relief>,
    /// Licence, with whom to name (`© OpenStreetMap contributors, ODbL 1.0`).
    pub licence: String,
}

impl StreetMap {
    /// Whether it knows nothing but heights.
    pub fn is_only_relief(&self) -> bool {
        let Self { roads, buildings, land, furniture, lines, relief, licence: _ } = self;
        relief.is_some()
            && roads.is_empty()
            && buildings.is_empty()
            && land.is_empty()
            && furniture.is_empty()
            && lines.is_empty()
    }
}
