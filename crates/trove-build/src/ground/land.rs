//! The land as a relief has it, in World.

use glam::DVec2;
use rayon::prelude::*;
use trove_model::{HeightField, Raster, Relief};

/// Heights are means over this around a position, metres: houses and noise are smaller, hills larger.
const MEAN_OVER_M: f64 = 9.0;

/// A relief that is lowered to World's heights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Land<'a> {
    pub(super) relief: &'a Relief,
    /// World's height of the relief's datum, metres.
    pub(super) datum_m: f64,
}

impl Land<'_> {
    /// Height at a position, metres; `None` where the relief does not know it.
    pub(crate) fn height_m(&self, position: DVec2) -> Option<f64> {
        let offsets = [-1.0, 0.0, 1.0].map(|offset| offset * MEAN_OVER_M);
        let mut sum_m = 0.0;
        for (x, y) in offsets.iter().flat_map(|&x| offsets.iter().map(move |&y| (x, y))) {
            // At the relief's edge one sample is better than none.
            let Some(height_m) = self.relief.height_m(position + DVec2::new(x, y)) else {
                return self.relief.height_m(position).map(|height_m| height_m + self.datum_m);
            };
            sum_m += height_m;
        }
        Some(sum_m / 9.0 + self.datum_m)
    }

    /// Whether the relief has the sea at a position: its datum exactly, as reliefs give it.
    pub(crate) fn is_sea(&self, position: DVec2) -> bool {
        self.relief.height_m(position).is_some_and(|height_m| height_m.abs() < 0.05)
    }

    /// The heights of a field's nodes; those that the relief does not know are as high as their nearest neighbours. The
    /// share of those; `None` where it knows none.
    pub(super) fn field(&self, flat: &HeightField) -> Option<(HeightField, f64)> {
        let (width, height) = (flat.nodes.width, flat.nodes.height);
        let row = |y: u32| {
            (0..width).map(move |x| {
                let p = flat.origin + DVec2::new(f64::from(x), f64::from(y)) * flat.cell_m;
                self.height_m(p).map_or(f32::NAN, |height_m| height_m as f32)
            })
        };
        let mut data: Vec<f32> = (0..height).into_par_iter().flat_map_iter(row).collect();
        let unknown = data.iter().filter(|z| z.is_nan()).count();
        if unknown == data.len() {
            return None;
        }
        // Outwards along rows, then along columns.
        if unknown > 0 {
            let width = width as usize;
            data.chunks_exact_mut(width).for_each(|row| carry_on(row, 0, 1));
            (0..width).for_each(|column| carry_on(&mut data, column, width));
        }
        let share = unknown as f64 / data.len() as f64;
        Some((HeightField { nodes: Raster { width, height, data }, ..flat.clone() }, share))
    }
}

/// Values that are not known become the nearest known ones before or behind them, among every `step`th from `first`.
fn carry_on(values: &mut [f32], first: usize, step: usize) {
    let count = (values.len() - first).div_ceil(step);
    let at = |i: usize| first + i * step;
    let known: Vec<usize> = (0..count).filter(|&i| !values[at(i)].is_nan()).collect();
    if known.is_empty() {
        return;
    }
    for i in 0..count {
        if values[at(i)].is_nan() {
            let next = known.partition_point(|&k| k < i);
            let candidates = [next.checked_sub(1), Some(next)].into_iter().flatten().filter_map(|k| known.get(k));
            if let Some(&nearest) = candidates.min_by_key(|&&k| k.abs_diff(i)) {
                values[at(i)] = values[at(nearest)];
            }
        }
    }
}
