//! nuScenes: a small valid dataset of which one file is replaced.

use std::fs;
use std::path::Path;

use serde_json::json;
use trove_model::Report;
use trove_read::nuscenes::NuScenes;

#[allow(clippy::unwrap_used, dead_code, unreachable_pub)] // the reader's tests use the rest
#[path = "../../crates/trove-read/tests/nuscenes/fixture.rs"]
mod fixture;

use fixture::{Dataset, SCENE, START_US, VERSION, put};

const SWEEP: &str = "samples/LIDAR_TOP/0.bin";
const CAN_BUS: &str = "can_bus/scene-0001_pose.json";
const LANES: &str = "maps/expansion/boston-seaport.json";
/// FNV-1a, which the index ends with.
const FNV: (u64, u64) = (0xcbf2_9ce4_8422_2325, 0x0100_0000_01b3);

fn tables() -> Vec<(&'static str, Vec<u8>)> {
    let table = |(name, rows)| (name, serde_json::to_vec(&rows).unwrap_or_default());
    Dataset::small().tables.into_iter().map(table).collect()
}

/// Points of a sweep, 20 bytes each.
fn sweep() -> Vec<u8> {
    (0..60u16).flat_map(|i| [f32::from(i % 9), f32::from(i / 9), -1.8, 0.5, 7.0]).flat_map(f32::to_le_bytes).collect()
}

pub(crate) fn prepare(folder: &Path) {
    for (name, bytes) in tables() {
        put(folder, &format!("{VERSION}/{name}.json"), &bytes);
    }
    put(folder, SWEEP, &sweep());
}

fn read(folder: &Path, cache: Option<&Path>) {
    let report = Report::default();
    if let Ok(dataset) = NuScenes::open(folder, VERSION, cache, &report) {
        let _ = dataset.drive(SCENE, &report);
    }
}

/// The first byte says which table it is.
pub(crate) fn feed_table(folder: &Path, data: &[u8]) {
    let Some((&which, rows)) = data.split_first() else { return };
    let tables = tables();
    let (name, whole) = &tables[usize::from(which) % tables.len()];
    let file = format!("{VERSION}/{name}.json");
    put(folder, &file, rows);
    read(folder, None);
    put(folder, &file, whole);
}

pub(crate) fn table_seeds() -> Vec<Vec<u8>> {
    tables().into_iter().enumerate().map(|(i, (_, bytes))| [vec![i as u8], bytes].concat()).collect()
}

/// The first byte says whether it is a sweep or its labels.
pub(crate) fn feed_lidar(folder: &Path, data: &[u8]) {
    put(folder, SWEEP, data);
    read(folder, None);
}

pub(crate) fn lidar_seeds() -> Vec<Vec<u8>> {
    vec![sweep()]
}

pub(crate) fn feed_can_bus(folder: &Path, data: &[u8]) {
    put(folder, CAN_BUS, data);
    read(folder, None);
}

/// Poses that agree with the tables', every 100 ms.
pub(crate) fn can_bus_seeds() -> Vec<Vec<u8>> {
    let message = |i: i64| {
        json!({"utime": START_US + i * 100_000, "pos": [100.4 + i as f64, 200.6, 0.25],
            "orientation": [1.0, 0.0, 0.0, 0.0], "vel": [10.0, 0.0, 0.0]})
    };
    vec![json!((0..=10).map(message).collect::<Vec<_>>()).to_string().into_bytes()]
}

pub(crate) fn feed_lane_map(folder: &Path, data: &[u8]) {
    put(folder, LANES, data);
    read(folder, None);
}

pub(crate) fn lane_map_seeds() -> Vec<Vec<u8>> {
    let corners = [[0.0, 0.0], [0.0, 10.0], [10.0, 10.0], [10.0, 0.0]];
    let node = |(i, [x, y]): (usize, &[f64; 2])| json!({"token": format!("n{i}"), "x": 110.0 + x, "y": 190.0 + y});
    let nodes: Vec<_> = corners.iter().enumerate().map(node).collect();
    let map = json!({
        "node": nodes,
        "polygon": [{"token": "p", "exterior_node_tokens": ["n0", "n1", "n2", "n3"], "holes": [{"node_tokens": ["n0", "n1", "n2"]}]}],
        "line": [{"token": "l", "node_tokens": ["n0", "n1"]}],
        "drivable_area": [{"token": "d", "polygon_tokens": ["p"]}],
        "ped_crossing": [{"token": "c", "polygon_token": "p"}],
        "walkway": [{"token": "w", "polygon_token": "p"}],
        "stop_line": [{"token": "s", "polygon_token": "p"}],
        "lane": [{"token": "lane", "polygon_token": "p"}],
        "lane_connector": [{"token": "k", "polygon_token": "p"}],
        "road_divider": [{"token": "r", "line_token": "l"}],
        "lane_divider": [{"token": "v", "line_token": "l"}],
        "connectivity": {"lane": {"incoming": ["k"], "outgoing": []}},
        "arcline_path_3": {"lane": [{"start_pose": [110.0, 195.0, 0.0], "end_pose": [120.0, 195.0, 0.0],
            "shape": "LSR", "radius": 50.0, "segment_length": [1.0, 10.0, 2.0]}]},
    });
    vec![map.to_string().into_bytes()]
}

pub(crate) fn prepare_index(folder: &Path) {
    prepare(folder);
    read(folder, Some(&folder.join("cache")));
}

/// The index of this folder's tables with its end replaced, and a sum that fits.
pub(crate) fn feed_index(folder: &Path, data: &[u8]) {
    let cache = folder.join("cache");
    let Some(path) = fs::read_dir(&cache).ok().and_then(|mut entries| entries.next()?.ok()).map(|e| e.path()) else {
        return;
    };
    let key = folder.join("key");
    let head = match fs::read(&key) {
        Ok(head) => head,
        Err(_) => {
            let whole = fs::read(&path).unwrap_or_default();
            let head = whole[..whole.len().saturating_sub(8 + index_seeds()[0].len())].to_vec();
            let _ = fs::write(&key, &head);
            head
        }
    };
    let mut bytes = [&head[..], data].concat();
    let sum = bytes.iter().fold(FNV.0, |h, &b| (h ^ u64::from(b)).wrapping_mul(FNV.1));
    bytes.extend(sum.to_le_bytes());
    let _ = fs::write(&path, bytes);
    read(folder, Some(&cache));
}

/// What follows the key: the spans of one scene in three tables, and no entries.
pub(crate) fn index_seeds() -> Vec<Vec<u8>> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    prepare_index(folder.path());
    let entry = fs::read_dir(folder.path().join("cache")).ok().and_then(|mut entries| entries.next()?.ok());
    let whole = entry.and_then(|entry| fs::read(entry.path()).ok()).unwrap_or_default();
    // The key ends with the line of the last table, `sensor`, and its time of change.
    let last = whole.windows(7).rposition(|word| word == b"sensor ").unwrap_or(0);
    let end = whole[last..].iter().position(|&b| b == b'\n').map_or(whole.len(), |line| last + line + 1);
    vec![whole[end..whole.len().saturating_sub(8).max(end)].to_vec()]
}
