//! Measures how scenes load from tables of the size of v1.0-trainval: 850 scenes, 2.6 M `sample_data` and `ego_pose`,
//! 1.2 M `sample_annotation` rows, 2 GB of JSON.
//!
//! `cargo run --release -p trove-read --example nuscenes_size [-- --scenes N]`
//!
//! The tables are made up (seeded, in the official formatting, rows of all scenes interleaved, which is the worst
//! order for an index), lie in the temporary folder and are removed afterwards. First pass and later load run in
//! processes of their own, so that their peak memory is their own.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use trove_model::{Random, Report, Seed};
use trove_read::nuscenes::NuScenes;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

const VERSION: &str = "v1.0-trainval";
const SAMPLES: usize = 40;
const INSTANCES: usize = 76;
/// Annotations of one instance.
const TRACK: usize = 18;
/// `sample_data` rows of a scene for each sensor: keyframes and what lies between them.
const SWEEPS: usize = 258;
/// Points of a LiDAR sweep.
const SWEEP_POINTS: usize = 34_720;
/// Between two samples, microseconds.
const PERIOD_US: i64 = 500_000;

const CHANNELS: [(&str, &str, &str); 12] = [
    ("LIDAR_TOP", "lidar", "pcd.bin"),
    ("CAM_FRONT", "camera", "jpg"),
    ("CAM_FRONT_LEFT", "camera", "jpg"),
    ("CAM_FRONT_RIGHT", "camera", "jpg"),
    ("CAM_BACK", "camera", "jpg"),
    ("CAM_BACK_LEFT", "camera", "jpg"),
    ("CAM_BACK_RIGHT", "camera", "jpg"),
    ("RADAR_FRONT", "radar", "pcd"),
    ("RADAR_FRONT_LEFT", "radar", "pcd"),
    ("RADAR_FRONT_RIGHT", "radar", "pcd"),
    ("RADAR_BACK_LEFT", "radar", "pcd"),
    ("RADAR_BACK_RIGHT", "radar", "pcd"),
];

fn main() -> Outcome<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        [] => measure_all(850),
        ["--scenes", n] => measure_all(n.parse()?),
        ["load", root, cache] => load(Path::new(root), Path::new(cache)),
        _ => Err("usage: nuscenes_size [--scenes N]".into()),
    }
}

fn measure_all(scenes: usize) -> Outcome<()> {
    let root = tempfile::Builder::new().prefix("trove-nuscenes-size-").tempdir()?;
    let cache = root.path().join("cache");
    let start = Instant::now();
    let bytes = write_tables(&root.path().join(VERSION), scenes)?;
    println!(
        "tables: {scenes} scenes, {:.2} GB, generated in {:.0} s",
        bytes as f64 / 1e9,
        start.elapsed().as_secs_f64()
    );
    write_sweeps(root.path(), scenes / 2)?;
    for pass in ["first pass and one scene", "later, one scene"] {
        println!("{pass}:");
        let status = Command::new(std::env::current_exe()?).arg("load").arg(root.path()).arg(&cache).status()?;
        if !status.success() {
            return Err("the measured process failed".into());
        }
    }
    let index = std::fs::read_dir(&cache)?.flatten().filter_map(|e| e.metadata().ok()).map(|m| m.len()).sum::<u64>();
    println!("index: {:.1} MB", index as f64 / 1e6);
    Ok(())
}

/// Opens the dataset, loads the scene in its middle, and prints what that took.
fn load(root: &Path, cache: &Path) -> Outcome<()> {
    let (report, start) = (Report::default(), Instant::now());
    let dataset = NuScenes::open(root, VERSION, Some(cache), &report)?;
    let opened_s = start.elapsed().as_secs_f64();
    let scenes = dataset.scenes();
    let scene = &scenes[scenes.len() / 2].name;
    let drive = dataset.drive(scene, &report)?;
    let total_s = start.elapsed().as_secs_f64();
    let boxes: usize = drive.keyframes.iter().map(|k| k.boxes.len()).sum();
    assert_eq!((drive.keyframes.len(), boxes, drive.rig.len()), (SAMPLES, INSTANCES * TRACK, 6));
    assert_eq!(drive.path.moments().len(), SWEEPS);
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|l| l.strip_prefix("VmHWM:")).map_or("unknown", str::trim);
    println!("  {} sweeps between keyframes of {} points", drive.sweeps.len(), SWEEP_POINTS);
    println!("  open {opened_s:.2} s, scene {:.2} s, together {total_s:.2} s, peak memory {peak}", total_s - opened_s);
    Ok(())
}

/// Writes all tables; returns their size in bytes.
fn write_tables(folder: &Path, scenes: usize) -> Outcome<u64> {
    std::fs::create_dir_all(folder)?;
    let table = |name: &str| Table::create(&folder.join(format!("{name}.json")));
    let mut written = 0;

    let mut rows = table("log")?;
    rows.row(&[
        text("token", &token("log", 0)),
        text("logfile", "n008"),
        text("vehicle", "n008"),
        text("date_captured", "2018-08-01"),
        text("location", "boston-seaport"),
    ])?;
    written += rows.close()?;

    let (mut rows, mut calibrations) = (table("sensor")?, table("calibrated_sensor")?);
    for (c, (channel, modality, _)) in CHANNELS.iter().enumerate() {
        rows.row(&[text("token", &token("sensor", c)), text("channel", channel), text("modality", modality)])?;
        for scene in 0..scenes {
            let matrix = "[\n[\n1266.417203046554,\n0.0,\n816.2670197447984\n],\n[\n0.0,\n1266.417203046554,\n\
                          491.50706579294757\n],\n[\n0.0,\n0.0,\n1.0\n]\n]";
            calibrations.row(&[
                text("token", &token("calibration", scene * 12 + c)),
                text("sensor_token", &token("sensor", c)),
                numbers("translation", &[1.70079, 0.01594, 1.51095]),
                numbers("rotation", &[0.4998015430, -0.5030316162, 0.4997798114, -0.4973708381]),
                plain("camera_intrinsic", if *modality == "camera" { matrix } else { "[]" }),
            ])?;
        }
    }
    written += rows.close()? + calibrations.close()?;

    let mut rows = table("category")?;
    rows.row(&[text("token", &token("category", 0)), text("name", "vehicle.car"), text("description", "")])?;
    written += rows.close()?;
    let mut rows = table("attribute")?;
    rows.row(&[text("token", &token("attribute", 0)), text("name", "vehicle.moving"), text("description", "")])?;
    written += rows.close()?;
    let mut rows = table("visibility")?;
    rows.row(&[text("token", "4"), text("level", "v80-100"), text("description", "")])?;
    written += rows.close()?;

    let (mut rows, mut samples, mut instances) = (table("scene")?, table("sample")?, table("instance")?);
    for scene in 0..scenes {
        rows.row(&[
            text("token", &token("scene", scene)),
            text("log_token", &token("log", 0)),
            plain("nbr_samples", SAMPLES),
            text("first_sample_token", &token("sample", scene * SAMPLES)),
            text("last_sample_token", &token("sample", scene * SAMPLES + SAMPLES - 1)),
            text("name", &format!("scene-{scene:04}")),
            text("description", "Parked truck, construction"),
        ])?;
        for i in 0..SAMPLES {
            samples.row(&[
                text("token", &token("sample", scene * SAMPLES + i)),
                plain("timestamp", start_us(scene) + i as i64 * PERIOD_US),
                text("prev", &neighbour("sample", scene, SAMPLES, i, -1)),
                text("next", &neighbour("sample", scene, SAMPLES, i, 1)),
                text("scene_token", &token("scene", scene)),
            ])?;
        }
        for i in 0..INSTANCES {
            let annotation = |j| token("annotation", (scene * INSTANCES + i) * TRACK + j);
            instances.row(&[
                text("token", &token("instance", scene * INSTANCES + i)),
                text("category_token", &token("category", 0)),
                plain("nbr_annotations", TRACK),
                text("first_annotation_token", &annotation(0)),
                text("last_annotation_token", &annotation(TRACK - 1)),
            ])?;
        }
    }
    written += rows.close()? + samples.close()? + instances.close()?;
    written += write_sensor_data(table("sample_data")?, table("ego_pose")?, scenes)?;
    written += write_annotations(table("sample_annotation")?, scenes)?;
    Ok(written)
}

/// Writes the LiDAR files of a scene.
fn write_sweeps(root: &Path, scene: usize) -> Outcome<()> {
    let mut random = Seed(4).random();
    for i in 0..SWEEPS {
        let mut points = Vec::with_capacity(SWEEP_POINTS * 20);
        for _ in 0..SWEEP_POINTS {
            let point = [random.range(-50.0, 50.0), random.range(-50.0, 50.0), -1.8, 7.0, 3.0];
            points.extend(point.iter().flat_map(|v| (*v as f32).to_le_bytes()));
        }
        let path = root.join(file(scene, i, &CHANNELS[0]));
        std::fs::create_dir_all(path.parent().ok_or("a file below a folder")?)?;
        std::fs::write(path, points)?;
    }
    Ok(())
}

/// Time of a scene's i-th row of a sensor, microseconds.
fn time_us(scene: usize, i: usize) -> i64 {
    start_us(scene) + i as i64 * PERIOD_US * SAMPLES as i64 / SWEEPS as i64
}

/// The sample that a row belongs to, and whether it is the first of it.
fn sample(i: usize) -> (usize, bool) {
    let key = i * SAMPLES / SWEEPS;
    (key, i == 0 || (i - 1) * SAMPLES / SWEEPS < key)
}

fn file(scene: usize, i: usize, (channel, _, ending): &(&str, &str, &str)) -> String {
    let folder = if sample(i).1 { "samples" } else { "sweeps" };
    let time_us = time_us(scene, i);
    format!("{folder}/{channel}/n008-2018-08-01-15-16-36-0400__{channel}__{time_us}.{ending}")
}

fn write_sensor_data(mut data: Table, mut poses: Table, scenes: usize) -> Outcome<u64> {
    let mut random = Seed(2).random();
    for i in 0..SWEEPS {
        for scene in 0..scenes {
            let ((key, is_key), time_us) = (sample(i), time_us(scene, i));
            for (c, sensor @ (_, modality, ending)) in CHANNELS.iter().enumerate() {
                let me = token("sample_data", (scene * SWEEPS + i) * 12 + c);
                let (height, width) = if *modality == "camera" { (900, 1600) } else { (0, 0) };
                data.row(&[
                    text("token", &me),
                    text("sample_token", &token("sample", scene * SAMPLES + key)),
                    text("ego_pose_token", &me),
                    text("calibrated_sensor_token", &token("calibration", scene * 12 + c)),
                    plain("timestamp", time_us),
                    text("fileformat", &ending[..3]),
                    plain("is_key_frame", is_key),
                    plain("height", height),
                    plain("width", width),
                    text("filename", &file(scene, i, sensor)),
                    text("prev", &neighbour("sample_data", scene, SWEEPS, i, -1)),
                    text("next", &neighbour("sample_data", scene, SWEEPS, i, 1)),
                ])?;
                let yaw = random.range(-0.1, 0.1);
                poses.row(&[
                    text("token", &me),
                    plain("timestamp", time_us),
                    numbers("rotation", &[yaw.cos(), random.range(-0.01, 0.01), random.range(-0.01, 0.01), yaw.sin()]),
                    numbers("translation", &[600.0 + i as f64 * 0.7 + random.unit(), 1600.0 + random.unit(), 0.0]),
                ])?;
            }
        }
    }
    Ok(data.close()? + poses.close()?)
}

fn write_annotations(mut rows: Table, scenes: usize) -> Outcome<u64> {
    let mut random = Seed(3).random();
    for instance in 0..INSTANCES {
        for i in 0..TRACK {
            for scene in 0..scenes {
                let track = scene * INSTANCES + instance;
                let sample = instance % (SAMPLES - TRACK) + i;
                let yaw = random.range(-1.5, 1.5);
                rows.row(&[
                    text("token", &token("annotation", track * TRACK + i)),
                    text("sample_token", &token("sample", scene * SAMPLES + sample)),
                    text("instance_token", &token("instance", track)),
                    text("visibility_token", "4"),
                    plain("attribute_tokens", format!("[\n\"{}\"\n]", token("attribute", 0))),
                    numbers("translation", &rounded(&mut random, 1000.0)),
                    numbers("size", &[1.95, 4.61, 1.733]),
                    numbers("rotation", &[(yaw / 2.0).cos(), 0.0, 0.0, (yaw / 2.0).sin()]),
                    text("prev", &neighbour("annotation", track, TRACK, i, -1)),
                    text("next", &neighbour("annotation", track, TRACK, i, 1)),
                    plain("num_lidar_pts", 12),
                    plain("num_radar_pts", 1),
                ])?;
            }
        }
    }
    rows.close()
}

fn rounded(random: &mut Random, size_m: f64) -> [f64; 3] {
    [0; 3].map(|_| (random.range(0.0, size_m) * 1000.0).round() / 1000.0)
}

fn start_us(scene: usize) -> i64 {
    1_533_151_603_547_590 + scene as i64 * 60_000_000
}

/// Token before or after the `i`-th of `count` in a group; empty beyond its ends.
fn neighbour(table: &str, group: usize, count: usize, i: usize, step: i64) -> String {
    match i.checked_add_signed(step as isize) {
        Some(other) if other < count => token(table, group * count + other),
        _ => String::new(),
    }
}

fn token(table: &str, index: usize) -> String {
    let mut random = Seed(1).child(table).nth(index as u64).random();
    format!("{:016x}{:016x}", random.bits(), random.bits())
}

fn text(key: &str, value: &str) -> String {
    format!("\"{key}\": \"{value}\"")
}

fn plain(key: &str, value: impl std::fmt::Display) -> String {
    format!("\"{key}\": {value}")
}

fn numbers(key: &str, values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|v| format!("{v:?}")).collect();
    format!("\"{key}\": [\n{}\n]", values.join(",\n"))
}

/// A table in the official formatting: a key or number a line, without indentation.
struct Table {
    file: BufWriter<File>,
    separator: &'static str,
}

impl Table {
    fn create(path: &Path) -> Outcome<Self> {
        Ok(Self { file: BufWriter::with_capacity(1 << 20, File::create(path)?), separator: "[\n" })
    }

    fn row(&mut self, fields: &[String]) -> Outcome<()> {
        write!(self.file, "{}{{\n{}\n}}", self.separator, fields.join(",\n"))?;
        self.separator = ",\n";
        Ok(())
    }

    fn close(mut self) -> Outcome<u64> {
        self.file.write_all(b"\n]\n")?;
        self.file.flush()?;
        Ok(self.file.get_ref().metadata()?.len())
    }
}
