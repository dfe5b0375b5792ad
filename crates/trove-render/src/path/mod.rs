//! Light carried along random paths from the eye: the paths that `trove_trace::path` follows.

mod camera;
pub(crate) mod falling;
mod fill;
mod rates;
mod seen;
mod splash;
mod splat;
pub(crate) mod streak;
mod tile;
mod wave;

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use rayon::prelude::*;
use trove_model::{Raster, Shot};

use crate::PreparedScene;
use crate::prepare::Carrier;
pub use rates::{RaySeconds, RayTimes};
pub(crate) use rates::{ray_sorts, ray_times, starts};
#[cfg(test)]
pub(crate) use seen::Seen;
use splat::{MARGIN_PX, Splat};
use tile::{Eye, Tile};
use wave::Wave;

/// What paths bring that begin there.
#[cfg(test)]
pub(crate) fn followed(scene: &PreparedScene, starts: Vec<trove_trace::path::Start>) -> Vec<trove_trace::path::Sample> {
    let mut wave = Wave::default();
    wave.starts = starts;
    wave.run(scene, None);
    wave.paths.iter().map(|path| path.sample()).collect()
}

/// A picture and the denoiser's guides.
pub(crate) struct Buffers {
    /// Linear radiance, of samples that pixels share.
    pub(crate) radiance: Raster<[f32; 3]>,
    /// Radiance of each pixel's own samples alone, those in its square: its noise is independent of its neighbours', as denoisers
    /// expect.
    pub(crate) own: Raster<[f32; 3]>,
    /// Variance of the radiance's brightness, estimated from two halves of the samples.
    pub(crate) variance: Raster<f32>,
    /// What the first surface that is no mirror reflects of white light; 1 for the sky.
    pub(crate) albedo: Raster<[f32; 3]>,
    /// That surface's shading normal, World; 0 for the sky.
    pub(crate) normal: Raster<[f32; 3]>,
    pub(crate) rays: u64,
    /// Mean number of samples of a pixel.
    pub(crate) spp: f64,
}

/// Traces a picture; `None` once `stop`, which is told the share done, has answered true.
pub(crate) fn trace(scene: &PreparedScene, shot: &Shot, stop: &(dyn Fn(f32) -> bool + Sync)) -> Option<Buffers> {
    let (width, height) = (shot.lens.width_px, shot.lens.height_px);
    let carrier = Carrier::new(scene, shot.carrier);
    let field = (shot.cache && scene.fog.is_some()).then(|| {
        let eye = shot.world_from_camera.translation.as_vec3();
        scene.fields.get(eye, |place| fill::fill(scene, place))
    });
    let eye = Eye { scene, shot, carrier: &carrier, field: field.as_deref() };
    let mut tiles = tile::tiles(width, height);
    let (steps, done, rays) = (2 * tiles.len(), AtomicUsize::new(0), AtomicU64::new(0));

    // What a tile brings depends on the seed and on itself alone, so the threads may take the tiles in any order.
    let pass = |tiles: &mut [Tile], work: &(dyn Fn(&mut Tile, &mut Wave) + Sync)| {
        tiles.par_iter_mut().try_for_each_init(Wave::default, |wave, tile| {
            if stop(done.fetch_add(1, Ordering::Relaxed) as f32 / steps as f32) {
                return None;
            }
            work(tile, wave);
            rays.fetch_add(std::mem::take(&mut wave.rays), Ordering::Relaxed);
            Some(())
        })
    };
    pass(&mut tiles, &|tile, wave| tile.begin(&eye, wave))?;
    let middle = tile::middle_brightness(&tiles);
    pass(&mut tiles, &|tile, wave| tile.refine(&eye, wave, middle))?;

    // Put together in their own order, since sums of floats depend on it.
    let black = || Raster::filled(width, height, [0.0; 3]);
    let (mut own, mut albedo, mut normal) = (black(), black(), black());
    let mut film = Raster::filled(width, height, Splat::default());
    let mut samples = 0;
    for block in tiles.iter().flat_map(|tile| &tile.blocks) {
        block.splats.develop(block.corner, block.count, &mut film);
        for pixel in 0..block.pixels.len() {
            let [x, y] = block.place(pixel).map(|p| p.wrapping_sub(MARGIN_PX));
            if x < width && y < height {
                let mean = block.mean(pixel);
                *own.at_mut(x, y) = mean.radiance.to_array();
                *albedo.at_mut(x, y) = mean.albedo.to_array();
                *normal.at_mut(x, y) = mean.normal.to_array();
                samples += u64::from(block.count);
            }
        }
    }
    let spp = samples as f64 / (f64::from(width) * f64::from(height)).max(1.0);
    let (radiance, variance) = (film.map(|splat| splat.mean().to_array()), film.map(Splat::variance));
    Some(Buffers { radiance, own, variance, albedo, normal, rays: rays.into_inner(), spp })
}
