//! A file's parts → `Drive`.

use std::path::Path;

use glam::DVec3;
use trove_files::PathComponent;
use trove_format::{PlainDrive, PlainEgoBody, PlainSweep};
use trove_model::{Drive, DriveOrigin, EgoBody, Exposure, Keyframe, Outcome, Report, RigCamera, Sweep};

use super::camera::camera;
use super::earth::Earth;
use super::exposures::{self, Place};
use super::faults::{Faults, Located, Part};
use super::keyframes;
use super::parts::{self, Parts};
use super::{boxes, lane_map, lidar};
use crate::ReadError;
use trove_files::Budget;

/// An ordinary car: length, width without mirrors and height of a compact, with Ego on its rear axle.
pub(crate) const ORDINARY_CAR: EgoBody =
    EgoBody { centre_ego: DVec3::new(1.35, 0.0, 0.75), size_m: DVec3::new(4.4, 1.8, 1.5) };

/// Points of all sweeps between the keyframes: they take 240 MB in memory.
const MOST_POINTS_BETWEEN: usize = 20_000_000;

/// Reads a drive from its file's text; `name` is the drive's.
pub(super) fn read(text: &str, path: &Path, name: &str, place: &Place, report: &Report) -> Result<Drive, ReadError> {
    let mut faults = Faults::of(text);
    let parts = parts::read(text, path.extension().is_some_and(|e| e == "jsonl"), &mut faults);
    let drive = parts.and_then(|parts| assemble(&parts, name, place, &mut faults, report));
    faults.into_result(path)?;
    let nothing = || ReadError::Missing {
        path: path.to_owned(),
        expected: "a drive".into(),
        found: "none".into(),
        remedy: "write it as docs/plain-drive.md says".into(),
    };
    drive.ok_or_else(nothing)
}

fn assemble(parts: &Parts, name: &str, place: &Place, faults: &mut Faults, report: &Report) -> Option<Drive> {
    let Parts { header, cameras, keyframes: moments } = parts;
    let mut rig = Vec::new();
    for (name, located) in cameras {
        if let Err(unsafe_name) = PathComponent::new(name) {
            faults.say(&located.part, &unsafe_name.to_string());
            continue;
        }
        if let Some((lens, ego_from_camera)) = faults.take(&located.part, camera(&located.value)) {
            rig.push(RigCamera { name: name.clone(), lens, ego_from_camera });
        }
    }
    let first = moments.first()?;
    let earth =
        Earth::new(&header.value.georeference, first.value.world_from_ego.as_ref(), first.value.geo_from_ego.as_ref());
    let earth = &faults.take(&first.part, earth)?;
    let budget =
        Budget::of_file(header.part.text.len() as u64 + moments.iter().map(|m| m.part.text.len() as u64).sum::<u64>());
    if let Err(exceeded) = budget.take(rig.len() * moments.len(), size_of::<Exposure>()) {
        faults.say(&header.part, &format!("cameras: expected {}", exceeded.expected()));
        return None;
    }
    let posed = keyframes::posed(moments, earth, faults);
    let path = keyframes::path(&header.value.path, &header.part, earth, faults);
    let mut keyframes = Vec::new();
    for (k, one) in posed.iter().enumerate() {
        let (moment, part) = (&one.moment.value, &one.moment.part);
        let lidar = moment.lidar.as_ref();
        let lidar = lidar.and_then(|l| lidar::sweep(l, one.world_from_ego, (earth, place), part, faults, report));
        keyframes.push(Keyframe {
            time_ns: moment.time_ns,
            token: moment.token.clone(),
            world_from_ego: one.world_from_ego,
            exposures: exposures::exposures(&posed, k, &rig, &path, (earth, place), faults, report),
            boxes: Vec::new(),
            lidar,
        });
    }
    let tracks = boxes::place(&posed, &mut keyframes, earth, faults);
    let ego_body = header.value.ego_body.and_then(|body| faults.take(&header.part, ego_body(&body)));
    let map = header.value.lane_map.as_ref().map(|map| lane_map::lane_map(map, earth));
    let lane_map = map.and_then(|map| faults.take(&header.part, map));
    if header.value.ego_body.is_none() {
        report.note(Outcome::Guessed, "recording vehicle's size: that of an ordinary car", name);
    }
    let mut drive = Drive {
        id: name.to_owned(),
        dataset: "trove".to_owned(),
        origin: DriveOrigin::Recorded,
        place: header.value.place.clone(),
        projection: earth.projection,
        is_georeferenced: earth.is_georeferenced,
        rig,
        ego_body: ego_body.unwrap_or(ORDINARY_CAR),
        keyframes,
        path,
        lidars: Vec::new(),
        sweeps: Vec::new(),
        tracks,
        lane_map,
        licence: header.value.licence.clone(),
    };
    drive.sweeps = sweeps(&drive, header, (earth, place), faults, report);
    Some(drive)
}

/// The sweeps between the keyframes.
fn sweeps(
    drive: &Drive,
    header: &Located<PlainDrive<(), ()>>,
    (earth, place): (&Earth, &Place),
    faults: &mut Faults,
    report: &Report,
) -> Vec<Sweep> {
    let (mut sweeps, mut before_ns, mut left) = (Vec::new(), None, MOST_POINTS_BETWEEN);
    for (i, PlainSweep { time_ns, lidar }) in header.value.sweeps.iter().enumerate() {
        let part = Part { text: header.part.text, path: format!("sweeps[{i}]") };
        if !keyframes::later(&part, *time_ns, before_ns.replace(*time_ns), faults) {
            continue;
        }
        let Some(world_from_ego) = drive.world_from_ego_at(*time_ns) else { continue };
        let Some(lidar) = lidar::sweep(lidar, world_from_ego, (earth, place), &part, faults, report) else { continue };
        match left.checked_sub(lidar.points_world.len()) {
            Some(rest) => left = rest,
            None => {
                report.note(Outcome::Dropped, "LiDAR sweep between keyframes: a drive has too many points", &part.path);
                break;
            }
        }
        sweeps.push(Sweep { time_ns: *time_ns, lidar });
    }
    sweeps
}

fn ego_body(body: &PlainEgoBody) -> Result<EgoBody, String> {
    let (centre_ego, size_m) = (DVec3::from_array(body.centre_m), DVec3::from_array(body.size_m));
    let is_vehicle = size_m.min_element() > 0.1 && size_m.max_element() < 30.0 && centre_ego.abs().max_element() < 30.0;
    let what = "ego_body: expected length, width and height of 0.1 to 30 m and a centre nearby, found";
    is_vehicle.then_some(EgoBody { centre_ego, size_m }).ok_or_else(|| format!("{what} {body:?}"))
}
