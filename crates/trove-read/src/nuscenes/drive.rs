//! One scene, joined from its tables.

use std::path::PathBuf;

use glam::DVec2;
use trove_model::{Drive, DriveOrigin, Keyframe, Outcome, Report, RigLidar, SweepPhase};

use super::dataset::NuScenes;
use super::exposures::{self, GlobalFromEgo, Joined, Revolution, Taken};
use super::index::read_spans;
use super::records::{AnnotationRecord, EgoPoseRecord, SampleDataRecord, SampleRecord};
use super::tables::{ByToken, LIDAR};
use super::{between, boxes, can_bus, keyframes, kinds, lane_map, lidar, place};
use crate::ReadError;
use crate::levelling::{self, Trust};

/// Heights are unknown: tilts are likely below 1/20 rad, and heights change by less than 3 m a keyframe.
const HEIGHTS: Trust = Trust { tilt: 400.0, change: 0.1, step_ns: 0 };

/// What was recorded of a scene.
struct Recorded<'a> {
    /// In the order of time.
    moments: Vec<Moment<'a>>,
    /// The LiDAR's between the keyframes, in the order of the table.
    between: Vec<Revolution>,
}

/// A sample that is used, with what was taken for it.
struct Moment<'a> {
    sample: &'a SampleRecord,
    taken: Taken,
    global_from_ego: GlobalFromEgo,
}

impl NuScenes {
    /// Loads a scene by its name.
    ///
    /// # Errors
    /// There is no such scene, or its tables or files cannot be read or are not what the dataset's are.
    pub fn drive(&self, scene: &str, report: &Report) -> Result<Drive, ReadError> {
        match self.tables.scenes.iter().position(|s| s.name == scene) {
            Some(i) => load(self, i, report),
            None => Err(self.no_such_scene(scene)),
        }
    }

    /// LiDAR sweeps, their labels and the map of a scene, as far as they are there.
    pub(super) fn recorded_files(&self, scene: &str) -> Result<Vec<PathBuf>, ReadError> {
        let index = self.tables.scenes.iter().position(|s| s.name == scene);
        let index = index.ok_or_else(|| self.no_such_scene(scene))?;
        let (report, files_below) = (Report::default(), self.files()); // said when the scene is read
        let recorded = Recorded::of(self, index, &report)?;
        let mut files = vec![can_bus::file(scene)];
        for revolution in recorded.revolutions() {
            let labels = self.tables.lidarseg_files.get(&revolution.token);
            files.extend(labels.and_then(|file| files_below.existing(file, &report)));
            files.extend(revolution.file.clone());
        }
        let sweeps = between::chosen(&files_below, recorded.revolutions(), &recorded.between, &report);
        files.extend(sweeps.into_iter().filter_map(|revolution| revolution.file.clone()));
        files.extend(self.log(&self.tables.scenes[index]).and_then(|log| lane_map::file(&log.location)));
        Ok(files.into_iter().map(|file| self.root.join(file)).filter(|path| path.is_file()).collect())
    }
}

/// Loads the scene at a place in the scene table.
fn load(dataset: &NuScenes, scene: usize, report: &Report) -> Result<Drive, ReadError> {
    let (tables, spans) = (&dataset.tables, &dataset.index.scenes[scene]);
    let record = &tables.scenes[scene];
    let recorded = Recorded::of(dataset, scene, report)?;
    let moments = &recorded.moments;
    let Some(first) = moments.first() else { return Err(empty(dataset, &record.name)) };

    // World is the global frame with the first position taken off, so that numbers are small.
    let anchor_m = first.global_from_ego.translation.truncate().round();
    let world_pose = |mut pose: GlobalFromEgo| {
        pose.translation -= anchor_m.extend(0.0);
        pose
    };
    let rig = exposures::rig(moments.iter().map(|m| &m.taken));
    let mut keyframes: Vec<_> = moments
        .iter()
        .map(|moment| Keyframe {
            time_ns: moment.sample.timestamp.saturating_mul(1000),
            token: moment.sample.token.clone(),
            world_from_ego: world_pose(moment.global_from_ego),
            exposures: exposures::exposures(&moment.taken, &rig, world_pose),
            boxes: Vec::new(),
            lidar: None,
        })
        .collect();
    let files = dataset.files();
    read_sweeps(dataset, moments, &mut keyframes, world_pose, report);
    let path = between::path(&files, &record.name, recorded.revolutions(), &recorded.between, report);
    let sweeps = between::chosen(&files, recorded.revolutions(), &recorded.between, report);
    let sweeps = between::sweeps(&files, &sweeps, world_pose, report);

    let annotations = read_spans::<AnnotationRecord>(&dataset.folder, &spans.annotations, report)?;
    let tracks = boxes::place(tables, &annotations, &mut keyframes, anchor_m, report);
    let log = dataset.log(record);
    if log.is_none() {
        report.note(Outcome::Warned, "nuScenes scene of an unknown log", &record.name);
    }
    let place_name = log.map_or("", |l| l.location.as_str());
    let driven: Vec<DVec2> = keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    let (projection, is_georeferenced) = place::projection(tables.relative, log, anchor_m, report);
    let is_flat = moments.iter().all(|m| m.global_from_ego.translation.z == first.global_from_ego.translation.z);
    let mut drive = Drive {
        id: record.name.clone(),
        dataset: tables.relative.name.clone(),
        origin: DriveOrigin::Recorded,
        place: place_name.to_owned(),
        is_georeferenced,
        projection,
        rig,
        lidars: recorded.revolutions().take(1).map(rig_lidar).collect(),
        ego_body: tables.relative.ego_body(),
        lane_map: lane_map::read(&dataset.root, place_name, anchor_m, &driven, report),
        keyframes,
        path: path.map(|_, pose| world_pose(*pose)),
        sweeps,
        tracks,
        licence: log.and_then(|l| l.trove_licence.clone()).unwrap_or_else(|| tables.relative.licence.clone()),
    };
    // Some relatives know heights.
    if is_flat {
        levelling::level(&mut drive, &HEIGHTS, report);
    }
    Ok(drive)
}

impl<'a> Recorded<'a> {
    /// The scene's samples that have a pose, in order, and what lies between.
    fn of(dataset: &'a NuScenes, scene: usize, report: &Report) -> Result<Self, ReadError> {
        let (tables, spans) = (&dataset.tables, &dataset.index.scenes[scene]);
        let data = read_spans::<SampleDataRecord>(&dataset.folder, &spans.sample_data, report)?;
        let ego_poses = read_spans::<EgoPoseRecord>(&dataset.folder, &spans.ego_poses, report)?;
        let ego_poses: ByToken<_> = ego_poses.into_iter().map(|p| (p.token.clone(), p)).collect();
        let Joined { mut of_samples, between } = exposures::join(&dataset.files(), tables, data, &ego_poses, report);
        let moment = |sample: &'a SampleRecord| {
            let taken = of_samples.remove(&sample.token).unwrap_or_default();
            match taken.global_from_ego(sample.timestamp.saturating_mul(1000), &sample.token, report) {
                Some(global_from_ego) => Some(Moment { sample, taken, global_from_ego }),
                None => {
                    report.note(Outcome::Dropped, "nuScenes sample without a usable ego pose", &sample.token);
                    None
                }
            }
        };
        let moments = keyframes::in_order(tables, scene, report).into_iter().filter_map(moment).collect();
        Ok(Self { moments, between })
    }

    /// The LiDAR's at the keyframes.
    fn revolutions(&self) -> impl Iterator<Item = &Revolution> {
        self.moments.iter().filter_map(|moment| moment.taken.revolution.as_ref())
    }
}

/// Its sweeps begin on the left, in its own axes at −x, and end at the time that they are given: points are brought to the
/// pose of that time, as the returns that were not there tell, which lie where the sensor was.
fn rig_lidar(revolution: &Revolution) -> RigLidar {
    let phase = SweepPhase { begins_at_rad: std::f64::consts::PI, over: 1.0 };
    RigLidar { name: LIDAR.into(), ego_from_lidar: revolution.ego_from_sensor, phase }
}

fn read_sweeps(
    dataset: &NuScenes,
    moments: &[Moment],
    keyframes: &mut [Keyframe],
    world_pose: impl Fn(GlobalFromEgo) -> GlobalFromEgo,
    report: &Report,
) {
    let categories = dataset.tables.categories.values();
    let mut numbered: Vec<_> = categories.filter_map(|c| Some((c.index?, c.name.as_str()))).collect();
    numbered.sort_unstable();
    let classes = kinds::lidar_classes(&numbered);
    for (moment, keyframe) in moments.iter().zip(keyframes) {
        let Some(revolution) = &moment.taken.revolution else { continue };
        let Some(points) = &revolution.file else { continue };
        let labels = dataset.tables.lidarseg_files.get(&revolution.token);
        let labels = labels.and_then(|file| dataset.files().existing(file, report));
        let labels = labels.as_deref().map(|labels| (labels, &classes));
        let world_from_sensor = world_pose(revolution.global_from_ego) * revolution.ego_from_sensor;
        keyframe.lidar = lidar::sweep(&dataset.root, points, labels, world_from_sensor, report);
    }
}

fn empty(dataset: &NuScenes, scene: &str) -> ReadError {
    ReadError::Format {
        path: dataset.folder.join("sample.json"),
        place: scene.to_owned(),
        expected: "at least one keyframe with an ego pose".to_owned(),
        found: "none usable".to_owned(),
        remedy: "choose another scene, or unpack the tables again".to_owned(),
    }
}
