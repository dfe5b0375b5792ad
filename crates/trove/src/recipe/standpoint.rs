//! Where a drive without georeference lies.

use std::f64::consts::FRAC_PI_2;

use anyhow::{Result, ensure};
use glam::DVec2;
use serde::{Deserialize, Serialize};
use trove_model::{Drive, MapProjection};

use super::check::check;

/// `drive.at`: the place and heading of the first keyframe's vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Standpoint {
    /// Latitude.
    pub lat_deg: f64,
    /// Longitude.
    pub lon_deg: f64,
    /// Clockwise from true north.
    pub heading_deg: f64,
}

impl Standpoint {
    pub(super) fn check(&self) -> Result<()> {
        check("drive.at.lat_deg", self.lat_deg, (-85.0..=85.0).contains(&self.lat_deg), "-85 to 85")?;
        check("drive.at.lon_deg", self.lon_deg, (-180.0..=180.0).contains(&self.lon_deg), "-180 to 180")?;
        check("drive.at.heading_deg", self.heading_deg, (-360.0..=360.0).contains(&self.heading_deg), "-360 to 360")
    }

    /// Lays a drive there.
    ///
    /// # Errors
    /// A drive that knows where it lies, or one without keyframes.
    pub(crate) fn lay(&self, drive: Drive) -> Result<Drive> {
        let id = &drive.id;
        ensure!(
            !drive.is_georeferenced,
            "drive.at: {id} was recorded with its place on earth; remove the key, which is for drives without one"
        );
        let Some(first) = drive.keyframes.first() else { anyhow::bail!("{id}: nothing was recorded") };
        let turn_rad = FRAC_PI_2 - self.heading_deg.to_radians() - first.world_from_ego.yaw_rad();
        let position = DVec2::from_angle(turn_rad).rotate(first.world_from_ego.translation.truncate());
        // What has no georeference was measured in metres, not in degrees.
        let projection = MapProjection::ellipsoidal(self.lat_deg, self.lon_deg, DVec2::ZERO);
        Ok(Drive { projection, is_georeferenced: true, ..drive.moved(turn_rad, -position) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::Recipe;

    const AT: Standpoint = Standpoint { lat_deg: 49.011, lon_deg: 8.423, heading_deg: 90.0 };

    fn drive(is_georeferenced: bool) -> Drive {
        use trove_model::{DriveOrigin, EgoBody, Keyframe, Pose};
        let keyframe = |x: f64| Keyframe {
            time_ns: 0,
            token: String::new(),
            world_from_ego: Pose::from_yaw(FRAC_PI_2, glam::DVec3::new(7.0, x, 0.2)),
            exposures: Vec::new(),
            boxes: Vec::new(),
            lidar: None,
        };
        Drive {
            id: "000000".into(),
            dataset: "kitti".into(),
            origin: DriveOrigin::Recorded,
            place: String::new(),
            projection: MapProjection::spherical(0.0, 0.0, DVec2::ZERO),
            is_georeferenced,
            rig: Vec::new(),
            ego_body: EgoBody { centre_ego: glam::DVec3::ZERO, size_m: glam::DVec3::ONE },
            keyframes: vec![keyframe(3.0), keyframe(13.0)],
            path: trove_model::Trajectory::default(),
            lidars: Vec::new(),
            sweeps: Vec::new(),
            tracks: Vec::new(),
            lane_map: None,
            licence: String::new(),
        }
    }

    #[test]
    fn a_drive_is_laid_where_the_recipe_says_with_headings_clockwise_from_north() {
        for (heading_deg, east_north_m) in [(0.0, [0.0, 10.0]), (90.0, [10.0, 0.0]), (225.0, [-7.0711, -7.0711])] {
            let laid = Standpoint { heading_deg, ..AT }.lay(drive(false)).unwrap();
            let (lat_deg, lon_deg) =
                laid.projection.geo_from_world(laid.keyframes[0].world_from_ego.translation.truncate());
            assert!(
                laid.is_georeferenced && (lat_deg - AT.lat_deg).abs() < 1e-9 && (lon_deg - AT.lon_deg).abs() < 1e-9
            );
            let second = laid.keyframes[1].world_from_ego.translation;
            assert!(second.truncate().distance(DVec2::from_array(east_north_m)) < 1e-4, "{heading_deg}: {second}");
            assert!((second.z - 0.2).abs() < 1e-12);
        }
    }

    #[test]
    fn a_drive_that_knows_its_place_is_not_laid_elsewhere() {
        let message = AT.lay(drive(true)).unwrap_err().to_string();
        assert!(message.contains("drive.at: 000000 was recorded with its place") && message.contains("remove the key"));
    }

    #[test]
    fn a_standpoint_has_three_numbers() {
        let read = |at: &str| {
            let text = format!("[drive]\ndataset = \"kitti\"\nroot = \"data\"\nat = {at}\n");
            Recipe::parse(&text).map(|recipe| recipe.drive.and_then(|drive| drive.at)).map_err(|e| format!("{e:#}"))
        };
        assert_eq!(read("{ lat_deg = 49.011, lon_deg = 8.423, heading_deg = 90 }"), Ok(Some(AT)));
        assert!(read("{ lat_deg = 49.011, lon_deg = 8.423 }").unwrap_err().contains("heading_deg"));
        assert!(read("{ lat_deg = 99, lon_deg = 8.423, heading_deg = 0 }").unwrap_err().contains("drive.at.lat_deg"));
        assert!(read("{ lat_deg = 49, lon_deg = 8, heading_deg = nan }").unwrap_err().contains("drive.at.heading_deg"));
    }
}
