//! Furniture by rule along the kerbs: lamps in turn on both sides, signs, and now and then something else.

use trove_model::{Kind, Random, Report, Seed};

use super::{Shop, Wish};
use crate::kerbs::{KERB_STEP_M, KerbPoint};
use crate::surroundings::Surroundings;

/// Lamps on one side are this far apart, metres, and at least so far from those on the other.
const LAMP_SPACING_M: f64 = 30.0;
const LAMP_ACROSS_M: f64 = 16.0;
/// Signs follow one another within this, metres.
const SIGN_SPACING_M: [f64; 2] = [35.0, 75.0];
/// Small things follow one another within this, metres.
const SMALL_SPACING_M: [f64; 2] = [18.0, 50.0];
/// Like things keep this far apart, metres.
const ALIKE_M: f64 = 12.0;
/// Nothing stands in a junction's mouth: a run of kerb shorter than this is an island or a corner, metres.
const MIN_RUN_M: f64 = 12.0;

/// Furnishes every run of kerb.
pub(super) fn furnish(around: &Surroundings, shop: &mut Shop, seed: Seed, report: &Report) {
    for (i, run) in around.kerbs.runs.iter().enumerate().filter(|(_, r)| r.len() as f64 * KERB_STEP_M >= MIN_RUN_M) {
        let seed = seed.nth(i as u64);
        lamps(run, shop, report);
        signs(run, shop, &mut seed.child("signs").random(), report);
        small_things(run, shop, &mut seed.child("small").random(), report);
    }
}

fn lamps(run: &[KerbPoint], shop: &mut Shop, report: &Report) {
    let mut since_m = LAMP_SPACING_M / 2.0;
    for kerb in run {
        since_m += KERB_STEP_M;
        if since_m < LAMP_SPACING_M || shop.distance_m(Kind::StreetLamp, kerb.position) < LAMP_ACROSS_M {
            continue;
        }
        if shop.place(&Wish::at_kerb(Kind::StreetLamp, kerb), report) {
            since_m = 0.0;
        }
    }
}

fn signs(run: &[KerbPoint], shop: &mut Shop, random: &mut Random, report: &Report) {
    for kerb in drawn(run, SIGN_SPACING_M, random) {
        if shop.distance_m(Kind::TrafficSign, kerb.position) >= ALIKE_M {
            shop.place(&Wish::at_kerb(Kind::TrafficSign, kerb), report);
        }
    }
}

fn small_things(run: &[KerbPoint], shop: &mut Shop, random: &mut Random, report: &Report) {
    const KINDS: [Kind; 9] = [
        Kind::Bin,
        Kind::Bin,
        Kind::Bench,
        Kind::Hydrant,
        Kind::Bollard,
        Kind::Bollard,
        Kind::Bollard,
        Kind::UtilityPole,
        Kind::Bench,
    ];
    for kerb in drawn(run, SMALL_SPACING_M, random) {
        let kind = KINDS[random.index(KINDS.len())];
        if kerb.sidewalk && shop.distance_m(kind, kerb.position) >= ALIKE_M {
            shop.place(&Wish::at_kerb(kind, kerb), report);
        }
    }
}

/// Points of a run at drawn distances.
fn drawn<'a>(run: &'a [KerbPoint], spacing_m: [f64; 2], random: &mut Random) -> Vec<&'a KerbPoint> {
    let mut at_m = random.range(0.0, spacing_m[1]);
    let mut points = Vec::new();
    while let Some(kerb) = run.get((at_m / KERB_STEP_M) as usize) {
        points.push(kerb);
        at_m += random.range(spacing_m[0], spacing_m[1]);
    }
    points
}
