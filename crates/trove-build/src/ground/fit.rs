//! A smooth surface through scattered, noisy heights.

use std::collections::BTreeMap;

use glam::{DVec2, IVec2};
use rayon::prelude::*;
use trove_model::{Bounds, HeightField, Raster};

use super::observations::Observation;

/// Widths of the kernels, coarse to fine, metres: each level fits what the one before left over.
const WIDTHS_M: [f64; 4] = [60.0, 25.0, 12.0, 7.0];
/// Residual at which an observation counts half, metres: about the noise of annotated heights.
const NOISE_M: f64 = 0.25;
/// Weight that pulls a level's correction to zero where there is little to see.
const PRIOR: f64 = 0.4;
/// Streets are hardly ever steeper.
const MAX_SLOPE: f64 = 0.14;

/// The field over `bounds`; at height 0 where nothing is known at all.
pub(super) fn fit(observations: &[Observation], bounds: Bounds, cell_m: f64) -> HeightField {
    // Whole cells from a multiple of the cell, so that node positions are exact.
    let origin = (bounds.min / cell_m).floor() * cell_m;
    let nodes = ((bounds.max - origin) / cell_m).ceil().as_uvec2() + 1;
    let flat = HeightField { origin, cell_m, nodes: Raster::filled(nodes.x.max(2), nodes.y.max(2), 0.0) };
    if observations.is_empty() {
        return flat;
    }
    let plain: Vec<f64> = observations.iter().map(|o| o.weight).collect();
    let first = levels(observations, &plain, &flat);
    // Once more with outliers weighed down.
    let robust: Vec<f64> = observations
        .iter()
        .map(|o| o.weight / (1.0 + ((o.height_m - first.height_m(o.position)) / NOISE_M).powi(2)))
        .collect();
    let mut field = levels(observations, &robust, &flat);
    smooth(&mut field);
    for _ in 0..50 {
        if steepest(&field) <= MAX_SLOPE {
            break;
        }
        smooth(&mut field);
    }
    field
}

fn levels(observations: &[Observation], weights: &[f64], flat: &HeightField) -> HeightField {
    let mut sum = flat.clone();
    for (level, &width_m) in WIDTHS_M.iter().enumerate() {
        let residuals: Vec<f64> = observations.par_iter().map(|o| o.height_m - sum.height_m(o.position)).collect();
        let coarse = correction(observations, weights, &residuals, flat, width_m, level == 0);
        let width = sum.nodes.width;
        sum.nodes.data.par_iter_mut().enumerate().for_each(|(i, z)| {
            let node = DVec2::new((i as u32 % width) as f64, (i as u32 / width) as f64);
            *z += coarse.height_m(flat.origin + node * flat.cell_m) as f32;
        });
    }
    sum
}

/// The kernel-weighted mean of the residuals on a grid of a third of the kernel's width.
fn correction(
    observations: &[Observation],
    weights: &[f64],
    residuals: &[f64],
    flat: &HeightField,
    width_m: f64,
    coarsest: bool,
) -> HeightField {
    let cell_m = width_m / 3.0;
    let size = DVec2::new(f64::from(flat.nodes.width), f64::from(flat.nodes.height)) * flat.cell_m;
    let nodes = (size / cell_m).ceil().as_uvec2() + 1;
    // Kernels that end see no farther than the neighbouring buckets.
    let bucket = |p: DVec2| if coarsest { IVec2::ZERO } else { ((p - flat.origin) / width_m).floor().as_ivec2() };
    let mut buckets: BTreeMap<[i32; 2], Vec<usize>> = BTreeMap::new();
    for (i, o) in observations.iter().enumerate() {
        buckets.entry(bucket(o.position).to_array()).or_default().push(i);
    }
    let buckets = &buckets;
    let row = |y: u32| {
        (0..nodes.x).map(move |x| {
            let node = flat.origin + DVec2::new(f64::from(x), f64::from(y)) * cell_m;
            let (mut sum, mut total) = (0.0, 0.0);
            let at = bucket(node);
            let around = if coarsest { 0 } else { 1 };
            let near = (-around..=around).flat_map(|dy| (-around..=around).map(move |dx| at + IVec2::new(dx, dy)));
            for &i in near.filter_map(|b| buckets.get(&b.to_array())).flatten() {
                let (o, w, r) = (&observations[i], weights[i], residuals[i]);
                let d2 = node.distance_squared(o.position) / (width_m * width_m);
                // The coarsest kernel never ends, so that everywhere is some known height.
                let kernel = if coarsest {
                    1.0 / (1.0 + d2).powi(3)
                } else if d2 < 1.0 {
                    (1.0 - d2).powi(2)
                } else {
                    continue;
                };
                sum += kernel * w * r;
                total += kernel * w;
            }
            let prior = if coarsest { 0.0 } else { PRIOR };
            (sum / (total + prior).max(1e-30)) as f32
        })
    };
    let data: Vec<f32> = (0..nodes.y).into_par_iter().flat_map_iter(row).collect();
    HeightField { origin: flat.origin, cell_m, nodes: Raster { width: nodes.x, height: nodes.y, data } }
}

/// One pass of the 1-2-1 kernel in both directions.
fn smooth(field: &mut HeightField) {
    let (width, height) = (field.nodes.width, field.nodes.height);
    let old = field.nodes.clone();
    let mean = |a: f32, b: f32, c: f32| 0.25 * a + 0.5 * b + 0.25 * c;
    let along_x = Raster::from_fn(width, height, |x, y| {
        mean(*old.at(x.saturating_sub(1), y), *old.at(x, y), *old.at((x + 1).min(width - 1), y))
    });
    field.nodes = Raster::from_fn(width, height, |x, y| {
        mean(*along_x.at(x, y.saturating_sub(1)), *along_x.at(x, y), *along_x.at(x, (y + 1).min(height - 1)))
    });
}

/// The largest slope between neighbouring nodes.
fn steepest(field: &HeightField) -> f64 {
    let (width, height) = (field.nodes.width, field.nodes.height);
    let mut steepest = 0.0f32;
    for y in 0..height {
        for x in 0..width {
            let z = *field.nodes.at(x, y);
            let east = (*field.nodes.at((x + 1).min(width - 1), y) - z).abs();
            let north = (*field.nodes.at(x, (y + 1).min(height - 1)) - z).abs();
            steepest = steepest.max(east.hypot(north));
        }
    }
    f64::from(steepest) / field.cell_m
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_a_hill(position: DVec2) -> f64 {
        0.05 * position.x + 0.3 * (position.y / 30.0).sin()
    }

    #[test]
    fn a_hill_is_found_again_in_spite_of_a_few_wild_heights() {
        let bounds = Bounds::square(DVec2::ZERO, 200.0);
        let mut observations: Vec<_> = (-20..=20)
            .flat_map(|i| (-4..=4).map(move |j| DVec2::new(f64::from(i) * 3.0, f64::from(j) * 4.0)))
            .map(|position| Observation { position, height_m: on_a_hill(position), weight: 1.0 })
            .collect();
        for o in observations.iter_mut().step_by(23) {
            o.height_m += 3.0;
        }
        let field = fit(&observations, bounds, 2.0);
        for x in [-50.0, -10.0, 0.0, 33.0] {
            let p = DVec2::new(x, 5.0);
            assert!((field.height_m(p) - on_a_hill(p)).abs() < 0.2, "{p}: {}", field.height_m(p));
        }
        assert!(steepest(&field) <= MAX_SLOPE);
        assert!(field.nodes.data.iter().all(|z| z.is_finite() && z.abs() < 5.0));
    }

    #[test]
    fn one_height_alone_makes_a_plane() {
        let observations = [Observation { position: DVec2::splat(3.0), height_m: 1.5, weight: 1.0 }];
        let field = fit(&observations, Bounds::square(DVec2::ZERO, 100.0), 2.0);
        assert!(field.nodes.data.iter().all(|z| (z - 1.5).abs() < 1e-3));
    }
}
