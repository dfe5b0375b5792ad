//! Where a material shines.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::mip_map::MipMap;

/// What a material's emission is multiplied by where.
#[derive(Clone)]
pub(crate) struct Glow {
    pub(crate) map: Arc<MipMap>,
    /// What texture coordinates are multiplied by.
    pub(crate) scale: Vec2,
}

impl Glow {
    /// From a map, and what texture coordinates are multiplied by.
    pub(crate) fn new(map: Arc<MipMap>, scale: Vec2) -> Self {
        Self { map, scale }
    }

    /// At a texture coordinate as sharp as the map is, so that light that is drawn and light that is met are the same.
    pub(crate) fn at(&self, uv: Vec2) -> Vec3 {
        self.map.at(uv * self.scale).truncate()
    }

    /// On average over the map.
    pub(crate) fn mean(&self) -> Vec3 {
        self.map.mean().truncate()
    }
}
