//! What a LiDAR tells.

use glam::DVec3;

use crate::{Class, InstanceId};

/// The returns of a sweep.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCloud {
    /// In the order in which their beams left, the told ones of a beam by their numbers.
    pub points: Vec<LidarPoint>,
}

/// A return that is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LidarPoint {
    /// Where it seems to be, in the sensor's axes at the sweep's time, metres: brought there by the vehicle's motion, not by
    /// what was met.
    pub position_m: DVec3,
    /// Power, calibrated for range as makers do: 100 is a white matt surface that faces the sensor, 101 to 255 are
    /// retroreflectors.
    pub intensity: u8,
    /// Number of the ring.
    pub ring: u16,
    /// 0 for the first return that is told of a beam, 1 for the second.
    pub number: u8,
    /// When its beam left, seconds after the sweep's time.
    pub time_s: f64,
    /// What was met.
    pub class: Class,
    /// Which object; 0 for stuff.
    pub instance: InstanceId,
}
