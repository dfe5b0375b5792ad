//! ASAM OpenLABEL 1.0: cuboids, boxes and cameras of a sequence in one JSON file.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};
use trove_format::{FrameFile, FrameTable, ObjectOrigin, ObjectRow};

use super::dataset::Dataset;
use super::geometry::{affine, quaternion_wxyz};
use super::plan::Plan;
use super::unit::Unit;
use crate::WriteError;

/// `<split>/<sequence>.json` and `<split>/<sequence>/*.png`.
pub(super) struct OpenLabel;

/// The coordinate system that all others are placed in.
const WORLD: &str = "world";

impl Dataset for OpenLabel {
    fn units(&self, plan: &Plan) -> Vec<Vec<usize>> {
        plan.sequences()
    }

    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let first = &plan.frames[frames[0]];
        let name = format!("{}_v{:02}_{}", first.scene, first.variation, first.view);
        let camera = first.view.as_str();
        let (mut rows, mut tracks) = (Map::new(), BTreeMap::new());
        let mut stream = Value::Null;
        for &number in frames {
            let planned = &plan.frames[number];
            let frame = plan.open(planned)?;
            let (index, table) = (planned.index, &frame.table);
            let picture = format!("{name}/{index:06}.png");
            unit.link(&format!("{}/{picture}", first.split), &frame.needed(FrameFile::Rgb)?)?;
            let intrinsics = intrinsics(table);
            if stream.is_null() {
                let properties = json!({ "intrinsics_pinhole": intrinsics });
                stream = json!({ "type": "camera", "uri": name, "stream_properties": properties });
            }
            rows.insert(index.to_string(), frame_row(table, camera, &picture, intrinsics));
            for object in table.objects.iter().filter(|object| object.origin != ObjectOrigin::Scenery) {
                let track = tracks.entry(object.id).or_insert_with(|| (object.kind, object.asset.clone(), Vec::new()));
                track.2.push(index);
            }
        }
        let objects: Map<String, Value> = tracks
            .into_iter()
            .map(|(id, (kind, asset, indices))| {
                let row = json!({
                    "name": format!("{} {id}", kind.name()),
                    "type": kind.name(),
                    "frame_intervals": intervals(&indices),
                    "object_data": { "text": [{ "name": "asset", "val": asset }] },
                });
                (id.to_string(), row)
            })
            .collect();
        let file = json!({ "openlabel": {
            "metadata": { "schema_version": "1.0.0", "name": name, "annotator": concat!("trove ", env!("CARGO_PKG_VERSION")) },
            "coordinate_systems": {
                WORLD: { "type": "scene_cs", "parent": "", "children": [camera] },
                camera: { "type": "sensor_cs", "parent": WORLD, "children": [] },
            },
            "streams": { camera: stream },
            "objects": objects,
            "frames": rows,
            "frame_intervals": [{ "frame_start": 0, "frame_end": frames.len() - 1 }],
        } });
        unit.stream(&format!("{}/{name}.json", first.split), |writer| Ok(serde_json::to_writer(writer, &file)?))
    }
}

fn intrinsics(table: &FrameTable) -> Value {
    let matrix: Vec<f64> = table.intrinsics.iter().flat_map(|row| [row[0], row[1], row[2], 0.0]).collect();
    let mut intrinsics = json!({
        "width_px": table.width_px,
        "height_px": table.height_px,
        "camera_matrix_3x4": matrix,
        "distortion_coeffs_1xN": table.distortion,
    });
    // The form names no models of distortion.
    intrinsics["trove_lens_model"] = json!(table.lens_model);
    intrinsics
}

fn frame_row(table: &FrameTable, camera: &str, picture: &str, intrinsics: Value) -> Value {
    let objects: Map<String, Value> = table
        .objects
        .iter()
        .filter(|object| object.origin != ObjectOrigin::Scenery)
        .map(|object| (object.id.to_string(), json!({ "object_data": object_data(object, camera) })))
        .collect();
    let matrix = table.world_from_camera.as_flattened();
    json!({
        "frame_properties": {
            "timestamp": seconds(table.time_ns),
            "streams": { camera: { "uri": picture, "stream_properties": {
                "intrinsics_pinhole": intrinsics,
                "sync": { "timestamp": seconds(table.time_ns) },
            } } },
            "transforms": { format!("{camera}_to_{WORLD}"): {
                "src": camera,
                "dst": WORLD,
                "transform_src_to_dst": { "matrix4x4": matrix },
            } },
        },
        "objects": objects,
    })
}

/// Seconds since 1970 with all their digits.
fn seconds(time_ns: i64) -> String {
    format!("{}.{:09}", time_ns.div_euclid(1_000_000_000), time_ns.rem_euclid(1_000_000_000))
}

fn object_data(object: &ObjectRow, camera: &str) -> Value {
    let world_from_body = affine(&object.world_from_body);
    let [x, y, z] = world_from_body.translation.to_array();
    let [qw, qx, qy, qz] = quaternion_wxyz(&world_from_body);
    let [length, width, height] = object.size_m;
    let cuboid = json!({
        "name": "box",
        "coordinate_system": WORLD,
        "val": [x, y, z, qx, qy, qz, qw, length, width, height],
    });
    // Middle, width and height.
    let bbox = |name: &str, [x0, y0, x1, y1]: [u32; 4]| {
        let [x0, y0, x1, y1] = [x0, y0, x1 + 1, y1 + 1].map(f64::from);
        json!({
            "name": name,
            "coordinate_system": camera,
            "val": [(x0 + x1) / 2.0, (y0 + y1) / 2.0, x1 - x0, y1 - y0],
        })
    };
    let boxes = [("visible", object.visible_box), ("amodal", object.amodal_box)];
    let boxes: Vec<Value> = boxes.into_iter().filter_map(|(name, bounds)| Some(bbox(name, bounds?))).collect();
    let mut data = json!({
        "cuboid": [cuboid],
        "num": [
            { "name": "truncation", "val": object.truncation },
            { "name": "occlusion", "val": object.occlusion },
        ],
    });
    if !boxes.is_empty() {
        data["bbox"] = json!(boxes);
    }
    data
}

/// Runs of frames that follow each other.
fn intervals(indices: &[u32]) -> Value {
    let run = |run: &[u32]| json!({ "frame_start": run.first(), "frame_end": run.last() });
    json!(indices.chunk_by(|a, b| a + 1 == *b).map(run).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_object_that_comes_back_has_two_intervals() {
        let expected = json!([{ "frame_start": 0, "frame_end": 1 }, { "frame_start": 4, "frame_end": 4 }]);
        assert_eq!(intervals(&[0, 1, 4]), expected);
        assert_eq!(seconds(1_500_000_005), "1.500000005");
    }
}
