//! Traffic signals: before or behind a junction as the country has it, on arms where the road is wide, and all of one
//! junction in one phase.

use glam::DVec2;
use trove_model::{Drive, Kind, Outcome, Report, Seed, SignalSide};

use super::junctions::{Arm, Junction, KerbSearch, kerb_side};
use super::yard::{Source, Wish, Yard, words};

/// Signals before a junction stand within this of its middle, those behind it too, metres.
const NEAR_M: [f64; 2] = [-3.0, -30.0];
const FAR_M: [f64; 2] = [3.0, 34.0];
/// A pole behind the kerb, metres.
const OFF_KERB_M: f64 = 0.75;
/// From the kerb to the middle of an approach, metres: wider ones get the next model.
const WIDE_M: [f64; 2] = [4.2, 7.5];
/// Signals of one junction that look the same way are at least this far apart, metres.
const APART_M: f64 = 5.0;
/// Approaches whose directions are this near (cosine) have green together.
const ONE_AXIS: f64 = 0.7;
/// Who passes nearer than this to a junction's middle, metres, faster than this, had green.
const PASSES_M: f64 = 14.0;
const DRIVES_MPS: f64 = 2.0;
/// Who stands before a junction at this distance, metres, slower than this, had red.
const WAITS_M: [f64; 2] = [6.0, 35.0];
const STANDS_MPS: f64 = 0.3;

/// Signals for every approach of every junction that has them.
pub(super) fn place(junctions: &[Junction<'_>], yard: &mut Yard<'_, '_, '_>, seed: Seed, report: &Report) {
    for (i, junction) in junctions.iter().enumerate().filter(|(_, j)| j.signalled) {
        let Some(first) = junction.arms.iter().find(|a| a.enters) else { continue };
        let recorded = recorded_green(yard.around.place.drive, junction.centre);
        let first_is_green = seed.nth(i as u64).random().chance(0.5);
        let mut heads: Vec<(DVec2, DVec2)> = Vec::new();
        for arm in junction.arms.iter().filter(|a| a.enters) {
            let green = match recorded {
                Some((way, green)) => (arm.inward.dot(way).abs() > ONE_AXIS) == green,
                None => (arm.inward.dot(first.inward).abs() > ONE_AXIS) == first_is_green,
            };
            if !approach(junction, arm, green, yard, &mut heads, report) {
                let what = "signal of an approach without a kerb to stand on";
                report.note(Outcome::Dropped, what, format_args!("osm way {}", arm.road.id));
            }
        }
    }
}

/// A pole for one approach; whether one stands there.
fn approach(
    junction: &Junction<'_>,
    arm: &Arm<'_>,
    green: bool,
    yard: &mut Yard<'_, '_, '_>,
    heads: &mut Vec<(DVec2, DVec2)>,
    report: &Report,
) -> bool {
    let customs = &yard.locale.signals;
    let side = kerb_side(arm.inward, yard.locale.driving_side.is_left());
    let search = |along_m: [f64; 2]| KerbSearch { traffic: arm.inward, on_road: arm.end, side, along_m };
    let (first, second) = match customs.side {
        SignalSide::Near => (NEAR_M, FAR_M),
        SignalSide::Far => (FAR_M, NEAR_M),
    };
    let found = [first, second].into_iter().find_map(|along_m| junction.kerb(yard.around, &search(along_m)));
    let Some(kerb) = found else { return false };
    let near = |&(at, way): &(DVec2, DVec2)| at.distance(kerb.position) < APART_M && way.dot(arm.inward) > ONE_AXIS;
    if heads.iter().any(near) {
        return true;
    }
    let beside_m = (kerb.position - arm.end).dot(side);
    let models = [&customs.narrow, &customs.wide, &customs.very_wide];
    let model = models[WIDE_M.iter().filter(|wide_m| beside_m > **wide_m).count()];
    let hand = yard.locale.driving_side.name();
    let state = if green { "green" } else { "red" };
    let tags = [words(model).as_slice(), &[hand, state]].concat();
    // Where a crossing is in the way, a little further from the junction.
    let away = arm.inward * (kerb.position - junction.centre).dot(arm.inward).signum();
    let placed = [0.0, 1.5, 3.0, 4.5].into_iter().any(|back_m| {
        let position = kerb.position + kerb.outward * OFF_KERB_M + away * back_m;
        let yaw_rad = (-arm.inward).to_angle();
        let wish = Wish { kind: Kind::TrafficSignal, tags: &tags, position, yaw_rad, source: Source::Mapped };
        yard.place(&wish, report)
    });
    if placed {
        heads.push((kerb.position, arm.inward));
    }
    placed
}

/// What the recording vehicle shows of a junction's phase: a direction, and whether it had green.
fn recorded_green(drive: &Drive, centre: DVec2) -> Option<(DVec2, bool)> {
    drive.keyframes.windows(2).find_map(|pair| {
        let [a, b] = [&pair[0], &pair[1]].map(|k| k.world_from_ego.translation.truncate());
        let seconds = (pair[1].time_ns - pair[0].time_ns) as f64 * 1e-9;
        let speed_mps = a.distance(b) / seconds.max(1e-3);
        let forward = (pair[0].world_from_ego.rotation * glam::DVec3::X).truncate().normalize_or_zero();
        let ahead_m = (centre - a).dot(forward);
        let beside_m = (centre - a).perp_dot(forward).abs();
        let waits = speed_mps < STANDS_MPS && (WAITS_M[0]..WAITS_M[1]).contains(&ahead_m) && beside_m < PASSES_M;
        let passes = speed_mps > DRIVES_MPS && a.distance(centre) < PASSES_M;
        (waits || passes).then_some((forward, passes))
    })
}
