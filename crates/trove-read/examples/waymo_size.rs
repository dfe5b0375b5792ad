//! Measures how a Waymo segment of 200 frames is read in both forms: 150 boxes a frame, five pictures of 400 KB, and the
//! top LiDAR with its poses in every frame.
//!
//! `cargo run --release -p trove-read --example waymo_size`
//!
//! The segment is made up, lies in the temporary folder and is removed afterwards. Each form is read in a process of its
//! own, so that the peak memory is its own.

use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use parquet_writer::Packing;
use trove_model::Report;
use trove_read::waymo::Waymo;
use waymo_writer::{Frame, Image, Label, Picture, Scan, Segment, put, record};

#[allow(clippy::unwrap_used, dead_code)] // the reader's tests use the rest
#[path = "../tests/waymo/parquet_writer.rs"]
mod parquet_writer;
#[allow(clippy::unwrap_used, dead_code)] // the reader's tests use the rest
#[path = "../tests/waymo/writer.rs"]
mod waymo_writer;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

const FRAMES: usize = 200;
const BOXES: usize = 150;
const PICTURE_BYTES: usize = 400_000;
const BEAMS: usize = 64;
const COLUMNS: usize = 2650;

fn main() -> Outcome<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [flag, root] = arguments.as_slice()
        && flag == "--read"
    {
        return read(Path::new(root));
    }
    let root = tempfile::tempdir()?;
    let mut segment = Segment::small();
    segment.lasers[0].inclinations = (0..BEAMS).map(|beam| -0.31 + beam as f64 * 0.005).collect();
    segment.frames = (0..FRAMES).map(|k| frame(&segment.frames[0], k)).collect();
    std::fs::create_dir_all(root.path().join("v1"))?;
    let mut file = std::fs::File::create(root.path().join("v1/segment.tfrecord"))?;
    for (k, frame) in segment.frames.iter().enumerate() {
        file.write_all(&record(&segment.frame_message(frame, k == 0)))?;
    }
    for (component, bytes) in segment.v2(Packing::Snappy) {
        put(root.path(), &format!("v2/{component}/small.parquet"), &bytes);
    }
    drop(segment);
    for form in ["v1", "v2"] {
        let status = Command::new(std::env::current_exe()?).arg("--read").arg(root.path().join(form)).status()?;
        if !status.success() {
            return Err(format!("{form} was not read").into());
        }
    }
    Ok(())
}

/// A frame like another, full of boxes.
fn frame(like: &Frame, k: usize) -> Frame {
    let label = |i: usize| {
        let (ring, place) = ((i / 10) as f64, (i % 10) as f64);
        let centre = [5.0 + 4.0 * ring, 4.0 * place - 20.0, 0.8];
        Label { id: format!("object-{i}"), centre, ..like.labels[0].clone() }
    };
    let picture = |camera| Picture { camera, jpeg: vec![k as u8; PICTURE_BYTES], ..like.pictures[0].clone() };
    // Ranges that differ from pixel to pixel, as real ones do.
    let range = |i: usize| [5.0 + ((i * 2_654_435_761) >> 8 & 0xfff) as f32 * 0.01, 0.5, 0.0, -1.0];
    let pose = |i: usize| [0.0, 0.0, 0.0, k as f32 + (i % COLUMNS) as f32 * 1e-4, 0.0, 0.0];
    let pixels = BEAMS * COLUMNS;
    Frame {
        time_us: like.time_us + k as i64 * 100_000,
        labels: (0..BOXES).map(label).collect(),
        pictures: (1..=5).map(picture).collect(),
        scans: vec![Scan {
            number: 1,
            first: Image { shape: [BEAMS, COLUMNS, 4], values: (0..pixels).flat_map(range).collect() },
            poses: Some(Image { shape: [BEAMS, COLUMNS, 6], values: (0..pixels).flat_map(pose).collect() }),
        }],
        ..like.clone()
    }
}

fn read(root: &Path) -> Outcome<()> {
    let (report, form) = (Report::default(), root.file_name().unwrap_or_default().to_string_lossy());
    for lidar_every in [usize::MAX, 5] {
        let started = Instant::now();
        let drive = Waymo::open(root, lidar_every, &report)?.drive("small", &report)?;
        let boxes: usize = drive.keyframes.iter().map(|keyframe| keyframe.boxes.len()).sum();
        let points =
            drive.keyframes.iter().filter_map(|k| k.lidar.as_ref()).map(|l| l.points_world.len()).sum::<usize>();
        println!(
            "{form}, LiDAR of {} frames: {:.2} s, {} frames, {boxes} boxes, {points} points, peak {} MB",
            drive.keyframes.iter().filter(|k| k.lidar.is_some()).count(),
            started.elapsed().as_secs_f64(),
            drive.keyframes.len(),
            peak_memory_mb()
        );
    }
    Ok(())
}

/// Of this process so far; 0 where the system does not tell.
fn peak_memory_mb() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak =
        status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB")?.trim().parse().ok());
    peak.unwrap_or(0u64) / 1024
}
