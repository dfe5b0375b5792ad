//! Where a grid is, and what fills it at all.

use glam::{DAffine3, DQuat, DVec3};
use trove_model::GridShot;

use crate::PreparedScene;

/// Where the grid is.
pub(super) struct Frame {
    /// To coordinates in which cell `[x, y, z]` goes from there to `[x + 1, y + 1, z + 1]`.
    pub(super) cells_from_world: DAffine3,
    pub(super) world_from_cells: DAffine3,
}

impl Frame {
    pub(super) fn new(shot: &GridShot) -> Self {
        let grid_from_cells = DAffine3::from_scale_rotation_translation(
            DVec3::splat(shot.plan.grid.voxel_m),
            DQuat::IDENTITY,
            shot.plan.grid.low_m,
        );
        let world_from_cells = shot.world_from_grid.affine() * grid_from_cells;
        Self { cells_from_world: world_from_cells.inverse(), world_from_cells }
    }
}

/// The number that an instance's cells have.
pub(super) fn label(scene: &PreparedScene, shot: &GridShot, instance: usize) -> u8 {
    let instance = &scene.instances[instance];
    match &instance.object {
        Some(object) => shot.plan.classes.object_id(instance.class, object.kind),
        None => shot.plan.classes.id(instance.class),
    }
}

/// Whether an instance fills cells at all.
pub(super) fn is_there(scene: &PreparedScene, shot: &GridShot, instance: usize) -> bool {
    let is_absent = scene.placed(instance as u32).id.0 != 0 && shot.absent == Some(scene.placed(instance as u32).id);
    !is_absent && label(scene, shot, instance) != shot.plan.classes.unlabelled
}
