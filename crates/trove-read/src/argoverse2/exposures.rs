//! What the cameras took for each keyframe.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use trove_model::{Exposure, Outcome, Report, RigCamera, Trajectory};

use super::city::CityFrame;
use super::frames::{Axle, City};

/// Cameras fire twenty times a second: a picture farther from a keyframe than this is another's, nanoseconds.
const FARTHEST_NS: u64 = 50_000_000;

/// The files of a folder whose names are times, by time.
pub(super) fn files_by_time(folder: &Path, extensions: &[&str]) -> BTreeMap<i64, PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let timed = |path: PathBuf| {
        let extension = path.extension()?.to_str()?;
        let time_ns = path.file_stem()?.to_str()?.parse().ok()?;
        (extensions.contains(&extension) && path.is_file()).then_some((time_ns, path))
    };
    entries.filter_map(timed).collect()
}

/// The pictures of a log's cameras, in the rig's order.
pub(super) struct Pictures<'a> {
    rig: &'a [RigCamera],
    files: Vec<BTreeMap<i64, PathBuf>>,
}

impl<'a> Pictures<'a> {
    /// Of those in `sensors/cameras` below a log's folder; cameras without any are reported.
    pub(super) fn of(log: &Path, rig: &'a [RigCamera], report: &Report) -> Self {
        let files = rig.iter().map(|camera| {
            let files = files_by_time(&log.join("sensors/cameras").join(&camera.name), &["jpg", "png"]);
            if files.is_empty() {
                let what = "time of an Argoverse 2 camera whose pictures are not at hand: the keyframe's";
                report.note(Outcome::Guessed, what, &camera.name);
            }
            files
        });
        Self { rig, files: files.collect() }
    }

    /// Those nearest to a keyframe, in time and place; a camera without one is taken to have fired with the keyframe.
    pub(super) fn exposures(
        &self,
        time_ns: i64,
        root: &Path,
        poses: &Trajectory<City, Axle>,
        frame: &CityFrame,
    ) -> Vec<Exposure> {
        let exposure = |(camera, fixed): (usize, &RigCamera)| {
            let files = &self.files[camera];
            let around = files.range(..time_ns).next_back().into_iter().chain(files.range(time_ns..).next());
            let nearest = around.min_by_key(|(t, _)| t.abs_diff(time_ns));
            let nearest = nearest.filter(|(t, _)| t.abs_diff(time_ns) <= FARTHEST_NS);
            let taken = nearest.and_then(|(&t, path)| Some((t, path, poses.at(t)?)));
            let (time_ns, pose, path) = match taken {
                Some((t, path, pose)) => (t, pose, Some(path)),
                None => (time_ns, poses.at(time_ns)?, None),
            };
            Some(Exposure {
                camera,
                time_ns,
                world_from_ego: frame.world_from_ego(&pose),
                lens: fixed.lens,
                ego_from_camera: fixed.ego_from_camera,
                token: path.map(|_| format!("{}/{time_ns}", fixed.name)),
                file: path.and_then(|path| Some(path.strip_prefix(root).ok()?.to_str()?.replace('\\', "/"))),
            })
        };
        self.rig.iter().enumerate().filter_map(exposure).collect()
    }
}
