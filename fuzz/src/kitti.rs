//! KITTI: a tracking sequence and a raw drive, of each of which one file is replaced.

use std::fs;
use std::path::Path;

use trove_model::Report;
use trove_read::drive_source::DriveSource;
use trove_read::kitti::Kitti;

const SEQUENCE: &str = "0003";
const DRIVE: &str = "2011_09_26_drive_0001_sync";
const CALIBRATION: &str = "training/calib/0003.txt";
const LABELS: &str = "training/label_02/0003.txt";
const OXTS: &str = "training/oxts/0003.txt";
const TRACKLETS: &str = "2011_09_26/2011_09_26_drive_0001_sync/tracklet_labels.xml";

const CAMERA: &str = "721.5 0 609.6 44.9 0 721.5 172.9 0.2 0 0 1 0.003";
const FORWARD: &str = "0 -1 0 0 0 -1 1 0 0";
const MOTION: &str = "0 -1 0 0 0 0 -1 -0.08 1 0 0 -0.27";
const BESIDE: &str = "1 0 0 -0.81 0 1 0 0.32 0 0 1 -0.8";
const FIX: &str = "49.011 8.4229 112.8 0.022 0.001 -1.22 -3.3 1.1 3.5 0.03\n";

fn calibration() -> String {
    format!("P0: {CAMERA}\nP2: {CAMERA}\nR_rect 1 0 0 0 1 0 0 0 1\nTr_velo_cam {MOTION}\nTr_imu_velo {BESIDE}\n")
}

fn labels() -> String {
    let row = |frame: usize, what: &str| {
        format!(
            "{frame} {what} 0 0 -1.79 296.7 161.8 455.2 292.4 2 1.82 4.43 -4.55 1.86 {} -2.1\n",
            13.4 + frame as f64
        )
    };
    let rows: String = (0..3).map(|k| row(k, "0 Van") + &row(k, "1 Cyclist")).collect();
    rows + "2 -1 DontCare -1 -1 -10 219.3 188.5 245.5 218.6 -1000 -1000 -1000 -10 -1 -1 -1\n"
}

fn tracklets() -> String {
    let pose = "<item><tx>25.2</tx><ty>8.6</ty><tz>-1.8</tz><rx>0</rx><ry>0</ry><rz>-3.18</rz><state>2</state>\
        <occlusion>0</occlusion><truncation>0</truncation></item>";
    format!(
        "<?xml version=\"1.0\"?>\n<!DOCTYPE boost_serialization>\n<boost_serialization><tracklets><count>1</count><item>\
         <objectType>Car</objectType><h>1.6</h><w>1.7</w><l>4.3</l><first_frame>0</first_frame><poses><count>3</count>\
         {}</poses></item></tracklets></boost_serialization>\n",
        pose.repeat(3)
    )
}

fn put(folder: &Path, file: &str, bytes: &[u8]) {
    let path = folder.join(file);
    if let Some(parent) = path.parent() {
        let _ = fs::create_dir_all(parent);
    }
    let _ = fs::write(path, bytes);
}

pub(crate) fn prepare(folder: &Path) {
    put(folder, CALIBRATION, calibration().as_bytes());
    put(folder, LABELS, labels().as_bytes());
    put(folder, OXTS, FIX.repeat(3).as_bytes());
    put(folder, TRACKLETS, tracklets().as_bytes());
    put(folder, "2011_09_26/calib_imu_to_velo.txt", b"R: 1 0 0 0 1 0 0 0 1\nT: -0.81 0.32 -0.8\n");
    put(folder, "2011_09_26/calib_velo_to_cam.txt", format!("R: {FORWARD}\nT: 0 -0.08 -0.27\n").as_bytes());
    let cameras = format!("S_rect_00: 1242 375\nR_rect_00: 1 0 0 0 1 0 0 0 1\nP_rect_00: {CAMERA}\n");
    put(folder, "2011_09_26/calib_cam_to_cam.txt", cameras.as_bytes());
    for k in 0..3 {
        put(folder, &format!("2011_09_26/{DRIVE}/oxts/data/{k:010}.txt"), FIX.as_bytes());
    }
    let times: String = (0..3).map(|k| format!("2011-09-26 13:04:32.{k}51950336\n")).collect();
    put(folder, &format!("2011_09_26/{DRIVE}/oxts/timestamps.txt"), times.as_bytes());
}

fn feed(folder: &Path, file: &str, name: &str, data: &[u8]) {
    put(folder, file, data);
    let report = Report::default();
    if let Ok(kitti) = Kitti::open(folder, None) {
        let _ = kitti.read(name, &report);
    }
}

pub(crate) fn feed_calibration(folder: &Path, data: &[u8]) {
    feed(folder, CALIBRATION, SEQUENCE, data);
}

pub(crate) fn calibration_seeds() -> Vec<Vec<u8>> {
    vec![calibration().into()]
}

pub(crate) fn feed_labels(folder: &Path, data: &[u8]) {
    feed(folder, LABELS, SEQUENCE, data);
}

pub(crate) fn label_seeds() -> Vec<Vec<u8>> {
    vec![labels().into()]
}

pub(crate) fn feed_oxts(folder: &Path, data: &[u8]) {
    feed(folder, OXTS, SEQUENCE, data);
}

pub(crate) fn oxts_seeds() -> Vec<Vec<u8>> {
    vec![FIX.repeat(3).into()]
}

pub(crate) fn feed_tracklets(folder: &Path, data: &[u8]) {
    feed(folder, TRACKLETS, DRIVE, data);
}

pub(crate) fn tracklet_seeds() -> Vec<Vec<u8>> {
    vec![tracklets().into()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_mutations_start_from_is_two_whole_drives() {
        let folder = tempfile::tempdir().unwrap();
        prepare(folder.path());
        let kitti = Kitti::open(folder.path(), None).unwrap();
        for (name, boxes) in [(SEQUENCE, 6), (DRIVE, 3)] {
            let drive = kitti.read(name, &Report::default()).unwrap();
            let found: usize = drive.keyframes.iter().map(|k| k.boxes.len()).sum();
            assert_eq!((drive.keyframes.len(), found), (3, boxes), "{name}");
        }
    }
}
