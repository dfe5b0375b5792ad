//! Raw recordings: a folder a drive, a file or a line a frame.

use std::path::{Path, PathBuf};

use trove_model::{Ego, Outcome, Pose, Report, Trajectory, World};

use super::boxes::Annotation;
use super::drive::{Moment, Picture, Recorded};
use super::facts::FACTS;
use super::layout::{Form, Recording, names};
use super::mounting::{Mounting, files_of_day};
use super::oxts::{Fix, Georeference, fix};
use super::{text, times, tracklets};
use crate::ReadError;

/// A sensor's time farther than this from the keyframe's is no time of it, nanoseconds.
const FARTHEST_NS: i64 = 150_000_000;

/// How many keyframes a recording has.
pub(super) fn keyframes(root: &Path, recording: &Recording) -> usize {
    match recording.form {
        Form::Synced => fixes_in(&folder(root, recording)).len(),
        _ => moments_file(root, recording).and_then(|path| times::read(&path).ok()).map_or(0, |times| times.len()),
    }
}

/// The files of a recording but its pictures and sweeps' own, as far as they are there.
pub(super) fn files(root: &Path, recording: &Recording) -> Vec<PathBuf> {
    let folder = folder(root, recording);
    let mut files = files_of_day(&root.join(&recording.below)).to_vec();
    let sensors = ["oxts", "image_00", "image_01", "image_02", "image_03", "velodyne_points"];
    files.extend(sensors.map(|sensor| folder.join(sensor).join("timestamps.txt")));
    files.push(folder.join("tracklet_labels.xml"));
    for sensor in ["oxts", "velodyne_points"] {
        let data = folder.join(sensor).join("data");
        files.extend(names(&data).into_iter().map(|name| data.join(name)));
    }
    files
}

/// Reads a recording.
pub(super) fn read(
    root: &Path,
    recording: &Recording,
    licence: &'static str,
    report: &Report,
) -> Result<Recorded, ReadError> {
    let folder = folder(root, recording);
    let is_synced = recording.form == Form::Synced;
    let mounting = Mounting::of_day(&root.join(&recording.below), is_synced)?;
    let fixes = timed_fixes(&folder, report)?;
    let Some(first) = fixes.first() else {
        let found = format!("none among {} files", fixes_in(&folder).len());
        return Err(text::damaged(&folder.join("oxts/data"), "all files", "at least one fix with a time", found));
    };
    let georeference = Georeference::at(&first.fix, mounting.ego_from_imu);
    let pose = |timed: &TimedFix| {
        let pose = georeference.near_pose(&timed.fix, &format!("frame {}", timed.frame), report)?;
        Some((timed.frame, timed.time_ns, pose))
    };
    let poses: Vec<_> = fixes.iter().filter_map(pose).collect();
    let below = format!("{}{}/", recording.below, recording.name);
    // Synced frames are what fixes there are; an extracted drive has ten a frame.
    let (moments, path) = match is_synced {
        true => (synced(root, &below, &mounting, &poses)?, Trajectory::default()),
        false => {
            let moments = extracted(root, recording, &below, &mounting, &poses, report)?;
            (moments, Trajectory::new(poses.iter().map(|(_, time_ns, pose)| (*time_ns, *pose)).collect()).0)
        }
    };
    let tracklets_file = folder.join("tracklet_labels.xml");
    let annotations = match tracklets_file.is_file() {
        true if is_synced => annotations(&tracklets::read(&tracklets_file, report)?, &moments, &mounting, report),
        true => {
            report.note(Outcome::Dropped, "tracklets, whose frames are those of the synced drive", &recording.name);
            Vec::new()
        }
        false => Vec::new(),
    };
    if moments.is_empty() {
        return Err(text::damaged(&folder, "all frames", "at least one with a time and a pose", "none"));
    }
    Ok(Recorded {
        name: recording.name.clone(),
        licence,
        projection: Some(georeference.projection),
        moments,
        path,
        annotations,
        ego_from_velodyne: mounting.ego_from_velodyne,
        rig: mounting.rig,
    })
}

fn folder(root: &Path, recording: &Recording) -> PathBuf {
    root.join(&recording.below).join(&recording.name)
}

/// The numbers of the frames that have a fix, with their files.
fn fixes_in(folder: &Path) -> Vec<(usize, PathBuf)> {
    let data = folder.join("oxts/data");
    let numbered = |name: String| Some((name.strip_suffix(".txt")?.parse().ok()?, data.join(&name)));
    let mut files: Vec<_> = names(&data).into_iter().filter_map(numbered).collect();
    files.sort_by_key(|(frame, _)| *frame);
    files
}

struct TimedFix {
    frame: usize,
    time_ns: i64,
    fix: Fix,
}

/// Fixes in the order of frames and of time; what is damaged or goes back in time is left out.
fn timed_fixes(folder: &Path, report: &Report) -> Result<Vec<TimedFix>, ReadError> {
    let path = folder.join("oxts/timestamps.txt");
    let times_ns = if path.is_file() {
        Some(times::read(&path)?)
    } else {
        report.note(Outcome::Guessed, "times of KITTI frames without timestamps.txt", path.display());
        None
    };
    let mut fixes = Vec::<TimedFix>::new();
    for (frame, path) in fixes_in(folder) {
        let dropped = |why: &str| report.note(Outcome::Dropped, &format!("KITTI frame: {why}"), path.display());
        let time_ns = match &times_ns {
            Some(times_ns) => times_ns.get(frame).copied().flatten(),
            None => Some(times::unknown_ns(frame)),
        };
        let Some(time_ns) = time_ns else {
            dropped("no time");
            continue;
        };
        if fixes.last().is_some_and(|last| last.time_ns >= time_ns) {
            dropped("time runs backwards");
            continue;
        }
        match text::read(&path).ok().and_then(|text| fix(&text)) {
            Some(fix) => fixes.push(TimedFix { frame, time_ns, fix }),
            None => dropped("OXTS file that cannot be read"),
        }
    }
    Ok(fixes)
}

/// A frame a fix; all its sensors share the fix's pose, as in the devkit.
fn synced(
    root: &Path,
    below: &str,
    mounting: &Mounting,
    poses: &[(usize, i64, Pose<World, Ego>)],
) -> Result<Vec<Moment>, ReadError> {
    let mut picture_times = Vec::new();
    for camera in &mounting.rig {
        let path = root.join(format!("{below}{}/timestamps.txt", camera.name));
        picture_times.push(if path.is_file() { times::read(&path)? } else { Vec::new() });
    }
    let moment = |&(frame, time_ns, world_from_ego): &(usize, i64, Pose<World, Ego>)| {
        let picture = |(camera, times_ns): (usize, &Vec<Option<i64>>)| {
            let own_ns = times_ns.get(frame).copied().flatten();
            let own_ns = own_ns.filter(|own| own.saturating_sub(time_ns).abs() < FARTHEST_NS);
            let file = format!("{below}{}/data/{frame:010}.png", mounting.rig[camera].name);
            Picture { camera, time_ns: own_ns.unwrap_or(time_ns), world_from_ego, file }
        };
        let sweep = Some(format!("{below}velodyne_points/data/{frame:010}.bin"));
        let pictures = picture_times.iter().enumerate().map(picture).collect();
        Moment { frame, time_ns, world_from_ego, pictures, sweep }
    };
    Ok(poses.iter().map(moment).collect())
}

/// What an extracted recording's keyframes are: the sweeps, without them the pictures of the first camera.
fn moments_file(root: &Path, recording: &Recording) -> Option<PathBuf> {
    let folder = folder(root, recording);
    let sensors = ["velodyne_points", "image_00", "image_01", "image_02", "image_03"];
    sensors.map(|sensor| folder.join(sensor).join("timestamps.txt")).into_iter().find(|path| path.is_file())
}

/// A frame a sweep, with the pictures nearest in time; each has its own pose between two fixes.
fn extracted(
    root: &Path,
    recording: &Recording,
    below: &str,
    mounting: &Mounting,
    poses: &[(usize, i64, Pose<World, Ego>)],
    report: &Report,
) -> Result<Vec<Moment>, ReadError> {
    let Some(path) = moments_file(root, recording) else {
        return Err(ReadError::Missing {
            path: folder(root, recording),
            expected: "velodyne_points/timestamps.txt or image_00/timestamps.txt".to_owned(),
            found: "neither".to_owned(),
            remedy: "unpack the drive again".to_owned(),
        });
    };
    let mut cameras = Vec::new();
    for camera in &mounting.rig {
        let path = root.join(format!("{below}{}/timestamps.txt", camera.name));
        let times_ns = if path.is_file() { times::read(&path)? } else { Vec::new() };
        let mut numbered: Vec<_> = times_ns.into_iter().enumerate().filter_map(|(i, t)| Some((t?, i))).collect();
        numbered.sort_unstable();
        cameras.push(numbered);
    }
    let mut moments = Vec::<Moment>::new();
    for (frame, time_ns) in times::read(&path)?.into_iter().enumerate() {
        let dropped =
            |why: &str| report.note(Outcome::Dropped, &format!("KITTI frame: {why}"), format!("{below}{frame}"));
        let Some(time_ns) = time_ns else {
            dropped("no time");
            continue;
        };
        if moments.last().is_some_and(|last| last.time_ns >= time_ns) {
            dropped("time runs backwards");
            continue;
        }
        let Some(world_from_ego) = pose_at(poses, time_ns) else {
            dropped("no fix at its time");
            continue;
        };
        let picture = |(camera, times_ns): (usize, &Vec<(i64, usize)>)| {
            let after = times_ns.partition_point(|(t, _)| *t < time_ns);
            let near = times_ns[after.saturating_sub(1)..].iter().take(2);
            let (own_ns, number) = *near.min_by_key(|(t, _)| t.abs_diff(time_ns))?;
            let own_ns = Some(own_ns).filter(|own| own.saturating_sub(time_ns).abs() < FARTHEST_NS)?;
            let file = format!("{below}{}/data/{number:010}.png", mounting.rig[camera].name);
            Some(Picture { camera, time_ns: own_ns, world_from_ego: pose_at(poses, own_ns)?, file })
        };
        let pictures = cameras.iter().enumerate().filter_map(picture).collect();
        let sweep = Some(format!("{below}velodyne_points/data/{frame:010}.txt"));
        moments.push(Moment { frame, time_ns, world_from_ego, pictures, sweep });
    }
    Ok(moments)
}

/// The vehicle at a time; `None` where no fix is near.
fn pose_at(poses: &[(usize, i64, Pose<World, Ego>)], time_ns: i64) -> Option<Pose<World, Ego>> {
    let after = poses.partition_point(|(_, t, _)| *t < time_ns);
    let near = |&(_, t, pose): &(usize, i64, Pose<World, Ego>)| {
        (t.saturating_sub(time_ns).abs() < FARTHEST_NS).then_some((t, pose))
    };
    let before = after.checked_sub(1).and_then(|i| poses.get(i)).and_then(near);
    match (before, poses.get(after).and_then(near)) {
        (Some((a, from)), Some((b, to))) => Some(from.interpolate(&to, (time_ns - a) as f64 / (b - a) as f64)),
        (one, other) => one.or(other).map(|(_, pose)| pose),
    }
}

fn annotations(
    tracklets: &[tracklets::Tracklet],
    moments: &[Moment],
    mounting: &Mounting,
    report: &Report,
) -> Vec<Annotation> {
    let mut found = Vec::new();
    for (number, tracklet) in tracklets.iter().enumerate() {
        if FACTS.kind(&tracklet.category).is_none() {
            report.note(Outcome::Dropped, "KITTI tracklet: unknown class", text::quoted(&tracklet.category));
            continue;
        }
        for (frame, pose) in (tracklet.first_frame..).zip(&tracklet.poses) {
            let Some(pose) = pose else { continue };
            let Ok(keyframe) = moments.binary_search_by_key(&frame, |moment| moment.frame) else {
                report.note(
                    Outcome::Dropped,
                    "KITTI tracklet: pose in no frame",
                    format!("tracklet {number}, {frame}"),
                );
                continue;
            };
            found.push(Annotation {
                keyframe,
                instance: number.to_string(),
                category: tracklet.category.clone(),
                token: format!("tracklet {number}, frame {frame}"),
                ego_from_body: mounting.ego_from_velodyne * pose.velodyne_from_body,
                size_m: tracklet.size_m,
                truncation: pose.truncation.clone(),
                occlusion: pose.occlusion.clone(),
            });
        }
    }
    found
}
