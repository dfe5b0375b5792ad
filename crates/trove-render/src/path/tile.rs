//! Squares of the picture, and how many samples their pixels need.

use std::ops::Range;

use glam::{DVec2, Vec3};
use trove_model::Shot;
use trove_trace::Sampler;
use trove_trace::path::{Sample, Start};

use super::camera::camera_ray;
use super::splat::{BLOCK_PX, MARGIN_PX, Place, Splats, brightness};
use crate::PreparedScene;
use crate::field::LightField;
use crate::prepare::Carrier;

/// Side of the squares that threads work on, whole blocks, pixels.
const TILE_PX: u32 = 16;

/// Most paths that a tile starts at once.
pub(super) const MOST_PATHS: usize = (TILE_PX * TILE_PX) as usize;

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

/// A square of the picture with its margin.
pub(super) struct Tile {
    pub(super) blocks: Vec<Block>,
    /// Places of the blocks that get more samples, which so far have had all that any has.
    open: Vec<usize>,
    samples: u32,
}

/// What is known of a picture when samples are taken.
#[derive(Clone, Copy)]
pub(super) enum Pass {
    /// Nothing: every pixel gets its first samples, all of them where errors are not judged.
    First,
    /// Its middle brightness: pixels get more where the error is above what is asked for.
    Refined(f32),
}

/// Pixels that get the same number of samples.
pub(super) struct Block {
    /// The first pixel in the picture with its margin.
    pub(super) corner: [u32; 2],
    columns: u32,
    /// Sums of the samples in each pixel, row by row.
    pub(super) pixels: Vec<Sample>,
    pub(super) splats: Splats,
    pub(super) count: u32,
}

/// Squares that cover a picture and its margin.
pub(super) fn tiles(width: u32, height: u32) -> Vec<Tile> {
    let [width, height] = [width, height].map(|size| if size > 0 { size + 2 * MARGIN_PX } else { 0 });
    let corners = (0..height).step_by(TILE_PX as usize);
    let corners = corners.flat_map(|y| (0..width).step_by(TILE_PX as usize).map(move |x| (x, y)));
    corners.map(|(x, y)| Tile::new(x..(x + TILE_PX).min(width), y..(y + TILE_PX).min(height))).collect()
}

impl Tile {
    fn new(columns: Range<u32>, rows: Range<u32>) -> Self {
        let corners = rows.clone().step_by(BLOCK_PX as usize);
        let corners = corners.flat_map(|y| columns.clone().step_by(BLOCK_PX as usize).map(move |x| [x, y]));
        let size = |[x, y]: [u32; 2]| [(columns.end - x).min(BLOCK_PX), (rows.end - y).min(BLOCK_PX)];
        let blocks: Vec<_> = corners.map(|corner| Block::new(corner, size(corner))).collect();
        Self { open: (0..blocks.len()).collect(), blocks, samples: 0 }
    }

    /// Whether any pixels are to get one more sample.
    pub(super) fn wants(&mut self, shot: &Shot, pass: Pass) -> bool {
        let judged = shot.noise > 0.0;
        let most = shot.spp.max(1);
        let first = if judged { FIRST.min(most) } else { most };
        match pass {
            Pass::First => self.samples < first,
            Pass::Refined(_) if !judged || self.samples >= most => false,
            Pass::Refined(middle) => {
                if (self.samples - first).is_multiple_of(ROUND) {
                    self.open.retain(|&block| self.blocks[block].error(middle) > shot.noise);
                }
                !self.open.is_empty()
            }
        }
    }

    /// Adds a sample of each path that was started.
    pub(super) fn take<'a>(&mut self, places: &[Place], samples: impl IntoIterator<Item = &'a Sample>) {
        for (sample, place) in samples.into_iter().zip(places) {
            let block = &mut self.blocks[place.block];
            block.pixels[place.pixel].add(sample);
            block.splats.add(place.position, sample.radiance, self.samples % 2 == 1);
        }
        self.samples += 1;
    }

    /// The paths of one more sample, and where each belongs.
    pub(super) fn start(&mut self, eye: &Eye<'_>, starts: &mut Vec<Start>, places: &mut Vec<Place>) {
        let shot = eye.shot;
        let log2_count = shot.spp.max(1).next_power_of_two().ilog2();
        for &index in &self.open {
            let block = &mut self.blocks[index];
            block.count += 1;
            for pixel in 0..block.pixels.len() {
                let mut sampler = Sampler::new(shot.seed.0, block.place(pixel), self.samples, log2_count);
                let ([x, y], [u, v]) = (block.offset(pixel), sampler.next2());
                let [within, _] = sampler.next2();
                let position = [x as f32 + u, y as f32 + v];
                let corner = DVec2::from(block.corner.map(f64::from)) - f64::from(MARGIN_PX);
                let at = corner + DVec2::from(position.map(f64::from));
                if let Some((ray, cone)) = camera_ray(shot, at, within) {
                    let ray = eye.carrier.past(ray);
                    let past = ray.past.map_or(0, |id| id.0);
                    starts.push(Start { ray: ray.plain(), past, cone, sampler });
                    places.push(Place { block: index, pixel, position });
                } else {
                    // Where the lens shows nothing the picture is black.
                    block.splats.add(position, Vec3::ZERO, self.samples % 2 == 1);
                }
            }
        }
    }
}

impl Block {
    fn new(corner: [u32; 2], [columns, rows]: [u32; 2]) -> Self {
        let pixels = vec![Sample::default(); (columns * rows) as usize];
        Self { corner, columns, pixels, splats: Splats::none(), count: 0 }
    }

    /// A pixel's place in the picture with its margin.
    pub(super) fn place(&self, pixel: usize) -> [u32; 2] {
        let ([x, y], [dx, dy]) = (self.corner, self.offset(pixel));
        [x + dx, y + dy]
    }

    /// A pixel's place in the block.
    fn offset(&self, pixel: usize) -> [u32; 2] {
        [pixel as u32 % self.columns, pixel as u32 / self.columns]
    }

    /// The mean of a pixel's own samples.
    pub(super) fn mean(&self, pixel: usize) -> Sample {
        self.pixels[pixel].divided(self.count.max(1) as f32)
    }

    /// The mean error of the pixels here as a share of their brightness, estimated from two halves of the samples (as
    /// Dammertz et al. 2010).
    fn error(&self, middle: f32) -> f32 {
        let (mut error, mut bright) = (0.0, 0.0);
        for pixel in 0..self.pixels.len() {
            let splat = self.splats.at(self.offset(pixel));
            bright += brightness(splat.mean());
            error += splat.variance().sqrt();
        }
        error / (bright + DARK * middle * self.pixels.len() as f32).max(f32::MIN_POSITIVE)
    }
}

/// The geometric mean of the pixels' brightness; those that are black are left out.
pub(super) fn middle_brightness(tiles: &[Tile]) -> f32 {
    let blocks = tiles.iter().flat_map(|tile| &tile.blocks);
    let bright = |block: &Block, pixel| f64::from(brightness(block.mean(pixel).radiance));
    let logs = blocks.flat_map(|block| (0..block.pixels.len()).map(move |pixel| bright(block, pixel).ln()));
    let (sum, n) = logs.filter(|log| log.is_finite()).fold((0.0, 0u32), |(sum, n), log| (sum + log, n + 1));
    (sum / f64::from(n.max(1))).exp() as f32
}
