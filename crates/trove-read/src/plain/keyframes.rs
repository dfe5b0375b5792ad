//! The vehicle at each keyframe, and between them.

use std::collections::BTreeSet;

use trove_format::PlainMoment;
use trove_model::{Ego, Pose, Trajectory, World};

use super::earth::Earth;
use super::faults::{Faults, Located, Part};
use super::parts::Moment;

/// No recording is of a time after 2096, or so long before 1970: differences of times fit into 64 bits.
const LATEST_NS: u64 = 4_000_000_000_000_000_000;

/// A keyframe of which time and pose are known.
pub(super) struct Posed<'a, 'm> {
    pub(super) moment: &'m Located<'a, Moment<'a>>,
    pub(super) world_from_ego: Pose<World, Ego>,
}

/// The keyframes in the order of time, which is a fault where the file's is another.
pub(super) fn posed<'a, 'm>(
    moments: &'m [Located<'a, Moment<'a>>],
    earth: &Earth,
    faults: &mut Faults,
) -> Vec<Posed<'a, 'm>> {
    let mut tokens = BTreeSet::new();
    let mut before_ns = None;
    let mut posed = Vec::new();
    for moment in moments {
        let (part, value) = (&moment.part, &moment.value);
        if !later(part, value.time_ns, before_ns.replace(value.time_ns), faults) {
            continue;
        }
        if !value.token.is_empty() && !tokens.insert(value.token.as_str()) {
            faults.say(part, &format!("token: expected another than an earlier keyframe's, found {:?}", value.token));
        }
        let pose = earth.ego(value.world_from_ego.as_ref(), value.geo_from_ego.as_ref());
        if let Some(world_from_ego) = faults.take(part, pose) {
            posed.push(Posed { moment, world_from_ego });
        }
    }
    posed
}

/// The vehicle between the keyframes, in the order of time, which is a fault where the file's is another.
pub(super) fn path(moments: &[PlainMoment], part: &Part, earth: &Earth, faults: &mut Faults) -> Trajectory<World, Ego> {
    let mut path = Vec::with_capacity(moments.len());
    for (i, moment) in moments.iter().enumerate() {
        let part = Part { text: part.text, path: format!("path[{i}]") };
        if later(&part, moment.time_ns, i.checked_sub(1).map(|before| moments[before].time_ns), faults) {
            let pose = earth.ego(moment.world_from_ego.as_ref(), moment.geo_from_ego.as_ref());
            path.extend(faults.take(&part, pose).map(|pose| (moment.time_ns, pose)));
        }
    }
    Trajectory::new(path).0
}

/// Whether a time is one, and later than that of what stands before; else a fault.
pub(super) fn later(part: &Part, time_ns: i64, before_ns: Option<i64>, faults: &mut Faults) -> bool {
    if let Some(before_ns) = before_ns.filter(|&before_ns| time_ns <= before_ns) {
        faults.say(part, &format!("time_ns: expected more than {before_ns} of the one before, found {time_ns}"));
    }
    let is_time = time_ns.unsigned_abs() <= LATEST_NS;
    if !is_time {
        faults.say(part, &format!("time_ns: expected nanoseconds since 1970, found {time_ns}"));
    }
    is_time
}

/// The vehicle at a time, from the keyframes around it; at most half a step before the first and after the last.
pub(super) fn at(posed: &[Posed], time_ns: i64) -> Option<Pose<World, Ego>> {
    let after = posed.partition_point(|k| k.moment.value.time_ns <= time_ns).clamp(1, posed.len().max(2) - 1);
    let (Some(a), Some(b)) = (posed.get(after - 1), posed.get(after)) else {
        return posed.first().map(|only| only.world_from_ego);
    };
    let from = a.moment.value.time_ns;
    let step = b.moment.value.time_ns.saturating_sub(from) as f64;
    let share = (time_ns.saturating_sub(from) as f64 / step.max(1.0)).clamp(-0.5, 1.5);
    // At a keyframe its own pose, to the last digit.
    Some(if share == 0.0 { a.world_from_ego } else { a.world_from_ego.interpolate(&b.world_from_ego, share) })
}
