//! What differs from country to country on a road: its paint, its surface, what the sidewalk is laid with.

use trove_model::MapProjection;

/// A broken line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Dash {
    pub dash_m: f64,
    pub gap_m: f64,
}

/// A line's pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Pattern {
    Dashed(Dash),
    Solid,
    Double,
}

/// A paint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Paint {
    White,
    Yellow,
    Red,
}

/// How a crossing is marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CrossingStyle {
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
pub(super) enum Minor {
    Stop,
    GiveWay,
    Unmarked,
}

/// What is painted where traffic gives way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum GiveWay {
    Triangles,
    /// One row of short bars.
    Bars,
    /// Two thin rows of short bars.
    DoubleBars,
}

/// Lines along the kerb against parking.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum KerbLines {
    None,
    DoubleYellow,
    /// One line on the edge of the carriageway.
    Red,
}

/// A country's ways, lengths in metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Customs {
    /// Between lanes of one direction in towns, and on roads built for speed.
    pub lane: Dash,
    pub fast_lane: Dash,
    /// Width of a line.
    pub line_m: f64,
    /// Between directions: its paint, its pattern with one lane a direction and with more.
    pub centre: (Paint, Pattern, Pattern),
    /// Whether streets of the lowest class have a centre line.
    pub marks_quiet_streets: bool,
    /// Crossings without and with signals.
    pub zebra: CrossingStyle,
    pub signalised: CrossingStyle,
    /// A crossing's bar and the gap beside it.
    pub bar: Dash,
    pub stop_line_m: f64,
    /// Between stop line and crossing.
    pub setback_m: f64,
    pub minor: Minor,
    pub give_way: GiveWay,
    pub kerb_lines: KerbLines,
    pub arrow_m: f64,
    /// Words follow arrows ("ONLY") and stop signs ("STOP").
    pub words: bool,
    /// Yellow hatching where crossing traffic must not be blocked.
    pub boxes: bool,
    /// Two-wheelers wait in a box of their own before the cars.
    pub motorcycle_box: bool,
    /// The coat of cycle lanes.
    pub cycle_coat: [f32; 3],
    /// What an aged road reflects: factor on the library's aged asphalt.
    pub road_tone: f64,
    /// Share of the stretches that are cast in concrete.
    pub concrete_share: f64,
    /// Width of the strip of concrete along the kerb; 0: none.
    pub gutter_m: f64,
    /// Tags of the surfaces of sidewalks and kerbs.
    pub sidewalk: &'static [&'static str],
    pub kerb: &'static [&'static str],
}

const fn dash(dash_m: f64, gap_m: f64) -> Dash {
    Dash { dash_m, gap_m }
}

/// The Vienna Convention's habits, where no row below applies.
const VIENNA: Customs = Customs {
    lane: dash(3.0, 6.0),
    fast_lane: dash(6.0, 12.0),
    line_m: 0.12,
    centre: (Paint::White, Pattern::Dashed(dash(3.0, 6.0)), Pattern::Double),
    marks_quiet_streets: false,
    zebra: CrossingStyle::Bars,
    signalised: CrossingStyle::Bars,
    bar: dash(0.5, 0.5),
    stop_line_m: 0.4,
    setback_m: 1.0,
    minor: Minor::GiveWay,
    give_way: GiveWay::Triangles,
    kerb_lines: KerbLines::None,
    arrow_m: 5.0,
    words: false,
    boxes: false,
    motorcycle_box: false,
    cycle_coat: [1.3, 0.42, 0.3],
    road_tone: 1.0,
    concrete_share: 0.02,
    gutter_m: 0.0,
    sidewalk: &["slabs"],
    kerb: &["concrete"],
};

/// Germany's and its neighbours' (RMS: 3/6 m in towns, crossings at signals between broken lines, stop lines of 0.5 m).
const GERMANY: Customs = Customs {
    signalised: CrossingStyle::Dashes,
    stop_line_m: 0.5,
    minor: Minor::Unmarked,
    give_way: GiveWay::Bars,
    gutter_m: 0.3,
    sidewalk: &["mosaic"],
    kerb: &["granite"],
    ..VIENNA
};

/// France and Monaco (IISR part 7: 3/10 m, dashes of 3/1.33 m between directions).
const FRANCE: Customs = Customs {
    lane: dash(3.0, 10.0),
    centre: (Paint::White, Pattern::Dashed(dash(3.0, 3.5)), Pattern::Solid),
    stop_line_m: 0.5,
    give_way: GiveWay::Bars,
    arrow_m: 4.0,
    sidewalk: &["asphalt-walk", "slabs"],
    kerb: &["granite"],
    ..VIENNA
};

/// The United Kingdom's and Ireland's (TSRGD: 2/4 m, double broken lines at give ways, yellow along kerbs).
const BRITAIN: Customs = Customs {
    lane: dash(2.0, 4.0),
    line_m: 0.1,
    centre: (Paint::White, Pattern::Dashed(dash(2.0, 4.0)), Pattern::Double),
    marks_quiet_streets: true,
    signalised: CrossingStyle::Dashes,
    stop_line_m: 0.3,
    give_way: GiveWay::DoubleBars,
    kerb_lines: KerbLines::DoubleYellow,
    arrow_m: 4.0,
    words: true,
    boxes: true,
    cycle_coat: [0.35, 0.85, 0.45],
    ..VIENNA
};

/// Singapore's (LTA's standard details: 2/4 m, light roads, black and white kerbs).
const SINGAPORE: Customs = Customs {
    centre: (Paint::White, Pattern::Dashed(dash(2.0, 4.0)), Pattern::Double),
    words: false,
    road_tone: 1.12,
    concrete_share: 0.15,
    gutter_m: 0.4,
    sidewalk: &["concrete"],
    kerb: &["black-white"],
    ..BRITAIN
};

/// Canada's and the United States' (MUTCD part 3: 10/30 ft, double yellow between directions, broad bars or lines).
const NORTH_AMERICA: Customs = Customs {
    lane: dash(3.05, 9.15),
    fast_lane: dash(3.05, 9.15),
    line_m: 0.12,
    centre: (Paint::Yellow, Pattern::Double, Pattern::Double),
    zebra: CrossingStyle::Bars,
    signalised: CrossingStyle::Ladder,
    bar: dash(0.45, 0.75),
    stop_line_m: 0.45,
    setback_m: 1.2,
    minor: Minor::Stop,
    arrow_m: 2.9,
    words: true,
    concrete_share: 0.05,
    cycle_coat: [0.35, 0.95, 0.45],
    gutter_m: 0.45,
    sidewalk: &["concrete"],
    ..VIENNA
};

const LATIN_AMERICA: Customs = Customs {
    lane: dash(3.0, 6.0),
    centre: (Paint::Yellow, Pattern::Dashed(dash(3.0, 6.0)), Pattern::Double),
    signalised: CrossingStyle::Bars,
    words: false,
    ..NORTH_AMERICA
};

/// Taiwan's (4/6 m, yellow between directions, red along kerbs, boxes for motorcycles).
const TAIWAN: Customs = Customs {
    lane: dash(4.0, 6.0),
    fast_lane: dash(4.0, 6.0),
    line_m: 0.1,
    centre: (Paint::Yellow, Pattern::Dashed(dash(4.0, 6.0)), Pattern::Double),
    bar: dash(0.4, 0.6),
    stop_line_m: 0.35,
    minor: Minor::Stop,
    kerb_lines: KerbLines::Red,
    motorcycle_box: true,
    gutter_m: 0.4,
    sidewalk: &["herringbone", "bricks"],
    ..VIENNA
};

const JAPAN: Customs = Customs {
    lane: dash(5.0, 5.0),
    line_m: 0.15,
    centre: (Paint::White, Pattern::Dashed(dash(5.0, 5.0)), Pattern::Solid),
    bar: dash(0.45, 0.45),
    minor: Minor::Stop,
    gutter_m: 0.4,
    sidewalk: &["asphalt-walk", "herringbone"],
    ..VIENNA
};

const CHINA: Customs = Customs {
    lane: dash(2.0, 4.0),
    fast_lane: dash(6.0, 9.0),
    line_m: 0.15,
    centre: (Paint::Yellow, Pattern::Dashed(dash(4.0, 6.0)), Pattern::Double),
    bar: dash(0.4, 0.6),
    sidewalk: &["herringbone", "slabs"],
    ..VIENNA
};

const AUSTRALIA: Customs = Customs {
    lane: dash(3.0, 9.0),
    fast_lane: dash(3.0, 9.0),
    signalised: CrossingStyle::Lines,
    give_way: GiveWay::Bars,
    gutter_m: 0.4,
    sidewalk: &["concrete"],
    ..VIENNA
};

/// Rectangles (south, west, north, east, degrees) of countries, each with few others; the first that holds a place
/// tells its customs.
#[rustfmt::skip]
const COUNTRIES: [([f64; 4], Customs); 12] = [
    ([1.1, 103.5, 1.5, 104.1], SINGAPORE),
    ([21.8, 119.9, 25.4, 122.1], TAIWAN),
    ([24.0, 129.4, 45.7, 146.0], JAPAN),
    ([24.0, 122.9, 31.0, 131.0], JAPAN),          // Ryukyu
    ([49.8, -10.8, 60.9, 1.8], BRITAIN),
    ([47.3, 6.0, 55.1, 17.2], GERMANY),
    ([42.3, -4.8, 51.1, 8.3], FRANCE),
    ([25.8, -170.0, 72.0, -52.0], NORTH_AMERICA),
    ([-56.0, -118.0, 32.7, -34.0], LATIN_AMERICA),
    ([18.0, 73.5, 53.6, 135.0], CHINA),
    ([-44.0, 112.9, -9.9, 154.0], AUSTRALIA),
    ([-47.5, 166.0, -34.0, 179.0], AUSTRALIA),    // New Zealand
];

/// The customs of a place.
pub(super) fn customs(projection: &MapProjection) -> &'static Customs {
    let (lat_deg, lon_deg) = (projection.origin_lat_deg, projection.origin_lon_deg);
    let holds = |b: &[f64; 4]| lat_deg >= b[0] && lat_deg <= b[2] && lon_deg >= b[1] && lon_deg <= b[3];
    COUNTRIES.iter().find(|(bounds, _)| holds(bounds)).map_or(&VIENNA, |(_, customs)| customs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn cities_paint_as_their_countries_do() {
        for (city, lat_deg, lon_deg, dash_m, centre) in [
            ("Boston", 42.35, -71.05, 3.05, Paint::Yellow),
            ("Toronto", 43.65, -79.38, 3.05, Paint::Yellow),
            ("Lima", -12.05, -77.04, 3.0, Paint::Yellow),
            ("Singapore", 1.29, 103.78, 2.0, Paint::White),
            ("London", 51.5, -0.1, 2.0, Paint::White),
            ("Neukölln", 52.47, 13.44, 3.0, Paint::White),
            ("Monaco", 43.74, 7.42, 3.0, Paint::White),
            ("Taipei", 25.05, 121.52, 4.0, Paint::Yellow),
            ("Tokyo", 35.68, 139.69, 5.0, Paint::White),
            ("Cairo", 30.04, 31.24, 3.0, Paint::White),
        ] {
            let projection = MapProjection { origin_lat_deg: lat_deg, origin_lon_deg: lon_deg, anchor_m: DVec2::ZERO };
            let customs = customs(&projection);
            assert_eq!((customs.lane.dash_m, customs.centre.0), (dash_m, centre), "{city}");
        }
    }
}
