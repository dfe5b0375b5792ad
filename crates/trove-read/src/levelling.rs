//! The vehicle's height and tilt, which a recording leaves out (nuScenes) or lets drift (KITTI).
//!
//! Where every ego pose has z = 0, on a slope the same standing cone rises or sinks from keyframe to keyframe by up to a
//! metre. What stands still tells the truth: a small rigid motion (height, and tilt about two axes) is sought after which
//! all standing objects keep their heights. It is sought at knots, and linear in time between them. Camera, LiDAR and
//! boxes of a keyframe move together, so every projection stays what the devkit says; what was recorded between two of them
//! moves with both.
//!
//! Least squares with Huber's weights; the objects' heights are eliminated, and a system of three unknowns a knot is left.

use std::collections::BTreeMap;

use glam::{DQuat, DVec2, DVec3};
use trove_model::{Drive, Keyframe, Outcome, Pose, Report, Track, World};

/// An object that moves less than this over the drive stands still.
const STANDING_M: f64 = 1.0;
/// A track with fewer boxes says nothing about change.
const LEAST_BOXES: usize = 3;
/// Boxes farther from the vehicle are annotated from a few points only.
const REACH_M: f64 = 50.0;
/// Distance at which a box counts half.
const HALF_WEIGHT_M: f64 = 30.0;
/// Residuals above it count linearly, not squared: an annotator's slip, or a person who sits down.
const HUBER_M: f64 = 0.05;
/// Rounds of reweighting; the solution moves by less than a millimetre after that.
const ROUNDS: usize = 10;
/// Metres or radians below which a motion is not worth a word.
const NOTICEABLE: f64 = 1e-3;
/// The first knot is at height 0.
const START_PRIOR: f64 = 1e6;
/// The system of more knots would take seconds; in longer drives they lie farther apart.
const MOST_KNOTS: usize = 600;

/// What is believed of a recording's heights without evidence, as weights against a standing object's, in m⁻².
pub(crate) struct Trust {
    /// That tilts are as recorded: the reciprocal square of a likely error, radians, over that of a height of 1 m.
    pub(crate) tilt: f64,
    /// That the error of the height does not change from knot to knot: likewise, metres.
    pub(crate) change: f64,
    /// Time from knot to knot, nanoseconds; 0 where every keyframe is one.
    pub(crate) step_ns: i64,
}

/// When there are knots, nanoseconds, each later than the one before.
struct Knots(Vec<i64>);

/// Between which knots a moment lies: the first of them, and the second's share.
#[derive(Clone, Copy)]
struct Between {
    knot: usize,
    share: f64,
}

/// A standing object's bottom at a keyframe.
struct Sight {
    between: Between,
    /// Derivatives of its height by the vehicle's height and tilts: 1 and the distance to the vehicle in x and y.
    slope: [f64; 3],
    height_m: f64,
    weight: f64,
    residual_m: f64,
}

/// Moves each keyframe of a drive so that what stands still keeps its height.
pub(crate) fn level(drive: &mut Drive, trust: &Trust, report: &Report) {
    let knots = Knots::of(drive, trust.step_ns);
    let mut objects: Vec<Vec<Sight>> =
        drive.tracks.iter().filter(|track| stands(track)).map(|track| sights(track, drive, &knots)).collect();
    objects.retain(|sights| sights.len() >= LEAST_BOXES);
    if objects.is_empty() {
        return;
    }
    let mut motion = vec![0.0; 3 * knots.0.len()];
    settle(&mut objects, &motion);
    let measured = |when: &str| format!("{}.standing_height_error_{when}_m", drive.dataset);
    report.measure(&measured("before"), median_residual_m(&objects));
    for _ in 0..ROUNDS {
        motion = solve(&objects, knots.0.len(), trust);
        settle(&mut objects, &motion);
    }
    report.measure(&measured("after"), median_residual_m(&objects));
    if motion.iter().any(|m| m.abs() > NOTICEABLE) {
        report.note(Outcome::Guessed, "height and tilt of the vehicle, from static objects", &drive.id);
    }
    apply(drive, &knots, &motion);
}

impl Knots {
    fn of(drive: &Drive, step_ns: i64) -> Self {
        let mut times_ns: Vec<i64> = drive.keyframes.iter().map(|k| k.time_ns).collect();
        times_ns.dedup();
        let (Some(&first), Some(&last)) = (times_ns.first(), times_ns.last()) else { return Self(times_ns) };
        if step_ns <= 0 || first == last {
            return Self(times_ns);
        }
        let duration = last.saturating_sub(first) as f64;
        let spans = (duration / step_ns as f64).ceil().clamp(1.0, (MOST_KNOTS - 1) as f64);
        let mut evenly: Vec<i64> =
            (0..=spans as i64).map(|i| first.saturating_add((i as f64 / spans * duration).round() as i64)).collect();
        evenly.dedup();
        Self(evenly)
    }

    /// Where a time lies; before the first knot as at it, and likewise after the last.
    fn at(&self, time_ns: i64) -> Between {
        let knot = self.0.partition_point(|t| *t <= time_ns).saturating_sub(1);
        let share = match self.0.get(knot..knot + 2) {
            Some(&[from, to]) => time_ns.saturating_sub(from).max(0) as f64 / to.saturating_sub(from) as f64,
            _ => 0.0,
        };
        Between { knot, share }
    }
}

impl Between {
    /// Height and two tilts at the moment.
    fn motion(self, motion: &[f64]) -> [f64; 3] {
        let of = |i: usize| motion[3 * self.knot + i];
        // The last knot may have none after it.
        let next = |i: usize| if self.share > 0.0 { motion[3 * (self.knot + 1) + i] } else { 0.0 };
        [0, 1, 2].map(|i| (1.0 - self.share) * of(i) + self.share * next(i))
    }
}

fn stands(track: &Track) -> bool {
    let position = |(_, cuboid): &(usize, trove_model::Cuboid)| cuboid.world_from_body.translation.truncate();
    trove_model::Bounds::around(track.boxes.iter().map(position))
        .is_some_and(|bounds| bounds.size_m().max_element() < STANDING_M)
}

fn sights(track: &Track, drive: &Drive, knots: &Knots) -> Vec<Sight> {
    let sight = |&(keyframe, cuboid): &(usize, trove_model::Cuboid)| {
        let centre = cuboid.world_from_body.translation;
        let from_ego: DVec2 = (centre - drive.keyframes[keyframe].world_from_ego.translation).truncate();
        let distance_m = from_ego.length();
        let share = 1.0 / (1.0 + (distance_m / HALF_WEIGHT_M).powi(2));
        (distance_m < REACH_M).then(|| Sight {
            between: knots.at(drive.keyframes[keyframe].time_ns),
            slope: [1.0, from_ego.x, from_ego.y],
            height_m: centre.z - cuboid.size_m.z / 2.0,
            weight: share * share,
            residual_m: 0.0,
        })
    };
    track.boxes.iter().filter_map(sight).collect()
}

impl Sight {
    fn robust_weight(&self) -> f64 {
        self.weight / (self.residual_m.abs() / HUBER_M).max(1.0)
    }

    fn moved_m(&self, motion: &[f64]) -> f64 {
        let at = self.between.motion(motion);
        self.height_m + (0..3).map(|i| self.slope[i] * at[i]).sum::<f64>()
    }

    /// Derivatives of its height by the unknowns that it depends on, by their indices.
    fn derivatives(&self) -> impl Iterator<Item = (usize, f64)> + Clone + '_ {
        let Between { knot, share } = self.between;
        let of = move |knot: usize, part: f64| (0..3).map(move |i| (3 * knot + i, part * self.slope[i]));
        of(knot, 1.0 - share).chain(of(knot + 1, share).filter(move |_| share > 0.0))
    }
}

/// Sets every sight's residual against its object's mean height.
fn settle(objects: &mut [Vec<Sight>], motion: &[f64]) {
    for sights in objects {
        let total: f64 = sights.iter().map(Sight::robust_weight).sum();
        let mean_m = sights.iter().map(|s| s.robust_weight() * s.moved_m(motion)).sum::<f64>() / total;
        for sight in sights {
            sight.residual_m = sight.moved_m(motion) - mean_m;
        }
    }
}

fn median_residual_m(objects: &[Vec<Sight>]) -> f64 {
    let mut residuals: Vec<f64> = objects.iter().flatten().map(|s| s.residual_m.abs()).collect();
    residuals.sort_by(f64::total_cmp);
    residuals[residuals.len() / 2]
}

/// Height and two tilts of each knot.
fn solve(objects: &[Vec<Sight>], knots: usize, trust: &Trust) -> Vec<f64> {
    let n = 3 * knots;
    let (mut matrix, mut right) = (vec![0.0; n * n], vec![0.0; n]);
    for sights in objects {
        // The object's own height is the weighted mean of its sights, so it leaves the sums less their mean's.
        let total: f64 = sights.iter().map(Sight::robust_weight).sum();
        let mean_m = sights.iter().map(|s| s.robust_weight() * s.height_m).sum::<f64>() / total;
        let mut together = BTreeMap::<usize, f64>::new();
        for s in sights {
            for (row, a) in s.derivatives() {
                right[row] -= s.robust_weight() * a * (s.height_m - mean_m);
                *together.entry(row).or_default() += s.robust_weight() * a;
                for (column, b) in s.derivatives() {
                    matrix[row * n + column] += s.robust_weight() * a * b;
                }
            }
        }
        for (row, a) in &together {
            for (column, b) in &together {
                matrix[row * n + column] -= a * b / total;
            }
        }
    }
    matrix[0] += START_PRIOR;
    for k in 0..knots {
        for tilt in [3 * k + 1, 3 * k + 2] {
            matrix[tilt * n + tilt] += trust.tilt;
        }
        if k + 1 < knots {
            let (a, b) = (3 * k, 3 * k + 3);
            for (row, column, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
                matrix[row * n + column] += sign * trust.change;
            }
        }
    }
    cholesky_solve(matrix, right)
}

/// Solves a symmetric positive definite system, which the priors make of it. What is 0 before a row's first number stays
/// so, and objects are seen for a while only, so most of a long drive's system is passed over.
fn cholesky_solve(mut matrix: Vec<f64>, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    let first: Vec<usize> = (0..n).map(|i| (0..i).find(|k| matrix[i * n + k] != 0.0).unwrap_or(i)).collect();
    for i in 0..n {
        for j in first[i]..=i {
            let dot: f64 = (first[i].max(first[j])..j).map(|k| matrix[i * n + k] * matrix[j * n + k]).sum();
            let value = matrix[i * n + j] - dot;
            matrix[i * n + j] = if i == j { value.max(f64::MIN_POSITIVE).sqrt() } else { value / matrix[j * n + j] };
        }
    }
    for i in 0..n {
        let dot: f64 = (first[i]..i).map(|k| matrix[i * n + k] * right[k]).sum();
        right[i] = (right[i] - dot) / matrix[i * n + i];
    }
    for i in (0..n).rev() {
        right[i] /= matrix[i * n + i];
        for k in first[i]..i {
            right[k] -= matrix[i * n + k] * right[i];
        }
    }
    right
}

/// Moves everything of each keyframe, its tracks' boxes included, and what was recorded between them.
fn apply(drive: &mut Drive, knots: &Knots, motion: &[f64]) {
    let moved = |time_ns: i64, ego: DVec3| {
        let m = knots.at(time_ns).motion(motion);
        let rotation = DQuat::from_scaled_axis(DVec3::new(m[2], -m[1], 0.0));
        Pose::<World, World>::new(rotation, ego + DVec3::Z * m[0] - rotation * ego)
    };
    let of_keyframe = |keyframe: &Keyframe| moved(keyframe.time_ns, keyframe.world_from_ego.translation);
    let motions: Vec<_> = drive.keyframes.iter().map(of_keyframe).collect();
    let mut sweeps = std::mem::take(&mut drive.sweeps);
    for sweep in &mut sweeps {
        let Some(ego) = drive.world_from_ego_at(sweep.time_ns) else { continue };
        sweep.lidar.move_by(&moved(sweep.time_ns, ego.translation));
    }
    drive.sweeps = sweeps;
    drive.path = drive.path.map(|time_ns, pose| moved(time_ns, pose.translation) * *pose);
    for (keyframe, moved) in drive.keyframes.iter_mut().zip(&motions) {
        keyframe.world_from_ego = *moved * keyframe.world_from_ego;
        for exposure in &mut keyframe.exposures {
            exposure.world_from_ego = *moved * exposure.world_from_ego;
        }
        for object in &mut keyframe.boxes {
            object.cuboid.world_from_body = *moved * object.cuboid.world_from_body;
        }
        if let Some(sweep) = &mut keyframe.lidar {
            sweep.move_by(moved);
        }
    }
    for (keyframe, cuboid) in drive.tracks.iter_mut().flat_map(|track| &mut track.boxes) {
        cuboid.world_from_body = motions[*keyframe] * cuboid.world_from_body;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::{Cuboid, DriveOrigin, Ego, EgoBody, Kind, LidarSweep, MapProjection, Sweep, Trajectory};

    /// As nuScenes', whose heights are none.
    const BLIND: Trust = Trust { tilt: 400.0, change: 0.1, step_ns: 0 };

    /// A vehicle that drives up a slope of 4 % past cones, recorded as nuScenes does: always at height 0.
    fn drive_uphill() -> Drive {
        let ego = |k: usize| DVec3::new(5.0 * k as f64, 0.0, 0.0);
        let keyframe = |k| Keyframe {
            time_ns: 500_000_000 * k as i64,
            token: String::new(),
            world_from_ego: Pose::<World, Ego>::from_yaw(0.0, ego(k)),
            exposures: Vec::new(),
            boxes: Vec::new(),
            lidar: None,
        };
        let track = |i: usize| {
            let (x, y) = (4.0 * i as f64, if i.is_multiple_of(2) { 6.0 } else { -7.0 });
            let seen = |k: usize| {
                let centre = DVec3::new(x, y, 0.04 * (x - ego(k).x) + 0.5);
                (k, Cuboid { world_from_body: Pose::from_yaw(0.0, centre), size_m: DVec3::new(0.4, 0.4, 1.0) })
            };
            let near = |&k: &usize| (x - ego(k).x).abs() < 30.0;
            Track { token: String::new(), kind: Kind::TrafficCone, boxes: (0..10).filter(near).map(seen).collect() }
        };
        Drive {
            id: "uphill".into(),
            dataset: "nuscenes".into(),
            origin: DriveOrigin::Recorded,
            place: String::new(),
            is_georeferenced: true,
            projection: MapProjection::spherical(0.0, 0.0, DVec2::ZERO),
            rig: Vec::new(),
            ego_body: EgoBody { centre_ego: DVec3::ZERO, size_m: DVec3::ONE },
            keyframes: (0..10).map(keyframe).collect(),
            path: Trajectory::default(),
            lidars: Vec::new(),
            sweeps: Vec::new(),
            tracks: (0..16).map(track).collect(),
            lane_map: None,
            licence: String::new(),
        }
    }

    #[test]
    fn a_vehicle_on_a_slope_rises_and_what_stands_keeps_its_height() {
        let (mut drive, report) = (drive_uphill(), Report::default());
        level(&mut drive, &BLIND, &report);
        let climbed_m =
            drive.keyframes[9].world_from_ego.translation.z - drive.keyframes[0].world_from_ego.translation.z;
        assert!((climbed_m - 0.04 * 45.0).abs() < 0.1, "climbed {climbed_m} m");
        for track in &drive.tracks {
            let heights = track.boxes.iter().map(|(_, cuboid)| cuboid.world_from_body.translation.z);
            let (low, high) = heights.fold((f64::MAX, f64::MIN), |(l, h), z| (l.min(z), h.max(z)));
            assert!(high - low < 0.02, "a cone moves by {} m", high - low);
        }
    }

    #[test]
    fn what_a_keyframe_sees_stays_where_it_was_seen() {
        let (mut drive, before) = (drive_uphill(), drive_uphill());
        level(&mut drive, &BLIND, &Report::default());
        for (after, before) in drive.tracks.iter().zip(&before.tracks).flat_map(|(a, b)| a.boxes.iter().zip(&b.boxes)) {
            let in_ego = |drive: &Drive, (k, cuboid): &(usize, Cuboid)| {
                drive.keyframes[*k].world_from_ego.inverse().point(cuboid.world_from_body.translation)
            };
            let (after_ego, before_ego) = (in_ego(&drive, after), in_ego(&drive_uphill(), before));
            assert!((after_ego - before_ego).length() < 1e-9);
        }
    }

    #[test]
    fn what_was_recorded_between_keyframes_rises_with_them() {
        let mut drive = drive_uphill();
        let pose = |i: i64| Pose::<World, Ego>::from_yaw(0.0, DVec3::new(0.5 * i as f64, 0.0, 0.0));
        drive.path = Trajectory::new((0..=90).map(|i| (50_000_000 * i, pose(i))).collect()).0;
        let origin_world = pose(33).translation + DVec3::Z * 1.8;
        let ground = (pose(33).translation + DVec3::new(10.0, 0.0, 0.4)).as_vec3();
        let lidar = LidarSweep { origin_world, points_world: vec![ground], classes: Vec::new() };
        drive.sweeps = vec![Sweep { time_ns: 50_000_000 * 33, lidar }];
        level(&mut drive, &BLIND, &Report::default());
        for keyframe in &drive.keyframes {
            assert_eq!(drive.path.at(keyframe.time_ns), Some(keyframe.world_from_ego));
        }
        for (time_ns, pose) in drive.path.moments() {
            let slope_m = 0.04 * 1e-8 * *time_ns as f64;
            assert!((pose.translation.z - slope_m).abs() < 0.1, "{time_ns}: {}", pose.translation.z);
        }
        let (ego, lidar) = (drive.path.at(50_000_000 * 33).unwrap(), &drive.sweeps[0].lidar);
        assert!(ego.inverse().point(lidar.origin_world).distance(DVec3::Z * 1.8) < 1e-9);
        let seen = ego.inverse().point(lidar.points_world[0].as_dvec3());
        assert!(seen.distance(DVec3::new(10.0, 0.0, 0.4)) < 1e-5, "{seen}");
    }

    #[test]
    fn between_knots_a_drift_is_linear() {
        // The slope's height grows evenly, so four knots in place of ten keyframes tell as much.
        let (mut drive, report) = (drive_uphill(), Report::default());
        let trust = Trust { step_ns: 1_500_000_000, ..BLIND };
        assert_eq!(Knots::of(&drive, trust.step_ns).0.len(), 4);
        level(&mut drive, &trust, &report);
        let climbed_m =
            drive.keyframes[9].world_from_ego.translation.z - drive.keyframes[0].world_from_ego.translation.z;
        assert!((climbed_m - 0.04 * 45.0).abs() < 0.1, "climbed {climbed_m} m");
        let error_m = report.measurements().into_iter().find(|m| m.name.ends_with("after_m")).unwrap().value;
        assert!(error_m < 0.02, "{error_m} m");
    }

    #[test]
    fn a_system_with_gaps_is_solved_as_a_whole_one() {
        let (n, mut matrix) = (6, vec![0.0; 36]);
        let right: Vec<f64> = (0..n).map(|i| i as f64 - 2.0).collect();
        for i in 0..n {
            matrix[i * n + i] = 4.0;
            if i >= 2 {
                (matrix[i * n + i - 2], matrix[(i - 2) * n + i]) = (1.0, 1.0);
            }
        }
        let found = cholesky_solve(matrix.clone(), right.clone());
        for i in 0..n {
            let product: f64 = (0..n).map(|j| matrix[i * n + j] * found[j]).sum();
            assert!((product - right[i]).abs() < 1e-12, "row {i}");
        }
    }

    #[test]
    fn a_level_drive_is_left_alone() {
        let mut drive = drive_uphill();
        for (_, cuboid) in drive.tracks.iter_mut().flat_map(|track| &mut track.boxes) {
            cuboid.world_from_body.translation.z = 0.5;
        }
        let before = drive.clone();
        level(&mut drive, &BLIND, &Report::default());
        assert_eq!(drive, before);
    }
}
