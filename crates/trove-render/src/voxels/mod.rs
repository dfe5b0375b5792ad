//! What fills the cells of a grid, and which of them cameras and LiDARs see.
//!
//! A cell is filled where a surface lies in it, by exact clipping of every triangle to it; the class with the largest area wins,
//! things before stuff. Sight is told by rays that end at the first surface.

mod clip;
mod frame;
mod sight;
mod solid;
mod surfaces;

use trove_model::{GridShot, InstanceId, Occupancy};

use crate::PreparedScene;
use frame::Frame;

/// Computed with the current thread pool; every cell depends on the scene and the shot alone.
pub(crate) fn occupancy(scene: &PreparedScene, shot: &GridShot) -> Occupancy {
    let frame = Frame::new(shot);
    let free = shot.plan.classes.unlabelled;
    let mut found = Occupancy {
        labels: vec![free; shot.plan.grid.len()],
        instances: vec![InstanceId(0); shot.plan.grid.len()],
        ..Occupancy::default()
    };
    surfaces::fill(scene, shot, &frame, &mut found);
    if shot.plan.is_solid {
        solid::fill(scene, shot, &frame, &mut found);
    }
    [found.seen_by_cameras, found.seen_by_lidars] = sight::seen(scene, shot, &frame);
    found
}
