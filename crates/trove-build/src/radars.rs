//! Where the vehicle's radars are when they look, and how they move.

use trove_model::{Drive, Ego, Pose, Radar, RadarShot, SensorFrame, SensorRay};

use crate::place::Seeds;
use crate::scanners::world_from_ego;
use crate::site::Site;

/// A radar with its place on the recording vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct MountedRadar {
    /// What it is called on the vehicle (`RADAR_FRONT`).
    pub name: String,
    /// What it is.
    pub radar: Radar,
    /// Mounting: x ahead, y to its left, z up.
    pub ego_from_radar: Pose<Ego, SensorFrame>,
}

/// The cycles of a keyframe, one a radar; none for a keyframe that the drive does not have.
pub fn radar_shots(
    drive: &Drive,
    site: &Site,
    keyframe: usize,
    radars: &[MountedRadar],
    seeds: &Seeds,
) -> Vec<RadarShot> {
    let Some(moment) = drive.keyframes.get(keyframe) else { return Vec::new() };
    let shot = |MountedRadar { name, radar, ego_from_radar }: &MountedRadar| {
        let at = |time_s: f64| (world_from_ego(drive, keyframe, time_s) * *ego_from_radar).translation;
        let step_s = SensorRay::MOVING_S;
        let view = format!("ego.{name}");
        RadarShot {
            radar: radar.clone(),
            time_ns: moment.time_ns,
            world_from_radar: moment.world_from_ego * *ego_from_radar,
            world_from_ego: moment.world_from_ego,
            velocity_mps: (at(step_s) - at(-step_s)) / (2.0 * step_s),
            seed: seeds.noise.child("radar").nth(keyframe as u64).child(&view),
            // Radars stand in bumpers, which let their waves pass.
            carrier: Some(site.ego_id(drive)),
            view,
        }
    };
    radars.iter().map(shot).collect()
}
