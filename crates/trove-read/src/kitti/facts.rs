//! The table of what KITTI's files do not say.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use glam::DVec3;
use serde::Deserialize;
use trove_model::{EgoBody, Kind};

/// `facts.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Facts {
    pub(super) place: String,
    pub(super) lat_deg: f64,
    pub(super) lon_deg: f64,
    /// Of the recording computer's clock, east of UTC.
    pub(super) utc_offset_s: i64,
    /// When a benchmark's frame was taken, as in `timestamps.txt`.
    pub(super) unknown_time: String,
    /// From one synced frame to the next.
    pub(super) frame_s: f64,
    car: Car,
    picture: Vec<Picture>,
    /// By the annotators' name.
    kinds: BTreeMap<String, Kind>,
    visibility: BTreeMap<String, f32>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Car {
    size_m: [f64; 3],
    centre_before_axle_m: f64,
    imu_height_m: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Picture {
    focal_px: f64,
    size_px: [u32; 2],
}

/// The table.
pub(super) static FACTS: LazyLock<Facts> =
    LazyLock::new(|| toml::from_str(include_str!("facts.toml")).expect("a test reads the table"));

impl Facts {
    /// The car's own box, about an Ego on the ground below the middle of the rear axle.
    pub(super) fn ego_body(&self) -> EgoBody {
        let size_m = DVec3::from_array(self.car.size_m);
        EgoBody { centre_ego: DVec3::new(self.car.centre_before_axle_m, 0.0, size_m.z / 2.0), size_m }
    }

    /// Height of the IMU above the road.
    pub(super) fn imu_height_m(&self) -> f64 {
        self.car.imu_height_m
    }

    /// Width and height of the rectified pictures of a focal length; `None` for one of no recording day.
    pub(super) fn picture_size_px(&self, focal_px: f64) -> Option<[u32; 2]> {
        self.picture.iter().find(|p| (p.focal_px - focal_px).abs() < 1e-3).map(|p| p.size_px)
    }

    /// What an annotated object is; `None` for a name that is not KITTI's.
    pub(super) fn kind(&self, category: &str) -> Option<Kind> {
        self.kinds.get(category).copied()
    }

    /// Visible share, 0 to 1, of an occlusion's number; `None` where that is unknown.
    pub(super) fn visibility(&self, occlusion: i64) -> Option<f32> {
        self.visibility.get(&occlusion.to_string()).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_whole() {
        let facts = &*FACTS;
        assert_eq!(facts.kind("Cyclist"), Some(Kind::BicycleWithRider));
        assert_eq!((facts.kind("DontCare"), facts.kind("Hovercraft")), (None, None));
        assert_eq!((facts.visibility(0), facts.visibility(3)), (Some(1.0), None));
        assert_eq!((facts.picture_size_px(721.5377), facts.picture_size_px(700.0)), (Some([1242, 375]), None));
        assert!(facts.ego_body().centre_ego.z * 2.0 == facts.ego_body().size_m.z && facts.imu_height_m() > 0.0);
    }
}
