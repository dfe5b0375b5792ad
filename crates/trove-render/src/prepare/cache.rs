//! Textures that were made ready before, for the next keyframe of the same site.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use trove_model::Texture;

use crate::texture::MipMap;

/// Filtered textures by the address of the image they were made from, which the cache keeps alive.
#[derive(Default)]
pub(crate) struct TextureCache {
    entries: Mutex<HashMap<usize, (Arc<Texture>, Arc<MipMap>)>>,
}

impl TextureCache {
    pub(crate) fn get(&self, texture: &Arc<Texture>) -> Arc<MipMap> {
        let mut entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        let make = || (texture.clone(), Arc::new(MipMap::new(texture)));
        entries.entry(Arc::as_ptr(texture) as usize).or_insert_with(make).1.clone()
    }

    /// Lets go of what only the cache still holds.
    pub(crate) fn forget_unused(&self) {
        let mut entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        entries.retain(|_, (texture, _)| Arc::strong_count(texture) > 1);
    }
}
