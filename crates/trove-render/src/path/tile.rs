//! Squares of the picture, and how many samples their pixels need.

use std::ops::Range;

use glam::DVec2;
use trove_model::Shot;

use super::camera::camera_ray;
use super::integrate::{Path, Sample};
use super::wave::Wave;
use crate::PreparedScene;
use crate::field::LightField;
use crate::prepare::Carrier;
use crate::sampling::{Sampler, tent};

/// Side of the squares that threads work on, and of the blocks in them whose pixels get the same number of samples, pixels.
const TILE_PX: u32 = 16;
const BLOCK_PX: u32 = 4;

/// Samples that every pixel gets before any is judged, and those that are added before it is judged again.
const FIRST: u32 = 8;
const ROUND: u32 = 4;

/// Below this share of the picture's middle brightness errors are judged as at it.
const DARK: f32 = 0.25;

/// What looks at what.
pub(super) struct Eye<'a> {
    pub(super) scene: &'a PreparedScene,
    pub(super) shot: &'a Shot,
    pub(super) carrier: &'a Carrier,
    pub(super) field: Option<&'a LightField>,
}

/// A square of the picture.
pub(super) struct Tile {
    /// Block by block, so that neighbours start alike.
    pub(super) pixels: Vec<Pixel>,
    blocks: Vec<Range<usize>>,
    samples: u32,
}

/// A pixel with the sum of its samples.
pub(super) struct Pixel {
    pub(super) x: u32,
    pub(super) y: u32,
    count: u32,
    sum: Sample,
    /// Brightness of every other sample.
    odd: f32,
}

/// Squares that cover a picture.
pub(super) fn tiles(width: u32, height: u32) -> Vec<Tile> {
    let corners = (0..height).step_by(TILE_PX as usize);
    let corners = corners.flat_map(|y| (0..width).step_by(TILE_PX as usize).map(move |x| (x, y)));
    corners.map(|(x, y)| Tile::new(x..(x + TILE_PX).min(width), y..(y + TILE_PX).min(height))).collect()
}

impl Tile {
    fn new(columns: Range<u32>, rows: Range<u32>) -> Self {
        let pixel = |x, y| Pixel { x, y, count: 0, sum: Sample::default(), odd: 0.0 };
        let mut pixels: Vec<Pixel> = rows.flat_map(|y| columns.clone().map(move |x| pixel(x, y))).collect();
        let block = |p: &Pixel| (p.y / BLOCK_PX, p.x / BLOCK_PX);
        pixels.sort_by_key(block);
        let mut blocks = Vec::new();
        for members in pixels.chunk_by(|a, b| block(a) == block(b)) {
            let from = blocks.last().map_or(0, |last: &Range<usize>| last.end);
            blocks.push(from..from + members.len());
        }
        Self { pixels, blocks, samples: 0 }
    }

    /// The first samples of every pixel: all of them where errors are not judged.
    pub(super) fn begin(&mut self, eye: &Eye<'_>, wave: &mut Wave) {
        let first = if eye.shot.noise > 0.0 { FIRST.min(eye.shot.spp) } else { eye.shot.spp };
        let blocks = self.blocks.clone();
        (0..first.max(1)).for_each(|_| self.sample(eye, wave, &blocks));
    }

    /// More samples where the error is above what is asked for, given the picture's middle brightness.
    pub(super) fn refine(&mut self, eye: &Eye<'_>, wave: &mut Wave, middle: f32) {
        if eye.shot.noise <= 0.0 {
            return;
        }
        let mut blocks = self.blocks.clone();
        loop {
            blocks.retain(|block| error(&self.pixels[block.clone()], middle) > eye.shot.noise);
            if blocks.is_empty() {
                return;
            }
            for _ in 0..ROUND {
                if self.samples >= eye.shot.spp {
                    return;
                }
                self.sample(eye, wave, &blocks);
            }
        }
    }

    /// One more sample for the pixels of some blocks, which so far have had all that any has.
    fn sample(&mut self, eye: &Eye<'_>, wave: &mut Wave, blocks: &[Range<usize>]) {
        self.start_blocks(eye, wave, blocks);
        wave.run(eye.scene, eye.field);
        for (path, &place) in wave.paths.iter().zip(&wave.places) {
            let (pixel, sample) = (&mut self.pixels[place], path.sample());
            if self.samples % 2 == 1 {
                pixel.odd += sample.radiance.element_sum();
            }
            pixel.sum.add(&sample);
        }
        self.samples += 1;
    }

    /// The paths of one sample of every pixel.
    pub(super) fn start(&mut self, eye: &Eye<'_>, wave: &mut Wave) {
        let blocks = self.blocks.clone();
        self.start_blocks(eye, wave, &blocks);
    }

    fn start_blocks(&mut self, eye: &Eye<'_>, wave: &mut Wave, blocks: &[Range<usize>]) {
        let shot = eye.shot;
        let log2_count = shot.spp.max(1).next_power_of_two().ilog2();
        let places = blocks.iter().flat_map(Clone::clone);
        wave.paths.clear();
        wave.places.clear();
        for place in places {
            let Pixel { x, y, count, .. } = &mut self.pixels[place];
            *count += 1;
            let mut sampler = Sampler::new(shot.seed, [*x, *y], self.samples, log2_count);
            let [u, v] = sampler.next2();
            let [within, _] = sampler.next2();
            // The reconstruction filter is drawn, not splatted: no pixel writes into another.
            let centre = DVec2::new(f64::from(*x) + 0.5, f64::from(*y) + 0.5);
            let position = centre + DVec2::new(f64::from(tent(u)), f64::from(tent(v)));
            // Where the lens shows nothing the picture is black.
            if let Some((ray, cone)) = camera_ray(shot, position, within) {
                wave.paths.push(Path::new(eye.carrier.past(ray), cone, sampler));
                wave.places.push(place);
            }
        }
    }
}

impl Pixel {
    /// The mean of its samples.
    pub(super) fn mean(&self) -> Sample {
        self.sum.divided(self.count.max(1) as f32)
    }

    pub(super) fn count(&self) -> u32 {
        self.count
    }

    /// Brightness: its mean, and how far the mean of every other sample is from it.
    fn brightness(&self) -> (f32, f32) {
        let mean = self.sum.radiance.element_sum() / self.count.max(1) as f32;
        let odd = self.odd / (self.count / 2).max(1) as f32;
        (mean / 3.0, (odd - mean).abs() / 3.0)
    }
}

/// The mean error of a block's pixels as a share of their brightness, estimated from two halves of their samples (as
/// Dammertz et al. 2010).
fn error(pixels: &[Pixel], middle: f32) -> f32 {
    let (mut error, mut brightness) = (0.0, 0.0);
    for pixel in pixels {
        let (mean, difference) = pixel.brightness();
        brightness += mean;
        error += difference;
    }
    error / (brightness + DARK * middle * pixels.len() as f32).max(f32::MIN_POSITIVE)
}

/// The geometric mean of the pixels' brightness; those that are black are left out.
pub(super) fn middle_brightness(tiles: &[Tile]) -> f32 {
    let logs = tiles.iter().flat_map(|tile| &tile.pixels).map(|p| f64::from(p.brightness().0).ln());
    let (sum, n) = logs.filter(|log| log.is_finite()).fold((0.0, 0u32), |(sum, n), log| (sum + log, n + 1));
    (sum / f64::from(n.max(1))).exp() as f32
}
