//! Annotations → boxes and tracks.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use glam::DVec3;
use trove_model::{Body, Cuboid, Keyframe, ObjectBox, Outcome, Pose, Report, Track, World};

use super::feather::Table;
use super::frames::Axle;
use super::kinds::kind_of_category;
use super::poses::{POSE, poses};
use crate::ReadError;

/// Boxes farther apart in time than this tell nothing of a velocity, and those within it are jittered by centimetres: the
/// velocity is that between the outermost two, nanoseconds.
const REACH_NS: i64 = 500_000_000;
/// Nothing that is annotated is longer, metres.
const LONGEST_BOX_M: f64 = 200.0;

/// A row of `annotations.feather`.
pub(super) struct Annotation {
    track: String,
    category: String,
    size_m: DVec3,
    axle_from_body: Pose<Axle, Body>,
    lidar_points: Option<u32>,
}

/// A log's annotations by time, in the order of the file; rows that are none are left out and reported.
pub(super) fn read(path: &Path, report: &Report) -> Result<BTreeMap<i64, Vec<Annotation>>, ReadError> {
    const COLUMNS: [&str; 7] =
        ["timestamp_ns", "track_uuid", "category", "length_m", "width_m", "height_m", "num_interior_pts"];
    let table = Table::read(path, &[&COLUMNS[..], &POSE[..]].concat())?;
    let (times, tracks, categories) =
        (table.integers("timestamp_ns")?, table.words("track_uuid")?, table.words("category")?);
    let sides = [table.numbers("length_m")?, table.numbers("width_m")?, table.numbers("height_m")?];
    let (poses, points) = (poses(&table)?, table.integers("num_interior_pts")?);
    let mut found = BTreeMap::<i64, Vec<Annotation>>::new();
    let rows = times.into_iter().zip(tracks).zip(categories).zip(poses).zip(points);
    for (i, ((((time_ns, track), category), pose), points)) in rows.enumerate() {
        let dropped =
            |why: &str| report.note(Outcome::Dropped, &format!("Argoverse 2 annotation: {why}"), format!("row {i}"));
        let size_m = DVec3::from_array([sides[0][i], sides[1][i], sides[2][i]]);
        let (Some(time_ns), Some(track), Some(category)) = (time_ns, track, category) else {
            dropped("without a time, a track or a category");
            continue;
        };
        match pose {
            None => dropped("box without a valid pose"),
            Some(_) if !size_m.is_finite() || size_m.min_element() <= 0.0 => dropped("box of no size"),
            Some(_) if size_m.max_element() > LONGEST_BOX_M => dropped("box longer than 200 m"),
            Some(axle_from_body) => {
                let lidar_points = points.and_then(|n| u32::try_from(n).ok());
                let annotation = Annotation { track, category, size_m, axle_from_body, lidar_points };
                found.entry(time_ns).or_default().push(annotation);
            }
        }
    }
    Ok(found)
}

/// The times of a log's annotations, one a row.
pub(super) fn times(path: &Path) -> Result<Vec<i64>, ReadError> {
    Ok(Table::read(path, &["timestamp_ns"])?.integers("timestamp_ns")?.into_iter().flatten().collect())
}

/// Puts annotations into their keyframes, whose times and vehicle poses are given beside them, and follows their tracks; velocities are
/// still unknown.
pub(super) fn place(
    annotations: &BTreeMap<i64, Vec<Annotation>>,
    moments: &[(i64, Pose<World, Axle>)],
    keyframes: &mut [Keyframe],
    report: &Report,
) -> Vec<Track> {
    let (mut tracks, mut track_of) = (Vec::<Track>::new(), BTreeMap::<&str, usize>::new());
    for (k, ((time_ns, world_from_axle), keyframe)) in moments.iter().zip(&mut *keyframes).enumerate() {
        let mut seen = BTreeSet::new();
        for annotation in annotations.get(time_ns).into_iter().flatten() {
            let token = format!("{}/{time_ns}", annotation.track);
            let dropped = |why: &str| report.note(Outcome::Dropped, &format!("Argoverse 2 annotation: {why}"), &token);
            let Some(kind) = kind_of_category(&annotation.category) else {
                let example = format!("'{}' of {token}", annotation.category);
                report.note(Outcome::Dropped, "Argoverse 2 annotation: unknown category", example);
                continue;
            };
            if !seen.insert(&annotation.track) {
                dropped("second of its track at one time");
                continue;
            }
            let track = *track_of.entry(&annotation.track).or_insert_with(|| {
                tracks.push(Track { token: annotation.track.clone(), kind, boxes: Vec::new() });
                tracks.len() - 1
            });
            let cuboid =
                Cuboid { world_from_body: *world_from_axle * annotation.axle_from_body, size_m: annotation.size_m };
            tracks[track].boxes.push((k, cuboid));
            keyframe.boxes.push(ObjectBox {
                track,
                kind: tracks[track].kind,
                category: annotation.category.clone(),
                token,
                cuboid,
                velocity_mps: None,
                is_parked: None,
                attributes: Vec::new(),
                lidar_points: annotation.lidar_points,
                visibility: None,
            });
        }
    }
    tracks
}

/// Gives every box the velocity of its track.
pub(super) fn set_velocities(keyframes: &mut [Keyframe], tracks: &[Track]) {
    let times: Vec<i64> = keyframes.iter().map(|k| k.time_ns).collect();
    for (k, object) in
        keyframes.iter_mut().enumerate().flat_map(|(k, frame)| frame.boxes.iter_mut().map(move |b| (k, b)))
    {
        let boxes = &tracks[object.track].boxes;
        let near = |i: &usize| times[*i].abs_diff(times[k]) <= REACH_NS as u64;
        let from = boxes.partition_point(|(i, _)| *i < k && !near(i));
        let to = boxes.partition_point(|(i, _)| *i <= k || near(i));
        let outermost = boxes[from..to].first().zip(boxes[from..to].last());
        object.velocity_mps = outermost.and_then(|((a, first), (b, last))| {
            let seconds = (times[*b] - times[*a]) as f64 * 1e-9;
            let path_m = last.world_from_body.translation - first.world_from_body.translation;
            (seconds > 0.0).then(|| path_m / seconds)
        });
    }
}
