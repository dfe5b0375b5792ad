//! nuImages: ten tables of rows, a picture and its masks each on its own.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use trove_format::{FrameFile, FrameTable, LensModel, ObjectOrigin};
use trove_model::{Class, Mask, Raster};

use super::dataset::{Dataset, Finished};
use super::geometry::affine;
use super::kinds;
use super::nuscenes_rows::{
    ATTRIBUTES, VERSION, attribute, calibrated_sensor, channel, ego_pose, in_plane, log, named_rows, sensor, token,
    world_from_ego,
};
use super::plan::Plan;
use super::tables::write_list;
use super::unit::Unit;
use crate::masks::{packed, run_lengths, within};
use crate::{StoredFrame, WriteError};

/// `v1.0-trove/*.json` and `samples/<camera>/*.png`.
pub(super) struct NuImages;

/// What pictures show of the ground that vehicles drive on.
const DRIVABLE: &str = "flat.driveable_surface";

impl Dataset for NuImages {
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        for &number in frames {
            let planned = &plan.frames[number];
            let frame = plan.open(planned)?;
            let table = &frame.table;
            let Some(world_from_ego) = world_from_ego(table, unit) else { continue };
            let channel = channel(&planned.view);
            let path = format!("samples/{channel}/{}.png", planned.path.replace('/', "__"));
            unit.link(&path, &frame.needed(FrameFile::Rgb)?)?;
            let name = &planned.path;
            let data = token("sample_data", name);
            let ego_from_camera = world_from_ego.inverse() * affine(&table.world_from_camera);
            let mut calibrated = calibrated_sensor(name, channel, ego_from_camera, Some(&table.intrinsics));
            calibrated["camera_distortion"] = distortion(table, unit);
            let mut pose = ego_pose(name, table.time_ns, in_plane(table, &world_from_ego));
            // What no frame tells.
            for unknown in ["speed", "acceleration", "rotation_rate"] {
                pose[unknown] = Value::Null;
            }
            let log = log(name, table);
            let sample = json!({
                "token": token("sample", name),
                "timestamp": table.time_ns / 1000,
                "log_token": log["token"],
                "key_camera_token": data,
            });
            let sample_data = json!({
                "token": data,
                "sample_token": sample["token"],
                "ego_pose_token": pose["token"],
                "calibrated_sensor_token": calibrated["token"],
                "timestamp": table.time_ns / 1000,
                "fileformat": "png",
                "is_key_frame": true,
                "height": table.height_px,
                "width": table.width_px,
                "filename": path,
                "prev": "",
                "next": "",
            });
            unit.row("log", &log)?;
            unit.row("sample", &sample)?;
            unit.row("sample_data", &sample_data)?;
            unit.row("ego_pose", &pose)?;
            unit.row("calibrated_sensor", &calibrated)?;
            annotations(&frame, name, &data, unit)?;
        }
        Ok(())
    }

    fn finish(&self, finished: &Finished<'_>, unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let mut categories: Vec<&str> = kinds::nuscenes_categories().into_iter().collect();
        categories.push(DRIVABLE);
        let channels: BTreeSet<&str> = finished.plan.frames.iter().map(|frame| channel(&frame.view)).collect();
        let fixed = [
            ("category", named_rows("category", &categories)),
            ("attribute", named_rows("attribute", &ATTRIBUTES)),
            ("sensor", channels.into_iter().map(|channel| sensor(channel, "camera")).collect()),
        ];
        for (table, rows) in fixed {
            write_list(finished, &format!("{VERSION}/{table}.json"), &rows, table, unit)?;
        }
        for table in ["log", "sample", "sample_data", "ego_pose", "calibrated_sensor", "object_ann", "surface_ann"] {
            write_list(finished, &format!("{VERSION}/{table}.json"), &[], table, unit)?;
        }
        Ok(())
    }
}

/// Rows of what a picture shows.
fn annotations(frame: &StoredFrame, name: &str, data: &str, unit: &mut Unit<'_>) -> Result<(), WriteError> {
    let (class, instance) = (frame.class()?, frame.instance()?);
    for object in frame.table.objects.iter().filter(|object| object.origin != ObjectOrigin::Scenery) {
        let (Some(category), Some(bounds)) = (kinds::nuscenes(object.kind), object.visible_box) else { continue };
        let mask = within(bounds, |x, y| u32::from(*instance.at(x, y)) == object.id);
        let attribute = attribute(object.kind, &object.states);
        let [x0, y0, x1, y1] = bounds;
        let row = json!({
            "token": token("object_ann", &format!("{name}/{}", object.id)),
            "sample_data_token": data,
            "category_token": token("category", category),
            "attribute_tokens": attribute.map(|name| token("attribute", name)).into_iter().collect::<Vec<_>>(),
            "bbox": [x0, y0, x1 + 1, y1 + 1],
            "mask": encoded(&mask, &instance),
        });
        unit.row("object_ann", &row)?;
    }
    if class.data.contains(&Class::Road) {
        let mask = within([0, 0, class.width - 1, class.height - 1], |x, y| *class.at(x, y) == Class::Road);
        let row = json!({
            "token": token("surface_ann", name),
            "sample_data_token": data,
            "category_token": token("category", DRIVABLE),
            "mask": encoded(&mask, &instance),
        });
        unit.row("surface_ann", &row)?;
    }
    Ok(())
}

/// COCO's string once more in base64, as nuImages has it.
fn encoded(mask: &Mask, picture: &Raster<u16>) -> Value {
    let counts = packed(&run_lengths(mask, picture.width, picture.height));
    json!({ "size": [picture.height, picture.width], "counts": STANDARD.encode(counts) })
}

/// nuImages' five or six coefficients: k₁ k₂ p₁ p₂ k₃ k₄.
fn distortion(table: &FrameTable, unit: &mut Unit<'_>) -> Value {
    let longer = table.distortion.iter().skip(6).any(|k| *k != 0.0);
    match table.lens_model {
        LensModel::Pinhole => json!([0.0, 0.0, 0.0, 0.0, 0.0]),
        LensModel::BrownConrady if !longer => {
            let sixth = table.distortion.get(5).is_some_and(|k| *k != 0.0);
            json!(table.distortion.iter().take(if sixth { 6 } else { 5 }).collect::<Vec<_>>())
        }
        _ => {
            unit.clip("frames whose lens distorts, which the form does not tell", 1);
            json!([])
        }
    }
}
