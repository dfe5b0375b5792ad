//! What every pixel shows: one ray through each pixel's centre.

use trove_model::{Labels, Raster, Shot};

use crate::PreparedScene;

/// All labels of a picture, computed with the current thread pool.
pub(crate) fn render(_scene: &PreparedScene, shot: &Shot) -> Labels {
    let (w, h) = (shot.lens.width_px, shot.lens.height_px);
    Labels {
        class: Raster::filled(w, h, 0),
        instance: Raster::filled(w, h, 0),
        depth_m: Raster::filled(w, h, f32::INFINITY),
        normal: Raster::filled(w, h, [0.0; 3]),
        flow_forward: Raster::filled(w, h, [f32::NAN; 2]),
        flow_backward: Raster::filled(w, h, [f32::NAN; 2]),
        objects: Vec::new(),
    }
}
