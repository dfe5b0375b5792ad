//! Light carried along random paths from the eye: unidirectional path tracing with light sampling.

mod camera;
mod integrate;

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use glam::DVec2;
use rayon::prelude::*;
use trove_model::{Raster, Shot};

use crate::PreparedScene;
use crate::sampling::{Sampler, tent};
use camera::camera_ray;
use integrate::Sample;

/// Side of the squares that threads work on, pixels.
const TILE_PX: u32 = 16;

/// A picture and the denoiser's guides.
pub(crate) struct Buffers {
    /// Linear radiance.
    pub(crate) radiance: Raster<[f32; 3]>,
    /// What the first surface that is no mirror reflects of white light; 1 for the sky.
    pub(crate) albedo: Raster<[f32; 3]>,
    /// That surface's shading normal, World; 0 for the sky.
    pub(crate) normal: Raster<[f32; 3]>,
    pub(crate) rays: u64,
}

/// Traces a picture; `None` once `stop`, which is told the share done, has answered true.
pub(crate) fn trace(scene: &PreparedScene, shot: &Shot, stop: &(dyn Fn(f32) -> bool + Sync)) -> Option<Buffers> {
    let (width, height) = (shot.lens.width_px, shot.lens.height_px);
    let (columns, rows) = (width.div_ceil(TILE_PX), height.div_ceil(TILE_PX));
    let tiles = columns as usize * rows as usize;
    let (done, rays) = (AtomicUsize::new(0), AtomicU64::new(0));

    // Every pixel depends on the seed and its place alone, so the threads may take the tiles in any order.
    let traced: Option<Vec<Vec<Sample>>> = (0..tiles)
        .into_par_iter()
        .map(|tile| {
            if stop(done.load(Ordering::Relaxed) as f32 / tiles as f32) {
                return None;
            }
            let (x0, y0) = (tile as u32 % columns * TILE_PX, tile as u32 / columns * TILE_PX);
            let mut pixels = Vec::with_capacity((TILE_PX * TILE_PX) as usize);
            let mut count = 0;
            for y in y0..(y0 + TILE_PX).min(height) {
                for x in x0..(x0 + TILE_PX).min(width) {
                    pixels.push(trace_pixel(scene, shot, x, y, &mut count));
                }
            }
            rays.fetch_add(count, Ordering::Relaxed);
            done.fetch_add(1, Ordering::Relaxed);
            Some(pixels)
        })
        .collect();

    let black = || Raster::filled(width, height, [0.0; 3]);
    let mut buffers = Buffers { radiance: black(), albedo: black(), normal: black(), rays: rays.into_inner() };
    for (tile, pixels) in traced?.into_iter().enumerate() {
        let (x0, y0) = (tile as u32 % columns * TILE_PX, tile as u32 / columns * TILE_PX);
        let tile_width = TILE_PX.min(width - x0);
        for (i, pixel) in pixels.into_iter().enumerate() {
            let (x, y) = (x0 + i as u32 % tile_width, y0 + i as u32 / tile_width);
            *buffers.radiance.at_mut(x, y) = pixel.radiance.to_array();
            *buffers.albedo.at_mut(x, y) = pixel.albedo.to_array();
            *buffers.normal.at_mut(x, y) = pixel.normal.to_array();
        }
    }
    Some(buffers)
}

/// The mean of a pixel's samples.
fn trace_pixel(scene: &PreparedScene, shot: &Shot, x: u32, y: u32, rays: &mut u64) -> Sample {
    let spp = shot.spp.max(1);
    let mut sum = Sample::default();
    for index in 0..spp {
        let mut sampler = Sampler::new(shot.seed, x, y, index);
        let u = sampler.next4();
        // The reconstruction filter is drawn, not splatted: no pixel writes into another.
        let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)
            + DVec2::new(f64::from(tent(u[0])), f64::from(tent(u[1])));
        // Where the lens shows nothing the picture is black.
        let Some((ray, cone)) = camera_ray(shot, pixel, u[2]) else { continue };
        sum.add(&integrate::radiance(scene, ray, cone, shot.carrier, &mut sampler, rays));
    }
    sum.divided(spp as f32)
}
