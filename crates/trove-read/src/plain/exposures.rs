//! What the cameras took for each keyframe.

use std::path::{Component, Path};

use trove_model::{Ego, Exposure, Outcome, Report, RigCamera, Trajectory, World};

use super::camera::camera;
use super::earth::Earth;
use super::faults::{Faults, nearest};
use super::keyframes::{self, Posed};

/// Cameras fire within this of the keyframe: other times are in another unit.
const LONGEST_NS: u64 = 60_000_000_000;

/// Where a drive's files lie.
pub(super) struct Place<'a> {
    /// The dataset's root.
    pub(super) root: &'a Path,
    /// The drive's folder below it, with a `/` at the end; empty for the root itself.
    pub(super) below: &'a str,
}

impl Place<'_> {
    /// A file's path below the root; the error says what is wrong with its name.
    pub(super) fn file(&self, key: &str, name: &str) -> Result<String, String> {
        let is_below = !name.is_empty() && Path::new(name).components().all(|c| matches!(c, Component::Normal(_)));
        let what = "expected a path from the drive's folder to a file below it, found";
        is_below.then(|| format!("{}{name}", self.below)).ok_or_else(|| format!("{key}: {what} {name:?}"))
    }
}

/// A keyframe's pictures in the rig's order.
pub(super) fn exposures(
    posed: &[Posed],
    k: usize,
    rig: &[RigCamera],
    path: &Trajectory<World, Ego>,
    (earth, place): (&Earth, &Place),
    faults: &mut Faults,
    report: &Report,
) -> Vec<Exposure> {
    let (moment, world_from_ego) = (&posed[k].moment.value, posed[k].world_from_ego);
    let untaken = |(camera, fixed): (usize, &RigCamera)| Exposure {
        camera,
        time_ns: moment.time_ns,
        world_from_ego,
        lens: fixed.lens,
        ego_from_camera: fixed.ego_from_camera,
        token: None,
        file: None,
    };
    let Some(pictures) = &moment.pictures else { return rig.iter().enumerate().map(untaken).collect() };
    let mut exposures = Vec::new();
    for (name, located) in pictures {
        let (part, picture) = (&located.part, &located.value);
        let Some(index) = rig.iter().position(|c| c.name == *name) else {
            faults.explain(part, || {
                let nearest = nearest(name, rig.iter().map(|c| c.name.as_str()));
                let hint = nearest.map(|camera| format!("did you mean {camera:?}? "));
                format!("expected the name of one of the cameras; {}found {name:?}", hint.unwrap_or_default())
            });
            continue;
        };
        let mut exposure = untaken((index, &rig[index]));
        exposure.token = picture.token.clone().or_else(|| picture.file.clone());
        exposure.time_ns = picture.time_ns.unwrap_or(moment.time_ns);
        if exposure.time_ns.abs_diff(moment.time_ns) > LONGEST_NS {
            faults.say(
                part,
                &format!("time_ns: expected it within a minute of the keyframe's, found {}", exposure.time_ns),
            );
            continue;
        }
        let given = picture.world_from_ego.is_some() || picture.geo_from_ego.is_some();
        if given {
            let pose = earth.ego(picture.world_from_ego.as_ref(), picture.geo_from_ego.as_ref());
            exposure.world_from_ego = faults.take(part, pose).unwrap_or(world_from_ego);
        } else if exposure.time_ns != moment.time_ns {
            let between = path.at(exposure.time_ns).or_else(|| keyframes::at(posed, exposure.time_ns));
            exposure.world_from_ego = between.unwrap_or(world_from_ego);
        }
        if let Some(calibrated) = picture.camera.as_ref().and_then(|c| faults.take(part, camera(c))) {
            (exposure.lens, exposure.ego_from_camera) = calibrated;
        }
        let file = picture.file.as_ref().and_then(|file| faults.take(part, place.file("file", file)));
        if let Some(file) = file {
            if place.root.join(&file).is_file() {
                exposure.file = Some(file);
            } else {
                report.note(Outcome::Dropped, "picture that is not there", file);
            }
        }
        exposures.push(exposure);
    }
    exposures.sort_by_key(|exposure| exposure.camera);
    exposures
}
