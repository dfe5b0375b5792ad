//! nuScenes: thirteen tables of rows that name each other by tokens, and pictures and sweeps below `samples`.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

use glam::DAffine3;
use serde_json::{Value, json};
use trove_format::{FrameFile, FrameTable, ObjectOrigin};
use trove_model::{Kind, State};

use super::dataset::{Dataset, Finished};
use super::geometry::{affine, quaternion_wxyz};
use super::kinds;
use super::kitti::note_distortion;
use super::nuscenes_lidar::{self, PanopticNumbers};
use super::nuscenes_radar;
use super::nuscenes_rows::{
    ATTRIBUTES, VERSION, attribute, calibrated_sensor, channel, ego_pose, in_plane, log, named_rows, sensor, token,
    world_from_ego,
};
use super::plan::{Plan, PlannedFrame};
use super::tables::write_list;
use super::unit::Unit;
use crate::{StoredRadarCycle, StoredSweep, WriteError, png_file};

/// `v1.0-trove/*.json`, `samples/<camera>/*.png` and `maps/*.png`; a variation seen from one vehicle is a scene.
pub(super) struct NuScenes;

/// The sensor whose pose and time are a sample's own, for every tool of nuScenes.
const LIDAR: &str = "LIDAR_TOP";
/// nuScenes' levels of visibility, percent.
const LEVELS: [&str; 4] = ["v0-40", "v40-60", "v60-80", "v80-100"];
impl Dataset for NuScenes {
    fn units(&self, plan: &Plan) -> Vec<Vec<usize>> {
        plan.grouped(scene_name)
    }

    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let scene = scene_name(&plan.frames[frames[0]]);
        let mut moments: BTreeMap<u32, Moment> = BTreeMap::new();
        let mut tracks = Tracks::default();
        let mut calibrations = BTreeSet::new();
        let mut cameras: BTreeMap<&str, Vec<Value>> = BTreeMap::new();
        for &i in frames {
            let planned = &plan.frames[i];
            let frame = plan.open(planned)?;
            let table = &frame.table;
            let Some(world_from_ego) = world_from_ego(table, unit) else { continue };
            note_distortion(table, unit);
            let channel = channel(&planned.view);
            let path = format!("samples/{channel}/{scene}__{channel}__{:06}.png", planned.keyframe);
            unit.link(&path, &frame.needed(FrameFile::Rgb)?)?;
            let name = format!("{scene}/{}/{channel}", planned.keyframe);
            let ego_from_camera = world_from_ego.inverse() * affine(&table.world_from_camera);
            let calibrated = calibrated_sensor(&scene, channel, ego_from_camera, Some(&table.intrinsics));
            let data = json!({
                "token": token("sample_data", &name),
                "sample_token": sample_token(&scene, planned.keyframe),
                "ego_pose_token": token("ego_pose", &name),
                "calibrated_sensor_token": calibrated["token"],
                "timestamp": table.time_ns / 1000,
                "fileformat": "png",
                "is_key_frame": true,
                "height": table.height_px,
                "width": table.width_px,
                "filename": path,
            });
            unit.row("ego_pose", &ego_pose(&name, table.time_ns, in_plane(table, &world_from_ego)))?;
            if calibrations.insert(calibrated["token"].to_string()) {
                unit.row("calibrated_sensor", &calibrated)?;
            }
            cameras.entry(channel).or_default().push(data);
            match moments.entry(planned.keyframe) {
                Entry::Occupied(mut moment) => moment.get_mut().look(table, world_from_ego),
                Entry::Vacant(moment) => {
                    let sweep = plan.sweep(planned).map(|sweep| plan.open_sweep(sweep)).transpose()?;
                    let radars = plan.radars(planned).map(|cycle| plan.open_radar(cycle)).collect::<Result<_, _>>()?;
                    moment.insert(Moment { sweep, radars, ..Moment::new(table, world_from_ego) });
                }
            }
            tracks.look(planned.keyframe, table);
        }
        for mut pictures in cameras.into_values() {
            link(&mut pictures);
            pictures.iter().try_for_each(|row| unit.row("sample_data", row))?;
        }
        scene_rows(&scene, &moments, unit)?;
        tracks.rows(&scene, &moments, unit)
    }

    fn finish(&self, finished: &Finished<'_>, unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let mut splits: BTreeMap<String, Vec<Value>> = BTreeMap::new();
        let mut logs = Vec::new();
        for rows in finished.rows(None) {
            let (frames, rows) = rows?;
            for row in rows.get("scene").into_iter().flatten() {
                let row: Value = serde_json::from_str(row.get()).map_err(|e| WriteError::Mismatch(e.to_string()))?;
                // The devkit keeps the plain names for its own lists.
                let split = format!("trove_{}", finished.plan.frames[frames[0]].split);
                splits.entry(split).or_default().push(row["name"].clone());
                logs.push(row["log_token"].clone());
            }
        }
        if logs.is_empty() {
            return Err(WriteError::Unfit {
                path: finished.plan.source.clone(),
                expected: "a camera carried by a vehicle whose pose is known (world_from_ego)".into(),
                found: "none".into(),
                remedy: "export it in a form without vehicles, such as kitti or coco".into(),
            });
        }
        let channels: BTreeSet<&str> = finished.plan.frames.iter().map(|frame| channel(&frame.view)).collect();
        let cameras = channels.into_iter().map(|channel| sensor(channel, "camera"));
        let radars: BTreeSet<&str> = finished.plan.radar_views().into_iter().map(channel).collect();
        let radars = radars.into_iter().map(|channel| sensor(channel, "radar"));
        let levels = LEVELS
            .iter()
            .zip(1..)
            .map(|(level, number): (_, u8)| json!({ "token": number.to_string(), "level": level, "description": "" }));
        let map = format!("maps/{}.png", token("map", "none"));
        let map_row = json!({
            "token": token("map", "none"),
            "category": "semantic_prior",
            "filename": map,
            "log_tokens": logs,
        });
        // The devkit asks for a raster of the drivable area, which frames do not have: nothing is marked in this one.
        unit.write(&map, &png_file::grey(&map, 1, 1, &[0])?)?;
        let fixed = [
            ("category", nuscenes_lidar::categories()),
            ("attribute", named_rows("attribute", &ATTRIBUTES)),
            ("visibility", levels.collect()),
            ("sensor", cameras.chain([sensor(LIDAR, "lidar")]).chain(radars).collect()),
            ("map", vec![map_row]),
        ];
        for (table, rows) in fixed {
            write_list(finished, &format!("{VERSION}/{table}.json"), &rows, "", unit)?;
        }
        let of_steps = ["log", "scene", "sample", "sample_data", "ego_pose", "calibrated_sensor"];
        let labels = ["lidarseg", "panoptic"].into_iter().filter(|_| finished.plan.has_sweeps());
        for table in of_steps.into_iter().chain(["instance", "sample_annotation"]).chain(labels) {
            write_list(finished, &format!("{VERSION}/{table}.json"), &[], table, unit)?;
        }
        let splits = serde_json::to_vec_pretty(&splits).map_err(|e| WriteError::Mismatch(e.to_string()))?;
        unit.write(&format!("{VERSION}/splits.json"), &splits)
    }
}

/// One vehicle's view of a variation of a drive, one side of a split.
fn scene_name(frame: &PlannedFrame) -> String {
    let carrier = frame.view.split('.').next().filter(|carrier| *carrier != "ego");
    let parts = carrier.into_iter().chain((frame.split != "train").then_some(frame.split.as_str()));
    parts.fold(format!("{}-v{:02}", frame.scene, frame.variation), |name, part| format!("{name}-{part}"))
}

/// Lets every row name the one before it and the one after it.
fn link(rows: &mut [Value]) {
    let tokens: Vec<Value> = rows.iter().map(|row| row["token"].clone()).collect();
    let at = |i: Option<usize>| i.and_then(|i| tokens.get(i)).cloned().unwrap_or_else(|| json!(""));
    for (i, row) in rows.iter_mut().enumerate() {
        (row["prev"], row["next"]) = (at(i.checked_sub(1)), at(Some(i + 1)));
    }
}

fn sample_token(scene: &str, keyframe: u32) -> String {
    token("sample", &format!("{scene}/{keyframe}"))
}

/// What a scene's frames say of one moment.
struct Moment {
    table: FrameTable,
    world_from_ego: DAffine3,
    sweep: Option<StoredSweep>,
    radars: Vec<StoredRadarCycle>,
}

impl Moment {
    fn new(table: &FrameTable, world_from_ego: DAffine3) -> Self {
        Self {
            table: FrameTable { objects: Vec::new(), ..table.clone() },
            world_from_ego,
            sweep: None,
            radars: Vec::new(),
        }
    }

    /// Keeps the pose of the camera whose picture is nearest to the moment.
    fn look(&mut self, table: &FrameTable, world_from_ego: DAffine3) {
        let apart = |table: &FrameTable| table.time_ns.abs_diff(table.keyframe_time_ns);
        if apart(table) < apart(&self.table) {
            let (sweep, radars) = (self.sweep.take(), std::mem::take(&mut self.radars));
            *self = Self { sweep, radars, ..Self::new(table, world_from_ego) };
        }
    }
}

impl Moment {
    /// Time and pose of the vehicle that the LiDAR's sweep has, and the LiDAR's place on it.
    fn lidar(&self) -> (i64, DAffine3, DAffine3) {
        let of_sweep = self.sweep.as_ref().and_then(|StoredSweep { table, .. }| {
            let world_from_ego = affine(table.world_from_ego.as_ref()?);
            Some((table.time_ns, world_from_ego, world_from_ego.inverse() * affine(&table.world_from_lidar)))
        });
        of_sweep.unwrap_or((self.table.time_ns, self.world_from_ego, DAffine3::IDENTITY))
    }

    /// Detections of an object by all radars.
    fn radar_points(&self, id: u32) -> u32 {
        let objects = self.radars.iter().flat_map(|cycle| &cycle.table.objects);
        objects.filter(|object| object.id == id).map(|object| object.points).sum()
    }

    /// Points on an object: as the sweep tells, or one on what a camera sees.
    fn lidar_points(&self, id: u32, visible_px: u64) -> u32 {
        match &self.sweep {
            Some(sweep) => sweep.table.objects.iter().find(|object| object.id == id).map_or(0, |object| object.points),
            None => u32::from(visible_px > 0),
        }
    }
}

fn scene_rows(scene: &str, moments: &BTreeMap<u32, Moment>, unit: &mut Unit<'_>) -> Result<(), WriteError> {
    let Some(Moment { table, .. }) = moments.values().next() else { return Ok(()) };
    let numbers = PanopticNumbers::of(moments.values().filter_map(|moment| moment.sweep.as_ref()));
    let mut calibrations = BTreeSet::new();
    let (mut samples, mut sweeps) = (Vec::new(), Vec::new());
    let mut radars: BTreeMap<&str, Vec<Value>> = BTreeMap::new();
    for (keyframe, moment) in moments {
        samples.push(json!({
            "token": sample_token(scene, *keyframe),
            "timestamp": moment.table.keyframe_time_ns / 1000,
            "scene_token": token("scene", scene),
        }));
        // The devkit takes a sample's own pose from its sweep, and so do others: where none was made there is one without points.
        let path = format!("samples/{LIDAR}/{scene}__{LIDAR}__{keyframe:06}.pcd.bin");
        let name = format!("{scene}/{keyframe}/{LIDAR}");
        let points = match &moment.sweep {
            Some(sweep) => nuscenes_lidar::points(sweep, &token("sample_data", &name), &numbers, unit)?,
            None => Vec::new(),
        };
        unit.write(&path, &points)?;
        let (time_ns, world_from_ego, ego_from_lidar) = moment.lidar();
        let calibrated = calibrated_sensor(scene, LIDAR, ego_from_lidar, None);
        if calibrations.insert(calibrated["token"].to_string()) {
            unit.row("calibrated_sensor", &calibrated)?;
        }
        sweeps.push(json!({
            "token": token("sample_data", &name),
            "sample_token": sample_token(scene, *keyframe),
            "ego_pose_token": token("ego_pose", &name),
            "calibrated_sensor_token": calibrated["token"],
            "timestamp": time_ns / 1000,
            "fileformat": "pcd",
            "is_key_frame": true,
            "height": 0,
            "width": 0,
            "filename": path,
        }));
        let plane_from_ego = in_plane(&moment.table, &world_from_ego);
        unit.row("ego_pose", &ego_pose(&name, time_ns, plane_from_ego))?;
        for cycle in &moment.radars {
            let channel = channel(&cycle.table.view);
            let path = format!("samples/{channel}/{scene}__{channel}__{keyframe:06}.pcd");
            unit.write(&path, &nuscenes_radar::file(cycle)?)?;
            let name = format!("{scene}/{keyframe}/{channel}");
            let world_from_ego = affine(&cycle.table.world_from_ego);
            let ego_from_radar = world_from_ego.inverse() * affine(&cycle.table.world_from_radar);
            let calibrated = calibrated_sensor(scene, channel, ego_from_radar, None);
            if calibrations.insert(calibrated["token"].to_string()) {
                unit.row("calibrated_sensor", &calibrated)?;
            }
            let plane_from_ego = in_plane(&moment.table, &world_from_ego);
            unit.row("ego_pose", &ego_pose(&name, cycle.table.time_ns, plane_from_ego))?;
            radars.entry(channel).or_default().push(json!({
                "token": token("sample_data", &name),
                "sample_token": sample_token(scene, *keyframe),
                "ego_pose_token": token("ego_pose", &name),
                "calibrated_sensor_token": calibrated["token"],
                "timestamp": cycle.table.time_ns / 1000,
                "fileformat": "pcd",
                "is_key_frame": true,
                "height": 0,
                "width": 0,
                "filename": path,
            }));
        }
    }
    for mut cycles in radars.into_values() {
        link(&mut cycles);
        cycles.iter().try_for_each(|row| unit.row("sample_data", row))?;
    }
    for (table, rows) in [("sample", &mut samples), ("sample_data", &mut sweeps)] {
        link(rows);
        rows.iter().try_for_each(|row| unit.row(table, row))?;
    }
    let log = log(scene, table);
    let row = json!({
        "token": token("scene", scene),
        "log_token": log["token"],
        "nbr_samples": samples.len(),
        "first_sample_token": samples.first().map(|row| &row["token"]),
        "last_sample_token": samples.last().map(|row| &row["token"]),
        "name": scene,
        "description": format!("{}, variation {}", table.scene, table.variation),
    });
    unit.row("log", &log)?;
    unit.row("scene", &row)
}

/// A scene's road users, each through all moments.
#[derive(Default)]
struct Tracks(BTreeMap<u32, Track>);

struct Track {
    kind: Kind,
    category: &'static str,
    sightings: BTreeMap<u32, Sighting>,
}

/// An object at one moment, in all views.
struct Sighting {
    plane_from_body: DAffine3,
    size_m: [f64; 3],
    states: Vec<State>,
    visible_px: u64,
    amodal_px: u64,
}

impl Tracks {
    fn look(&mut self, keyframe: u32, table: &FrameTable) {
        for object in table.objects.iter().filter(|object| object.origin != ObjectOrigin::Scenery) {
            let Some(category) = kinds::nuscenes(object.kind) else { continue };
            let new = || Track { kind: object.kind, category, sightings: BTreeMap::new() };
            let sightings = &mut self.0.entry(object.id).or_insert_with(new).sightings;
            let sighting = sightings.entry(keyframe).or_insert_with(|| Sighting {
                plane_from_body: in_plane(table, &affine(&object.world_from_body)),
                size_m: object.size_m,
                states: object.states.clone(),
                visible_px: 0,
                amodal_px: 0,
            });
            sighting.visible_px += u64::from(object.visible_px);
            sighting.amodal_px += u64::from(object.amodal_px);
        }
    }

    fn rows(&self, scene: &str, moments: &BTreeMap<u32, Moment>, unit: &mut Unit<'_>) -> Result<(), WriteError> {
        for (id, Track { kind, category, sightings }) in &self.0 {
            let instance = token("instance", &format!("{scene}/{id}"));
            let mut annotations = Vec::new();
            for (keyframe, sighting) in sightings {
                let attribute = attribute(*kind, &sighting.states);
                let [length, width, height] = sighting.size_m;
                annotations.push(json!({
                    "token": token("sample_annotation", &format!("{scene}/{id}/{keyframe}")),
                    "sample_token": sample_token(scene, *keyframe),
                    "instance_token": instance,
                    "visibility_token": level(sighting.visible_px, sighting.amodal_px).to_string(),
                    "attribute_tokens": attribute.map(|name| token("attribute", name)).into_iter().collect::<Vec<_>>(),
                    "translation": sighting.plane_from_body.translation.to_array(),
                    "size": [width, length, height],
                    "rotation": quaternion_wxyz(&sighting.plane_from_body),
                    // Boxes without points are neither trained nor judged on.
                    "num_lidar_pts": moments[keyframe].lidar_points(*id, sighting.visible_px),
                    "num_radar_pts": moments[keyframe].radar_points(*id),
                }));
            }
            link(&mut annotations);
            let row = json!({
                "token": instance,
                "category_token": token("category", category),
                "nbr_annotations": annotations.len(),
                "first_annotation_token": annotations.first().map(|row| &row["token"]),
                "last_annotation_token": annotations.last().map(|row| &row["token"]),
            });
            unit.row("instance", &row)?;
            annotations.iter().try_for_each(|row| unit.row("sample_annotation", row))?;
        }
        Ok(())
    }
}

/// The number of nuScenes' level of visibility: the share of an object that all views together show.
fn level(visible_px: u64, amodal_px: u64) -> u8 {
    let percent = 100 * visible_px / amodal_px.max(1);
    match percent {
        ..40 => 1,
        40..60 => 2,
        60..80 => 3,
        _ => 4,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_shares_of_all_views_together() {
        assert_eq!([level(0, 0), level(39, 100), level(40, 100), level(79, 100), level(100, 100)], [1, 1, 2, 3, 4]);
    }
}
