//! Where the grids around the vehicle are, and who looks into them.

use std::sync::Arc;

use trove_model::{Drive, Ego, GridFrame, GridPlan, GridShot, LidarShot, Pose, SensorFrame, Shot, Viewpoint};

use crate::site::Site;

/// The grids of a keyframe, one a plan with its name; none for a keyframe that the drive does not have. A grid in the axes of
/// a LiDAR is in the vehicle's where the drive has none.
///
/// Of `shots` and `lidars`, those of the keyframe, the recording vehicle's look into them.
pub fn grid_shots(
    drive: &Drive,
    site: &Site,
    keyframe: usize,
    plans: &[(String, Arc<GridPlan>)],
    shots: &[Shot],
    lidars: &[LidarShot],
) -> Vec<GridShot> {
    let Some(moment) = drive.keyframes.get(keyframe) else { return Vec::new() };
    let is_own = |shot: &&Shot| matches!(shot.viewpoint, Viewpoint::Recording { .. });
    let shot = |(name, plan): &(String, Arc<GridPlan>)| {
        let lidar = drive.lidars.first().filter(|_| plan.frame == GridFrame::Lidar);
        let ego_from_grid = lidar.map_or(Pose::<Ego, SensorFrame>::IDENTITY, |lidar| lidar.ego_from_lidar);
        GridShot {
            view: format!("ego.{name}"),
            plan: plan.clone(),
            world_from_grid: moment.world_from_ego * ego_from_grid,
            world_from_ego: moment.world_from_ego,
            time_ns: moment.time_ns,
            absent: Some(site.ego_id(drive)),
            cameras: shots.iter().filter(is_own).cloned().collect(),
            lidars: lidars.to_vec(),
        }
    };
    plans.iter().map(shot).collect()
}
