//! Recordings of people's own: the plain form with its LiDAR files, and traces.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use trove_model::Report;
use trove_read::DATASETS;

/// A small drive of two keyframes; the second has a sweep in a file.
fn drive(sweep: &str) -> Value {
    let moment = |k: i64| {
        json!({"time_ns": 1_600_000_000_000_000_000_i64 + k * 500_000_000,
            "world_from_ego": {"translation_m": [4 * k, 0.5, 0], "yaw_rad": 0.1},
            "pictures": {"front": {"time_ns": 1_600_000_000_000_000_100_i64 + k * 500_000_000}},
            "boxes": [{"track": "7", "kind": "car", "size_m": [4.5, 1.9, 1.6],
                "ego_from_body": {"translation_m": [18, -1.5, 0.8], "rotation_wxyz": [1, 0, 0, 0]}}]})
    };
    let mut second = moment(1);
    second["lidar"] = json!({"file": sweep, "ego_from_lidar": {"translation_m": [0.9, 0, 1.8]}});
    json!({"trove_drive": 1, "georeference": {"utm": {"zone": 32}}, "cameras": {"front": {"width_px": 160,
        "height_px": 90, "fx_px": 114.0, "lens_model": "brown-conrady", "distortion": [-0.3, 0.1],
        "ego_from_camera": {"translation_m": [1.7, 0, 1.5]}}}, "keyframes": [at_home(moment(0)), at_home(second)]})
}

/// In the middle of a zone.
fn at_home(mut moment: Value) -> Value {
    let east = moment["world_from_ego"]["translation_m"][0].as_f64().unwrap_or_default();
    moment["world_from_ego"]["translation_m"] = json!([500_000.0 + east, 5_430_000.5, 110.0]);
    moment
}

fn read(dataset: &str, root: &Path) {
    let report = Report::default();
    let dataset = DATASETS.iter().find(|known| known.name == dataset);
    let opener = dataset.and_then(|dataset| (dataset.configure)(toml::Table::new()).ok());
    let Some(Ok(source)) = opener.map(|open| open(root, None, &report)) else { return };
    for listing in source.drives() {
        let _ = source.describe(&listing.name, &report);
        let _ = source.recording(&listing.name);
    }
}

pub(crate) fn feed_json(folder: &Path, data: &[u8]) {
    let _ = fs::write(folder.join("drive.json"), data);
    read("trove", folder);
}

pub(crate) fn json_seeds() -> Vec<Vec<u8>> {
    vec![drive("0.bin").to_string().into_bytes()]
}

pub(crate) fn feed_lines(folder: &Path, data: &[u8]) {
    let _ = fs::write(folder.join("drive.jsonl"), data);
    read("trove", folder);
}

pub(crate) fn lines_seeds() -> Vec<Vec<u8>> {
    let mut header = drive("0.bin");
    let keyframes = header["keyframes"].take();
    if let Some(header) = header.as_object_mut() {
        header.remove("keyframes");
    }
    vec![format!("{header}\n{}\n{}\n", keyframes[0], keyframes[1]).into_bytes()]
}

pub(crate) fn prepare_pcd(folder: &Path) {
    let _ = fs::write(folder.join("drive.json"), drive("0.pcd").to_string());
}

pub(crate) fn feed_pcd(folder: &Path, data: &[u8]) {
    let _ = fs::write(folder.join("0.pcd"), data);
    read("trove", folder);
}

pub(crate) fn pcd_seeds() -> Vec<Vec<u8>> {
    let file = |data: &str, body: &[u8]| {
        let header =
            "VERSION 0.7\nFIELDS x y z i\nSIZE 4 4 8 2\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2";
        [format!("{header}\nDATA {data}\n").as_bytes(), body].concat()
    };
    // 36 bytes, as they are, in two pieces.
    let packed = [&38u32.to_le_bytes()[..], &36u32.to_le_bytes(), &[31], &[7; 32], &[3], &[9; 4]].concat();
    vec![file("ascii", b"1 2 3 4\n5 6.5 nan 8\n"), file("binary", &[7; 36]), file("binary_compressed", &packed)]
}

pub(crate) fn prepare_las(folder: &Path) {
    let _ = fs::write(folder.join("drive.json"), drive("0.las").to_string());
}

pub(crate) fn feed_las(folder: &Path, data: &[u8]) {
    let _ = fs::write(folder.join("0.las"), data);
    read("trove", folder);
}

pub(crate) fn las_seeds() -> Vec<Vec<u8>> {
    let mut las = vec![0; 375 + 2 * 30];
    las[..4].copy_from_slice(b"LASF");
    (las[24], las[25], las[104]) = (1, 4, 6);
    las[96..100].copy_from_slice(&375u32.to_le_bytes());
    las[105..107].copy_from_slice(&30u16.to_le_bytes());
    las[247..255].copy_from_slice(&2u64.to_le_bytes());
    (0..3).for_each(|i| las[131 + 8 * i..139 + 8 * i].copy_from_slice(&0.01f64.to_le_bytes()));
    vec![las]
}

pub(crate) fn feed_gpx(folder: &Path, data: &[u8]) {
    let _ = fs::write(folder.join("trace.gpx"), data);
    read("gps", folder);
}

pub(crate) fn gpx_seeds() -> Vec<Vec<u8>> {
    let point = |i: u32| {
        format!("<trkpt lat=\"49.{i:04}\" lon=\"8.5\"><ele>110</ele><time>2020-01-01T00:00:{i:02}Z</time></trkpt>")
    };
    let points: String = (0..20).map(point).collect();
    vec![format!("<?xml version=\"1.0\"?><gpx><trk><trkseg>{points}</trkseg></trk></gpx>").into_bytes()]
}

pub(crate) fn feed_csv(folder: &Path, data: &[u8]) {
    let _ = fs::write(folder.join("trace.csv"), data);
    read("gps", folder);
}

pub(crate) fn csv_seeds() -> Vec<Vec<u8>> {
    let geographic = |i: u32| format!("2020-01-01T00:00:{i:02}Z;49.{i:04};8.5;110;0\n");
    let ecef = |i: u32| {
        format!(
            "{i}.5,{},{},3881014.4,0.2124,-0.8030,-0.4352,-0.3472\n",
            -2_712_087 + i64::from(i),
            -4_261_670 + i64::from(i)
        )
    };
    vec![
        format!("time;lat;lon;alt;course\n{}", (0..20).map(geographic).collect::<String>()).into_bytes(),
        format!("time_s,ecef_x_m,ecef_y_m,ecef_z_m,qw,qx,qy,qz\n{}", (0..20).map(ecef).collect::<String>())
            .into_bytes(),
    ]
}
