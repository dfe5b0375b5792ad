//! What both forms of the dataset hold, before it is a drive.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3, Vec3};
use trove_model::{Ego, Pose, World};

/// A 4 × 4 transform, row by row.
pub(super) type Matrix = [f64; 16];

/// The vehicle in the dataset's global frame, which is World but for the anchor.
pub(super) type GlobalFromEgo = Pose<World, Ego>;

/// A segment as it stands in its files, some of its frames perhaps out of order.
#[derive(Default)]
pub(super) struct Segment {
    pub(super) name: String,
    /// `location_sf`.
    pub(super) location: String,
    /// By their numbers.
    pub(super) cameras: BTreeMap<i64, CameraRecord>,
    pub(super) frames: Vec<FrameRecord>,
    pub(super) map: Vec<MapFeature>,
    /// What is added to positions in the global frame to get those in the map's.
    pub(super) map_from_global_m: DVec3,
}

/// A camera's calibration; its axes are x forward, y left, z up.
#[derive(Clone)]
pub(super) struct CameraRecord {
    /// f_u, f_v, c_u, c_v, k1, k2, p1, p2, k3.
    pub(super) intrinsics: [f64; 9],
    pub(super) vehicle_from_camera: Matrix,
    pub(super) width: i64,
    pub(super) height: i64,
}

/// A LiDAR's calibration.
#[derive(Clone)]
pub(super) struct LaserRecord {
    /// From the lowest beam to the highest, radians; empty where they are evenly spaced.
    pub(super) inclinations_rad: Vec<f64>,
    pub(super) lowest_rad: f64,
    pub(super) highest_rad: f64,
    pub(super) vehicle_from_laser: Matrix,
}

/// A moment with its annotations.
pub(super) struct FrameRecord {
    pub(super) time_us: i64,
    pub(super) global_from_ego: GlobalFromEgo,
    pub(super) pictures: Vec<PictureRecord>,
    pub(super) labels: Vec<LabelRecord>,
    pub(super) returns: Option<Returns>,
}

/// What all LiDARs of a frame saw.
#[derive(Default)]
pub(super) struct Returns {
    /// Where the top LiDAR stands.
    pub(super) origin_ego: DVec3,
    /// In the vehicle at the frame's pose.
    pub(super) points_ego: Vec<Vec3>,
}

/// When and where a picture was taken. Times are seconds since 1970; NaN where unknown.
#[derive(Clone)]
pub(super) struct PictureRecord {
    pub(super) camera: i64,
    pub(super) global_from_vehicle: Matrix,
    pub(super) pose_s: f64,
    /// Of the vehicle in the global frame, m/s.
    pub(super) velocity_mps: DVec3,
    /// About the global axes, rad/s.
    pub(super) turning_rad_s: DVec3,
    /// First row or column opened, and last one read.
    pub(super) trigger_s: f64,
    pub(super) readout_done_s: f64,
}

/// A box in the vehicle's frame; numbers that are missing are NaN.
#[derive(Clone)]
pub(super) struct LabelRecord {
    pub(super) id: String,
    pub(super) kind: i64,
    pub(super) centre_ego: DVec3,
    /// Length, width, height.
    pub(super) size_m: DVec3,
    pub(super) heading_rad: f64,
    /// In the global frame; `None` where unknown.
    pub(super) velocity_mps: Option<DVec3>,
    pub(super) lidar_points: Option<i64>,
}

/// Something on the dataset's map, in the map's plane.
pub(super) struct MapFeature {
    pub(super) id: i64,
    pub(super) form: MapForm,
}

pub(super) enum MapForm {
    Lane {
        is_for_bicycles: bool,
        line: Vec<DVec2>,
    },
    RoadLine {
        is_between_directions: bool,
        line: Vec<DVec2>,
    },
    RoadEdge(Vec<DVec2>),
    Crosswalk(Vec<DVec2>),
    Driveway(Vec<DVec2>),
    /// Stop signs and speed bumps, which the model has no place for.
    Other,
}
