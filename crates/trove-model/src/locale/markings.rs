//! What is painted on roads, and what they are made of.

/// A broken line, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Dash {
    /// Length of a dash.
    pub dash_m: f64,
    /// From one dash to the next.
    pub gap_m: f64,
}

/// A line's pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[allow(missing_docs)] // the names are the definition
pub enum LinePattern {
    Dashed(Dash),
    Solid,
    /// Two solid lines side by side.
    Double,
    /// Two broken lines side by side.
    DoubleDashed(Dash),
    /// Two lines side by side, of which the left one is solid.
    SolidDashed(Dash),
    /// Two lines side by side, of which the right one is solid.
    DashedSolid(Dash),
}

/// A paint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[allow(missing_docs)] // the names are the definition
pub enum Paint {
    White,
    Yellow,
    Red,
}

impl Paint {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::White, Self::Yellow, Self::Red];

    /// Its name in files (`white`).
    pub fn name(self) -> &'static str {
        match self {
            Self::White => "white",
            Self::Yellow => "yellow",
            Self::Red => "red",
        }
    }
}

/// The line between directions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct CentreLine {
    /// Its paint.
    pub paint: Paint,
    /// Its pattern with one lane a direction.
    pub narrow: LinePattern,
    /// Its pattern with more lanes.
    pub wide: LinePattern,
    /// Whether streets of the lowest class have one.
    pub on_quiet_streets: bool,
}

/// How a crossing is marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum CrossingStyle {
    /// Bars along the road.
    Bars,
    /// A line on each side.
    Lines,
    /// A broken line on each side.
    Dashes,
    /// Bars between lines.
    Ladder,
}

/// Who gives way where a minor road meets a major one without a mapped sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum MinorRoad {
    /// Whoever comes from the minor road stops at a line.
    Stop,
    /// Whoever comes from the minor road gives way at a line.
    GiveWay,
    /// Nothing is painted.
    Unmarked,
}

/// What is painted where traffic gives way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum GiveWayLine {
    /// A row of triangles.
    Triangles,
    /// One row of short bars.
    Bars,
    /// Two thin rows of short bars.
    DoubleBars,
}

/// Lines along the kerb against parking.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum KerbLines {
    /// None are painted.
    None,
    /// Two yellow lines in the gutter.
    DoubleYellow,
    /// One line on the edge of the carriageway.
    Red,
}

/// What is painted on roads, lengths in metres.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct MarkingCustoms {
    /// Share of the streets that anything is painted on, and of the crossings without signals of which the map does not
    /// say whether they are, 0 to 1.
    pub painted_share: f64,
    /// Between lanes of one direction in towns.
    pub lane: Dash,
    /// Between lanes of one direction on roads built for speed.
    pub fast_lane: Dash,
    /// Width of a line.
    pub line_m: f64,
    /// Between directions.
    pub centre: CentreLine,
    /// Crossings without signals.
    pub zebra: CrossingStyle,
    /// Crossings with signals.
    pub signalised: CrossingStyle,
    /// The paint of crossings.
    pub crossing_paint: Paint,
    /// A crossing's bar and the gap beside it.
    pub bar: Dash,
    /// Width of a stop line.
    pub stop_line_m: f64,
    /// Between stop line and crossing.
    pub setback_m: f64,
    /// Who gives way where a minor road meets a major one without a mapped sign.
    pub minor: MinorRoad,
    /// What is painted where traffic gives way.
    pub give_way: GiveWayLine,
    /// Lines along the kerb against parking.
    pub kerb_lines: KerbLines,
    /// Length of an arrow.
    pub arrow_m: f64,
    /// Whether words follow arrows ("ONLY") and stop signs ("STOP").
    pub words: bool,
    /// Whether there is yellow hatching where crossing traffic must not be blocked.
    pub boxes: bool,
    /// Whether two-wheelers wait in a box of their own before the cars.
    pub motorcycle_box: bool,
    /// The coat of cycle lanes, linear RGB.
    pub cycle_coat: [f32; 3],
}

/// What roads and sidewalks are made of.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct RoadSurfaceCustoms {
    /// What an aged road reflects: factor on the library's aged asphalt.
    pub road_tone: f64,
    /// Share of the stretches of road that are cast in concrete, 0 to 1.
    pub concrete_share: f64,
    /// Width of the strip of concrete along the kerb, metres; 0: none.
    pub gutter_m: f64,
    /// Tags of the surfaces of sidewalks, any of which will do.
    pub sidewalk: Vec<String>,
}

/// Kerbs.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct KerbCustoms {
    /// Height above the carriageway, metres.
    pub height_m: f64,
    /// Tags of the surfaces of kerb stones, any of which will do.
    pub tags: Vec<String>,
}
