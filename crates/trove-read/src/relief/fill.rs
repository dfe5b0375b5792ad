//! Heights for nodes that a file covers and does not know.

use std::collections::VecDeque;

use glam::DVec2;
use trove_model::Relief;

/// Passes that smooth what was filled.
const PASSES: usize = 30;

/// Fills nodes that are not known where `is_covered` holds from those around them, inwards, and smooths them; how many.
pub(super) fn fill(relief: &mut Relief, is_covered: impl Fn(DVec2) -> bool) -> usize {
    let (width, height) = (relief.nodes.width, relief.nodes.height);
    let position = |x: u32, y: u32| relief.origin + DVec2::new(f64::from(x), f64::from(y)) * relief.cell_m;
    let voids: Vec<[u32; 2]> = (0..height)
        .flat_map(|y| (0..width).map(move |x| [x, y]))
        .filter(|&[x, y]| !relief.nodes.at(x, y).is_finite() && is_covered(position(x, y)))
        .collect();
    if voids.is_empty() || voids.len() == relief.nodes.data.len() {
        return 0;
    }
    let mut is_open = vec![false; relief.nodes.data.len()];
    let index = |[x, y]: [u32; 2]| y as usize * width as usize + x as usize;
    voids.iter().for_each(|&at| is_open[index(at)] = true);
    let around = |[x, y]: [u32; 2]| {
        let (west, east) = (x.saturating_sub(1), (x + 1).min(width - 1));
        let (south, north) = (y.saturating_sub(1), (y + 1).min(height - 1));
        (south..=north).flat_map(move |y| (west..=east).map(move |x| [x, y])).filter(move |&at| at != [x, y])
    };
    let heights_m = &mut relief.nodes.data;
    let mean = |heights_m: &[f32], at: [u32; 2]| {
        let known = around(at).map(|n| heights_m[index(n)]).filter(|z| z.is_finite());
        let (sum, count) = known.fold((0.0, 0.0), |(sum, count), z| (sum + z, count + 1.0));
        (count > 0.0).then(|| sum / count)
    };
    let mut next: VecDeque<[u32; 2]> =
        voids.iter().copied().filter(|&at| around(at).any(|n| heights_m[index(n)].is_finite())).collect();
    let mut filled = Vec::with_capacity(voids.len());
    while let Some(at) = next.pop_front() {
        if !std::mem::take(&mut is_open[index(at)]) {
            continue;
        }
        if let Some(height_m) = mean(heights_m, at) {
            heights_m[index(at)] = height_m;
            filled.push(at);
            next.extend(around(at).filter(|&n| is_open[index(n)]));
        }
    }
    for _ in 0..PASSES {
        for &at in &filled {
            heights_m[index(at)] = mean(heights_m, at).unwrap_or(heights_m[index(at)]);
        }
    }
    filled.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::Raster;

    #[test]
    fn a_hole_in_a_slope_is_filled_to_the_slope_and_what_no_file_covers_stays_unknown() {
        let height_m = |x: u32, y: u32| 3.0 * x as f32 + y as f32;
        let nodes = Raster::from_fn(20, 20, |x, y| {
            if (5..9).contains(&x) && (6..10).contains(&y) || x > 17 { f32::NAN } else { height_m(x, y) }
        });
        let mut relief = Relief { origin: DVec2::ZERO, cell_m: DVec2::splat(30.0), nodes, sources: Vec::new() };
        assert_eq!(fill(&mut relief, |p| p.x < 17.5 * 30.0), 16);
        for (x, y) in (5..9).flat_map(|x| (6..10).map(move |y| (x, y))) {
            let off_m = relief.nodes.at(x, y) - height_m(x, y);
            assert!(off_m.abs() < 0.5, "{x}, {y}: {off_m}");
        }
        assert!(relief.nodes.at(18, 4).is_nan());
    }
}
