//! Where a recording knows the ground and where a relief does.

use std::collections::BTreeSet;

use glam::{DVec2, IVec2};
use trove_model::{Bounds, HeightField};

use super::observations::Observation;
use super::terrain::ease;
use crate::geometry::distance_field::DistanceField;

/// This near to something recorded the ground is as recorded, metres.
const RECORDED_M: f64 = 25.0;
/// Beyond that it goes over into the relief, metres.
const BLEND_M: f64 = 60.0;
/// Cells in which distances to what was recorded are told, metres.
const CELL_M: f64 = 4.0;

/// How much higher the recording has the ground than the relief: the median of the differences, for the two count from
/// different zeros (ellipsoid, geoid, the first keyframe), metres, and the middle of what is left; `None` where they do
/// not overlap.
pub(super) fn shift_m(observations: &[Observation], relief_m: impl Fn(DVec2) -> Option<f64>) -> Option<(f64, f64)> {
    let middle = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied()
    };
    let differences: Vec<f64> = observations.iter().filter_map(|o| Some(o.height_m - relief_m(o.position)?)).collect();
    let shift_m = middle(differences.clone())?;
    Some((shift_m, middle(differences.iter().map(|d| (d - shift_m).abs()).collect())?))
}

/// The recorded field near what was recorded, the relief's far from it.
pub(super) fn merged(recorded: HeightField, relief: &HeightField, observations: &[Observation]) -> HeightField {
    let cell = |p: DVec2| (p / CELL_M).floor().as_ivec2();
    let seen: BTreeSet<[i32; 2]> = observations.iter().map(|o| cell(o.position).to_array()).collect();
    let last = DVec2::new(f64::from(recorded.nodes.width), f64::from(recorded.nodes.height)) - 1.0;
    let bounds = Bounds { min: recorded.origin, max: recorded.origin + last * recorded.cell_m }.grown(BLEND_M);
    // Whole cells, so that a cell's middle is a cell of those seen.
    let bounds = Bounds { min: (bounds.min / CELL_M).floor() * CELL_M, max: (bounds.max / CELL_M).ceil() * CELL_M };
    let distance = DistanceField::to_cells(bounds, CELL_M, |p| {
        let at: IVec2 = cell(p);
        seen.contains(&at.to_array())
    });
    let mut field = recorded;
    let width = field.nodes.width;
    for (i, height_m) in field.nodes.data.iter_mut().enumerate() {
        let node = DVec2::new(f64::from(i as u32 % width), f64::from(i as u32 / width));
        let p = field.origin + node * field.cell_m;
        let share = ease((distance.at(p) - RECORDED_M) / BLEND_M);
        *height_m += (relief.nodes.data[i] - *height_m) * share as f32;
    }
    field
}
