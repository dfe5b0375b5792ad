//! Houses.

use crate::RoofShape;

/// Roofs of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct RoofShare {
    /// The shape.
    pub shape: RoofShape,
    /// Share of all roofs, 0 to 1; what the list leaves is flat.
    pub share: f64,
}

/// What pitched roofs are covered with.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Covering {
    /// Tags of the surfaces, any of which will do.
    pub tags: Vec<String>,
    /// Share of all roofs, 0 to 1; the last of the list takes what is left.
    pub share: f64,
}

/// What a building is used for, as far as its facade tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum FacadeUse {
    /// Whatever there is.
    Any,
    /// People live in it, or nothing is known of it.
    Homes,
    /// A row of houses.
    Terrace,
}

/// Facades of some buildings; of a list the first rule that fits counts.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct FacadeRule {
    /// What the buildings are used for.
    #[cfg_attr(feature = "serde", serde(default = "any"))]
    pub of: FacadeUse,
    /// Their height is more than this, metres.
    #[cfg_attr(feature = "serde", serde(default))]
    pub above_m: f64,
    /// Their height is less than this, metres; without it there is no upper limit.
    #[cfg_attr(feature = "serde", serde(default))]
    pub below_m: Option<f64>,
    /// Share of them that has an ornate facade instead, 0 to 1.
    #[cfg_attr(feature = "serde", serde(default))]
    pub ornate_share: f64,
    /// Whether new ones never have it.
    #[cfg_attr(feature = "serde", serde(default))]
    pub ornate_if_old: bool,
    /// Tags of the facades, any of which will do.
    pub tags: Vec<String>,
}

#[cfg(feature = "serde")]
fn any() -> FacadeUse {
    FacadeUse::Any
}

/// Large buildings of which only a facade is known.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct LidarBuildings {
    /// Share of them that are offices, 0 to 1; the others are apartments.
    pub office_share: f64,
    /// Storeys, from and to.
    pub storeys: [f64; 2],
}

/// Houses: what they look like where the map does not tell.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct BuildingCustoms {
    /// Whether people live in high blocks rather than in houses of a few storeys.
    pub tall_homes: bool,
    /// Whether a building of no known kind may be a house for one family.
    pub family_houses: bool,
    /// Whether a building of no known kind may be an office.
    pub unknown_offices: bool,
    /// Roofs of houses for one family.
    pub house_roofs: Vec<RoofShare>,
    /// Roofs of other homes up to 24 m.
    pub home_roofs: Vec<RoofShare>,
    /// Roofs of other homes up to 8 m that cover less than 200 m².
    pub small_home_roofs: Vec<RoofShare>,
    /// Whether buildings around a courtyard may have pitched roofs.
    pub pitched_courtyards: bool,
    /// What pitched roofs of houses for one family are covered with.
    pub house_coverings: Vec<Covering>,
    /// What other pitched roofs are covered with.
    pub coverings: Vec<Covering>,
    /// Share of flat roofs that are planted, 0 to 1.
    pub green_roof_share: f64,
    /// Whether pitched roofs have chimneys and skylights.
    pub chimneys: bool,
    /// Share of flat roofs above 18 m with a water tank of wood, 0 to 1.
    pub wooden_tank_share: f64,
    /// Share of flat roofs with water tanks of steel or plastic, 0 to 1.
    pub steel_tank_share: f64,
    /// Tags of rendered facades, any of which will do.
    pub rendered: Vec<String>,
    /// Tags of the facades of houses for one family, any of which will do.
    pub house_facades: Vec<String>,
    /// Facades of what is neither a house for one family nor of a kind that looks alike everywhere.
    pub facades: Vec<FacadeRule>,
    /// Whether ground floors are arcades.
    pub arcades: bool,
    /// Large buildings that LiDAR alone knows.
    pub from_lidar: LidarBuildings,
}
