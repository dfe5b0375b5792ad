//! Argoverse 2 logs as the tests write them.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use arrow_array::{
    ArrayRef, Float32Array, Float64Array, Int64Array, RecordBatch, StringArray, UInt8Array, UInt16Array,
};
use arrow_ipc::CompressionType;
use arrow_ipc::writer::{FileWriter, IpcWriteOptions};
use serde_json::{Value, json};
use tempfile::TempDir;
use trove_model::{Drive, Report};
use trove_read::ReadError;
use trove_read::argoverse2::Argoverse2;

pub(crate) const LOG: &str = "0b5142c9-420b-3fc0-9f98-b59a4e2d0b91";
pub(crate) const POSES: &str = "city_SE3_egovehicle.feather";
pub(crate) const ANNOTATIONS: &str = "annotations.feather";
pub(crate) const INTRINSICS: &str = "calibration/intrinsics.feather";
pub(crate) const MOUNTS: &str = "calibration/egovehicle_SE3_sensor.feather";
pub(crate) const SWEEP: &str = "sensors/lidar/315966253700000000.feather";
pub(crate) const MAP: &str = "map/log_map_archive_0b5142c9____PIT_city_1.json";
pub(crate) const HEIGHT: &str = "map/0b5142c9_ground_height_surface____PIT.npy";
pub(crate) const SIMILARITY: &str = "map/0b5142c9___img_Sim2_city.json";
/// The first keyframe, as the dataset counts.
pub(crate) const START_NS: i64 = 315_966_253_700_000_000;
pub(crate) const PERIOD_NS: i64 = 100_000_000;

/// A column of a table.
#[derive(Clone, Debug)]
pub(crate) enum Column {
    Float(Vec<f64>),
    Single(Vec<f32>),
    Int(Vec<i64>),
    Byte(Vec<u8>),
    Short(Vec<u16>),
    Text(Vec<String>),
}

impl Column {
    fn array(&self) -> ArrayRef {
        match self {
            Self::Float(values) => Arc::new(Float64Array::from(values.clone())),
            Self::Single(values) => Arc::new(Float32Array::from(values.clone())),
            Self::Int(values) => Arc::new(Int64Array::from(values.clone())),
            Self::Byte(values) => Arc::new(UInt8Array::from(values.clone())),
            Self::Short(values) => Arc::new(UInt16Array::from(values.clone())),
            Self::Text(values) => Arc::new(StringArray::from(values.clone())),
        }
    }

    pub(crate) fn floats(&mut self) -> &mut Vec<f64> {
        if let Self::Float(values) = self { values } else { panic!("a column of floats") }
    }

    pub(crate) fn ints(&mut self) -> &mut Vec<i64> {
        if let Self::Int(values) = self { values } else { panic!("a column of integers") }
    }

    pub(crate) fn texts(&mut self) -> &mut Vec<String> {
        if let Self::Text(values) = self { values } else { panic!("a column of text") }
    }
}

/// Columns by name, in the order of the file.
pub(crate) type Table = Vec<(&'static str, Column)>;

pub(crate) fn column<'a>(table: &'a mut Table, name: &str) -> &'a mut Column {
    &mut table.iter_mut().find(|(n, _)| *n == name).unwrap().1
}

/// A table as the dataset's files have it; LZ4 as pandas writes it, or Zstandard.
pub(crate) fn feather(table: &Table, compression: CompressionType) -> Vec<u8> {
    let batch = RecordBatch::try_from_iter(table.iter().map(|(name, column)| (*name, column.array()))).unwrap();
    let options = IpcWriteOptions::default().try_with_compression(Some(compression)).unwrap();
    let mut writer = FileWriter::try_new_with_options(Vec::new(), &batch.schema(), options).unwrap();
    writer.write(&batch).unwrap();
    writer.into_inner().unwrap()
}

/// The columns of poses, each w, x, y, z, tx, ty, tz.
pub(crate) fn pose_columns(poses: &[[f64; 7]]) -> Table {
    let names = ["qw", "qx", "qy", "qz", "tx_m", "ty_m", "tz_m"];
    names.into_iter().enumerate().map(|(i, name)| (name, Column::Float(poses.iter().map(|p| p[i]).collect()))).collect()
}

pub(crate) fn words<'a>(words: impl IntoIterator<Item = &'a str>) -> Column {
    Column::Text(words.into_iter().map(str::to_owned).collect())
}

/// A NumPy file of float32.
pub(crate) fn npy(width: usize, heights: &[f32]) -> Vec<u8> {
    let header =
        format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {width}), }}\n", heights.len() / width);
    let length = (header.len() as u16).to_le_bytes();
    let data = heights.iter().flat_map(|h| h.to_le_bytes());
    [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes()].concat().into_iter().chain(data).collect()
}

/// A log to be changed and written.
#[derive(Clone)]
pub(crate) struct Log {
    pub(crate) tables: BTreeMap<&'static str, Table>,
    pub(crate) map: Value,
}

impl Log {
    /// Three keyframes on a straight, with a car and a pedestrian, two cameras, a sweep and a map, in Pittsburgh.
    pub(crate) fn small() -> Self {
        let turned = [0.8f64.sqrt(), 0.0, 0.0, 0.2f64.sqrt()];
        let at = |wxyz: [f64; 4], x: f64, y: f64, z: f64| [wxyz[0], wxyz[1], wxyz[2], wxyz[3], x, y, z];
        let upright = [1.0, 0.0, 0.0, 0.0];
        let times: Vec<i64> = (0..9).map(|i| START_NS + (i - 2) * PERIOD_NS / 2).collect();
        let poses: Vec<_> = (0..9).map(|i| at(turned, 5000.0 + f64::from(i), 2400.0, 70.0)).collect();
        let stamps: Vec<i64> = (0..6).map(|i| START_NS + i / 2 * PERIOD_NS).collect();
        let boxes: Vec<_> =
            (0..6).map(|i| if i % 2 == 0 { at(upright, 12.0, 3.0, 0.4) } else { at(turned, 8.0, -4.0, 0.5) }).collect();
        let forward = [0.5, -0.5, 0.5, -0.5];
        let sides = |car: f64, walker: f64| Column::Float([car, walker].repeat(3));
        let mut annotations = vec![
            ("timestamp_ns", Column::Int(stamps)),
            ("track_uuid", words(["car", "walker"].repeat(3))),
            ("category", words(["REGULAR_VEHICLE", "PEDESTRIAN"].repeat(3))),
            ("length_m", sides(4.5, 0.7)),
            ("width_m", sides(1.9, 0.8)),
            ("height_m", sides(1.6, 1.7)),
        ];
        annotations.extend(pose_columns(&boxes));
        annotations.push(("num_interior_pts", Column::Int([100, 7].repeat(3))));
        let mut mounts = vec![("sensor_name", words(["ring_front_center", "ring_rear_left", "up_lidar"]))];
        let sensors =
            [at(forward, 1.6, 0.0, 1.4), at([0.6, -0.6, -0.37, 0.37], 1.1, 0.1, 1.4), at(upright, 1.35, 0.0, 1.64)];
        mounts.extend(pose_columns(&sensors));
        let pixels = |center: f64, rear: f64| Column::Float(vec![center, rear]);
        let intrinsics = vec![
            ("sensor_name", words(["ring_front_center", "ring_rear_left"])),
            ("fx_px", pixels(1776.0, 1684.0)),
            ("fy_px", pixels(1776.0, 1684.0)),
            ("cx_px", pixels(778.0, 1029.0)),
            ("cy_px", pixels(1013.5, 765.8)),
            ("k1", pixels(-0.24, -0.28)),
            ("k2", pixels(-0.2, 0.0)),
            ("k3", pixels(0.3, 0.1)),
            ("height_px", Column::Short(vec![2048, 1550])),
            ("width_px", Column::Short(vec![1550, 2048])),
        ];
        let coordinate = |f: fn(u16) -> f32| Column::Single((0..40).map(f).collect());
        let sweep = vec![
            ("x", coordinate(|i| f32::from(i % 8) - 4.0)),
            ("y", coordinate(|i| f32::from(i / 8))),
            ("z", coordinate(|_| -0.325)),
            ("intensity", Column::Byte(vec![9; 40])),
            ("laser_number", Column::Byte((0..40).collect())),
        ];
        let ego = [&[("timestamp_ns", Column::Int(times))], &pose_columns(&poses)[..]].concat();
        let tables =
            [(POSES, ego), (ANNOTATIONS, annotations), (MOUNTS, mounts), (INTRINSICS, intrinsics), (SWEEP, sweep)];
        Self { tables: tables.into(), map: map() }
    }

    /// The same with one table changed.
    pub(crate) fn with(mut self, table: &str, change: impl FnOnce(&mut Table)) -> Self {
        change(self.tables.get_mut(table).unwrap());
        self
    }

    pub(crate) fn write(&self) -> TempDir {
        let root = tempfile::tempdir().unwrap();
        for (file, bytes) in self.files() {
            put(root.path(), file, &bytes);
        }
        root
    }

    /// Every file of the log, below its folder.
    pub(crate) fn files(&self) -> Vec<(&'static str, Vec<u8>)> {
        let table = |(file, table): (&&'static str, &Table)| (*file, feather(table, CompressionType::LZ4_FRAME));
        let mut files: Vec<_> = self.tables.iter().map(table).collect();
        files.push((MAP, self.map.to_string().into_bytes()));
        files.push((HEIGHT, npy(60, &[69.675; 60 * 40])));
        files.push((
            SIMILARITY,
            json!({"R": [1.0, 0.0, 0.0, 1.0], "t": [-4985.0, -2390.0], "s": 2.0}).to_string().into(),
        ));
        files
    }
}

/// Two lanes in opposite directions with a double line between them, a crossing, and the area that they lie on.
pub(crate) fn map() -> Value {
    let line =
        |points: &[[f64; 2]]| -> Value { points.iter().map(|[x, y]| json!({"x": x, "y": y, "z": 69.7})).collect() };
    let segment = |id: u32, left: Value, right: Value, kind: &str, right_mark: &str| {
        json!({"id": id, "is_intersection": false, "lane_type": kind, "left_lane_boundary": left,
            "right_lane_boundary": right, "left_lane_mark_type": "DOUBLE_SOLID_YELLOW",
            "right_lane_mark_type": right_mark, "successors": [], "predecessors": [],
            "left_neighbor_id": null, "right_neighbor_id": null})
    };
    let (from, to) = (4990.0, 5010.0);
    json!({
        "lane_segments": {
            "1": segment(1, line(&[[from, 2402.0], [to, 2402.0]]), line(&[[from, 2398.5], [to, 2398.5]]), "VEHICLE", "NONE"),
            "2": segment(2, line(&[[to, 2402.0], [from, 2402.0]]), line(&[[to, 2405.5], [from, 2405.5]]), "VEHICLE", "DASHED_WHITE"),
            "3": segment(3, line(&[[to, 2405.5], [from, 2405.5]]), line(&[[to, 2407.0], [from, 2407.0]]), "BIKE", "SOLID_WHITE"),
        },
        "drivable_areas": {"7": {"id": 7, "area_boundary": line(&[[from, 2398.0], [to, 2398.0], [to, 2407.5], [from, 2407.5], [from, 2398.0]])}},
        "pedestrian_crossings": {"8": {"id": 8, "edge1": line(&[[5006.0, 2398.0], [5006.0, 2407.5]]), "edge2": line(&[[5009.0, 2407.5], [5009.0, 2398.0]])}},
    })
}

/// Writes a file of the log below a root.
pub(crate) fn put(root: &Path, file: &str, bytes: &[u8]) {
    let path = root.join(LOG).join(file);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, bytes).unwrap();
}

pub(crate) fn load(root: &Path, report: &Report) -> Result<Drive, ReadError> {
    Argoverse2::open(root, report)?.drive(LOG, report)
}
