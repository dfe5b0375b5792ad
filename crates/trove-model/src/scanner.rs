//! LiDARs: how they send their beams out, and what they make of what comes back.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::{Ego, InstanceId, Pose, Seed, SensorFrame, SensorRay, World};

/// A LiDAR as its maker builds it: beams above each other in rings that fire a column at a time, clockwise as seen from above.
#[derive(Clone, Debug, PartialEq)]
pub struct Scanner {
    /// What it is called (`hdl-32e`).
    pub name: String,
    /// Angle of each ring above the sensor's xy plane, radians, in the order of the rings' numbers.
    pub elevations_rad: Vec<f64>,
    /// Horizontal field of view, radians; a full turn where it spins.
    pub width_rad: f64,
    /// Columns of one sweep.
    pub columns: usize,
    /// From one sweep's beginning to the next one's, seconds; its columns are spread evenly over it.
    pub sweep_s: f64,
    /// Full angle of the cone that a beam fills, radians.
    pub divergence_rad: f64,
    /// Nearer returns are not told, metres.
    pub nearest_m: f64,
    /// Farther returns are not told, metres.
    pub farthest_m: f64,
    /// Where half of the pulses bring back a matt surface of 10 % reflectance that faces the sensor, metres.
    pub reach_m: f64,
    /// Standard deviation of a range, metres.
    pub noise_m: f64,
    /// Surfaces of one beam that are this far behind each other make two returns, metres.
    pub pulse_m: f64,
    /// An intensity i of 0 to 255 that rises evenly with power is told as 255 · (i / 255)^this.
    pub intensity_exponent: f64,
    /// Which returns of a beam are told.
    pub told: ToldReturns,
}

/// Which returns of a beam a LiDAR tells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToldReturns {
    /// That of the most power.
    #[default]
    Strongest,
    /// The farthest.
    Last,
    /// The strongest and the last one, or where these are one the second strongest.
    Dual,
}

impl ToldReturns {
    /// Each with its name in files.
    pub const ALL: [(Self, &str); 3] = [(Self::Strongest, "strongest"), (Self::Last, "last"), (Self::Dual, "dual")];

    /// The name in files.
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].1
    }
}

/// A LiDAR on the vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct RigLidar {
    /// The dataset's name of it (`LIDAR_TOP`).
    pub name: String,
    /// Mounting.
    pub ego_from_lidar: Pose<Ego, SensorFrame>,
    /// When its sweeps are.
    pub phase: SweepPhase,
}

/// When a LiDAR's sweeps are, and where in its turn they begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepPhase {
    /// Azimuth of a spinning LiDAR's first column, from the sensor's x axis towards its y axis, radians.
    pub begins_at_rad: f64,
    /// Share of the sweep that is over at the time that stands for it, to which its points are brought: 0 to 1.
    pub over: f64,
}

impl SweepPhase {
    /// It begins behind the sensor and faces forward at its time, as KITTI's: the sensor's x axis is ahead.
    pub const FORWARD: Self = Self { begins_at_rad: TAU / 2.0, over: 0.5 };
}

impl Scanner {
    /// Whether it turns full circles.
    pub fn spins(&self) -> bool {
        self.width_rad >= TAU
    }

    /// How many beams a sweep has.
    pub fn beams(&self) -> usize {
        self.columns * self.elevations_rad.len()
    }

    /// Where a beam goes, unit, in the sensor's axes. A raster is centred about the x axis; a spinning one begins at
    /// `begins_at_rad`.
    pub fn direction(&self, column: usize, ring: usize, begins_at_rad: f64) -> DVec3 {
        let step = self.width_rad / self.columns as f64;
        let first = if self.spins() { begins_at_rad } else { (self.width_rad - step) / 2.0 };
        let (sin, cos) = (first - step * column as f64).sin_cos();
        let (up, along) = self.elevations_rad[ring].sin_cos();
        DVec3::new(along * cos, along * sin, up)
    }

    /// When a column leaves, seconds after the sweep's beginning.
    pub fn column_s(&self, column: usize) -> f64 {
        self.sweep_s * column as f64 / self.columns as f64
    }
}

/// One sweep to be made: where a LiDAR is while it turns.
#[derive(Clone, Debug, PartialEq)]
pub struct LidarShot {
    /// Name of its folder (`ego.LIDAR_TOP`).
    pub view: String,
    /// The LiDAR.
    pub scanner: Scanner,
    /// When its sweeps are.
    pub phase: SweepPhase,
    /// The time that stands for the sweep, nanoseconds since 1970 UTC: the moment of the scene.
    pub time_ns: i64,
    /// The sensor at that time; points are told in its axes then.
    pub world_from_lidar: Pose<World, SensorFrame>,
    /// The vehicle that carries it at that time.
    pub world_from_ego: Pose<World, Ego>,
    /// The sensor during the sweep, at times spread evenly from its beginning to its end; at least two.
    pub way: Vec<Pose<World, SensorFrame>>,
    /// Source of noise and drop-out.
    pub seed: Seed,
    /// The object that carries it.
    pub carrier: Option<InstanceId>,
}

impl LidarShot {
    /// When a column leaves, seconds after [`LidarShot::time_ns`].
    pub fn time_s(&self, column: usize) -> f64 {
        self.scanner.column_s(column) - self.phase.over * self.scanner.sweep_s
    }

    /// The sensor when a column leaves.
    pub fn world_from_lidar_at(&self, column: usize) -> Pose<World, SensorFrame> {
        let at = column as f64 / self.scanner.columns as f64 * (self.way.len() - 1) as f64;
        let before = (at as usize).min(self.way.len() - 2);
        self.way[before].interpolate(&self.way[before + 1], at - before as f64)
    }

    /// The middle of a beam.
    pub fn ray(&self, column: usize, ring: usize) -> SensorRay {
        let pose = self.world_from_lidar_at(column);
        let direction = pose.vector(self.scanner.direction(column, ring, self.phase.begins_at_rad));
        SensorRay { origin: pose.translation, direction, time_s: self.time_s(column) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scanner(width_rad: f64) -> Scanner {
        Scanner {
            name: "three beams".into(),
            elevations_rad: vec![-0.2, 0.0, 0.1],
            width_rad,
            columns: 8,
            sweep_s: 0.1,
            divergence_rad: 0.003,
            nearest_m: 1.0,
            farthest_m: 100.0,
            reach_m: 50.0,
            noise_m: 0.02,
            pulse_m: 0.8,
            intensity_exponent: 1.0,
            told: ToldReturns::Strongest,
        }
    }

    #[test]
    fn a_turn_goes_clockwise_from_where_it_begins_and_a_raster_from_the_left() {
        let spinning = scanner(TAU);
        let azimuths = |scanner: &Scanner, begins_at_rad: f64| -> Vec<f64> {
            let azimuth = |v: DVec3| v.y.atan2(v.x).to_degrees().rem_euclid(360.0);
            (0..8).map(|column| azimuth(scanner.direction(column, 1, begins_at_rad)).round()).collect()
        };
        assert_eq!(azimuths(&spinning, TAU / 2.0), [180.0, 135.0, 90.0, 45.0, 0.0, 315.0, 270.0, 225.0]);
        assert_eq!(azimuths(&scanner(TAU / 4.5), 1.0), [35.0, 25.0, 15.0, 5.0, 355.0, 345.0, 335.0, 325.0]);
        assert!((spinning.direction(3, 0, 0.3).z.asin() + 0.2).abs() < 1e-12);
    }

    #[test]
    fn each_column_leaves_from_where_the_sensor_is_then() {
        let at = |x: f64| Pose::from_yaw(0.0, DVec3::X * x);
        let shot = LidarShot {
            view: "v".into(),
            scanner: scanner(TAU),
            phase: SweepPhase { begins_at_rad: 0.0, over: 1.0 },
            time_ns: 0,
            world_from_lidar: at(2.0),
            world_from_ego: Pose::IDENTITY,
            way: vec![at(0.0), at(1.5), at(2.0)],
            seed: Seed(0),
            carrier: None,
        };
        let left: Vec<(f64, f64)> = [0, 2, 6].map(|c| (shot.time_s(c), shot.ray(c, 1).origin.x)).to_vec();
        for ((time_s, x), (expect_s, expect)) in left.into_iter().zip([(-0.1, 0.0), (-0.075, 0.75), (-0.025, 1.75)]) {
            assert!((time_s - expect_s).abs() < 1e-12 && (x - expect).abs() < 1e-12, "{time_s}: {x}");
        }
        assert_eq!(shot.ray(2, 1).time_s, shot.time_s(2));
    }
}
