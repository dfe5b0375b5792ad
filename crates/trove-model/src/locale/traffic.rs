//! Who is on the road.

use super::CarColors;

/// How often those who share a street are met, as shares of their sum.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct TrafficMix {
    /// Along the sidewalk.
    pub walking: f64,
    /// On the sidewalk.
    pub standing: f64,
    /// At a crossing, for a gap.
    pub waiting: f64,
    /// On bicycles.
    pub cycling: f64,
    /// On motorcycles.
    pub motorcycling: f64,
    /// In cars, trucks and buses.
    pub driving: f64,
    /// Cars and trucks that nobody is in.
    pub parked: f64,
    /// Animals that nobody leads, beside the road and on its edge.
    pub straying: f64,
    /// Where nobody was recorded, how full kerbs are.
    pub kerb_parking: KerbParking,
    /// What colours cars have.
    pub car_colors: CarColors,
}

/// How much of the room for parked vehicles is taken, as shares.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct KerbParking {
    /// Kerbs of residential and minor streets.
    pub quiet: f64,
    /// Those of secondary and tertiary roads.
    pub busy: f64,
    /// Rows that the map tells of.
    pub rows: f64,
}
