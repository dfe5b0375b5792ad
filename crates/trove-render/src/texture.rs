//! Images on surfaces: bilinear look-up in a chain of ever smaller copies.

mod glow;
mod mip_map;
mod opacity;
mod relief;

use std::sync::Arc;

use trove_model::{Material, Texture};
use trove_trace::Map;

use crate::cache::Cache;

pub(crate) use glow::Glow;
pub(crate) use mip_map::MipMap;
pub(crate) use opacity::OpacityMask;

/// A texture that many may share, or none.
#[derive(Clone)]
pub(crate) struct MapOf(pub(crate) Option<Arc<MipMap>>);

impl Map for MapOf {
    fn texture(&self) -> Option<trove_trace::Texture<'_>> {
        self.0.as_ref().map(|map| map.texture())
    }
}

/// What was made of textures, for all scenes that share them.
#[derive(Default)]
pub(crate) struct Textures {
    maps: Cache<Texture, MipMap>,
    normals: Cache<Texture, MipMap>,
    heights: Cache<Texture, MipMap>,
    masks: Cache<Texture, OpacityMask>,
}

impl Textures {
    /// Makes what these materials need and forgets what nobody uses any more.
    pub(crate) fn make_all(&self, materials: &[Material]) {
        let plain = |m: &Material| [m.base_color_map.clone(), m.orm_map.clone(), m.emission_map.clone()];
        self.maps.make_all(materials.iter().flat_map(plain).flatten().collect::<Vec<_>>().iter(), MipMap::new);
        self.normals.make_all(materials.iter().filter_map(|m| m.normal_map.as_ref()), relief::from_normals);
        self.heights.make_all(materials.iter().filter_map(|m| m.height_map.as_ref()), relief::from_heights);
        self.masks.forget_unused();
    }

    /// Colours or plain numbers.
    pub(crate) fn map(&self, texture: &Arc<Texture>) -> Arc<MipMap> {
        self.maps.get(texture, MipMap::new)
    }

    /// Tangent-space normals: x, y, z from 0 to 1, and √(1 − length) of the mean that they stand for.
    pub(crate) fn normals(&self, texture: &Arc<Texture>) -> Arc<MipMap> {
        self.normals.get(texture, relief::from_normals)
    }

    /// A height map: slopes along u and v from 0 to 1 for −1 to 1 of its range per texel, the height from 0 to 1, and the
    /// root of the slopes' variance.
    pub(crate) fn heights(&self, texture: &Arc<Texture>) -> Arc<MipMap> {
        self.heights.get(texture, relief::from_heights)
    }

    /// Where alpha reaches `cutoff`; kept for one cut-off a texture, which is all that is ever asked for.
    pub(crate) fn mask(&self, texture: &Arc<Texture>, cutoff: f32) -> Arc<OpacityMask> {
        let make = |t: &Texture| OpacityMask::new(t, &self.map(texture), cutoff);
        let kept = self.masks.get(texture, make);
        if kept.cutoff() == cutoff { kept } else { Arc::new(make(texture)) }
    }
}
