//! The ground: its height from what stood on it and from a relief, and surfaces that lie on it.

mod apron;
mod blocks;
mod drape;
mod fit;
mod land;
mod lawn;
mod merge;
mod noise;
mod observations;
mod profiles;
mod ramps;
mod spans;
mod terrain;
#[cfg(test)]
mod tests;

use trove_model::{Bounds, Drive, DriveOrigin, HeightField, Outcome, Relief, Report, StreetMap};

pub(crate) use apron::{Apron, apron, beyond_m};
pub(crate) use drape::Drape;
pub(crate) use land::Land;
pub(crate) use lawn::Lawn;
pub(crate) use noise::noise;
pub(crate) use ramps::Ramps;
pub(crate) use spans::Spans;

/// Distance of the height field's nodes, metres: wheels are 2–4 m apart, so a finer field would only copy noise.
const CELL_M: f64 = 2.0;

/// Heights are changed by up to this where that makes the ground even: much less than a wheel's play, metres.
const EVEN_M: f32 = 0.005;

/// How high a place lies.
#[derive(Clone, Debug)]
pub(crate) struct Ground<'a> {
    /// Height of the carriageway's level.
    pub heights: HeightField,
    /// How high bridges and tunnels run; empty without a relief.
    pub spans: Spans,
    /// The land beyond; `None` without a relief.
    pub land: Option<Land<'a>>,
}

/// A smooth height field: the driven path, the bottoms of the annotated boxes and the LiDAR's ground returns tell the
/// height; beyond them it is the relief, with the map's roads and waters laid into it, or without a relief the
/// nearest known height.
///
/// Reports `ground.box_bottom_median_m` and `ground.box_bottom_p90_m`, the distances of box bottoms to it, and
/// `relief.shift_m`, by which the relief was raised.
pub(crate) fn ground<'a>(
    drive: &Drive,
    map: Option<&StreetMap>,
    relief: Option<&'a Relief>,
    kerb_m: f64,
    bounds: Bounds,
    report: &Report,
) -> Ground<'a> {
    let observations = match drive.origin {
        DriveOrigin::Recorded => observations::observations(drive, kerb_m),
        // Its views stand wherever the ground is.
        DriveOrigin::MadeUp => Vec::new(),
    };
    let mut heights = fit::fit(&observations, bounds, CELL_M);
    let mut spans = Spans::default();
    let shift = relief.and_then(|relief| merge::shift_m(&observations, |p| relief.height_m(p)));
    let land = relief.map(|relief| {
        // Nobody knows the height of a place that nobody recorded: World's 0 is about its middle's.
        let middle_m = || relief.height_m(bounds.centre()).unwrap_or(0.0);
        Land { relief, datum_m: shift.map_or_else(|| -middle_m().round(), |(shift_m, _)| shift_m) }
    });
    if let Some(land) = land
        && let Some((field, unknown)) = land.field(&heights)
    {
        report.measure("relief.shift_m", land.datum_m);
        if let Some((_, left_m)) = shift {
            report.measure("relief.to_recording_median_m", left_m);
        }
        if unknown > 0.0 {
            let example = format!("{}: {:.0} % of the place", drive.id, 100.0 * unknown);
            report.note(Outcome::Guessed, "ground beyond the elevation files, as high as their edge", example);
        }
        let (field, hanging) = terrain::terrain(map.unwrap_or(&StreetMap::default()), field, land);
        spans = hanging;
        heights = if observations.is_empty() { field } else { merge::merged(heights, &field, &observations) };
    }
    blocks::evened(&mut heights, EVEN_M);
    measure_boxes(drive, kerb_m, &heights, report);
    Ground { heights, spans, land }
}

fn measure_boxes(drive: &Drive, kerb_m: f64, field: &HeightField, report: &Report) {
    let mut misfits: Vec<f64> = observations::box_bottoms(drive, kerb_m)
        .map(|bottom| (bottom.height_m - field.height_m(bottom.position)).abs())
        .collect();
    misfits.sort_by(f64::total_cmp);
    if !misfits.is_empty() {
        report.measure("ground.box_bottom_median_m", misfits[misfits.len() / 2]);
        report.measure("ground.box_bottom_p90_m", misfits[misfits.len() * 9 / 10]);
    }
}
