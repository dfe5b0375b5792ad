//! Single mapped things.

use glam::DVec2;

use super::CrossingMarking;
use crate::LeafType;

/// What a single mapped thing is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)] // the names are the definition
pub enum FurnitureKind {
    StreetLamp,
    TrafficSignal,
    TrafficSign,
    StopSign,
    GiveWaySign,
    Crossing,
    Tree,
    Shrub,
    Bench,
    PicnicTable,
    Bin,
    Hydrant,
    Bollard,
    BusStop,
    UtilityPole,
    BicycleParking,
    Mailbox,
    StreetCabinet,
    Telephone,
    AdvertisingColumn,
    Fountain,
    Flagpole,
    /// A cover in the road.
    Manhole,
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
    /// Height, where tagged.
    pub height_m: Option<f64>,
    /// What of its kind it is; `None` where the map does not say.
    pub detail: Option<FurnitureDetail>,
}

/// What the map says of a thing beside its kind.
#[derive(Clone, Debug, PartialEq)]
pub enum FurnitureDetail {
    /// Of a tree or shrub.
    Plant(MappedPlant),
    /// Of a traffic sign.
    Sign(MappedSign),
    /// Of a crossing.
    Crossing(CrossingMarking),
    /// Of a street lamp.
    Lamp(LampMount),
}

/// What the map says of a plant.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MappedPlant {
    /// Species, taxon or genus in lower case (`tilia cordata`); `None` where not tagged.
    pub species: Option<String>,
    /// Its leaves; `None` where the map does not say, or says that they are mixed.
    pub leaves: Option<LeafType>,
}

/// What a traffic sign says.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // the names are the definition
pub enum MappedSign {
    Stop,
    GiveWay,
    NoEntry,
    OneWay,
    NoStopping,
    NoParking,
    Parking,
    PedestrianCrossing,
    /// A danger that is not named.
    Danger,
    SpeedLimit {
        limit_kmh: f64,
    },
    /// Something that has no name here.
    Other,
}

/// What a street lamp hangs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LampMount {
    /// On top of a straight mast.
    StraightMast,
    /// On a mast that reaches over the road.
    BentMast,
    /// On a wall or under a ceiling.
    Wall,
    /// On wires over the road.
    Wires,
    /// In or on the ground.
    Ground,
}

impl Furniture {
    /// A thing of which nothing but kind and place is known.
    pub fn new(id: i64, kind: FurnitureKind, position: DVec2) -> Self {
        Self { id, kind, position, heading_rad: None, height_m: None, detail: None }
    }

    /// What the map says of a plant; nothing where it says nothing or this is none.
    pub fn plant(&self) -> MappedPlant {
        match &self.detail {
            Some(FurnitureDetail::Plant(plant)) => plant.clone(),
            _ => MappedPlant::default(),
        }
    }

    /// What a traffic sign says, as far as the map tells.
    pub fn sign(&self) -> Option<MappedSign> {
        match self.detail {
            Some(FurnitureDetail::Sign(sign)) => Some(sign),
            _ => None,
        }
    }

    /// How a crossing is marked, as far as the map tells.
    pub fn crossing(&self) -> Option<CrossingMarking> {
        match self.detail {
            Some(FurnitureDetail::Crossing(marking)) => Some(marking),
            _ => None,
        }
    }

    /// What a street lamp hangs on, as far as the map tells.
    pub fn lamp(&self) -> Option<LampMount> {
        match self.detail {
            Some(FurnitureDetail::Lamp(mount)) => Some(mount),
            _ => None,
        }
    }
}
