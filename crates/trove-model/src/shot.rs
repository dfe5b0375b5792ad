//! One picture to take.

use crate::{Camera, InstanceId, Lens, Pose, Seed, World};

/// How bright the picture becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExposureRule {
    /// Metered, plus a correction in stops.
    Auto {
        /// Stops; positive is brighter.
        compensation_ev: f64,
    },
    /// Radiance is multiplied by 2 to this power.
    Fixed {
        /// Stops.
        ev: f64,
    },
}

/// A camera at a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// Name (`ego.CAM_FRONT`).
    pub view: String,
    /// Intrinsics.
    pub lens: Lens,
    /// Pose.
    pub world_from_camera: Pose<World, Camera>,
    /// The same camera at the previous keyframe; `None` where there is none, and backward flow is not defined.
    pub world_from_camera_previous: Option<Pose<World, Camera>>,
    /// The same camera at the next keyframe; `None` where there is none, and forward flow is not defined.
    pub world_from_camera_next: Option<Pose<World, Camera>>,
    /// Time, nanoseconds since 1970 UTC.
    pub time_ns: i64,
    /// Samples a pixel.
    pub spp: u32,
    /// Brightness.
    pub exposure: ExposureRule,
    /// Source of all randomness in the picture.
    pub seed: Seed,
    /// The object that carries the camera: camera and label rays pass through it, its shadow and reflection stay.
    pub carrier: Option<InstanceId>,
}
