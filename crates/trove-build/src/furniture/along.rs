//! Furniture by rule along the kerbs: lamps, and now and then something that the region has on its sidewalks.

use trove_model::{Kind, LampRow, Random, Report, Road, RoadKind, Seed};

use super::yard::{Source, Yard, as_often, words};
use crate::geometry::segments::SegmentIndex;
use crate::surroundings::{KERB_STEP_M, KerbPoint};

/// A lamp on the other side is at least so far away as a share of the spacing.
const ACROSS: f64 = 0.48;
/// Things of the same kind keep this far apart, metres.
const ALIKE_M: f64 = 14.0;
/// Bollards stand in rows of so many, this far apart, metres.
const BOLLARDS: [usize; 2] = [3, 8];
const BOLLARD_STEP_M: f64 = 2.0;
/// Nothing stands in a junction's mouth: a run of kerb shorter than this is an island or a corner, metres.
const MIN_RUN_M: f64 = 12.0;
/// Nor this near to where a kerb ends, metres.
const RUN_END_M: f64 = 3.0;
/// Further from the driven path than this no one sees a bin, metres.
const SEEN_M: f64 = 160.0;
/// A kerb's road is at most this far from it, metres.
const ROAD_REACH_M: f64 = 16.0;

/// Furnishes every run of kerb.
pub(super) fn furnish(yard: &mut Yard<'_, '_, '_>, seed: Seed, report: &Report) {
    let around = yard.around;
    let roads: Vec<&Road> = around.place.map.iter().flat_map(|m| &m.roads).filter(|r| r.kind.is_for_cars()).collect();
    let index = SegmentIndex::new(roads.iter().map(|r| r.centreline.as_slice()));
    let road = |kerb: &KerbPoint| index.nearest(kerb.position, ROAD_REACH_M).map(|n| roads[n.line]);
    let path: Vec<glam::DVec2> =
        around.place.drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    let path = SegmentIndex::new([path.as_slice()]);
    let is_seen = |kerb: &KerbPoint| path.nearest(kerb.position, SEEN_M).is_some();
    for (i, run) in around.kerbs.runs.iter().enumerate().filter(|(_, r)| r.len() as f64 * KERB_STEP_M >= MIN_RUN_M) {
        let end = (RUN_END_M / KERB_STEP_M) as usize;
        let run = &run[end..run.len() - end];
        lamps(run, &road, yard, seed.child("lamps"), report);
        let mut random = seed.nth(i as u64).random();
        small_things(run, &is_seen, yard, &mut random, report);
    }
}

fn lamps<'r>(
    run: &[KerbPoint],
    road: &dyn Fn(&KerbPoint) -> Option<&'r Road>,
    yard: &mut Yard<'_, '_, '_>,
    seed: Seed,
    report: &Report,
) {
    let customs = &yard.locale.lamps;
    let mut since_m = f64::INFINITY;
    for kerb in run {
        since_m += KERB_STEP_M;
        if since_m < customs.side.spacing_m {
            continue;
        }
        let road = road(kerb);
        let main = road.is_none_or(|r| r.kind <= RoadKind::Tertiary);
        let LampRow { models, spacing_m } = if main { &customs.main } else { &customs.side };
        let spacing_m = *spacing_m;
        let dark = road.is_some_and(|r| r.lit == Some(false) || r.kind == RoadKind::Service);
        // Main roads are lit from both sides in turn, side streets from one.
        let across_m = if main || customs.both_sides { spacing_m * ACROSS } else { spacing_m * 0.8 };
        if dark || since_m < spacing_m || yard.has_near(Kind::StreetLamp, kerb.position, across_m) {
            continue;
        }
        // A street's lamps are alike on both its sides.
        let draw = seed.child(road.and_then(|r| r.name.as_deref()).unwrap_or_default()).random().index(models.len());
        if yard.place_at_kerb(Kind::StreetLamp, &words(&models[draw]), kerb, Source::MadeUp, report) {
            since_m = 0.0;
        }
    }
}

fn small_things(
    run: &[KerbPoint],
    is_seen: &dyn Fn(&KerbPoint) -> bool,
    yard: &mut Yard<'_, '_, '_>,
    random: &mut Random,
    report: &Report,
) {
    let customs = &yard.locale.street;
    let (models, [least_m, most_m]) = (as_often(&customs.small), customs.small_spacing_m);
    let mut at_m = random.range(0.0, most_m);
    while let Some(kerb) = run.get((at_m / KERB_STEP_M) as usize) {
        let Some(model) = random.pick(&models).copied() else { return };
        let kind = model.kind;
        let count = if kind == Kind::Bollard { BOLLARDS[0] + random.index(BOLLARDS[1] - BOLLARDS[0]) } else { 1 };
        let alone = !yard.has_near(kind, kerb.position, if kind == Kind::StreetFurniture { 5.0 } else { ALIKE_M });
        let step = (BOLLARD_STEP_M / KERB_STEP_M) as usize;
        if alone && is_seen(kerb) {
            let row = run[(at_m / KERB_STEP_M) as usize..].iter().step_by(step).take(count);
            for kerb in row.filter(|k| k.sidewalk) {
                yard.place_at_kerb(kind, &words(&model.tags), kerb, Source::MadeUp, report);
            }
        }
        at_m += random.range(least_m, most_m) + count as f64 * BOLLARD_STEP_M;
    }
}
