//! Parking bays and cycle lanes.

use trove_model::{ParkingOrientation, Polygon, Seed};

use super::legs::Leg;
use super::symbols::{bicycle, laid};
use crate::geometry::path::Path;
use crate::geometry::plane::strip;
use crate::roads::course::Course;
use crate::roads::cross_section::{Band, Use};

/// Width of a bay's lines.
const LINE_M: f64 = 0.1;
/// Length of a bay along the kerb, by how cars stand.
const PARALLEL_M: f64 = 6.0;
const PERPENDICULAR_M: f64 = 2.5;
/// Cars stand at 60° to the kerb.
const DIAGONAL_SLANT: f64 = 0.577;
/// Share of the rows on the carriageway that are marked.
const MARKED_SHARE: f64 = 0.55;
/// Nobody parks this near to a junction.
const CLEAR_M: f64 = 6.0;
/// Bicycles are painted this far from each other.
const SYMBOL_PERIOD_M: f64 = 45.0;

/// The lines of the rows in which cars stand on a road between two junctions, marked by chance; all white.
pub(super) fn rows(leg: &Leg<'_>, seed: Seed) -> Vec<Polygon> {
    let mut paint = Vec::new();
    for (i, band) in leg.stretch.section.bands.iter().enumerate() {
        let marked = seed.nth(i as u64).random().chance(MARKED_SHARE);
        if marked && leg.length_m() > 3.0 * CLEAR_M {
            paint.extend(row(&leg.path, [leg.from_m + CLEAR_M, leg.to_m - CLEAR_M], band));
        }
    }
    paint
}

/// The lines of the bays beside the roads; all white.
pub(super) fn bays(courses: &[Course]) -> Vec<Polygon> {
    let bays = courses.iter().filter(|course| course.line.len() > 1).filter_map(|course| match course.bands[..] {
        [band] => Some((Path::new(&course.line), band)),
        _ => None,
    });
    bays.flat_map(|(path, band)| row(&path, [0.5, path.length_m() - 0.5], &band)).collect()
}

/// The lines of a row of cars between two lengths; none where the band is no row of cars.
fn row(path: &Path<'_>, [from_m, to_m]: [f64; 2], band: &Band) -> Vec<Polygon> {
    let Use::Parking(orientation) = band.usage else { return Vec::new() };
    let (pitch_m, slant) = match orientation {
        ParkingOrientation::Parallel => (PARALLEL_M, 0.0),
        ParkingOrientation::Diagonal => (PERPENDICULAR_M / 0.866, DIAGONAL_SLANT),
        ParkingOrientation::Perpendicular => (PERPENDICULAR_M, 0.0),
    };
    let count = ((to_m - from_m) / pitch_m).floor().max(0.0) as usize;
    // The side away from the kerb.
    let (kerb_m, lane_m) =
        if band.left_m + band.right_m > 0.0 { (band.left_m, band.right_m) } else { (band.right_m, band.left_m) };
    let mut paint: Vec<Polygon> = (0..=count)
        .flat_map(|i| {
            let s_m = from_m + i as f64 * pitch_m;
            let lean_m = slant * (kerb_m - lane_m).abs();
            strip(&[path.beside(s_m, lane_m), path.beside(s_m + lean_m, kerb_m)], LINE_M / 2.0)
        })
        .collect();
    if orientation == ParkingOrientation::Parallel {
        paint.extend(strip(&path.part(from_m, from_m + count as f64 * pitch_m, lane_m), LINE_M / 2.0));
    }
    paint
}

/// The symbols of the lanes for bicycles, and the lanes themselves.
pub(super) fn cycle_lanes(leg: &Leg<'_>, on_left: bool) -> (Vec<Polygon>, Vec<Polygon>) {
    let (mut symbols, mut lanes) = (Vec::new(), Vec::new());
    for band in leg.stretch.section.bands.iter().filter(|b| b.usage == Use::Cycle) {
        let middle_m = (band.left_m + band.right_m) / 2.0;
        // Bicycles ride with the cars beside them.
        let forward = leg.road().oneway || (middle_m > 0.0) == on_left;
        let mut s_m = leg.from_m + 5.0;
        while s_m < leg.to_m - 4.0 {
            let along = leg.path.at(s_m).1 * if forward { 1.0 } else { -1.0 };
            symbols.extend(laid(&bicycle(), leg.path.beside(s_m, middle_m), along));
            s_m += SYMBOL_PERIOD_M;
        }
        lanes.extend(strip(&leg.path.part(leg.from_m, leg.to_m, middle_m), band.width_m() / 2.0 - 0.05));
    }
    (symbols, lanes)
}
