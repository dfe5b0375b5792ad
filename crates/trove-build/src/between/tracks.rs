//! Boxes of objects between keyframes.

use trove_model::{Cuboid, Keyframe, Kind, Outcome, Pose, Report, Track};

use super::course::{Course, Waypoint};
use super::times::{MAX_STEP_NS, When, seconds};

/// The rear axle is this share of the length behind the middle: 0.28 to 0.31 for cars and cycles, a little less for buses.
const REAR_AXLE: f64 = 0.29;
/// Wheels that slip farther than this from one keyframe to the next are told of, metres.
const TOLD_M: f64 = 0.05;

/// The box of a track at each moment; `None` where it is not there: only between two keyframes that follow one another and
/// both have it is it there between them.
pub(super) fn boxes_between(
    track: &Track,
    keyframes: &[Keyframe],
    times: &[When],
    report: &Report,
) -> Vec<Option<Cuboid>> {
    let start_ns = keyframes.first().map_or(0, |k| k.time_ns);
    let mut found: Vec<Option<Cuboid>> = vec![None; times.len()];
    for run in runs(track, keyframes) {
        let waypoint = |(k, cuboid): &(usize, Cuboid)| Waypoint {
            time_s: seconds(keyframes[*k].time_ns, start_ns),
            rotation: cuboid.world_from_body.rotation,
            position: cuboid.world_from_body.translation,
        };
        let course = Course::new(run.iter().map(waypoint).collect(), axle_m(track.kind, run));
        let (first, last) = (run[0].0, run[run.len() - 1].0);
        for (slip_m, pair) in course.slips_m().zip(run.windows(2)) {
            if slip_m > TOLD_M {
                let example =
                    format!("{} ({}), {slip_m:.2} m after keyframe {}", track.token, track.kind.name(), pair[0].0);
                report.note(Outcome::Warned, "wheels that slip sideways between keyframes, as annotated", example);
            }
        }
        let inside =
            |when: &When| (first..last).contains(&when.keyframe) || (when.keyframe == last && when.share == 0.0);
        for (when, cuboid) in times.iter().zip(&mut found).filter(|(when, _)| inside(when)) {
            let at = when.keyframe - first;
            let (_, before) = run[at];
            *cuboid = Some(if when.share == 0.0 {
                before
            } else {
                let (rotation, position) = course.at(seconds(when.time_ns, start_ns));
                let size_m = before.size_m.lerp(run[at + 1].1.size_m, when.share);
                Cuboid { world_from_body: Pose::new(rotation, position), size_m }
            });
        }
    }
    found
}

/// The parts of a track without a gap.
fn runs<'a>(track: &'a Track, keyframes: &'a [Keyframe]) -> impl Iterator<Item = &'a [(usize, Cuboid)]> {
    let follows = |(a, from): &(usize, Cuboid), (b, to): &(usize, Cuboid)| {
        let apart_ns = keyframes.get(*b).zip(keyframes.get(*a)).map_or(0, |(b, a)| b.time_ns.saturating_sub(a.time_ns));
        let is_sound = |cuboid: &Cuboid| cuboid.world_from_body.is_finite();
        *b == a + 1 && (1..=MAX_STEP_NS).contains(&apart_ns) && is_sound(from) && is_sound(to)
    };
    let there = |run: &&[(usize, Cuboid)]| run.iter().all(|(k, _)| *k < keyframes.len());
    track.boxes.chunk_by(follows).filter(there)
}

/// From the rear axle to the middle of the box; `None` for what has no wheels that lead it.
fn axle_m(kind: Kind, run: &[(usize, Cuboid)]) -> Option<f64> {
    kind.is_vehicle().then(|| run[0].1.size_m.x * REAR_AXLE)
}
