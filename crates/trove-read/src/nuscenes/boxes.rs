//! Annotations → boxes and tracks.

use std::collections::{BTreeMap, HashMap};

use glam::{DVec2, DVec3};
use trove_model::{Cuboid, Keyframe, Kind, ObjectBox, Outcome, Report, Track};

use super::kinds::{PARKED, VEHICLE, WITH_RIDER, WITHOUT_RIDER, with_rider};
use super::poses;
use super::records::AnnotationRecord;
use super::tables::Tables;

/// The devkit's `box_velocity`: neighbours farther apart in time than this tell nothing, seconds; twice this where
/// there is one on either side.
const LONGEST_GAP_S: f64 = 1.5;
/// Nothing that is annotated is longer, metres.
const LONGEST_BOX_M: f64 = 200.0;
/// A cycle without a cycle attribute that is faster than this is ridden, m/s.
const RIDDEN_MPS: f64 = 1.0;

/// Puts the annotations into their keyframes and follows their instances.
pub(super) fn place(
    tables: &Tables,
    annotations: &[AnnotationRecord],
    keyframes: &mut [Keyframe],
    anchor_m: DVec2,
    report: &Report,
) -> Vec<Track> {
    let by_token: HashMap<&str, &AnnotationRecord> = annotations.iter().map(|a| (a.token.as_str(), a)).collect();
    let keyframe_of: HashMap<String, usize> = keyframes.iter().enumerate().map(|(i, k)| (k.token.clone(), i)).collect();
    let mut found = Vec::new();
    for annotation in annotations {
        // A sample that is no keyframe was reported when it was left out.
        let Some(&keyframe) = keyframe_of.get(&annotation.sample_token) else { continue };
        match object(tables, annotation, anchor_m) {
            Ok(mut object) => {
                object.velocity_mps = velocity_mps(tables, &by_token, annotation, report);
                object.visibility = visibility(tables, annotation, report);
                object.attributes = attributes(tables, annotation, report);
                object.is_parked = is_parked(&object.attributes);
                found.push((keyframe, annotation.instance_token.as_str(), object));
            }
            Err(why) => {
                report.note(Outcome::Dropped, &format!("nuScenes annotation: {why}"), &annotation.token);
            }
        }
    }
    // Tracks are numbered in the order in which they appear.
    found.sort_by_key(|(keyframe, ..)| *keyframe);
    let (mut tracks, mut track_of) = (Vec::<Track>::new(), BTreeMap::new());
    for (keyframe, instance, mut object) in found {
        let track = *track_of.entry(instance).or_insert_with(|| {
            tracks.push(Track { token: instance.to_owned(), kind: object.kind, boxes: Vec::new() });
            tracks.len() - 1
        });
        if tracks[track].boxes.last().is_some_and(|(k, _)| *k == keyframe) {
            report.note(Outcome::Dropped, "nuScenes annotation: second of its instance in a sample", &object.token);
            continue;
        }
        tracks[track].boxes.push((keyframe, object.cuboid));
        object.track = track;
        keyframes[keyframe].boxes.push(object);
    }
    seat_riders(keyframes, &mut tracks, report);
    tracks
}

fn object(tables: &Tables, annotation: &AnnotationRecord, anchor_m: DVec2) -> Result<ObjectBox, String> {
    let instance = tables.instances.get(&annotation.instance_token).ok_or("unknown instance")?;
    let category = &tables.categories.get(&instance.category_token).ok_or("unknown category token")?.name;
    let kind = tables.relative.kind(category).ok_or_else(|| format!("unknown category '{category}'"))?;
    let [width, length, height] = annotation.size;
    let size_m = DVec3::new(length, width, height);
    if size_m.min_element() <= 0.0 {
        return Err("box of zero or negative size".to_owned());
    }
    if size_m.max_element() > LONGEST_BOX_M {
        return Err(format!("box longer than {LONGEST_BOX_M} m"));
    }
    let mut world_from_body =
        poses::pose(annotation.translation, annotation.rotation).ok_or("box without a valid pose")?;
    world_from_body.translation -= anchor_m.extend(0.0);
    Ok(ObjectBox {
        track: 0,
        kind,
        category: category.clone(),
        token: annotation.token.clone(),
        cuboid: Cuboid { world_from_body, size_m },
        velocity_mps: None,
        is_parked: None,
        attributes: Vec::new(),
        lidar_points: annotation.num_lidar_pts.and_then(|n| u32::try_from(n).ok()),
        visibility: None,
    })
}

/// The devkit's `box_velocity`: from the annotation before to the one after, or this one where there is none.
fn velocity_mps(
    tables: &Tables,
    by_token: &HashMap<&str, &AnnotationRecord>,
    annotation: &AnnotationRecord,
    report: &Report,
) -> Option<DVec3> {
    let neighbour = |token: &str| {
        let found = by_token.get(token).filter(|a| a.instance_token == annotation.instance_token);
        if found.is_none() && !token.is_empty() {
            report.note(Outcome::Warned, "nuScenes annotation: neighbour in time missing", &annotation.token);
        }
        found
    };
    let (before, after) = (neighbour(&annotation.prev), neighbour(&annotation.next));
    let longest_s = if before.is_some() && after.is_some() { 2.0 * LONGEST_GAP_S } else { LONGEST_GAP_S };
    let (first, last) = (before.copied().unwrap_or(annotation), after.copied().unwrap_or(annotation));
    let time_us = |a: &AnnotationRecord| Some(tables.samples.get(&a.sample_token)?.timestamp);
    let seconds = time_us(last)?.saturating_sub(time_us(first)?) as f64 * 1e-6;
    let path_m = DVec3::from_array(last.translation) - DVec3::from_array(first.translation);
    (seconds > 0.0 && seconds <= longest_s && path_m.is_finite()).then(|| path_m / seconds)
}

/// The middle of the annotator's bin (`v40-60` → 0.5).
fn visibility(tables: &Tables, annotation: &AnnotationRecord, report: &Report) -> Option<f32> {
    let token = annotation.visibility_token.as_ref().filter(|token| !token.is_empty())?;
    let level = tables.visibilities.get(token).map_or("", |v| v.level.as_str());
    let bin = level.strip_prefix('v').and_then(|l| l.split_once('-'));
    let middle = bin.and_then(|(a, b)| Some((a.parse::<f32>().ok()? + b.parse::<f32>().ok()?) / 200.0));
    if middle.is_none() {
        report.note(Outcome::Warned, "nuScenes annotation: unknown visibility", &annotation.token);
    }
    middle
}

fn attributes(tables: &Tables, annotation: &AnnotationRecord, report: &Report) -> Vec<String> {
    let name = |token: &String| {
        let found = tables.attributes.get(token).map(|a| a.name.clone());
        if found.is_none() {
            report.note(Outcome::Warned, "nuScenes annotation: unknown attribute", &annotation.token);
        }
        found
    };
    annotation.attribute_tokens.iter().filter_map(name).collect()
}

/// What a vehicle's attribute tells; only vehicles have one that begins so.
fn is_parked(attributes: &[String]) -> Option<bool> {
    let told = attributes.iter().find(|name| name.starts_with(VEHICLE))?;
    Some(told == PARKED)
}

/// Cycles by their attribute: the box's own, else what most of the track's say, else whether it ever moves.
fn seat_riders(keyframes: &mut [Keyframe], tracks: &mut [Track], report: &Report) {
    let says = |object: &ObjectBox| {
        let has = |name: &str| object.attributes.iter().any(|a| a == name);
        if has(WITH_RIDER) { Some(true) } else { has(WITHOUT_RIDER).then_some(false) }
    };
    let mut votes = vec![(0u32, 0u32, 0.0f64); tracks.len()];
    for object in keyframes.iter().flat_map(|k| &k.boxes) {
        let (with, without, fastest_mps) = &mut votes[object.track];
        *fastest_mps = fastest_mps.max(object.velocity_mps.map_or(0.0, DVec3::length));
        match says(object) {
            Some(true) => *with += 1,
            Some(false) => *without += 1,
            None => {}
        }
    }
    let mut bare = Vec::<Kind>::new();
    for (track, (with, without, fastest_mps)) in tracks.iter_mut().zip(votes) {
        bare.push(track.kind);
        let Some(ridden) = with_rider(track.kind) else { continue };
        if with + without == 0 {
            report.note(Outcome::Guessed, "rider of a cycle without attributes, from whether it moves", &track.token);
        }
        let is_ridden = if with + without > 0 { with >= without } else { fastest_mps > RIDDEN_MPS };
        if is_ridden {
            track.kind = ridden;
        }
    }
    for object in keyframes.iter_mut().flat_map(|k| &mut k.boxes) {
        let (bare, of_track) = (bare[object.track], tracks[object.track].kind);
        object.kind = match (says(object), with_rider(bare)) {
            (Some(true), Some(ridden)) => ridden,
            (Some(false), Some(_)) => bare,
            _ => of_track,
        };
    }
}
