//! HDF5 files as BlenderProc writes them, one a frame.

use hdf5_pure::{DatasetBuilder, FileBuilder};
use serde_json::{Value, json};
use trove_format::FrameFile;

use super::dataset::Dataset;
use super::plan::Plan;
use super::unit::Unit;
use crate::{StoredFrame, WriteError};

/// `<split>/<frame>.hdf5`.
pub(super) struct Hdf5;

/// What Blender writes as the depth of the sky, metres.
const SKY_DEPTH_M: f32 = 1e10;
/// Rows of a block that is packed on its own.
const BLOCK_ROWS: u64 = 64;
/// Fast, since most files are read more often than they are kept.
const COMPRESSION: u32 = 4;

impl Dataset for Hdf5 {
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        for &number in frames {
            let planned = &plan.frames[number];
            let bytes = encoded(&plan.open(planned)?)?;
            unit.write(&format!("{}/{number}.hdf5", planned.split), &bytes)?;
        }
        Ok(())
    }
}

fn encoded(frame: &StoredFrame) -> Result<Vec<u8>, WriteError> {
    let mut file = FileBuilder::new();
    let size = [u64::from(frame.table.height_px), u64::from(frame.table.width_px)];
    let mut add = |name: &str, channels: u64, fill: &dyn Fn(&mut DatasetBuilder)| {
        let [height, width] = size;
        let dataset = file.create_dataset(name);
        fill(dataset);
        match channels {
            1 => dataset.with_shape(&[height, width]).with_chunks(&[height.min(BLOCK_ROWS), width]),
            _ => dataset.with_shape(&[height, width, channels]).with_chunks(&[height.min(BLOCK_ROWS), width, channels]),
        };
        dataset.with_shuffle().with_deflate(COMPRESSION);
    };
    if frame.has(FrameFile::Rgb) {
        let colors = frame.rgb()?;
        add("colors", 3, &|dataset| _ = dataset.with_u8_data(colors.data.as_flattened()));
    }
    if frame.has(FrameFile::Depth) {
        let depth = frame.depth_m()?.map(|depth_m| if depth_m.is_finite() { *depth_m } else { SKY_DEPTH_M });
        add("depth", 1, &|dataset| _ = dataset.with_f32_data(&depth.data));
    }
    if frame.has(FrameFile::Normal) {
        // Blender's camera looks along −z with y up; values are from 0 to 1.
        let normals = frame.normal()?.map(|&[x, y, z]| [x, -y, -z].map(|part| 0.5 + 0.5 * part));
        add("normals", 3, &|dataset| _ = dataset.with_f32_data(normals.data.as_flattened()));
    }
    let class = frame.class()?.map(|class| class.id());
    add("class_segmaps", 1, &|dataset| _ = dataset.with_u8_data(&class.data));
    let instance = frame.instance()?;
    add("instance_segmaps", 1, &|dataset| _ = dataset.with_u16_data(&instance.data));
    for (name, file) in [("forward_flow", FrameFile::FlowForward), ("backward_flow", FrameFile::FlowBackward)] {
        if frame.has(file) {
            let flow = if file == FrameFile::FlowForward { frame.flow_forward()? } else { frame.flow_backward()? };
            add(name, 2, &|dataset| _ = dataset.with_f32_data(flow.data.as_flattened()));
        }
    }
    let text = |name: &str, value: &Value, file: &mut FileBuilder| {
        file.create_dataset(name).with_vlen_strings(&[&value.to_string()]).with_shape(&[]);
    };
    let row = |object: &trove_format::ObjectRow| {
        json!({
            "idx": object.id,
            "category_id": object.class_id,
            "name": object.kind.name(),
            "world_from_body": object.world_from_body,
            "size_m": object.size_m,
        })
    };
    // Id 0 is what belongs to no object.
    let none = json!({ "idx": 0, "category_id": 0, "name": "none" });
    let rows: Vec<Value> = [none].into_iter().chain(frame.table.objects.iter().map(row)).collect();
    text("instance_attribute_maps", &json!(rows), &mut file);
    let camera = json!({
        "intrinsics": frame.table.intrinsics,
        "world_from_camera": frame.table.world_from_camera,
        "time_ns": frame.table.time_ns,
    });
    text("camera", &camera, &mut file);
    file.finish().map_err(|e| WriteError::Encoding { name: "hdf5".into(), found: e.to_string() })
}
