//! What stands along streets.

use std::collections::BTreeMap;

use crate::Kind;

/// The unit of speed limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
pub enum SpeedUnit {
    /// Kilometres an hour.
    Kmh,
    /// Miles an hour.
    Mph,
}

impl SpeedUnit {
    /// `kmh` or `mph`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kmh => "kmh",
            Self::Mph => "mph",
        }
    }

    /// The number on the sign of a limit, a multiple of five.
    pub fn written(self, limit_kmh: f64) -> f64 {
        let written = match self {
            Self::Kmh => limit_kmh,
            Self::Mph => limit_kmh / 1.609_344,
        };
        // Half a mile or kilometre an hour is rounding of the map's unit.
        (written / 5.0).round() * 5.0
    }
}

/// Which sign stands at a junction without mapped ones, for whoever has to wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum WarrantedSign {
    /// A stop sign on lesser roads and on those that end there.
    Stop,
    /// A give-way sign on lesser roads.
    GiveWay,
}

/// Traffic signs.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct SignCustoms {
    /// The tag that the country's signs carry beside what they say, such as `us` or `vienna`.
    pub style: String,
    /// The unit of speed limits.
    pub speed_unit: SpeedUnit,
    /// Which sign stands at junctions without mapped ones.
    pub priority: WarrantedSign,
    /// Whether one-way signs are arrows that point along the street, for those who would turn into it.
    pub one_way_arrows: bool,
    /// What signs are called in this style where that is not what they say: a stop is a `stop` everywhere, but who gives
    /// way (`give-way`) may be told to `yield`.
    pub called: BTreeMap<String, String>,
    /// Tags of the sign of a bus stop.
    pub bus_stop: Vec<String>,
    /// Plates with the names of streets.
    pub name_plate: NamePlate,
}

impl SignCustoms {
    /// The tags of the sign that says something: `stop`, `give-way`, `no-entry`, `one-way`, `speed-50` and so on.
    pub fn tags<'s>(&'s self, says: &'s str) -> [&'s str; 3] {
        ["sign", &self.style, self.called.get(says).map_or(says, String::as_str)]
    }

    /// What the sign for a speed limit says, in the country's own unit.
    pub fn speed_limit(&self, limit_kmh: f64) -> String {
        format!("speed-{}", self.speed_unit.written(limit_kmh))
    }
}

/// A plate with the name of a street.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct NamePlate {
    /// The plate's colour, linear RGB.
    pub ground: [f32; 3],
    /// The letters' colour, linear RGB.
    pub ink: [f32; 3],
    /// What is shortened on it: the word in capitals, and what is written for it.
    pub short: Vec<[String; 2]>,
}

/// Where signals stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum SignalSide {
    /// Before the junction, at the stop line.
    Near,
    /// Behind it.
    Far,
}

/// Traffic signals.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct SignalCustoms {
    /// Where they stand.
    pub side: SignalSide,
    /// Tags of those at a narrow approach.
    pub narrow: Vec<String>,
    /// Tags of those at a wide approach.
    pub wide: Vec<String>,
    /// Tags of those at a very wide approach.
    pub very_wide: Vec<String>,
}

/// Street lamps.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct LampCustoms {
    /// Along main roads, on both sides in turn.
    pub main: LampRow,
    /// Along side streets.
    pub side: LampRow,
    /// Whether they stand on both sides of side streets.
    pub both_sides: bool,
}

/// Street lamps along a road.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct LampRow {
    /// Tags of the lamps, one of which is drawn for a street.
    pub models: Vec<Vec<String>>,
    /// From one to the next on one side, metres.
    pub spacing_m: f64,
}

/// A model by its kind and tags, and how often it is met.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct ModelShare {
    /// What it is.
    pub kind: Kind,
    /// Words that it has to carry.
    pub tags: Vec<String>,
    /// So many shares of the list's sum.
    #[cfg_attr(feature = "serde", serde(default = "once"))]
    pub share: u32,
}

#[cfg(feature = "serde")]
fn once() -> u32 {
    1
}

/// What else stands along streets.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct StreetCustoms {
    /// What stands along sidewalks.
    pub small: Vec<ModelShare>,
    /// From one of these to the next, from and to, metres.
    pub small_spacing_m: [f64; 2],
    /// Tags of mailboxes.
    pub mailbox: Vec<String>,
    /// Whether sidewalks of main roads have railings here and there.
    pub railings: bool,
    /// What bounds the open land behind sidewalks.
    pub boundaries: Vec<ModelShare>,
    /// The share of sidewalks' length that has a boundary behind it, 0 to 1.
    pub boundary_share: f64,
    /// Whether wires hang from pole to pole along side streets.
    pub overhead_wires: bool,
}
