//! What stands along streets in which part of the world.

use glam::{Vec3, vec3};
use trove_model::{MapProjection, drives_on_left};

/// Whose signs a country has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Signs {
    /// After the Manual on Uniform Traffic Control Devices.
    American,
    /// After the Vienna Convention on Road Signs and Signals.
    Vienna,
}

/// Where signals stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SignalSide {
    /// Before the junction, at the stop line.
    Near,
    /// Behind it.
    Far,
}

/// A region's habits; models are named by their tags, with `/` between them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Habits {
    pub signs: Signs,
    /// Speed limits are in miles an hour.
    pub miles: bool,
    pub on_left: bool,
    pub signal_side: SignalSide,
    /// Signals at a narrow, at a wide and at a very wide approach.
    pub signals: [&'static str; 3],
    /// Lamps along main roads and along side streets.
    pub lamps: [&'static [&'static str]; 2],
    /// Distance of lamps on one side along main roads and along side streets, metres.
    pub lamp_spacing_m: [f64; 2],
    /// Along side streets they stand on both sides.
    pub lamps_on_both_sides: bool,
    /// What stands along sidewalks, as often as it is named.
    pub small: &'static [&'static str],
    pub mailbox: &'static str,
    /// Sidewalks of main roads have railings here and there.
    pub railings: bool,
    /// What bounds the open land behind sidewalks, as often as it is named, and on which share of their length.
    pub boundaries: &'static [&'static str],
    pub boundary_share: f64,
    /// Wires from pole to pole along side streets.
    pub overhead_wires: bool,
    pub bus_stop: &'static str,
    /// Ground and ink of street names, linear RGB.
    pub name_plate: [Vec3; 2],
}

const WHITE: Vec3 = vec3(0.66, 0.66, 0.65);
const BLACK: Vec3 = vec3(0.022, 0.022, 0.022);
const GREEN: Vec3 = vec3(0.012, 0.13, 0.06);
const BLUE: Vec3 = vec3(0.018, 0.06, 0.22);

const AMERICA: Habits = Habits {
    signs: Signs::American,
    miles: true,
    on_left: false,
    signal_side: SignalSide::Far,
    signals: ["signal/us-arm", "signal/us-arm", "signal/us-long-arm"],
    lamps: [&["lamp/cobra"], &["lamp/cobra", "lamp/post-top", "lamp/historic"]],
    lamp_spacing_m: [38.0, 34.0],
    lamps_on_both_sides: false,
    small: &[
        "hydrant/pillar",
        "hydrant/yellow",
        "parking-meter/single",
        "parking-meter/single",
        "bin/round",
        "news-box/row",
        "bicycle-rack/hoops",
        "bench/slatted",
        "planter/round",
        "cabinet/slim",
    ],
    mailbox: "mailbox/blue",
    railings: false,
    boundaries: &["fence/picket", "fence/chain-link", "fence/bars"],
    boundary_share: 0.15,
    overhead_wires: true,
    bus_stop: "sign/us/bus-stop",
    name_plate: [GREEN, WHITE],
};

const EUROPE: Habits = Habits {
    signs: Signs::Vienna,
    miles: false,
    on_left: false,
    signal_side: SignalSide::Near,
    signals: ["signal/post", "signal/post", "signal/arm"],
    lamps: [&["lamp/curved", "lamp/straight"], &["lamp/post-top", "lamp/straight", "lamp/historic"]],
    lamp_spacing_m: [32.0, 28.0],
    lamps_on_both_sides: false,
    small: &[
        "bollard",
        "bollard",
        "bollard",
        "bin/post",
        "bicycle-rack/hoops",
        "bicycle-rack/hoops",
        "cabinet/slim",
        "cabinet/wide",
        "parking-meter/station",
        "bench/slatted",
        "planter/trough",
        "advertising/column",
    ],
    mailbox: "mailbox/yellow",
    railings: false,
    boundaries: &["fence/bars", "fence/bars", "wall/dwarf", "wall/dwarf", "wall/garden", "wall/railed"],
    boundary_share: 0.3,
    overhead_wires: false,
    bus_stop: "sign/vienna/bus-stop",
    name_plate: [BLUE, WHITE],
};

const GERMANY: Habits = Habits { bus_stop: "sign/vienna/haltestelle", name_plate: [WHITE, BLACK], ..EUROPE };

const BRITAIN: Habits = Habits {
    miles: true,
    mailbox: "mailbox/red",
    railings: true,
    name_plate: [WHITE, BLACK],
    lamps: [&["lamp/straight"], &["lamp/straight", "lamp/historic"]],
    boundaries: &[
        "wall/railed",
        "wall/railed",
        "wall/railed",
        "fence/bars",
        "fence/bars",
        "wall/garden",
        "wall/garden",
        "wall/brick",
        "fence/wood",
        "fence/picket",
    ],
    boundary_share: 0.75,
    ..EUROPE
};

const EAST_ASIA: Habits = Habits {
    signal_side: SignalSide::Far,
    signals: ["signal/lying-arm", "signal/lying-arm", "signal/lying-arm"],
    lamps: [&["lamp/curved", "lamp/mast"], &["lamp/straight", "lamp/curved"]],
    lamp_spacing_m: [30.0, 28.0],
    small: &[
        "hydrant/pillar",
        "bollard",
        "bollard",
        "cabinet/wide",
        "cabinet/wide",
        "planter/trough",
        "planter/trough",
        "bin/post",
        "telephone",
        "bicycle-rack/hoops",
    ],
    mailbox: "mailbox/green",
    railings: true,
    name_plate: [GREEN, WHITE],
    boundaries: &["wall/concrete", "wall/garden", "fence/bars"],
    ..EUROPE
};

const JAPAN: Habits = Habits { overhead_wires: true, mailbox: "mailbox/red", name_plate: [BLUE, WHITE], ..EAST_ASIA };

const TROPICAL_ASIA: Habits = Habits {
    signal_side: SignalSide::Far,
    signals: ["signal/post", "signal/arm", "signal/arm"],
    lamps: [&["lamp/mast", "lamp/curved"], &["lamp/straight", "lamp/mast"]],
    lamp_spacing_m: [34.0, 30.0],
    small: &[
        "hydrant/pillar",
        "hydrant/pillar",
        "bin/round",
        "bin/post",
        "cabinet/slim",
        "bollard",
        "bicycle-rack/hoops",
        "bench/stone",
    ],
    mailbox: "mailbox/red",
    railings: true,
    name_plate: [GREEN, WHITE],
    boundaries: &["fence/bars", "fence/bars", "wall/railed", "fence/chain-link"],
    ..EUROPE
};

/// Rectangles (south, west, north, east, degrees), the first that holds a place counts; elsewhere it is Europe's.
#[rustfmt::skip]
const REGIONS: [([f64; 4], Habits); 15] = [
    ([49.0, -141.0, 84.0, -52.0], Habits { miles: false, ..AMERICA }),  // Canada
    ([45.1, -84.0, 49.0, -70.0],  Habits { miles: false, ..AMERICA }),  // Ontario, Quebec
    ([43.1, -82.4, 45.1, -78.95], Habits { miles: false, ..AMERICA }),  // around Toronto
    ([43.3, -66.9, 49.0, -52.0],  Habits { miles: false, ..AMERICA }),  // Nova Scotia, Newfoundland
    ([25.9, -170.0, 72.0, -66.9], AMERICA),
    ([18.5, -170.0, 25.9, -154.0], AMERICA),                            // Hawaii
    ([24.3, -83.0, 25.9, -79.8],  AMERICA),                             // southern Florida
    ([51.3, -10.8, 54.1, -5.9],   Habits { miles: false, ..BRITAIN }),  // Ireland
    ([54.1, -10.8, 55.5, -8.1],   Habits { miles: false, ..BRITAIN }),  // Donegal
    ([49.8, -8.2, 60.9, 1.8],     BRITAIN),
    ([46.3, 9.6, 55.1, 17.2],     GERMANY),                             // and Austria
    ([47.5, 7.0, 55.1, 9.6],      GERMANY),
    ([24.0, 129.6, 45.7, 146.0],  JAPAN),
    ([20.5, 97.0, 46.0, 131.0],   EAST_ASIA),
    ([-11.1, 68.0, 20.5, 141.1],  TROPICAL_ASIA),
];

impl Habits {
    pub(super) fn of(projection: &MapProjection) -> Self {
        let (lat_deg, lon_deg) = (projection.origin_lat_deg, projection.origin_lon_deg);
        let holds = |b: &[f64; 4]| lat_deg >= b[0] && lat_deg <= b[2] && lon_deg >= b[1] && lon_deg <= b[3];
        let habits = REGIONS.iter().find(|(rectangle, _)| holds(rectangle)).map_or(EUROPE, |(_, habits)| *habits);
        Self { on_left: drives_on_left(lat_deg, lon_deg), ..habits }
    }

    /// What the sign for a speed limit is called, with the number that is written there.
    pub(super) fn speed_sign(&self, limit_kmh: f64) -> String {
        // Half a mile or kilometre an hour is rounding of the map's unit.
        let written = if self.miles { limit_kmh / 1.609_344 } else { limit_kmh };
        let number = (written / 5.0).round() * 5.0;
        format!("speed-{number}")
    }

    /// The tags of the American sign where the country has those, of the other elsewhere.
    pub(super) fn sign<'n>(&self, american: &'n str, vienna: &'n str) -> [&'n str; 3] {
        if self.signs == Signs::American { ["sign", "us", american] } else { ["sign", "vienna", vienna] }
    }
}

/// The tags of a model.
pub(super) fn words(model: &str) -> Vec<&str> {
    model.split('/').collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn limits_are_written_in_the_country_s_unit() {
        let of = |origin_lat_deg, origin_lon_deg, limit_kmh| {
            let projection = MapProjection { origin_lat_deg, origin_lon_deg, anchor_m: DVec2::ZERO };
            Habits::of(&projection).speed_sign(limit_kmh)
        };
        assert_eq!(of(42.35, -71.05, 40.23), "speed-25"); // Boston
        assert_eq!(of(43.65, -79.38, 40.0), "speed-40"); // Toronto
        assert_eq!(of(51.5, -0.12, 32.19), "speed-20"); // London
        assert_eq!(of(52.47, 13.44, 30.0), "speed-30"); // Berlin
        assert_eq!(of(43.74, 7.43, 50.0), "speed-50"); // Monaco
        assert_eq!(of(25.05, 121.52, 50.0), "speed-50"); // Taipei
        assert_eq!(of(1.3, 103.79, 70.0), "speed-70"); // Singapore
    }
}
