//! Where a material shines.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::mip_map::MipMap;

/// What a material's emission is multiplied by where.
pub(crate) struct Glow {
    pub(crate) map: Arc<MipMap>,
    /// What texture coordinates are multiplied by.
    pub(crate) scale: Vec2,
}

impl Glow {
    /// On average over the map.
    pub(crate) fn mean(&self) -> Vec3 {
        self.map.mean().truncate()
    }
}
