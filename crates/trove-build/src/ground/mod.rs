//! The ground: its height from what stood on it, and surfaces that lie on it.

mod blocks;
mod drape;
mod fit;
mod lawn;
mod noise;
mod observations;
mod ramps;

use trove_model::{Bounds, Drive, HeightField, Report};

pub(crate) use drape::Drape;
pub(crate) use lawn::Lawn;
pub(crate) use noise::noise;
pub(crate) use ramps::Ramps;

/// Distance of the height field's nodes, metres: wheels are 2–4 m apart, so a finer field would only copy noise.
const CELL_M: f64 = 2.0;

/// Heights are changed by up to this where that makes the ground even: much less than a wheel's play, metres.
const EVEN_M: f32 = 0.005;

/// A smooth height field: the driven path, the bottoms of the annotated boxes and the LiDAR's ground returns tell the
/// height; beyond them it goes on at the nearest known height.
///
/// Reports `ground.box_bottom_median_m` and `ground.box_bottom_p90_m`, the distances of box bottoms to it.
pub(crate) fn height_field(drive: &Drive, kerb_m: f64, bounds: Bounds, report: &Report) -> HeightField {
    let observations = observations::observations(drive, kerb_m);
    let mut field = fit::fit(&observations, bounds, CELL_M);
    blocks::evened(&mut field, EVEN_M);
    let mut misfits: Vec<f64> = observations::box_bottoms(drive, kerb_m)
        .map(|bottom| (bottom.height_m - field.height_m(bottom.position)).abs())
        .collect();
    misfits.sort_by(f64::total_cmp);
    if !misfits.is_empty() {
        report.measure("ground.box_bottom_median_m", misfits[misfits.len() / 2]);
        report.measure("ground.box_bottom_p90_m", misfits[misfits.len() * 9 / 10]);
    }
    field
}
