//! Whose customs a place follows.
//!
//! What differs from country to country is data: the rows of a table that the reader turns into a [`Locale`]. Climate is
//! not part of it: plants follow latitude and season.

mod buildings;
mod car_colors;
mod markings;
mod street;
mod traffic;

pub use buildings::{BuildingCustoms, Covering, FacadeRule, FacadeUse, LidarBuildings, RoofShare};
pub use car_colors::CarColors;
pub use markings::{
    CentreLine, CrossingStyle, Dash, GiveWayLine, KerbCustoms, KerbLines, LinePattern, MarkingCustoms, MinorRoad,
    Paint, RoadSurfaceCustoms,
};
pub use street::{
    LampCustoms, LampRow, ModelShare, NamePlate, SignCustoms, SignalCustoms, SignalSide, SpeedUnit, StreetCustoms,
    WarrantedSign,
};
pub use traffic::{KerbParking, TrafficMix};

/// Whose customs a place follows: what a country's roads, signs, traffic and houses have in common.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Locale {
    /// ISO 3166-1 alpha-2 code, such as `GB`; `None` where no country is known.
    pub country: Option<String>,
    /// The side of the road that traffic keeps to.
    pub driving_side: DrivingSide,
    /// What is painted on roads.
    pub markings: MarkingCustoms,
    /// What roads and sidewalks are made of.
    pub surfaces: RoadSurfaceCustoms,
    /// Kerbs.
    pub kerb: KerbCustoms,
    /// Traffic signs.
    pub signs: SignCustoms,
    /// Traffic signals.
    pub signals: SignalCustoms,
    /// Street lamps.
    pub lamps: LampCustoms,
    /// What else stands along streets.
    pub street: StreetCustoms,
    /// Who is on the road.
    pub traffic: TrafficMix,
    /// Houses.
    pub buildings: BuildingCustoms,
}

/// The side of the road that traffic keeps to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[allow(missing_docs)] // the names are the definition
pub enum DrivingSide {
    Left,
    Right,
}

impl DrivingSide {
    /// Whether traffic keeps to the left.
    pub fn is_left(self) -> bool {
        self == Self::Left
    }

    /// `left` or `right`.
    pub fn name(self) -> &'static str {
        if self.is_left() { "left" } else { "right" }
    }
}
