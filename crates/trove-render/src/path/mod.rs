//! Light carried along random paths from the eye: unidirectional path tracing with light sampling.

mod integrate;
mod wave;

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use glam::{DVec2, Vec3};
use rayon::prelude::*;
use trove_model::{Raster, Shot};

use crate::PreparedScene;
use crate::accel::Ray;
use crate::prepare::Carrier;
use crate::sampling::{Sampler, tent};
use integrate::{Cone, Path, Sample};
use wave::Wave;

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
    let carrier = Carrier::new(scene, shot.carrier, shot.world_from_camera.translation.as_vec3());
    let tiles = columns as usize * rows as usize;
    let (done, rays) = (AtomicUsize::new(0), AtomicU64::new(0));

    // Every pixel depends on the seed and its place alone, so the threads may take the tiles in any order.
    let traced: Option<Vec<Vec<Sample>>> = (0..tiles)
        .into_par_iter()
        .map_init(Wave::default, |wave, tile| {
            if stop(done.load(Ordering::Relaxed) as f32 / tiles as f32) {
                return None;
            }
            let (x0, y0) = (tile as u32 % columns * TILE_PX, tile as u32 / columns * TILE_PX);
            let pixels =
                trace_tile(wave, scene, shot, &carrier, [x0, y0], [TILE_PX.min(width - x0), TILE_PX.min(height - y0)]);
            let count = std::mem::take(&mut wave.rays);
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

/// The means of the samples of a tile's pixels, row by row.
fn trace_tile(
    wave: &mut Wave,
    scene: &PreparedScene,
    shot: &Shot,
    carrier: &Carrier,
    [x0, y0]: [u32; 2],
    [width, height]: [u32; 2],
) -> Vec<Sample> {
    let spp = shot.spp.max(1);
    let log2_count = spp.next_power_of_two().ilog2();
    let mut sums = vec![Sample::default(); (width * height) as usize];
    // Squares of 4×4 pixels, one after the other, whose rays run alike.
    let mut order: Vec<[u32; 2]> = (0..width * height).map(|i| [i % width, i / width]).collect();
    order.sort_by_key(|[x, y]| (y / 4, x / 4));
    for index in 0..spp {
        wave.paths.clear();
        wave.paths.extend(order.iter().map(|&[x, y]| {
            let [x, y] = [x0 + x, y0 + y];
            let mut sampler = Sampler::new(shot.seed, [x, y], index, log2_count);
            let u = sampler.next2();
            // The reconstruction filter is drawn, not splatted: no pixel writes into another.
            let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)
                + DVec2::new(f64::from(tent(u[0])), f64::from(tent(u[1])));
            let (ray, cone) = camera_ray(shot, pixel);
            Path::new(carrier.past(ray), cone, sampler)
        }));
        wave.run(scene, carrier);
        for (path, [x, y]) in wave.paths.iter().zip(&order) {
            sums[(y * width + x) as usize].add(&path.sample());
        }
    }
    sums.into_iter().map(|sum| sum.divided(spp as f32)).collect()
}

/// The ray through a position in the image and the cone that a pixel sees.
fn camera_ray(shot: &Shot, pixel: DVec2) -> (Ray, Cone) {
    let direction_camera = shot.lens.unproject(pixel);
    let length = direction_camera.length();
    let direction: Vec3 = shot.world_from_camera.vector(direction_camera / length).as_vec3();
    let spread_rad = (1.0 / (shot.lens.fx_px * shot.lens.fy_px).sqrt() / length) as f32;
    (Ray::new(shot.world_from_camera.translation.as_vec3(), direction), Cone { width_m: 0.0, spread_rad })
}
