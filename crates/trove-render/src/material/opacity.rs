//! What a surface lets pass of a ray, as data that a kernel keeps.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use crate::lookups::LOOKUPS;
use crate::texture::OpacityMask;

/// Where a material is not there, and what goes straight through where it is.
#[derive(Default)]
pub(crate) struct Opacity {
    /// Where it has holes, and what texture coordinates are multiplied by.
    pub(super) holes: Option<(Arc<OpacityMask>, Vec2)>,
    pub(super) pane: Option<Pane>,
}

/// A thin sheet of glass.
pub(super) struct Pane {
    /// Colour of what goes straight through it.
    pub(super) tint: Vec3,
    pub(super) transmission: f32,
    pub(super) metalness: f32,
    /// Normal reflectance of both faces together.
    pub(super) f0: f32,
    /// GGX α.
    pub(super) alpha: f32,
}

impl Opacity {
    /// A surface with holes wherever the mask has them, mapped as the mesh says.
    pub(crate) fn cut_out(mask: OpacityMask) -> Self {
        Self { holes: Some((Arc::new(mask), Vec2::ONE)), pane: None }
    }

    /// A clear pane without holes.
    #[cfg(test)]
    pub(crate) fn pane_of_glass() -> Self {
        let pane = Pane { tint: Vec3::ONE, transmission: 1.0, metalness: 0.0, f0: 0.04, alpha: 0.01 };
        Self { holes: None, pane: Some(pane) }
    }

    /// Whether nothing ever passes.
    pub(crate) fn is_opaque(&self) -> bool {
        self.holes.is_none() && self.pane.is_none()
    }

    /// Whether it has holes.
    pub(crate) fn has_holes(&self) -> bool {
        self.holes.is_some()
    }

    /// The cells of its holes, if it has any, and what texture coordinates are multiplied by.
    pub(crate) fn holes(&self) -> Option<(trove_trace::Mask<'_>, Vec2)> {
        self.holes.as_ref().map(|(mask, scale)| (mask.cells(), *scale))
    }

    /// Whether the surface is there, at texture coordinates before scaling.
    pub(crate) fn covers(&self, uv: Vec2) -> bool {
        self.holes.as_ref().is_none_or(|(mask, scale)| mask.covers(uv * scale))
    }

    /// Whether light goes straight through what is there.
    pub(crate) fn is_pane(&self) -> bool {
        self.pane.is_some()
    }

    /// The share of light that does, at an angle with cosine `cos` to the normal; 0 for what is no pane.
    pub(crate) fn straight_through(&self, cos: f32) -> Vec3 {
        let Some(pane) = &self.pane else { return Vec3::ZERO };
        let split = LOOKUPS.lobes.split(cos.abs(), pane.alpha);
        let reflected = trove_trace::reflected(Vec3::splat(pane.f0), split).x;
        pane.tint * ((1.0 - reflected) * pane.transmission * (1.0 - pane.metalness))
    }
}
