//! Materials whose textures tile.

use trove_model::Surface;

/// Every surface.
pub(crate) fn surfaces() -> Vec<Surface> {
    Vec::new()
}
