//! Things of the place that no one annotated: plants and furniture.

use glam::{DAffine3, DQuat, DVec3};
use trove_model::{Asset, Seed};

/// An asset that stands somewhere for good.
#[derive(Clone, Debug)]
pub(crate) struct Scenery<'a> {
    /// What stands there.
    pub asset: &'a Asset,
    /// The middle of its foot, World, metres.
    pub foot_world: DVec3,
    /// Where its front looks, counter-clockwise from east.
    pub yaw_rad: f64,
    /// Scale along its own axes.
    pub scale: DVec3,
    /// Draws its paints.
    pub seed: Seed,
}

impl Scenery<'_> {
    /// From the asset's mesh to World.
    pub(crate) fn world_from_mesh(&self) -> DAffine3 {
        let rotation = DQuat::from_rotation_z(self.yaw_rad);
        DAffine3::from_scale_rotation_translation(self.scale, rotation, self.foot_world)
    }
}
