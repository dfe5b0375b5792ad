//! Where in the big tables each scene's records lie, so that a scene is loaded by seeking.
//!
//! `sample_data`, `ego_pose` and `sample_annotation` have millions of rows; one pass over them finds what belongs to
//! which scene. What the pass had to report is kept with it, so that a run that finds the index says the same.

use std::collections::HashMap;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use serde::Deserialize;
use trove_files::open_regular;
use trove_model::{Entry, Outcome, Report};

use super::records::{AnnotationRecord, EgoPoseRecord, Record, SampleDataRecord};
use super::table::{RawRecord, Table, records};
use super::tables::{LIDAR, Tables, note_duplicate, parse, table_path};
use crate::ReadError;

/// Bytes of a table that hold whole records with commas between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Span {
    pub(super) offset: u64,
    pub(super) length: u64,
}

/// One scene's records in the big tables, in the order of the files.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct SceneSpans {
    /// Keyframes' `sample_data` of cameras, and all of the top LiDAR.
    pub(super) sample_data: Vec<Span>,
    /// The poses that those name.
    pub(super) ego_poses: Vec<Span>,
    pub(super) annotations: Vec<Span>,
}

/// The scenes' spans, in the order of the scene table, and what the pass had to report.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Index {
    pub(super) scenes: Vec<SceneSpans>,
    pub(super) entries: Vec<Entry>,
}

#[derive(Deserialize)]
struct SampleDataKey<'a> {
    #[serde(borrow)]
    sample_token: std::borrow::Cow<'a, str>,
    #[serde(borrow)]
    ego_pose_token: std::borrow::Cow<'a, str>,
    #[serde(borrow)]
    calibrated_sensor_token: std::borrow::Cow<'a, str>,
    is_key_frame: bool,
}

#[derive(Deserialize)]
struct EgoPoseKey<'a> {
    #[serde(borrow)]
    token: std::borrow::Cow<'a, str>,
}

#[derive(Deserialize)]
struct AnnotationKey<'a> {
    #[serde(borrow)]
    sample_token: std::borrow::Cow<'a, str>,
}

impl Index {
    /// Passes over the big tables once.
    pub(super) fn build(folder: &Path, tables: &Tables) -> Result<Self, ReadError> {
        let report = Report::default();
        let mut scene_of_sample = HashMap::new();
        for (scene, samples) in tables.samples_of_scene.iter().enumerate() {
            scene_of_sample.extend(samples.iter().map(|token| (token.as_str(), scene)));
        }
        let count = tables.scenes.len();
        let (poses_and_data, annotations) = rayon::join(
            || -> Result<_, ReadError> {
                let (data, scenes_of_pose) = sample_data_spans(folder, tables, &scene_of_sample, &report)?;
                Ok((data, ego_pose_spans(folder, count, &scenes_of_pose, &report)?))
            },
            || annotation_spans(folder, count, &scene_of_sample, &report),
        );
        let ((data, poses), annotations) = (poses_and_data?, annotations?);
        let spans = data.into_iter().zip(poses).zip(annotations);
        let scenes =
            spans.map(|((sample_data, ego_poses), annotations)| SceneSpans { sample_data, ego_poses, annotations });
        Ok(Self { scenes: scenes.collect(), entries: report.entries() })
    }

    /// Says again what the pass had to report.
    pub(super) fn replay(&self, report: &Report) {
        for entry in &self.entries {
            for i in 0..entry.count as usize {
                let example = entry.examples.get(i).or(entry.examples.last());
                report.note(entry.outcome, &entry.what, example.map_or("", String::as_str));
            }
        }
    }
}

type Spans = Vec<Vec<Span>>;

fn sample_data_spans(
    folder: &Path,
    tables: &Tables,
    scene_of_sample: &HashMap<&str, usize>,
    report: &Report,
) -> Result<(Spans, HashMap<String, usize>), ReadError> {
    let mut spans = vec![Vec::new(); tables.scenes.len()];
    let mut scene_of_pose = HashMap::new();
    each::<SampleDataRecord>(folder, |raw| {
        let Some(key) = parse::<SampleDataKey>(SampleDataRecord::TABLE, raw, report) else { return };
        // A keyframe's sensor that is not known stays, for the scene to report.
        let is_used = match tables.sensor(&key.calibrated_sensor_token) {
            Some(sensor) => sensor.channel == LIDAR || key.is_key_frame && sensor.modality == "camera",
            None => key.is_key_frame,
        };
        if !is_used {
            return;
        }
        match scene_of_sample.get(&*key.sample_token) {
            Some(&scene) => {
                push(&mut spans[scene], raw);
                scene_of_pose.insert(key.ego_pose_token.into_owned(), scene);
            }
            None => note_orphan::<SampleDataRecord>(raw, report),
        }
    })?;
    Ok((spans, scene_of_pose))
}

fn ego_pose_spans(
    folder: &Path,
    scenes: usize,
    scene_of_pose: &HashMap<String, usize>,
    report: &Report,
) -> Result<Spans, ReadError> {
    let mut spans = vec![Vec::new(); scenes];
    each::<EgoPoseRecord>(folder, |raw| {
        let Some(key) = parse::<EgoPoseKey>(EgoPoseRecord::TABLE, raw, report) else { return };
        if let Some(&scene) = scene_of_pose.get(&*key.token) {
            push(&mut spans[scene], raw);
        }
    })?;
    Ok(spans)
}

fn annotation_spans(
    folder: &Path,
    scenes: usize,
    scene_of_sample: &HashMap<&str, usize>,
    report: &Report,
) -> Result<Spans, ReadError> {
    let mut spans = vec![Vec::new(); scenes];
    each::<AnnotationRecord>(folder, |raw| {
        let Some(key) = parse::<AnnotationKey>(AnnotationRecord::TABLE, raw, report) else { return };
        match scene_of_sample.get(&*key.sample_token) {
            Some(&scene) => push(&mut spans[scene], raw),
            None => note_orphan::<AnnotationRecord>(raw, report),
        }
    })?;
    Ok(spans)
}

fn note_orphan<T: Record>(raw: &RawRecord, report: &Report) {
    let what = format!("nuScenes {} record of an unknown sample", T::TABLE);
    report.note(Outcome::Dropped, &what, format!("{}.json, byte {}", T::TABLE, raw.offset));
}

fn each<T: Record>(folder: &Path, mut visit: impl FnMut(&RawRecord)) -> Result<(), ReadError> {
    let mut table = Table::open(&table_path::<T>(folder))?;
    while let Some(raw) = table.next_record()? {
        visit(&raw);
    }
    Ok(())
}

/// Adds a record, to the last span where nothing but the separator lies between.
fn push(spans: &mut Vec<Span>, raw: &RawRecord) {
    /// A comma, an end of line and an indentation.
    const SEPARATOR_BYTES: u64 = 16;
    let end = raw.offset + raw.bytes.len() as u64;
    match spans.last_mut() {
        Some(last) if raw.offset - (last.offset + last.length) <= SEPARATOR_BYTES => last.length = end - last.offset,
        _ => spans.push(Span { offset: raw.offset, length: raw.bytes.len() as u64 }),
    }
}

/// The records in some spans of a table, in the order of the file; the first of several with the same token stands.
pub(super) fn read_spans<T: Record>(folder: &Path, spans: &[Span], report: &Report) -> Result<Vec<T>, ReadError> {
    let path = table_path::<T>(folder);
    let mut file = open_regular(&path).map_err(|e| ReadError::io(&path, e))?;
    let (mut found, mut tokens) = (Vec::<T>::new(), std::collections::HashSet::new());
    for span in spans {
        let mut bytes = Vec::new();
        file.seek(SeekFrom::Start(span.offset)).map_err(|e| ReadError::io(&path, e))?;
        file.by_ref().take(span.length).read_to_end(&mut bytes).map_err(|e| ReadError::io(&path, e))?;
        for raw in records(&bytes, span.offset) {
            let Some(record) = parse::<T>(T::TABLE, &raw, report) else { continue };
            if tokens.insert(record.token().to_owned()) {
                found.push(record);
            } else {
                note_duplicate::<T>(record.token(), report);
            }
        }
    }
    Ok(found)
}
