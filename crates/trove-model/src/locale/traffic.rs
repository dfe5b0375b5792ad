//! Who is on the road.

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
}
