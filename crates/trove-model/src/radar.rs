//! Radars: what they look at, how they tell things apart, and what they tell.

use glam::DVec3;

use crate::{Class, Ego, InstanceId, Pose, Seed, SensorFrame, World};

/// A radar as its maker builds it: it measures range, azimuth and radial speed in every cycle, and no height.
#[derive(Clone, Debug, PartialEq)]
pub struct Radar {
    /// What it is called (`ars408`).
    pub name: String,
    /// Length of its waves, metres.
    pub wavelength_m: f64,
    /// From one cycle's beginning to the next one's, seconds.
    pub cycle_s: f64,
    /// As many detections as a cycle tells at most, the nearest ones.
    pub most: usize,
    /// Detections of nothing in a cycle, on average.
    pub false_alarms: f64,
    /// Weaker radar cross-sections are not told, dB of a square metre.
    pub faintest_dbsm: f64,
    /// Slower than this over ground a detection is told as stationary, metres a second.
    pub stands_mps: f64,
    /// Fastest approach that is told, metres a second, more than 0.
    pub approach_mps: f64,
    /// Fastest departure that is told, metres a second, more than 0.
    pub departure_mps: f64,
    /// What a cycle looks at, one after the other: the same thing may be in several.
    pub scans: Vec<RadarScan>,
    /// How the scene's surfaces reflect its waves.
    pub surfaces: RadarSurfaces,
}

/// One of the looks of a radar's cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct RadarScan {
    /// What it is called (`near`).
    pub name: String,
    /// Nearer things are not told, metres.
    pub nearest_m: f64,
    /// Farther things are not told, metres.
    pub farthest_m: f64,
    /// Height of the antennas' beam, radians: half of it above and below the sensor's xy plane a target echoes half of what it
    /// does in that plane.
    pub elevation_rad: f64,
    /// Things this far behind each other are told apart, metres.
    pub range_resolution_m: f64,
    /// Things this far beside each other straight ahead are told apart, radians; elsewhere by the same step of the sine.
    pub azimuth_resolution_rad: f64,
    /// Things whose radial speeds differ by this are told apart, metres a second.
    pub speed_resolution_mps: f64,
    /// Standard deviation of a range, metres.
    pub range_error_m: f64,
    /// Standard deviation of a radial speed, metres a second.
    pub speed_error_mps: f64,
    /// What it is like in directions away from straight ahead, in their order; the last one is the edge of what it sees.
    pub directions: Vec<RadarDirection>,
}

/// What a radar is like in a direction, to the left and to the right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadarDirection {
    /// From straight ahead, radians.
    pub azimuth_rad: f64,
    /// Where half of the looks find a target of 10 m², metres.
    pub reach_m: f64,
    /// Standard deviation of an azimuth, radians.
    pub error_rad: f64,
}

/// How the surfaces of a scene reflect a radar's waves.
#[derive(Clone, Debug, PartialEq)]
pub struct RadarSurfaces {
    /// Of each class, by its id, where its material is neither metal nor a pane.
    pub of_class: [RadarSurface; Class::ALL.len()],
    /// Bare or painted metal of any class.
    pub metal: RadarSurface,
    /// Panes of glass of any class.
    pub pane: RadarSurface,
}

/// How a surface reflects a radar's waves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RadarSurface {
    /// Share of the power that is reflected at normal incidence, 0 to 1; more at a slant (Schlick 1994).
    pub reflectance: f64,
    /// Share of what is reflected that goes evenly in all directions (Lambert), 0 to 1; the rest goes about the mirror's.
    pub diffuse: f64,
    /// How wide about: GGX's α, about the tangent of the slopes of what the model does not show.
    pub spread: f64,
    /// Standard deviation of its heights, metres: how far it is a mirror for what lies behind (Rayleigh's roughness).
    pub height_m: f64,
    /// Share of the power that passes straight through, 0 to 1.
    pub passes: f64,
}

impl RadarSurfaces {
    /// The surface of a class and a material.
    pub fn of(&self, class: Class, is_metal: bool, is_pane: bool) -> &RadarSurface {
        match (is_pane, is_metal) {
            (true, _) => &self.pane,
            (false, true) => &self.metal,
            (false, false) => &self.of_class[usize::from(class.id())],
        }
    }
}

impl RadarScan {
    /// How far from straight ahead it sees, radians.
    pub fn half_width_rad(&self) -> f64 {
        self.directions.last().map_or(0.0, |edge| edge.azimuth_rad)
    }

    /// What it is like in a direction; `None` beyond its edge.
    pub fn at(&self, azimuth_rad: f64) -> Option<RadarDirection> {
        let azimuth_rad = azimuth_rad.abs();
        let after = self.directions.iter().position(|direction| direction.azimuth_rad >= azimuth_rad)?;
        let (a, b) = (self.directions[after.saturating_sub(1)], self.directions[after]);
        let apart = b.azimuth_rad - a.azimuth_rad;
        let share = if apart > 0.0 { ((azimuth_rad - a.azimuth_rad) / apart).clamp(0.0, 1.0) } else { 1.0 };
        Some(RadarDirection {
            azimuth_rad,
            // Gains, which are told in decibels, fall evenly.
            reach_m: a.reach_m * (b.reach_m / a.reach_m).powf(share),
            error_rad: a.error_rad + (b.error_rad - a.error_rad) * share,
        })
    }

    /// The share of a target's echo that is left at an elevation, both ways.
    pub fn elevation_gain(&self, elevation_rad: f64) -> f64 {
        0.5_f64.powf((elevation_rad / (self.elevation_rad / 2.0)).powi(2))
    }
}

/// A cycle to be made: where a radar is and how it moves.
#[derive(Clone, Debug, PartialEq)]
pub struct RadarShot {
    /// Name of its folder (`ego.RADAR_FRONT`).
    pub view: String,
    /// The radar.
    pub radar: Radar,
    /// When it looks, nanoseconds since 1970 UTC: the moment of the scene.
    pub time_ns: i64,
    /// The sensor then: x ahead, y to its left, z up.
    pub world_from_radar: Pose<World, SensorFrame>,
    /// The vehicle that carries it.
    pub world_from_ego: Pose<World, Ego>,
    /// How the sensor moves, World, metres a second.
    pub velocity_mps: DVec3,
    /// Source of noise.
    pub seed: Seed,
    /// The object that carries it, through which its waves pass.
    pub carrier: Option<InstanceId>,
}

/// Something that a radar tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadarDetection {
    /// Range, metres.
    pub range_m: f64,
    /// Azimuth from the sensor's x axis towards its y axis, radians.
    pub azimuth_rad: f64,
    /// How fast it goes away from the sensor, metres a second; less than 0 for what comes nearer.
    pub radial_mps: f64,
    /// The same over ground: without the sensor's own motion, as if what was met were as high as the sensor.
    pub ground_mps: f64,
    /// Radar cross-section, dB of a square metre.
    pub rcs_dbsm: f64,
    /// Standard deviations that the sensor tells: of the range, metres, …
    pub range_error_m: f64,
    /// … of the azimuth, radians, …
    pub azimuth_error_rad: f64,
    /// … and of the speed, metres a second.
    pub speed_error_mps: f64,
    /// What most of its power comes from; [`Class::Void`] for a false alarm.
    pub class: Class,
    /// Which object; 0 for stuff and false alarms.
    pub instance: InstanceId,
    /// Surfaces on its way out and back: 1 for what is where it is told, more for a ghost behind or in front of a mirror, 0
    /// for a false alarm.
    pub surfaces: u8,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reach_falls_evenly_in_decibels_and_ends_at_the_edge() {
        let direction = |azimuth_rad, reach_m, error_rad| RadarDirection { azimuth_rad, reach_m, error_rad };
        let scan = RadarScan {
            name: "near".into(),
            nearest_m: 0.2,
            farthest_m: 100.0,
            elevation_rad: 0.2,
            range_resolution_m: 0.4,
            azimuth_resolution_rad: 0.05,
            speed_resolution_mps: 0.1,
            range_error_m: 0.05,
            speed_error_mps: 0.01,
            directions: vec![direction(0.0, 100.0, 0.01), direction(0.8, 25.0, 0.03)],
        };
        let middle = scan.at(-0.4).unwrap();
        assert!((middle.reach_m - 50.0).abs() < 1e-9 && (middle.error_rad - 0.02).abs() < 1e-12);
        assert_eq!(scan.at(0.0).unwrap().reach_m, 100.0);
        assert_eq!((scan.at(0.81), scan.half_width_rad()), (None, 0.8));
        assert!((scan.elevation_gain(-0.1) - 0.5).abs() < 1e-12);
    }
}
