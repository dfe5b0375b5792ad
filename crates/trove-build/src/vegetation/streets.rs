//! Trees and hedges along streets, where no one says what grows there.

use glam::DVec2;
use trove_model::{Kind, Seed};

use super::hedges::{bed, hedge};
use super::wish::Wish;
use crate::surroundings::Clearance;
use crate::surroundings::Surroundings;
use crate::surroundings::{KERB_STEP_M, KerbPoint};

/// Streets are planted by such stretches, metres: beyond, another street's habits begin.
const STRETCH_M: f64 = 120.0;
/// Share of the stretches with trees, and of those with a hedge.
const TREE_SHARE: f64 = 0.5;
const HEDGE_SHARE: f64 = 0.24;
/// Share of the hedges that are flower beds instead.
const BED_SHARE: f64 = 0.3;
/// Trees of a row are this far apart, metres.
const TREE_SPACING_M: [f64; 2] = [8.0, 12.0];
/// Hedges are this long, metres, with gaps of as much.
const HEDGE_RUN_M: f64 = 14.0;
/// Rows of trees stand this far from the kerb, metres.
const TREE_OFF_KERB_M: f64 = 1.3;
/// Land begins within this of the kerb, or there is no hedge, metres.
const LAND_REACH_M: f64 = 7.0;
/// Hedges stand this far behind where the sidewalk ends, metres.
const BEHIND_M: f64 = 0.7;

/// Trees behind the kerb, hedges where the sidewalk ends.
pub(super) fn wishes(around: &Surroundings, clearance: &Clearance, seed: Seed) -> Vec<Wish> {
    let mut wishes = Vec::new();
    for (i, run) in around.kerbs.runs.iter().enumerate() {
        let stretch_points = (STRETCH_M / KERB_STEP_M) as usize;
        for (j, stretch) in run.chunks(stretch_points).enumerate() {
            let seed = seed.nth(i as u64).nth(j as u64);
            let mut random = seed.random();
            let (trees, hedge) = (random.chance(TREE_SHARE), random.chance(HEDGE_SHARE));
            let height_m = random.range(7.0, 12.0);
            if trees {
                row_of_trees(stretch, height_m, seed, &mut wishes);
            }
            if hedge {
                hedges(stretch, clearance, seed, &mut wishes);
            }
        }
    }
    wishes
}

fn row_of_trees(stretch: &[KerbPoint], height_m: f64, seed: Seed, wishes: &mut Vec<Wish>) {
    let mut random = seed.child("trees").random();
    let spacing_m = random.range(TREE_SPACING_M[0], TREE_SPACING_M[1]);
    let mut at_m = random.range(0.0, spacing_m);
    while let Some(kerb) = stretch.get((at_m / KERB_STEP_M) as usize) {
        let position = kerb.position + kerb.outward * TREE_OFF_KERB_M;
        // Here and there one has been replaced.
        let age = if random.chance(0.1) { 0.55 } else { random.range(0.85, 1.15) };
        let tree = Wish::new(Kind::Tree, position, height_m * age, seed.0);
        wishes.push(Wish { radius_m: Some(2.2), paved: true, ..tree });
        at_m += spacing_m * random.range(0.92, 1.08);
    }
}

fn hedges(stretch: &[KerbPoint], clearance: &Clearance, seed: Seed, wishes: &mut Vec<Wish>) {
    let mut random = seed.child("hedge").random();
    let height_m = random.range(0.7, 1.3);
    let run_points = (HEDGE_RUN_M / KERB_STEP_M) as usize;
    let skip = random.index(run_points);
    for run in stretch.get(skip..).unwrap_or_default().chunks(run_points).step_by(2) {
        let line: Vec<DVec2> =
            run.iter().step_by(2).filter_map(|k| land_behind(k.position, k.outward, clearance)).collect();
        // Where the sidewalk's edge jumps the hedge ends; no one plants a piece alone.
        for part in line.chunk_by(|a, b| a.distance(*b) < 3.0 * KERB_STEP_M).filter(|part| part.len() > 3) {
            // Here and there it is flowers.
            if seed.child("bed").random().chance(BED_SHARE) {
                wishes.extend(bed(part, 0.45, seed));
            } else {
                wishes.extend(hedge(part, height_m, seed));
            }
        }
    }
}

/// A little behind where the sidewalk gives way to open land.
fn land_behind(kerb: DVec2, outward: DVec2, clearance: &Clearance) -> Option<DVec2> {
    let steps = (LAND_REACH_M / 0.5) as usize;
    let at = |i: usize| kerb + outward * (1.0 + 0.5 * i as f64);
    (0..steps).map(at).find(|&p| clearance.is_land(p)).map(|p| p + outward * BEHIND_M)
}
