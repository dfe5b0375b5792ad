//! How the file's World lies on the earth, and from it to ours: x east, y north, metres, near the first keyframe.

use glam::{DQuat, DVec2, DVec3};
use trove_format::{PlainGeoPose, PlainGeoreference, PlainPose};
use trove_model::{Ego, Frame, MapProjection, Pose, World};

use super::poses;
use crate::geodesy::Utm;

/// Nothing of a drive lies farther from its first keyframe, metres.
const FARTHEST_M: f64 = 1e6;
/// Nearer to the poles x and y are no map, degrees.
const HIGHEST_LAT_DEG: f64 = 89.0;

/// From the file's World to ours.
pub(super) struct Earth {
    pub(super) projection: MapProjection,
    pub(super) is_georeferenced: bool,
    is_wgs84: bool,
    /// World's origin in the file's World.
    anchor: DVec3,
    /// Of the file's axes to east and north.
    turn: DQuat,
    /// The file's metres in a true one, in the plane.
    scale: f64,
}

impl Earth {
    /// Of a georeference and the first keyframe's vehicle.
    pub(super) fn new(
        georeference: &PlainGeoreference,
        world_from_ego: Option<&PlainPose>,
        geo_from_ego: Option<&PlainGeoPose>,
    ) -> Result<Self, String> {
        if *georeference == PlainGeoreference::Wgs84 {
            let geo = geo_from_ego.ok_or("expected geo_from_ego, since the georeference is wgs84, found none")?;
            place("geo_from_ego", geo.lat_deg, geo.lon_deg)?;
            let projection = MapProjection::ellipsoidal(geo.lat_deg, geo.lon_deg, DVec2::ZERO);
            let anchor = poses::position("geo_from_ego", [0.0, 0.0, geo.alt_m])?.round();
            return Ok(Self { anchor, is_wgs84: true, ..Self::upright(projection, anchor) });
        }
        let first = world_from_ego.ok_or("expected world_from_ego, found none")?;
        let anchor = poses::position("world_from_ego", first.translation_m)?.round();
        match *georeference {
            PlainGeoreference::Unknown => {
                let nowhere = MapProjection::ellipsoidal(0.0, 0.0, DVec2::ZERO);
                Ok(Self { is_georeferenced: false, ..Self::upright(nowhere, anchor) })
            }
            PlainGeoreference::Near { lat_deg, lon_deg } => {
                place("georeference", lat_deg, lon_deg)?;
                let near = MapProjection::ellipsoidal(lat_deg, lon_deg, DVec2::ZERO);
                Ok(Self { is_georeferenced: false, ..Self::upright(near, anchor) })
            }
            PlainGeoreference::Utm { zone, is_south } => {
                let grid = Utm::new(zone, is_south);
                let grid = grid.ok_or_else(|| format!("georeference.utm.zone: expected 1 to 60, found {zone}"))?;
                let off = || format!("world_from_ego: expected easting and northing of the zone, found {anchor}");
                let (lat_deg, lon_deg) = grid.geo_from_utm(anchor.truncate()).ok_or_else(off)?;
                place("world_from_ego, from its zone", lat_deg, lon_deg)?;
                let (convergence, scale) = grid.convergence_and_scale(lat_deg, lon_deg).ok_or_else(off)?;
                let projection = MapProjection::ellipsoidal(lat_deg, lon_deg, DVec2::ZERO);
                Ok(Self { turn: DQuat::from_rotation_z(convergence), scale, ..Self::upright(projection, anchor) })
            }
            PlainGeoreference::Local { origin_lat_deg, origin_lon_deg, x_axis_yaw_rad, metres_per_rad } => {
                place("georeference.local.origin", origin_lat_deg, origin_lon_deg)?;
                let turn = poses::rotation("georeference.local.x_axis", None, Some(x_axis_yaw_rad))?;
                let mut projection =
                    MapProjection::ellipsoidal(origin_lat_deg, origin_lon_deg, (turn * anchor).truncate());
                if let Some(metres) = metres_per_rad.map(DVec2::from_array) {
                    // A radian's length on the earth is within a percent of this.
                    if !(metres / projection.metres_per_rad - 1.0).abs().cmplt(DVec2::splat(0.02)).all() {
                        let expected = projection.metres_per_rad;
                        return Err(format!(
                            "georeference.local.metres_per_rad: expected about {expected}, found {metres}"
                        ));
                    }
                    projection.metres_per_rad = metres;
                }
                Ok(Self { turn, ..Self::upright(projection, anchor) })
            }
            PlainGeoreference::Wgs84 => unreachable!("returned above"),
        }
    }

    fn upright(projection: MapProjection, anchor: DVec3) -> Self {
        Self { projection, is_georeferenced: true, is_wgs84: false, anchor, turn: DQuat::IDENTITY, scale: 1.0 }
    }

    /// Whether poses in the file's World mean something.
    pub(super) fn has_world(&self) -> bool {
        !self.is_wgs84
    }

    /// The vehicle in World; the error says what is wrong with what the file gives.
    pub(super) fn ego(
        &self,
        world: Option<&PlainPose>,
        geo: Option<&PlainGeoPose>,
    ) -> Result<Pose<World, Ego>, String> {
        let pose = match (self.is_wgs84, world, geo) {
            (false, Some(world), None) => self.pose(poses::pose("world_from_ego", world)?),
            (true, None, Some(geo)) => {
                place("geo_from_ego", geo.lat_deg, geo.lon_deg)?;
                let rotation = poses::rotation("geo_from_ego", geo.rotation_wxyz, geo.yaw_rad)?;
                let alt_m = poses::position("geo_from_ego", [0.0, 0.0, geo.alt_m])?.z;
                let position = self.projection.world_from_geo(geo.lat_deg, geo.lon_deg);
                Pose::new(rotation, position.extend(alt_m - self.anchor.z))
            }
            (false, ..) => return Err("expected world_from_ego and no geo_from_ego, which goes with wgs84".to_owned()),
            (true, ..) => return Err("expected geo_from_ego, since the georeference is wgs84, and no other".to_owned()),
        };
        near("the vehicle", pose.translation)?;
        Ok(pose)
    }

    /// A pose in the file's World, in ours.
    pub(super) fn pose<Src: Frame>(&self, pose: Pose<World, Src>) -> Pose<World, Src> {
        Pose::new(self.turn * pose.rotation, self.point(pose.translation))
    }

    /// A point in the file's World, in ours.
    pub(super) fn point(&self, point: DVec3) -> DVec3 {
        let p = point - self.anchor;
        self.turn * DVec3::new(p.x / self.scale, p.y / self.scale, p.z)
    }

    /// A velocity in the file's World, in ours.
    pub(super) fn vector(&self, vector: DVec3) -> DVec3 {
        self.turn * vector
    }
}

/// An error where a position in World is absurd.
pub(super) fn near(what: &str, position: DVec3) -> Result<(), String> {
    let is_near = position.abs().cmplt(DVec3::splat(FARTHEST_M)).all();
    let km = (position.length() * 1e-3).min(1e12);
    is_near
        .then_some(())
        .ok_or_else(|| format!("{what}: expected it near the first keyframe, found it {km:.0} km away"))
}

fn place(key: &str, lat_deg: f64, lon_deg: f64) -> Result<(), String> {
    if !(-180.0..=360.0).contains(&lon_deg) {
        return Err(format!("{key}: expected a longitude of −180 to 180, found {lon_deg}"));
    }
    if !(-HIGHEST_LAT_DEG..=HIGHEST_LAT_DEG).contains(&lat_deg) {
        return Err(format!("{key}: expected a latitude of −{HIGHEST_LAT_DEG} to {HIGHEST_LAT_DEG}, found {lat_deg}"));
    }
    Ok(())
}
