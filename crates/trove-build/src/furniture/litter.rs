//! Litter on sidewalks.

use glam::DVec2;
use trove_model::{Kind, Report, Seed};

use super::yard::{Source, Wish, Yard};
use crate::geometry::segments::SegmentIndex;
use crate::surroundings::KERB_STEP_M;

/// From one piece to the next, metres.
const SPACING_M: [f64; 2] = [4.0, 36.0];
/// It lies this far behind the kerb, metres.
const OFF_KERB_M: [f64; 2] = [0.08, 1.4];
/// Further from the driven path than this no one sees it, metres.
const SEEN_M: f64 = 50.0;

/// Strews pieces along the sidewalks near the driven path.
pub(super) fn strew(yard: &mut Yard<'_, '_, '_>, seed: Seed, report: &Report) {
    let around = yard.around;
    if !yard.has(Kind::StreetFurniture, &["litter"]) {
        return;
    }
    let path: Vec<DVec2> =
        around.place.drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    let path = SegmentIndex::new([path.as_slice()]);
    for (i, run) in around.kerbs.runs.iter().enumerate() {
        let mut random = seed.nth(i as u64).random();
        let mut at_m = random.range(0.0, SPACING_M[1]);
        while let Some(kerb) = run.get((at_m / KERB_STEP_M) as usize) {
            at_m += random.range(SPACING_M[0], SPACING_M[1]);
            let position = kerb.position + kerb.outward * random.range(OFF_KERB_M[0], OFF_KERB_M[1]);
            let yaw_rad = random.range(0.0, std::f64::consts::TAU);
            if kerb.sidewalk && path.nearest(position, SEEN_M).is_some() {
                // It lies wherever it fell, as near to cameras and walls as what a map has.
                let wish =
                    Wish { kind: Kind::StreetFurniture, tags: &["litter"], position, yaw_rad, source: Source::Mapped };
                yard.place(&wish, report);
            }
        }
    }
}
