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
use trove_trace::path::Sample;

use crate::PreparedScene;
use crate::prepare::Carrier;
use crate::remote::{RemoteScene, RemoteWave};
pub use rates::{RaySeconds, RayTimes};
pub(crate) use rates::{ray_sorts, ray_times, starts};
#[cfg(test)]
pub(crate) use seen::Seen;
use splat::{MARGIN_PX, Splat};
use tile::{Eye, Pass, Tile};
use wave::Wave;

/// Tiles whose paths another machine follows together: a million paths, which take 0.8 GB there.
const TILES_THERE: usize = 4096;

/// What paths bring that begin there.
#[cfg(test)]
pub(crate) fn followed(scene: &PreparedScene, starts: Vec<trove_trace::path::Start>) -> Vec<trove_trace::path::Sample> {
    let mut wave = Wave::default();
    wave.starts = starts;
    wave.run(scene, None);
    wave.samples
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

/// Why a picture was not traced.
pub(crate) enum Ended {
    /// As it was asked to.
    Stopped,
    /// By what another machine said.
    Failed(String),
}

/// Traces a picture, by another machine where there is one; ends once `stop`, which is told the share done, has answered true.
pub(crate) fn trace(
    scene: &PreparedScene,
    shot: &Shot,
    remote: Option<&dyn RemoteScene>,
    stop: &(dyn Fn(f32) -> bool + Sync),
) -> Result<Buffers, Ended> {
    let carrier = Carrier::new(scene, shot.carrier);
    let field = (shot.cache && scene.fog.is_some()).then(|| {
        let eye = shot.world_from_camera.translation.as_vec3();
        scene.fields.get(eye, |place| fill::fill(scene, place))
    });
    let eye = Eye { scene, shot, carrier: &carrier, field: field.as_deref() };
    let mut tiles = tile::tiles(shot.lens.width_px, shot.lens.height_px);
    let rays = match remote {
        Some(remote) => followed_there(&eye, &mut tiles, remote, stop)?,
        None => followed_here(&eye, &mut tiles, stop)?,
    };
    Ok(developed(shot, &tiles, rays))
}

/// The first samples of all tiles, and then those that their picture asks for.
fn in_passes(tiles: &mut [Tile], mut take: impl FnMut(&mut [Tile], Pass) -> Result<(), Ended>) -> Result<(), Ended> {
    take(tiles, Pass::First)?;
    let middle = tile::middle_brightness(tiles);
    take(tiles, Pass::Refined(middle))
}

/// Gives the tiles' pixels their samples, each tile by one thread of the processor; how many rays that took.
fn followed_here(eye: &Eye<'_>, tiles: &mut [Tile], stop: &(dyn Fn(f32) -> bool + Sync)) -> Result<u64, Ended> {
    let (steps, done, rays) = (2 * tiles.len(), AtomicUsize::new(0), AtomicU64::new(0));
    // What a tile brings depends on the seed and on itself alone, so the threads may take the tiles in any order.
    let take = |tiles: &mut [Tile], pass: Pass| {
        tiles.par_iter_mut().try_for_each_init(Wave::default, |wave, tile| {
            if stop(done.fetch_add(1, Ordering::Relaxed) as f32 / steps as f32) {
                return Err(Ended::Stopped);
            }
            while tile.wants(eye.shot, pass) {
                wave.starts.clear();
                wave.places.clear();
                tile.start(eye, &mut wave.starts, &mut wave.places);
                wave.run(eye.scene, eye.field);
                tile.take(&wave.places, &wave.samples);
            }
            rays.fetch_add(std::mem::take(&mut wave.rays), Ordering::Relaxed);
            Ok(())
        })
    };
    in_passes(tiles, take)?;
    Ok(rays.into_inner())
}

/// The same by another machine, many tiles at once.
fn followed_there(
    eye: &Eye<'_>,
    tiles: &mut [Tile],
    remote: &dyn RemoteScene,
    stop: &(dyn Fn(f32) -> bool + Sync),
) -> Result<u64, Ended> {
    let most = tiles.len().min(TILES_THERE) * tile::MOST_PATHS;
    let mut wave = remote.wave(eye.field.map(|field| field.view()), most).map_err(Ended::Failed)?;
    let mut samples = vec![Sample::default(); most];
    let (steps, mut done, mut rays) = (2.0 * (tiles.len() as f32 / TILES_THERE as f32).ceil(), 0.0, 0);
    let take = |tiles: &mut [Tile], pass: Pass| {
        for tiles in tiles.chunks_mut(TILES_THERE) {
            rays += followed_at_once(eye, tiles, pass, &mut *wave, &mut samples, &|| stop(done / steps))?;
            done += 1.0;
        }
        Ok(())
    };
    in_passes(tiles, take)?;
    Ok(rays)
}

/// Some of the tiles, sample by sample.
fn followed_at_once(
    eye: &Eye<'_>,
    tiles: &mut [Tile],
    pass: Pass,
    wave: &mut dyn RemoteWave,
    samples: &mut [Sample],
    stop: &dyn Fn() -> bool,
) -> Result<u64, Ended> {
    let mut rays = 0;
    loop {
        let started = tiles.par_iter_mut().filter_map(|tile| {
            let (mut starts, mut places) = (Vec::new(), Vec::new());
            tile.wants(eye.shot, pass).then(|| {
                tile.start(eye, &mut starts, &mut places);
                (tile, starts, places)
            })
        });
        let started: Vec<_> = started.collect();
        if started.is_empty() {
            return Ok(rays);
        }
        if stop() {
            return Err(Ended::Stopped);
        }
        let starts = started.iter().map(|(_, starts, _)| starts.as_slice()).collect::<Vec<_>>().concat();
        let samples = &mut samples[..starts.len()];
        rays += wave.follow(&starts, samples).map_err(Ended::Failed)?;
        let mut rest = &*samples;
        let brought = started.into_iter().map(|(tile, starts, places)| {
            let (own, others) = rest.split_at(starts.len());
            rest = others;
            (tile, places, own)
        });
        let brought: Vec<_> = brought.collect();
        brought.into_par_iter().for_each(|(tile, places, samples)| tile.take(&places, samples));
    }
}

/// The picture of all samples. Tiles are put together in their own order, since sums of floats depend on it.
fn developed(shot: &Shot, tiles: &[Tile], rays: u64) -> Buffers {
    let (width, height) = (shot.lens.width_px, shot.lens.height_px);
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
    Buffers { radiance, own, variance, albedo, normal, rays, spp }
}
