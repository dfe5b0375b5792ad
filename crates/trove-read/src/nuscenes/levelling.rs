//! The vehicle's height and tilt, which nuScenes leaves out.
//!
//! Every ego pose has z = 0, so on a slope the same standing cone rises or sinks from keyframe to keyframe by up to a
//! metre. What stands still tells the truth: for each keyframe a small rigid motion (height, and tilt about two axes)
//! is sought after which all standing objects keep their heights. Camera, LiDAR and boxes of a keyframe move together,
//! so every projection stays what the devkit says.
//!
//! Least squares with Huber's weights; the objects' heights are eliminated, and a dense system of three unknowns a
//! keyframe is left.

use glam::{DQuat, DVec2, DVec3};
use trove_model::{Drive, Outcome, Pose, Report, Track, World};

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
/// Weights of what is believed without evidence: tilts are near 0 (1/20 rad), heights change little (3 m a keyframe),
/// and the first keyframe is at height 0.
const TILT_PRIOR: f64 = 400.0;
const CHANGE_PRIOR: f64 = 0.1;
const START_PRIOR: f64 = 1e6;

/// A standing object's bottom at a keyframe.
struct Sight {
    keyframe: usize,
    /// Derivatives of its height by the keyframe's height and tilts: 1 and the distance to the vehicle in x and y.
    slope: [f64; 3],
    height_m: f64,
    weight: f64,
    residual_m: f64,
}

/// Moves each keyframe of a drive so that what stands still keeps its height.
pub(super) fn level(drive: &mut Drive, report: &Report) {
    let mut objects: Vec<Vec<Sight>> =
        drive.tracks.iter().filter(|track| stands(track)).map(|track| sights(track, drive)).collect();
    objects.retain(|sights| sights.len() >= LEAST_BOXES);
    if objects.is_empty() {
        return;
    }
    let mut motion = vec![0.0; 3 * drive.keyframes.len()];
    settle(&mut objects, &motion);
    report.measure("nuscenes.standing_height_error_before_m", median_residual_m(&objects));
    for _ in 0..ROUNDS {
        motion = solve(&objects, drive.keyframes.len());
        settle(&mut objects, &motion);
    }
    report.measure("nuscenes.standing_height_error_after_m", median_residual_m(&objects));
    if motion.iter().any(|m| m.abs() > NOTICEABLE) {
        report.note(Outcome::Guessed, "height and tilt of the vehicle, from static objects", &drive.id);
    }
    apply(drive, &motion);
}

fn stands(track: &Track) -> bool {
    let position = |(_, cuboid): &(usize, trove_model::Cuboid)| cuboid.world_from_body.translation.truncate();
    trove_model::Bounds::around(track.boxes.iter().map(position))
        .is_some_and(|bounds| bounds.size_m().max_element() < STANDING_M)
}

fn sights(track: &Track, drive: &Drive) -> Vec<Sight> {
    let sight = |&(keyframe, cuboid): &(usize, trove_model::Cuboid)| {
        let centre = cuboid.world_from_body.translation;
        let from_ego: DVec2 = (centre - drive.keyframes[keyframe].world_from_ego.translation).truncate();
        let distance_m = from_ego.length();
        let share = 1.0 / (1.0 + (distance_m / HALF_WEIGHT_M).powi(2));
        (distance_m < REACH_M).then(|| Sight {
            keyframe,
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
        self.height_m + (0..3).map(|i| self.slope[i] * motion[3 * self.keyframe + i]).sum::<f64>()
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

/// Height and two tilts of each keyframe.
fn solve(objects: &[Vec<Sight>], keyframes: usize) -> Vec<f64> {
    let n = 3 * keyframes;
    let (mut matrix, mut right) = (vec![0.0; n * n], vec![0.0; n]);
    for sights in objects {
        // The object's own height is the weighted mean of its sights, so it leaves the sums less their mean's.
        let total: f64 = sights.iter().map(Sight::robust_weight).sum();
        let mean_m = sights.iter().map(|s| s.robust_weight() * s.height_m).sum::<f64>() / total;
        for s in sights {
            for i in 0..3 {
                let row = 3 * s.keyframe + i;
                right[row] -= s.robust_weight() * s.slope[i] * (s.height_m - mean_m);
                for j in 0..3 {
                    matrix[row * n + 3 * s.keyframe + j] += s.robust_weight() * s.slope[i] * s.slope[j];
                }
                for other in sights {
                    let both = s.robust_weight() * other.robust_weight() / total;
                    for j in 0..3 {
                        matrix[row * n + 3 * other.keyframe + j] -= both * s.slope[i] * other.slope[j];
                    }
                }
            }
        }
    }
    matrix[0] += START_PRIOR;
    for k in 0..keyframes {
        for tilt in [3 * k + 1, 3 * k + 2] {
            matrix[tilt * n + tilt] += TILT_PRIOR;
        }
        if k + 1 < keyframes {
            let (a, b) = (3 * k, 3 * k + 3);
            for (row, column, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
                matrix[row * n + column] += sign * CHANGE_PRIOR;
            }
        }
    }
    cholesky_solve(matrix, right)
}

/// Solves a symmetric positive definite system, which the priors make of it.
fn cholesky_solve(mut matrix: Vec<f64>, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    for j in 0..n {
        for i in j..n {
            let dot: f64 = (0..j).map(|k| matrix[i * n + k] * matrix[j * n + k]).sum();
            let value = matrix[i * n + j] - dot;
            matrix[i * n + j] = if i == j { value.max(f64::MIN_POSITIVE).sqrt() } else { value / matrix[j * n + j] };
        }
    }
    for i in 0..n {
        let dot: f64 = (0..i).map(|k| matrix[i * n + k] * right[k]).sum();
        right[i] = (right[i] - dot) / matrix[i * n + i];
    }
    for i in (0..n).rev() {
        let dot: f64 = (i + 1..n).map(|k| matrix[k * n + i] * right[k]).sum();
        right[i] = (right[i] - dot) / matrix[i * n + i];
    }
    right
}

/// Moves everything of each keyframe, its tracks' boxes included.
fn apply(drive: &mut Drive, motion: &[f64]) {
    let motions: Vec<Pose<World, World>> = drive
        .keyframes
        .iter()
        .zip(motion.chunks_exact(3))
        .map(|(keyframe, m)| {
            let ego = keyframe.world_from_ego.translation;
            let rotation = DQuat::from_scaled_axis(DVec3::new(m[2], -m[1], 0.0));
            Pose::new(rotation, ego + DVec3::Z * m[0] - rotation * ego)
        })
        .collect();
    for (keyframe, &moved) in drive.keyframes.iter_mut().zip(&motions) {
        keyframe.world_from_ego = moved * keyframe.world_from_ego;
        for exposure in &mut keyframe.exposures {
            exposure.world_from_ego = moved * exposure.world_from_ego;
        }
        for object in &mut keyframe.boxes {
            object.cuboid.world_from_body = moved * object.cuboid.world_from_body;
        }
        if let Some(sweep) = &mut keyframe.lidar {
            sweep.origin_world = moved.point(sweep.origin_world);
            for point in &mut sweep.points_world {
                *point = moved.point(point.as_dvec3()).as_vec3();
            }
        }
    }
    for (keyframe, cuboid) in drive.tracks.iter_mut().flat_map(|track| &mut track.boxes) {
        cuboid.world_from_body = motions[*keyframe] * cuboid.world_from_body;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::{Cuboid, DriveOrigin, Ego, EgoBody, Keyframe, Kind, MapProjection};

    /// A vehicle that drives up a slope of 4 % past cones, recorded as nuScenes does: always at height 0.
    fn drive_uphill() -> Drive {
        let ego = |k: usize| DVec3::new(5.0 * k as f64, 0.0, 0.0);
        let keyframe = |k| Keyframe {
            time_ns: 0,
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
            tracks: (0..16).map(track).collect(),
            lane_map: None,
            licence: String::new(),
        }
    }

    #[test]
    fn a_vehicle_on_a_slope_rises_and_what_stands_keeps_its_height() {
        let (mut drive, report) = (drive_uphill(), Report::default());
        level(&mut drive, &report);
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
        level(&mut drive, &Report::default());
        for (after, before) in drive.tracks.iter().zip(&before.tracks).flat_map(|(a, b)| a.boxes.iter().zip(&b.boxes)) {
            let in_ego = |drive: &Drive, (k, cuboid): &(usize, Cuboid)| {
                drive.keyframes[*k].world_from_ego.inverse().point(cuboid.world_from_body.translation)
            };
            let (after_ego, before_ego) = (in_ego(&drive, after), in_ego(&drive_uphill(), before));
            assert!((after_ego - before_ego).length() < 1e-9);
        }
    }

    #[test]
    fn a_level_drive_is_left_alone() {
        let mut drive = drive_uphill();
        for (_, cuboid) in drive.tracks.iter_mut().flat_map(|track| &mut track.boxes) {
            cuboid.world_from_body.translation.z = 0.5;
        }
        let before = drive.clone();
        level(&mut drive, &Report::default());
        assert_eq!(drive, before);
    }
}
