//! A smoothed trace → keyframes.

use glam::{DQuat, DVec2, DVec3, EulerRot};
use trove_model::{
    Drive, DriveOrigin, Ego, Exposure, Keyframe, MapProjection, Outcome, Pose, Report, RigCamera, Trajectory, World,
};

use super::clean;
use super::fix::{Fault, Fix};
use super::smooth::{Sample, smoothed};
use crate::plain::ORDINARY_CAR;

/// Slower than this nothing is driven, m/s: the motion says no heading, and the way does not grow.
const STANDING_MPS: f64 = 0.7;
/// No road is steeper; heights of receivers are noisy.
const STEEPEST: f64 = 0.35;
/// Longer times without a fix are told, seconds.
const LONG_GAP_S: f64 = 10.0;
/// More keyframes than this are a slip in the recipe.
const MOST_KEYFRAMES: f64 = 200_000.0;
/// Nanoseconds of 1 January 2000: devices that count from elsewhere are earlier.
const YEAR_2000_NS: i64 = 946_684_800_000_000_000;
/// What their traces begin at: noon of 21 June 2000 at longitude 0.
const UNKNOWN_NS: i64 = 961_588_800_000_000_000;
/// The sun takes so long for a degree, nanoseconds.
const DEGREE_NS: f64 = 240e9;

/// How far apart keyframes stand.
#[derive(Clone, Copy, Debug)]
pub(super) enum Apart {
    Metres(f64),
    Seconds(f64),
}

/// The drive of a trace; the error says what it lacks.
pub(super) fn drive(
    name: &str,
    fixes: &[Fix],
    apart: Apart,
    rig: &[RigCamera],
    licence: &str,
    report: &Report,
) -> Result<Drive, Fault> {
    let kept = clean::possible(fixes, report);
    let Some(first) = kept.first() else { return Err(Fault::new("the whole", "positions with their times", "none")) };
    let start_ns = if first.time_ns < YEAR_2000_NS {
        let what = "GPS: times that do not count from 1970: noon in June, unless light.time says when it was";
        report.note(Outcome::Guessed, what, name);
        UNKNOWN_NS - (first.lon_deg * DEGREE_NS) as i64
    } else {
        first.time_ns
    };
    let projection = MapProjection::ellipsoidal(first.lat_deg, first.lon_deg, DVec2::ZERO);
    let seconds = |fix: &Fix| fix.time_ns.saturating_sub(first.time_ns) as f64 * 1e-9;
    let times_s: Vec<f64> = kept.iter().map(seconds).collect();
    for gap in times_s.windows(2).filter(|w| w[1] - w[0] > LONG_GAP_S) {
        let example = format!("{name}: {:.0} s from {:.0} s on", gap[1] - gap[0], gap[0]);
        report.note(Outcome::Guessed, "GPS: way between fixes far apart in time: straight", example);
    }
    let mut alt_m = first.alt_m.unwrap_or(0.0);
    let start_m = alt_m;
    let position = |fix: &Fix| {
        alt_m = fix.alt_m.unwrap_or(alt_m);
        projection.world_from_geo(fix.lat_deg, fix.lon_deg).extend(alt_m - start_m)
    };
    let positions: Vec<DVec3> = kept.iter().map(position).collect();
    let samples = smoothed(&times_s, &positions);
    let yaws = yaws(&kept, &samples, name, report)?;
    let poses = poses(&samples, &yaws);
    let ways = ways(&samples);
    let last = samples.len() - 1;
    let (whole, step) = match apart {
        Apart::Metres(step) => (ways[last], step),
        Apart::Seconds(step) => (times_s[last], step),
    };
    if whole / step > MOST_KEYFRAMES {
        let found = format!("{:.0}", whole / step);
        return Err(Fault::new("spacing_m", &format!("at most {MOST_KEYFRAMES} keyframes; space them wider"), &found));
    }
    let scale = if matches!(apart, Apart::Metres(_)) { &ways } else { &times_s };
    let mut keyframes = Vec::new();
    for n in 0..=(whole / step + 1e-9) as usize {
        let (i, share) = between(scale, n as f64 * step);
        let (time_s, world_from_ego) = moment(&samples, &poses, i, share);
        let time_ns = after(start_ns, time_s);
        keyframes.push(keyframe(n, time_ns, world_from_ego, rig));
    }
    report.note(Outcome::Guessed, "recording vehicle's size: that of an ordinary car", name);
    Ok(Drive {
        id: name.to_owned(),
        dataset: "gps".to_owned(),
        origin: DriveOrigin::Recorded,
        place: String::new(),
        projection,
        is_georeferenced: true,
        rig: rig.to_vec(),
        ego_body: ORDINARY_CAR,
        keyframes,
        path: path(start_ns, &samples, &poses),
        lidars: Vec::new(),
        sweeps: Vec::new(),
        tracks: Vec::new(),
        lane_map: None,
        licence: licence.to_owned(),
    })
}

/// The vehicle at each fix.
fn path(first_ns: i64, samples: &[Sample], poses: &[Pose<World, Ego>]) -> Trajectory<World, Ego> {
    let moments = samples.iter().zip(poses).map(|(sample, pose)| (after(first_ns, sample.time_s), *pose));
    Trajectory::new(moments.collect()).0
}

fn after(first_ns: i64, time_s: f64) -> i64 {
    first_ns.saturating_add((time_s * 1e9).round() as i64)
}

fn keyframe(n: usize, time_ns: i64, world_from_ego: Pose<World, Ego>, rig: &[RigCamera]) -> Keyframe {
    let exposure = |(camera, fixed): (usize, &RigCamera)| Exposure {
        camera,
        time_ns,
        world_from_ego,
        lens: fixed.lens,
        ego_from_camera: fixed.ego_from_camera,
        token: None,
        file: None,
    };
    Keyframe {
        time_ns,
        token: format!("{n}"),
        world_from_ego,
        exposures: rig.iter().enumerate().map(exposure).collect(),
        boxes: Vec::new(),
        lidar: None,
    }
}

/// Where the vehicle points at each sample: as the file says, else where it moves; standing, as before or else as next.
fn yaws(kept: &[Fix], samples: &[Sample], name: &str, report: &Report) -> Result<Vec<f64>, Fault> {
    let moving = |s: &Sample| {
        let flat = s.velocity_mps.truncate();
        (flat.length() > STANDING_MPS).then(|| flat.to_angle())
    };
    let told = |fix: &Fix, sample: &Sample| fix.yaw_rad.zip(moving(sample)).map(|(yaw, way)| (yaw - way).cos());
    let agree: Vec<f64> = kept.iter().zip(samples).filter_map(|(fix, sample)| told(fix, sample)).collect();
    // Axes or signs other than what is documented.
    let is_trusted = agree.iter().filter(|&&cos| cos > 0.7).count() * 2 >= agree.len();
    if !is_trusted {
        report.note(Outcome::Substituted, "GPS: headings that do not follow the motion, by the motion", name);
    }
    let of_fix = |(fix, sample): (&Fix, &Sample)| fix.yaw_rad.filter(|_| is_trusted).or_else(|| moving(sample));
    let known: Vec<Option<f64>> = kept.iter().zip(samples).map(of_fix).collect();
    let lacks = || Fault::new("the whole", "a trace that moves, or headings", "one that stands");
    let mut yaw = known.iter().flatten().next().copied().ok_or_else(lacks)?;
    Ok(known
        .into_iter()
        .map(|known| {
            yaw = known.unwrap_or(yaw);
            yaw
        })
        .collect())
}

/// Poses at the samples, pitched by the slope of the way.
fn poses(samples: &[Sample], yaws: &[f64]) -> Vec<Pose<World, Ego>> {
    let mut slope = 0.0;
    let pose = |(sample, &yaw): (&Sample, &f64)| {
        let flat_mps = sample.velocity_mps.truncate().length();
        if flat_mps > STANDING_MPS {
            slope = (sample.velocity_mps.z / flat_mps).clamp(-STEEPEST, STEEPEST);
        }
        let rotation = DQuat::from_euler(EulerRot::ZYX, yaw, -f64::atan(slope), 0.0);
        Pose::new(rotation, sample.position)
    };
    samples.iter().zip(yaws).map(pose).collect()
}

/// How far the vehicle has come at each sample, metres; standing it gets nowhere.
fn ways(samples: &[Sample]) -> Vec<f64> {
    let mut way_m = 0.0;
    let mut ways = vec![0.0];
    for pair in samples.windows(2) {
        let step_m = pair[0].position.distance(pair[1].position);
        if step_m > STANDING_MPS * (pair[1].time_s - pair[0].time_s) {
            way_m += step_m;
        }
        ways.push(way_m);
    }
    ways
}

/// The sample before a value on a scale that never falls, and the share of the step to the next.
fn between(scale: &[f64], value: f64) -> (usize, f64) {
    let after = scale.partition_point(|&at| at < value).clamp(1, scale.len().max(2) - 1);
    let (from, to) = (scale[after - 1], scale.get(after).copied().unwrap_or(scale[after - 1]));
    (after - 1, if to > from { ((value - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 })
}

/// Time and pose between a sample and the next, by their positions and velocities (Hermite).
fn moment(samples: &[Sample], poses: &[Pose<World, Ego>], i: usize, share: f64) -> (f64, Pose<World, Ego>) {
    let (Some(a), Some(b)) = (samples.get(i), samples.get(i + 1)) else { return (samples[i].time_s, poses[i]) };
    let (t, step_s) = (share, b.time_s - a.time_s);
    let mut pose = poses[i].interpolate(&poses[i + 1], t);
    if step_s < LONG_GAP_S {
        let (u, v) = (a.velocity_mps * step_s, b.velocity_mps * step_s);
        let (t2, t3) = (t * t, t * t * t);
        pose.translation = a.position * (2.0 * t3 - 3.0 * t2 + 1.0)
            + u * (t3 - 2.0 * t2 + t)
            + b.position * (3.0 * t2 - 2.0 * t3)
            + v * (t3 - t2);
    }
    (a.time_s + t * step_s, pose)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fixes(positions: impl Iterator<Item = (f64, DVec2)>) -> Vec<Fix> {
        let projection = MapProjection::ellipsoidal(49.0, 8.0, DVec2::ZERO);
        let fix = |(time_s, world)| {
            let (lat_deg, lon_deg) = projection.geo_from_world(world);
            Fix { time_ns: YEAR_2000_NS + (time_s * 1e9) as i64, lat_deg, lon_deg, alt_m: Some(100.0), yaw_rad: None }
        };
        positions.map(fix).collect()
    }

    fn read(fixes: &[Fix], apart: Apart) -> Drive {
        drive("trace", fixes, apart, &[], "", &Report::default()).unwrap()
    }

    #[test]
    fn keyframes_stand_at_equal_distances_and_a_stop_has_none() {
        // East at 10 m/s for 10 s, a stop of a minute, and on.
        let x = |t: f64| if t < 10.0 { 10.0 * t } else { 100.0 + 10.0 * (t - 70.0).max(0.0) };
        let trace = fixes((0..160).map(|i| 0.5 * f64::from(i)).map(|t| (t, DVec2::new(x(t), 0.0))));
        let drive = read(&trace, Apart::Metres(5.0));
        assert_eq!(drive.path.moments().len(), 160, "a pose a fix");
        assert!(drive.path.moments().iter().all(|(_, pose)| pose.translation.y.abs() < 0.1));
        let places: Vec<DVec3> = drive.keyframes.iter().map(|k| k.world_from_ego.translation).collect();
        assert!((places.len() as i32 - 40).abs() <= 1, "{}", places.len());
        for pair in places.windows(2) {
            assert!((pair[0].distance(pair[1]) - 5.0).abs() < 0.5, "{pair:?}");
        }
        assert!(drive.keyframes.iter().all(|k| k.world_from_ego.yaw_rad().abs() < 0.02));
        let standing = read(&trace, Apart::Seconds(2.0));
        assert_eq!(standing.keyframes.len(), 40);
        assert!(standing.keyframes.windows(2).all(|w| w[1].time_ns - w[0].time_ns == 2_000_000_000));
    }

    #[test]
    fn headings_of_the_file_are_taken_where_they_follow_the_motion() {
        let north = |yaw_rad: f64| {
            let mut trace = fixes((0..20).map(|t| (f64::from(t), DVec2::new(0.0, 8.0 * f64::from(t)))));
            trace.iter_mut().for_each(|fix| fix.yaw_rad = Some(yaw_rad));
            let report = Report::default();
            let drive = drive("trace", &trace, Apart::Metres(8.0), &[], "", &report).unwrap();
            (drive.keyframes[5].world_from_ego.yaw_rad(), report.entries().iter().any(|e| e.what.contains("headings")))
        };
        let (yaw, is_told) = north(1.6);
        assert!((yaw - 1.6).abs() < 1e-9 && !is_told);
        let (yaw, is_told) = north(0.0);
        assert!((yaw - std::f64::consts::FRAC_PI_2).abs() < 1e-3 && is_told);
    }

    #[test]
    fn a_trace_that_says_nothing_is_an_error() {
        let error = |fixes: &[Fix], apart| drive("trace", fixes, apart, &[], "", &Report::default()).unwrap_err();
        assert!(error(&[], Apart::Metres(5.0)).expected.contains("positions"));
        let standing = fixes((0..20).map(|t| (f64::from(t), DVec2::ZERO)));
        assert!(error(&standing, Apart::Metres(5.0)).expected.contains("moves"));
        let driven = fixes((0..20).map(|t| (f64::from(t), DVec2::new(0.0, 8.0 * f64::from(t)))));
        assert!(error(&driven, Apart::Seconds(1e-6)).expected.contains("wider"));
    }
}
