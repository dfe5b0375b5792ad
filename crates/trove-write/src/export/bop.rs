//! BOP: pictures, depth, masks and poses of rigid models, a folder a sequence.

use std::collections::BTreeMap;

use glam::DAffine3;
use serde_json::{Map, Value, json};
use trove_format::{FrameFile, ObjectOrigin, ObjectRow};

use super::dataset::{Dataset, Finished};
use super::geometry::{camera_from_body, camera_from_world};
use super::kitti::note_distortion;
use super::plan::{Plan, PlannedFrame};
use super::unit::Unit;
use crate::masks::{run_lengths, within};
use crate::{StoredFrame, WriteError, png_file};

/// `<split>/<sequence>/{rgb,depth,mask_visib,mask}` with `scene_*.json`, and `models/models_info.json`.
pub(super) struct Bop;

/// Millimetres in a step of depth: 16 bits reach 655.35 m.
const DEPTH_STEP_MM: f64 = 10.0;
/// Below this share visible, BOP's detection does not count an object.
const IGNORED_BELOW: f64 = 0.1;

const CAMERAS: &str = "cameras";
const POSES: &str = "poses";
const INFOS: &str = "infos";
const MASKS: &str = "masks";

impl Dataset for Bop {
    fn units(&self, plan: &Plan) -> Vec<Vec<usize>> {
        plan.sequences()
    }

    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        for &number in frames {
            let planned = &plan.frames[number];
            let frame = plan.open(planned)?;
            let (folder, image) = (folder(planned), planned.index);
            unit.link(&format!("{folder}/rgb/{image:06}.png"), &frame.needed(FrameFile::Rgb)?)?;
            note_distortion(&frame.table, unit);
            write_depth(&frame, &format!("{folder}/depth/{image:06}.png"), unit)?;
            let camera_from_world = camera_from_world(&frame.table);
            let [rotation, translation] = pose_mm(&camera_from_world);
            unit.row(
                CAMERAS,
                &json!({
                    "cam_K": frame.table.intrinsics.as_flattened(),
                    "cam_R_w2c": rotation,
                    "cam_t_w2c": translation,
                    "depth_scale": DEPTH_STEP_MM,
                    "width": frame.table.width_px,
                    "height": frame.table.height_px,
                }),
            )?;
            objects(&frame, planned, unit)?;
        }
        Ok(())
    }

    fn finish(&self, finished: &Finished<'_>, unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let models = models(finished)?;
        let info = |[x, y, z]: &[u64; 3]| {
            let [x, y, z] = [*x as f64, *y as f64, *z as f64];
            json!({
                "diameter": (x * x + y * y + z * z).sqrt(),
                "min_x": -x / 2.0, "min_y": -y / 2.0, "min_z": -z / 2.0,
                "size_x": x, "size_y": y, "size_z": z,
            })
        };
        let infos: Map<String, Value> = models.iter().map(|((_, size), id)| (id.to_string(), info(size))).collect();
        write_json("models/models_info.json", &Value::Object(infos), unit)?;
        for rows in finished.rows(None) {
            let (frames, rows) = rows?;
            let parsed = |table: &str| -> Result<Vec<Value>, WriteError> {
                let rows = rows.get(table).into_iter().flatten();
                rows.map(|row| serde_json::from_str(row.get()).map_err(|e| WriteError::Mismatch(e.to_string())))
                    .collect()
            };
            let numbered = |values: Vec<Value>| -> Value {
                Value::Object(values.into_iter().enumerate().map(|(i, value)| (i.to_string(), value)).collect())
            };
            let mut poses = parsed(POSES)?;
            for pose in poses.iter_mut().filter_map(Value::as_array_mut).flatten() {
                pose["obj_id"] = json!(models.get(&model(&pose["model"])));
                pose.as_object_mut().map(|pose| pose.remove("model"));
            }
            let (cameras, infos, masks) = (parsed(CAMERAS)?, parsed(INFOS)?, parsed(MASKS)?);
            let folder = folder(&finished.plan.frames[frames[0]]);
            let mut coco = coco(&models, &cameras, &poses, &infos, &masks);
            coco["info"] =
                json!({ "description": "made by trove export", "version": finished.manifest.versions.trove });
            coco["licenses"] = finished.licenses();
            write_json(&format!("{folder}/scene_gt_coco.json"), &coco, unit)?;
            write_json(&format!("{folder}/scene_camera.json"), &numbered(cameras), unit)?;
            write_json(&format!("{folder}/scene_gt.json"), &numbered(poses), unit)?;
            write_json(&format!("{folder}/scene_gt_info.json"), &numbered(infos), unit)?;
        }
        Ok(())
    }
}

/// A model as it stands in the scene, and its size in whole millimetres: one model fits boxes of several sizes.
type Model = (String, [u64; 3]);

/// The numbers of all models, from 1.
fn models(finished: &Finished<'_>) -> Result<BTreeMap<Model, usize>, WriteError> {
    let mut models = BTreeMap::new();
    for rows in finished.rows(None) {
        for row in rows?.1.get(POSES).into_iter().flatten() {
            let poses: Vec<Value> = serde_json::from_str(row.get()).map_err(|e| WriteError::Mismatch(e.to_string()))?;
            models.extend(poses.iter().map(|pose| (model(&pose["model"]), 0)));
        }
    }
    models.values_mut().zip(1..).for_each(|(id, number)| *id = number);
    Ok(models)
}

fn model(row: &Value) -> Model {
    (row[0].as_str().unwrap_or_default().to_owned(), [1, 2, 3].map(|i| row[i].as_u64().unwrap_or_default()))
}

fn folder(planned: &PlannedFrame) -> String {
    format!("{}/{:06}", planned.split, planned.sequence)
}

fn write_json(path: &str, value: &Value, unit: &mut Unit<'_>) -> Result<(), WriteError> {
    unit.stream(path, |file| Ok(serde_json::to_writer(file, value)?))
}

fn write_depth(frame: &StoredFrame, path: &str, unit: &mut Unit<'_>) -> Result<(), WriteError> {
    let depth_m = frame.depth_m()?;
    let mut clipped = 0;
    let step = |depth_m: &f32| {
        let steps = (f64::from(*depth_m) * 1000.0 / DEPTH_STEP_MM).round();
        let fits = (1.0..=f64::from(u16::MAX)).contains(&steps);
        clipped += u64::from(!fits && depth_m.is_finite());
        // 0 is no measurement.
        if fits { steps as u16 } else { 0 }
    };
    let steps: Vec<u16> = depth_m.data.iter().map(step).collect();
    unit.clip("depths below 5 mm or beyond 655.35 m, written as no measurement", clipped);
    unit.write(path, &png_file::grey16(path, depth_m.width, depth_m.height, &steps)?)
}

/// Rows and masks of the road users that have a model.
fn objects(frame: &StoredFrame, planned: &PlannedFrame, unit: &mut Unit<'_>) -> Result<(), WriteError> {
    let instance = frame.instance()?;
    let (width, height) = (instance.width, instance.height);
    let has_model = |object: &&ObjectRow| object.origin != ObjectOrigin::Scenery && !object.asset.is_empty();
    let whole = if frame.has(FrameFile::Masks) { frame.masks()?.objects } else { Vec::new() };
    if whole.is_empty() && frame.table.objects.iter().any(|object| has_model(&object)) {
        unit.clip("frames without masks.json, whose objects have no whole masks (mask)", 1);
    }
    let (mut poses, mut infos, mut masks) = (Vec::new(), Vec::new(), Vec::new());
    for (i, object) in frame.table.objects.iter().filter(has_model).enumerate() {
        let path = format!("{}/mask_visib/{:06}_{i:06}.png", folder(planned), planned.index);
        let pixels: Vec<u8> = instance.data.iter().map(|id| 255 * u8::from(u32::from(*id) == object.id)).collect();
        unit.write(&path, &png_file::grey(&path, width, height, &pixels)?)?;
        if let Some(row) = whole.iter().find(|row| row.id == object.id) {
            let path = format!("{}/mask/{:06}_{i:06}.png", folder(planned), planned.index);
            let pixels: Vec<u8> = frame.painted(&row.amodal)?.data.iter().map(|is_in| 255 * u8::from(*is_in)).collect();
            unit.write(&path, &png_file::grey(&path, width, height, &pixels)?)?;
        }
        let [rotation, translation] = pose_mm(&camera_from_body(&frame.table, object));
        let [x, y, z] = object.size_m.map(|side| (side * 1000.0).round() as u64);
        poses.push(json!({ "cam_R_m2c": rotation, "cam_t_m2c": translation, "model": [object.asset, x, y, z] }));
        infos.push(json!({
            "bbox_obj": xywh(object.amodal_box),
            "bbox_visib": xywh(object.visible_box),
            "px_count_all": object.amodal_px,
            "px_count_valid": object.amodal_px,
            "px_count_visib": object.visible_px,
            "visib_fract": f64::from(object.visible_px) / f64::from(object.amodal_px.max(1)),
        }));
        let runs = object.visible_box.map_or_else(
            || vec![width * height],
            |bounds| run_lengths(&within(bounds, |x, y| u32::from(*instance.at(x, y)) == object.id), width, height),
        );
        masks.push(runs);
    }
    unit.row(POSES, &poses)?;
    unit.row(INFOS, &infos)?;
    unit.row(MASKS, &masks)
}

/// Rotation by rows, and translation in millimetres.
fn pose_mm(pose: &DAffine3) -> [Vec<f64>; 2] {
    let rotation = pose.matrix3.transpose().to_cols_array().to_vec();
    [rotation, (pose.translation * 1000.0).to_array().to_vec()]
}

/// First column, first row, width and height; −1 where nothing is seen.
fn xywh(bounds: Option<[u32; 4]>) -> [i64; 4] {
    bounds.map_or([-1; 4], |[x0, y0, x1, y1]| [x0, y0, x1 + 1 - x0, y1 + 1 - y0].map(i64::from))
}

/// The sequence as COCO's objects.
fn coco(
    models: &BTreeMap<Model, usize>,
    cameras: &[Value],
    poses: &[Value],
    infos: &[Value],
    masks: &[Value],
) -> Value {
    let category =
        |((asset, _), id): (&Model, &usize)| json!({ "id": id, "name": asset, "supercategory": "road user" });
    let image = |(i, camera): (usize, &Value)| json!({ "id": i, "file_name": format!("rgb/{i:06}.png"), "width": camera["width"], "height": camera["height"] });
    let mut annotations = Vec::new();
    for (i, camera) in cameras.iter().enumerate() {
        let of = |rows: &[Value]| rows.get(i).and_then(Value::as_array).cloned().unwrap_or_default();
        for ((pose, info), runs) in of(poses).iter().zip(of(infos)).zip(of(masks)) {
            annotations.push(json!({
                "id": annotations.len() + 1,
                "image_id": i,
                "category_id": pose["obj_id"],
                "iscrowd": 0,
                "area": info["px_count_visib"],
                "bbox": info["bbox_visib"],
                "segmentation": { "size": [camera["height"], camera["width"]], "counts": runs },
                "ignore": info["visib_fract"].as_f64().is_some_and(|share| share < IGNORED_BELOW),
                "width": camera["width"],
                "height": camera["height"],
            }));
        }
    }
    let images: Vec<Value> = cameras.iter().enumerate().map(image).collect();
    json!({ "categories": models.iter().map(category).collect::<Vec<_>>(), "images": images, "annotations": annotations })
}
