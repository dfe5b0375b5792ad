//! The small tables, whole and by token; at full size they hold 40 MB.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use trove_files::PathComponent;
use trove_model::{Outcome, Report};

use super::records::{
    AnnotationRecord, AttributeRecord, CalibratedSensorRecord, CategoryRecord, EgoPoseRecord, InstanceRecord,
    LidarsegRecord, LogRecord, Record, SampleDataRecord, SampleRecord, SceneRecord, SensorRecord, VisibilityRecord,
};
use super::relatives::Relative;
use super::table::{RawRecord, Table};
use crate::ReadError;

/// The LiDAR that is used, whose time is the keyframe's time.
pub(super) const LIDAR: &str = "LIDAR_TOP";

/// Records by token; for looking up, never for iterating.
pub(super) type ByToken<T> = HashMap<String, T>;

/// What is kept in memory while a dataset is open.
pub(super) struct Tables {
    /// Which dataset they are of.
    pub(super) relative: &'static Relative,
    /// In the order of the file.
    pub(super) scenes: Vec<SceneRecord>,
    /// For each scene the tokens of its samples, in the order of the file.
    pub(super) samples_of_scene: Vec<Vec<String>>,
    pub(super) logs: ByToken<LogRecord>,
    pub(super) samples: ByToken<SampleRecord>,
    pub(super) sensors: ByToken<SensorRecord>,
    pub(super) calibrated_sensors: ByToken<CalibratedSensorRecord>,
    pub(super) instances: ByToken<InstanceRecord>,
    pub(super) categories: ByToken<CategoryRecord>,
    pub(super) attributes: ByToken<AttributeRecord>,
    pub(super) visibilities: ByToken<VisibilityRecord>,
    /// File of each LiDAR sweep's labels, by the sweep's `sample_data` token; empty without lidarseg.
    pub(super) lidarseg_files: ByToken<String>,
}

impl Tables {
    /// Reads them from a version's folder.
    pub(super) fn read(folder: &Path, report: &Report) -> Result<Self, ReadError> {
        let scenes = scenes_with_own_names(read_table(folder, report)?, report);
        let mut scene_of_token = HashMap::new();
        for (i, scene) in scenes.iter().enumerate() {
            scene_of_token.insert(scene.token.as_str(), i);
        }
        let samples: Vec<SampleRecord> = read_table(folder, report)?;
        let mut samples_of_scene = vec![Vec::new(); scenes.len()];
        for sample in &samples {
            match scene_of_token.get(sample.scene_token.as_str()) {
                Some(&scene) => samples_of_scene[scene].push(sample.token.clone()),
                None => report.note(Outcome::Dropped, "nuScenes sample of an unknown scene", &sample.token),
            }
        }
        let lidarseg: Vec<LidarsegRecord> =
            if table_path::<LidarsegRecord>(folder).exists() { read_table(folder, report)? } else { Vec::new() };
        let categories: ByToken<CategoryRecord> = by_token(read_table(folder, report)?);
        Ok(Self {
            relative: Relative::of(categories.values().map(|category| category.name.as_str())),
            samples_of_scene,
            samples: by_token(samples),
            scenes,
            logs: by_token(read_table(folder, report)?),
            sensors: by_token(usable_sensors(read_table(folder, report)?, report)),
            calibrated_sensors: by_token(read_table(folder, report)?),
            instances: by_token(read_table(folder, report)?),
            categories,
            attributes: by_token(read_table(folder, report)?),
            visibilities: by_token(read_table(folder, report)?),
            lidarseg_files: lidarseg.into_iter().map(|r| (r.sample_data_token, r.filename)).collect(),
        })
    }

    /// The sensor whose calibration this is.
    pub(super) fn sensor(&self, calibrated_sensor_token: &str) -> Option<&SensorRecord> {
        self.sensors.get(&self.calibrated_sensors.get(calibrated_sensor_token)?.sensor_token)
    }
}

/// Scenes become folders under their names: those whose name cannot be one are left out, and so is whatever has the
/// name of one before it.
fn scenes_with_own_names(mut scenes: Vec<SceneRecord>, report: &Report) -> Vec<SceneRecord> {
    let mut names = HashSet::new();
    scenes.retain(|scene| match PathComponent::new(&scene.name) {
        Err(why) => {
            report.note(
                Outcome::Dropped,
                "nuScenes scene whose name is no folder's",
                format!("{}: {why}", scene.token),
            );
            false
        }
        // Some file systems tell no capitals.
        Ok(name) => {
            names.insert(name.as_str().to_lowercase()) || {
                let example = format!("{}: {}", scene.token, scene.name);
                report.note(Outcome::Dropped, "nuScenes scene with the name of another", example);
                false
            }
        }
    });
    scenes
}

/// Channels become parts of folders' names; of several LiDARs one is used.
fn usable_sensors(mut sensors: Vec<SensorRecord>, report: &Report) -> Vec<SensorRecord> {
    for other in sensors.iter().filter(|sensor| sensor.modality == "lidar" && sensor.channel != LIDAR) {
        report.note(Outcome::Dropped, &format!("nuScenes LiDAR other than {LIDAR}"), &other.channel);
    }
    sensors.retain(|sensor| {
        PathComponent::new(&sensor.channel)
            .inspect_err(|why| {
                let example = format!("{}: {why}", sensor.token);
                report.note(Outcome::Dropped, "nuScenes sensor whose channel is no folder's name", example);
            })
            .is_ok()
    });
    sensors
}

/// The files of all tables that are there.
pub(super) fn all(folder: &Path) -> Vec<PathBuf> {
    let paths = [
        table_path::<SceneRecord>(folder),
        table_path::<LogRecord>(folder),
        table_path::<SampleRecord>(folder),
        table_path::<SampleDataRecord>(folder),
        table_path::<EgoPoseRecord>(folder),
        table_path::<CalibratedSensorRecord>(folder),
        table_path::<SensorRecord>(folder),
        table_path::<AnnotationRecord>(folder),
        table_path::<InstanceRecord>(folder),
        table_path::<CategoryRecord>(folder),
        table_path::<AttributeRecord>(folder),
        table_path::<VisibilityRecord>(folder),
        table_path::<LidarsegRecord>(folder),
    ];
    paths.into_iter().filter(|path| path.is_file()).collect()
}

/// Where a table lies.
pub(super) fn table_path<T: Record>(folder: &Path) -> PathBuf {
    folder.join(format!("{}.json", T::TABLE))
}

/// Reads one record; one that cannot be read is reported.
pub(super) fn parse<'a, T: serde::Deserialize<'a>>(table: &str, raw: &RawRecord<'a>, report: &Report) -> Option<T> {
    serde_json::from_slice(raw.bytes)
        .inspect_err(|e| {
            let what = format!("nuScenes {table} record that cannot be read");
            report.note(Outcome::Dropped, &what, format!("{table}.json, byte {}: {e}", raw.offset));
        })
        .ok()
}

/// A whole table in the order of the file; the first of several records with the same token stands.
fn read_table<T: Record>(folder: &Path, report: &Report) -> Result<Vec<T>, ReadError> {
    let mut table = Table::open(&table_path::<T>(folder))?;
    let (mut found, mut tokens) = (Vec::<T>::new(), std::collections::HashSet::new());
    while let Some(raw) = table.next_record()? {
        let Some(record) = parse::<T>(T::TABLE, &raw, report) else { continue };
        if tokens.insert(record.token().to_owned()) {
            found.push(record);
        } else {
            note_duplicate::<T>(record.token(), report);
        }
    }
    Ok(found)
}

/// Notes that a second record has the same token.
pub(super) fn note_duplicate<T: Record>(token: &str, report: &Report) {
    report.note(Outcome::Dropped, &format!("nuScenes {} record with a duplicate token", T::TABLE), token);
}

fn by_token<T: Record>(records: Vec<T>) -> ByToken<T> {
    records.into_iter().map(|r| (r.token().to_owned(), r)).collect()
}
