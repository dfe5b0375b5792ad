//! The way of something through poses at known times: curves along which wheels roll, and a pace that never turns back.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec2, DVec3};

/// Closer poses are one pose: annotators' hands tremble.
pub(crate) const TREMOR_M: f64 = 0.02;
/// Likewise for how far one is turned from the other.
pub(crate) const TREMOR_RAD: f64 = 0.005;
/// What annotated poses ask of wheels beyond rolling is let slip up to so much from one pose to the next, metres: to steer it
/// away would make every vehicle weave by its annotator's errors.
const SLIP_M: f64 = 0.035;
/// A heading off the way by more than this is no steering, tangent of the angle.
const STEEPEST: f64 = 0.4;
/// Nothing steers farther than this from one pose to the next, radians.
const SHARPEST_RAD: f64 = 1.4;
/// What moves less from one pose to the next does not say whither it steers, metres.
const LEAST_M: f64 = 0.15;
/// Who turns farther than this between two poses was annotated the wrong way round in one of them, radians.
const FLIP_RAD: f64 = 2.2;

/// A pose at a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waypoint {
    /// Seconds, more than those of the one before.
    pub time_s: f64,
    /// World from Body or Ego.
    pub rotation: DQuat,
    /// Its origin in World, metres.
    pub position: DVec3,
}

/// A way through waypoints, at each of which it has exactly that pose.
#[derive(Clone, Debug)]
pub(super) struct Course {
    points: Vec<Waypoint>,
    stretches: Vec<Stretch>,
    /// From the axle that does not slip forward to the origin, metres; `None` for what has no wheels to follow.
    axle_m: Option<f64>,
}

/// From one waypoint to the next, in the plane.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    /// How it gets along.
    way: Way,
    /// Share of the way a share of the time, at its start and at its end.
    pace: [f64; 2],
}

#[derive(Clone, Copy, Debug)]
enum Way {
    /// It stays as it is at its start.
    Rest,
    /// Its origin goes from one place to another, whatever the heading.
    Drift([DVec2; 2], [DVec2; 2]),
    /// Its axle rolls along its own heading: ends, tangents, slip, and whether it goes backwards.
    Roll { ends: [DVec2; 2], tangents: [DVec2; 2], slip: DVec2, back: bool },
}

impl Course {
    /// Through waypoints in the order of time, the first of which there must be; `axle_m` is how far the origin is ahead of an
    /// axle that only rolls.
    pub(super) fn new(points: Vec<Waypoint>, axle_m: Option<f64>) -> Self {
        let points = held(points);
        let steps: Vec<Step> = points.windows(2).map(|pair| Step::new([&pair[0], &pair[1]], axle_m)).collect();
        let speeds: Vec<f64> =
            (0..points.len()).map(|i| speed(i.checked_sub(1).and_then(|i| steps.get(i)), steps.get(i))).collect();
        let stretches = steps.iter().enumerate().map(|(i, step)| {
            let pace = [speeds[i], speeds[i + 1]]
                .map(|v| if step.length_m == 0.0 { 0.0 } else { (v * step.seconds / step.length_m).clamp(0.0, 3.0) });
            let way = match (axle_m, step.rolls) {
                _ if step.length_m == 0.0 && !step.turns => Way::Rest,
                (Some(_), true) => roll(step, [&points[i], &points[i + 1]]),
                (Some(_), false) => Way::Drift(step.ends, [step.chord(); 2]),
                (None, _) => {
                    let beside = [i.checked_sub(1).map(|i| &steps[i]), steps.get(i + 1)];
                    Way::Drift(step.ends, free_tangents(step, beside))
                }
            };
            Stretch { way, pace }
        });
        let stretches = stretches.collect();
        Self { points, stretches, axle_m }
    }

    /// Rotation and position at a time, seconds; the first and the last beyond them.
    pub(super) fn at(&self, time_s: f64) -> (DQuat, DVec3) {
        let next = self.points.partition_point(|p| p.time_s <= time_s);
        let (before, after) = (next.checked_sub(1).map(|i| &self.points[i]), self.points.get(next));
        let (Some(a), Some(b)) = (before, after) else {
            let only = before.or(after).unwrap_or(&self.points[0]);
            return (only.rotation, only.position);
        };
        let stretch = &self.stretches[next - 1];
        let time = (time_s - a.time_s) / (b.time_s - a.time_s);
        let share = stretch.share(time);
        let (rotation, place) = match stretch.way {
            Way::Rest => return (a.rotation, a.position),
            Way::Drift(ends, tangents) => {
                let rotation = match (self.axle_m.is_some() && flips(a, b), time < 0.5) {
                    (true, true) => a.rotation,
                    (true, false) => b.rotation,
                    (false, _) => a.rotation.slerp(b.rotation, time),
                };
                (rotation, hermite(ends, tangents, share).0)
            }
            Way::Roll { ends, tangents, slip, back } => {
                let (foot, along) = hermite(ends, tangents, share);
                let heading_rad = if back { -along } else { along }.to_angle();
                // Tilt is between the tilts; the heading is the wheels'.
                let tilted = a.rotation.slerp(b.rotation, share);
                let rotation = DQuat::from_rotation_z(heading_rad - yaw_rad(tilted)) * tilted;
                let ahead = self.axle_m.unwrap_or(0.0) * DVec2::from_angle(heading_rad);
                (rotation, foot + slip * share + ahead)
            }
        };
        (rotation, place.extend(a.position.z + (b.position.z - a.position.z) * share))
    }

    /// How far the poses at the ends of each stretch ask for what wheels do not do, metres, in the order of time: 0 for
    /// what has no wheels.
    pub(super) fn slips_m(&self) -> impl Iterator<Item = f64> {
        let axle_m = self.axle_m;
        self.stretches.iter().zip(self.points.windows(2)).map(move |(stretch, ends)| match (stretch.way, axle_m) {
            (Way::Roll { slip, .. }, _) => slip.length(),
            (Way::Drift([a, b], _), Some(_)) if flips(&ends[0], &ends[1]) => a.distance(b),
            (Way::Drift(..), Some(axle_m)) => {
                let [a, b] = [foot(&ends[0], axle_m), foot(&ends[1], axle_m)];
                (b - a).perp_dot(middle(&ends[0], &ends[1])).abs()
            }
            (Way::Drift(..), None) | (Way::Rest, _) => 0.0,
        })
    }
}

impl Stretch {
    /// The share of the way at a share of the time: a cubic whose slopes at the ends keep it from ever turning back (Fritsch
    /// and Carlson 1980).
    fn share(&self, time: f64) -> f64 {
        let [start, end] = self.pace;
        let (t2, t3) = (time * time, time * time * time);
        (3.0 * t2 - 2.0 * t3) + start * (t3 - 2.0 * t2 + time) + end * (t3 - t2)
    }
}

/// What two waypoints say of the stretch between them.
#[derive(Clone, Copy, Debug)]
struct Step {
    seconds: f64,
    ends: [DVec2; 2],
    /// Along the way, negative backwards.
    length_m: f64,
    turns: bool,
    /// Whether its heading leads along the way.
    rolls: bool,
}

impl Step {
    fn new([a, b]: [&Waypoint; 2], axle_m: Option<f64>) -> Self {
        let feet = [a, b].map(|p| foot(p, axle_m.unwrap_or(0.0)));
        let turn_rad = turn_rad(a, b);
        let middle = middle(a, b);
        let ahead_m = (feet[1] - feet[0]).dot(middle);
        let aside_m = ((feet[1] - feet[0]).perp_dot(middle).abs() - SLIP_M).max(0.0);
        let rolls = axle_m.is_some()
            && turn_rad.abs() < SHARPEST_RAD
            && ahead_m.abs() > LEAST_M
            && aside_m < STEEPEST * ahead_m.abs();
        let ends = if rolls { feet } else { [a, b].map(|p| p.position.truncate()) };
        let far_m = ends[0].distance(ends[1]);
        let sign = if axle_m.is_some() && ahead_m < 0.0 { -1.0 } else { 1.0 };
        Self {
            seconds: b.time_s - a.time_s,
            ends,
            length_m: sign * if rolls { far_m * arc_share(turn_rad) } else { far_m },
            turns: a.rotation.angle_between(b.rotation) > 0.0 || a.position.z != b.position.z,
            rolls,
        }
    }

    fn chord(&self) -> DVec2 {
        self.ends[1] - self.ends[0]
    }
}

/// The speed at a waypoint between two stretches, m/s: their harmonic mean, and none where one of them rests or they lead
/// opposite ways, so that what stops has stopped.
fn speed(before: Option<&Step>, after: Option<&Step>) -> f64 {
    let of = |step: &Step| step.length_m / step.seconds;
    match (before, after) {
        (Some(a), Some(b)) if of(a) * of(b) > 0.0 => {
            let (long, short) = (2.0 * b.seconds + a.seconds, b.seconds + 2.0 * a.seconds);
            (long + short) / (long / of(a) + short / of(b))
        }
        (Some(_), Some(_)) | (None, None) => 0.0,
        (Some(only), None) | (None, Some(only)) => of(only),
    }
}

/// Rolling from one pose to another: along both headings, with what slips on the way.
fn roll(step: &Step, points: [&Waypoint; 2]) -> Way {
    let headings = points.map(|p| yaw_rad(p.rotation));
    let aside = middle(points[0], points[1]).perp();
    let slip = aside * step.chord().dot(aside).clamp(-SLIP_M, SLIP_M);
    let tangents = headings.map(|heading| DVec2::from_angle(heading) * step.length_m);
    Way::Roll { ends: [step.ends[0], step.ends[1] - slip], tangents, slip, back: step.length_m < 0.0 }
}

/// Tangents of what goes where it likes: at each end along the way of the stretches that meet there.
fn free_tangents(step: &Step, beside: [Option<&Step>; 2]) -> [DVec2; 2] {
    let own = step.chord();
    let Some(along) = own.try_normalize() else { return [own; 2] };
    let through = |other: Option<&Step>| {
        let other = other.and_then(|other| other.chord().try_normalize());
        other.filter(|other| other.dot(along) > 0.0).map_or(along, |other| (other + along).normalize())
    };
    let directions = beside.map(through);
    let length_m = own.length() * arc_share(directions[0].angle_to(directions[1]));
    directions.map(|direction| direction * length_m)
}

/// How much longer than its chord an arc is that turns so far.
fn arc_share(turn_rad: f64) -> f64 {
    let half = (turn_rad / 2.0).abs();
    if half < 1e-6 { 1.0 } else { half / half.sin() }
}

/// A place on a cubic, and its direction there.
fn hermite([a, b]: [DVec2; 2], [from, to]: [DVec2; 2], t: f64) -> (DVec2, DVec2) {
    let (t2, t3) = (t * t, t * t * t);
    let place = a + (b - a) * (3.0 * t2 - 2.0 * t3) + from * (t3 - 2.0 * t2 + t) + to * (t3 - t2);
    let along = (b - a) * (6.0 * t - 6.0 * t2) + from * (3.0 * t2 - 4.0 * t + 1.0) + to * (3.0 * t2 - 2.0 * t);
    (place, along)
}

/// Each waypoint that is the one before it but for a tremor gets that one's pose.
fn held(mut points: Vec<Waypoint>) -> Vec<Waypoint> {
    for i in 1..points.len() {
        let before = points[i - 1];
        if is_tremor((before.rotation, before.position), (points[i].rotation, points[i].position)) {
            points[i] = Waypoint { time_s: points[i].time_s, ..before };
        }
    }
    points
}

/// Whether two poses, rotations and positions in metres, are one but for the tremor of an annotator's hand.
pub(crate) fn is_tremor(a: (DQuat, DVec3), b: (DQuat, DVec3)) -> bool {
    a.1.distance(b.1) < TREMOR_M && a.0.angle_between(b.0) < TREMOR_RAD
}

/// Where the axle is.
fn foot(point: &Waypoint, axle_m: f64) -> DVec2 {
    point.position.truncate() - axle_m * DVec2::from_angle(yaw_rad(point.rotation))
}

/// How far something turns to the left from one waypoint to the next.
fn turn_rad(a: &Waypoint, b: &Waypoint) -> f64 {
    wrap(yaw_rad(b.rotation) - yaw_rad(a.rotation))
}

/// The heading halfway.
fn middle(a: &Waypoint, b: &Waypoint) -> DVec2 {
    DVec2::from_angle(yaw_rad(a.rotation) + turn_rad(a, b) / 2.0)
}

/// Whether one of two waypoints was annotated the wrong way round.
fn flips(a: &Waypoint, b: &Waypoint) -> bool {
    turn_rad(a, b).abs() > FLIP_RAD
}

fn yaw_rad(rotation: DQuat) -> f64 {
    let forward = rotation * DVec3::X;
    forward.y.atan2(forward.x)
}

/// An angle from −π to π.
fn wrap(angle_rad: f64) -> f64 {
    (angle_rad + PI).rem_euclid(TAU) - PI
}

#[cfg(test)]
mod tests {
    use super::*;

    const AXLE_M: f64 = 1.35;

    fn waypoint(time_s: f64, yaw_rad: f64, foot: DVec2) -> Waypoint {
        let position = (foot + AXLE_M * DVec2::from_angle(yaw_rad)).extend(0.8);
        Waypoint { time_s, rotation: DQuat::from_rotation_z(yaw_rad), position }
    }

    /// Where the rear axle is, and the heading.
    fn axle(course: &Course, time_s: f64) -> (DVec2, f64) {
        let (rotation, position) = course.at(time_s);
        (position.truncate() - AXLE_M * DVec2::from_angle(yaw_rad(rotation)), yaw_rad(rotation))
    }

    /// The largest sideways step of the rear axle between moments, metres, at so many a second.
    fn slip_m(course: &Course, end_s: f64, rate_hz: f64) -> f64 {
        let count = (end_s * rate_hz).round() as usize;
        let poses: Vec<_> = (0..=count).map(|i| axle(course, i as f64 / rate_hz)).collect();
        let aside = |pair: &[(DVec2, f64)]| {
            let [(a, from), (b, to)] = [pair[0], pair[1]];
            (b - a).perp_dot(DVec2::from_angle(from + wrap(to - from) / 2.0)).abs()
        };
        poses.windows(2).map(aside).fold(0.0, f64::max)
    }

    #[test]
    fn a_vehicle_on_a_circle_stays_on_it_and_looks_along_it() {
        // Radii and speeds from a parking garage to a motorway, half a second apart, forwards and backwards.
        for (radius_m, speed_mps) in [(6.0, 4.0), (12.0, 8.0), (40.0, 14.0), (300.0, 30.0), (8.0, -2.0)] {
            let on = |time_s: f64| {
                let angle = speed_mps * time_s / radius_m;
                (DVec2::new(angle.sin(), 1.0 - angle.cos()) * radius_m, angle)
            };
            let points = (0..8).map(|i| f64::from(i) * 0.5).map(|t| waypoint(t, wrap(on(t).1), on(t).0)).collect();
            let course = Course::new(points, Some(AXLE_M));
            for i in 0..=350 {
                let time_s = f64::from(i) * 0.01;
                let ((found, heading), (expected, angle)) = (axle(&course, time_s), on(time_s));
                let off_m = (found.distance(DVec2::new(0.0, radius_m)) - radius_m).abs();
                assert!(off_m < 0.002, "{radius_m} m at {time_s} s: {off_m} m off the circle");
                assert!(found.distance(expected) < 0.02, "{radius_m} m at {time_s} s: {found} {expected}");
                assert!(wrap(heading - angle).abs() < 0.01, "{radius_m} m at {time_s} s: {heading} {angle}");
            }
            let slip_m = slip_m(&course, 3.5, 10.0);
            assert!(slip_m < 1e-3, "{radius_m} m: {slip_m}");
        }
    }

    #[test]
    fn annotated_poses_are_met_and_their_errors_slip_by_centimetres() {
        // Straight on at 10 m/s, each heading off by up to two degrees and each place by up to five centimetres.
        let error = |i: i32| (f64::from((i * 7919) % 13) / 6.0 - 1.0, f64::from((i * 104_729) % 11) / 5.0 - 1.0);
        let points: Vec<Waypoint> = (0..40)
            .map(|i| {
                let (turn, aside) = error(i);
                waypoint(f64::from(i) * 0.5, 0.035 * turn, DVec2::new(5.0 * f64::from(i), 0.05 * aside))
            })
            .collect();
        let course = Course::new(points.clone(), Some(AXLE_M));
        for point in &points {
            let (rotation, position) = course.at(point.time_s);
            assert!(position.distance(point.position) < 1e-9 && rotation.angle_between(point.rotation) < 1e-7);
        }
        assert!(course.slips_m().all(|slip_m| slip_m <= SLIP_M + 1e-12));
        let slip_m = slip_m(&course, 19.5, 10.0);
        assert!(slip_m < 0.02, "{slip_m}");
        // What straight lines and turning on the spot would do.
        let naive = points.windows(2).map(|p| {
            let middle = yaw_rad(p[0].rotation.slerp(p[1].rotation, 0.5));
            (foot(&p[1], AXLE_M) - foot(&p[0], AXLE_M)).perp_dot(DVec2::from_angle(middle)).abs()
        });
        assert!(naive.fold(0.0, f64::max) > 0.1, "the errors are some");
    }

    #[test]
    fn a_stop_stays_a_stop_and_nobody_creeps_or_overshoots() {
        // It brakes, stands for two seconds while the annotator's hand trembles, and sets out.
        let way_m = [0.0, 4.0, 7.0, 9.0, 10.0, 10.01, 10.0, 10.012, 10.005, 11.0, 13.0, 16.0];
        let points = (0..).zip(way_m).map(|(i, x)| waypoint(f64::from(i) * 0.5, 0.0, DVec2::new(x, 0.0))).collect();
        let course = Course::new(points, Some(AXLE_M));
        let mut before = f64::NEG_INFINITY;
        for i in 0..=550 {
            let time_s = f64::from(i) * 0.01;
            let x = axle(&course, time_s).0.x;
            assert!(x >= before - 1e-12, "{time_s} s: back from {before} to {x}");
            if (2.0..=4.0).contains(&time_s) {
                assert_eq!(x, 10.0, "{time_s} s");
            }
            before = x;
        }
        // Speeds join: no jolt at a keyframe while it rolls.
        let mps = |time_s: f64| (axle(&course, time_s + 1e-4).0.x - axle(&course, time_s).0.x) / 1e-4;
        for time_s in [0.5, 1.0, 1.5, 2.0, 4.5, 5.0] {
            assert!((mps(time_s) - mps(time_s - 1e-4)).abs() < 0.05, "{time_s}");
        }
        assert!(mps(2.0 - 2e-4) < 0.05 && mps(4.0) < 0.05);
    }

    #[test]
    fn who_walks_goes_round_corners_and_who_is_turned_round_by_an_annotator_does_not_spin() {
        let places = [[0.0, 0.0], [0.7, 0.0], [1.2, 0.5], [1.2, 1.2], [1.2, 1.2]];
        let walker = |(i, at): (usize, [f64; 2])| Waypoint {
            time_s: i as f64 * 0.5,
            rotation: DQuat::from_rotation_z(0.4 * i as f64),
            position: DVec2::from_array(at).extend(0.9),
        };
        let course = Course::new(places.into_iter().enumerate().map(walker).collect(), None);
        let at = |time_s: f64| course.at(time_s).1.truncate();
        for i in 0..200 {
            let step_m = at(f64::from(i + 1) * 0.01).distance(at(f64::from(i) * 0.01));
            assert!(step_m < 0.025, "{i}: {step_m}");
        }
        assert!((at(0.75).y) < 0.25 && at(1.75).distance(DVec2::new(1.2, 1.2)) < 1e-9);
        let yaw = yaw_rad(course.at(1.75).0);
        assert!((yaw - 1.4).abs() < 1e-9, "turns on the spot: {yaw}");
        // A parked car whose box lies the other way round in the second keyframe.
        let flipped = [(0.0, 0.0), (0.5, PI - 0.05)].map(|(t, yaw)| Waypoint {
            time_s: t,
            rotation: DQuat::from_rotation_z(yaw),
            position: DVec3::new(3.0, 0.0, 0.8),
        });
        let course = Course::new(flipped.to_vec(), Some(AXLE_M));
        for time_s in [0.1, 0.2, 0.3, 0.4] {
            let yaw = yaw_rad(course.at(time_s).0);
            assert!(yaw.abs() < 1e-9 || (yaw - PI + 0.05).abs() < 1e-9, "{time_s}: {yaw}");
        }
    }
}
