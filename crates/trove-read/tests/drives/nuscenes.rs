//! nuScenes: the canonical drive as tables.

use std::path::Path;

use glam::{DQuat, DVec3};
use serde_json::{Value, json};
use tempfile::TempDir;
use trove_model::{Distortion, Drive, Frame, Kind, Pose, Report};
use trove_read::nuscenes::NuScenes;

use crate::canonical;
use crate::comparison::{TIGHT, differences};

/// World's origin in the dataset's global frame.
const ANCHOR_M: DVec3 = DVec3::new(300.0, 500.0, 0.0);

/// What nuScenes can say: its pictures are without distortion.
fn sayable() -> Drive {
    let mut drive = canonical::drive();
    let lenses = drive.keyframes.iter_mut().flat_map(|k| &mut k.exposures).map(|e| &mut e.lens);
    lenses.chain(drive.rig.iter_mut().map(|c| &mut c.lens)).for_each(|lens| lens.distortion = Distortion::None);
    drive
}

fn wxyz(rotation: DQuat) -> [f64; 4] {
    [rotation.w, rotation.x, rotation.y, rotation.z]
}

fn posed<D: Frame, S: Frame>(token: &str, pose: &Pose<D, S>, offset: DVec3) -> Value {
    json!({"token": token, "translation": (pose.translation + offset).to_array(), "rotation": wxyz(pose.rotation)})
}

const NUSCENES: Form = Form { version: "v1.0-mini", category: nuscenes_category, folders: ["samples", "samples"] };
const LYFT: Form = Form { version: "train_data", category: lyft_category, folders: ["lidar", "train_lidar"] };

fn lyft_category(kind: Kind) -> (&'static str, &'static [&'static str]) {
    match kind {
        Kind::Car => ("car", &[]),
        Kind::Adult => ("pedestrian", &[]),
        Kind::BicycleWithRider => ("bicycle", &["with"]),
        Kind::Truck => ("truck", &[]),
        other => panic!("{other:?} is not in the canonical drive"),
    }
}

fn nuscenes_category(kind: Kind) -> (&'static str, &'static [&'static str]) {
    match kind {
        Kind::Car => ("vehicle.car", &[]),
        Kind::Adult => ("human.pedestrian.adult", &[]),
        Kind::BicycleWithRider => ("vehicle.bicycle", &["with"]),
        Kind::Truck => ("vehicle.truck", &[]),
        other => panic!("{other:?} is not in the canonical drive"),
    }
}

fn chain(i: usize, count: usize, token: impl Fn(usize) -> String) -> (String, String) {
    let next = if i + 1 < count { token(i + 1) } else { String::new() };
    (i.checked_sub(1).map(&token).unwrap_or_default(), next)
}

/// How the tables are written of a dataset that shares nuScenes' schema.
struct Form {
    version: &'static str,
    category: fn(Kind) -> (&'static str, &'static [&'static str]),
    /// Where sensors' files lie, as the tables have it and in truth.
    folders: [&'static str; 2],
}

fn write(drive: &Drive, form: &Form) -> TempDir {
    let root = tempfile::tempdir().unwrap();
    let table = |name: &str, rows: Vec<Value>| {
        put(root.path(), &format!("{}/{name}.json", form.version), &json!(rows).to_string())
    };
    // On the dataset's sphere World's origin lies at the anchor.
    let radius_m = 6_378_137.0;
    let lat_deg = canonical::LAT_DEG - (ANCHOR_M.y / radius_m).to_degrees();
    let lon_deg = canonical::LON_DEG - (ANCHOR_M.x / (radius_m * lat_deg.to_radians().cos())).to_degrees();
    // … and the first vehicle where the canonical one is, though their metres differ by a few thousandths.
    let first = drive.keyframes[0].world_from_ego.translation.truncate();
    let (first_lat_deg, first_lon_deg) = drive.projection.geo_from_world(first);
    let sphere = trove_model::MapProjection::spherical(lat_deg, lon_deg, ANCHOR_M.truncate());
    let off = first - sphere.world_from_geo(first_lat_deg, first_lon_deg);
    let offset = ANCHOR_M - off.extend(0.0);

    let count = drive.keyframes.len();
    let keyframe = |k: usize| format!("k{k}");
    table(
        "scene",
        vec![json!({"token": "s", "log_token": "l", "nbr_samples": count, "first_sample_token": keyframe(0),
            "last_sample_token": keyframe(count - 1), "name": "canonical", "description": ""})],
    );
    table(
        "log",
        vec![
            json!({"token": "l", "logfile": "", "vehicle": "", "date_captured": "2020-09-13", "location": "pittsburgh",
            "trove_origin_lat_deg": lat_deg, "trove_origin_lon_deg": lon_deg}),
        ],
    );
    let (mut sensors, mut calibrations) = (Vec::new(), Vec::new());
    for camera in &drive.rig {
        let lens = &camera.lens;
        sensors.push(json!({"token": camera.name, "channel": camera.name, "modality": "camera"}));
        let mut row = posed(&camera.name, &camera.ego_from_camera, DVec3::ZERO);
        row["sensor_token"] = json!(camera.name);
        row["camera_intrinsic"] =
            json!([[lens.fx_px, 0.0, lens.cx_px], [0.0, lens.fy_px, lens.cy_px], [0.0, 0.0, 1.0]]);
        calibrations.push(row);
    }
    sensors.push(json!({"token": "lidar", "channel": "LIDAR_TOP", "modality": "lidar"}));
    let mut row = posed("lidar", &canonical::ego_from_lidar(), DVec3::ZERO);
    (row["sensor_token"], row["camera_intrinsic"]) = (json!("lidar"), json!([]));
    calibrations.push(row);
    table("sensor", sensors);
    table("calibrated_sensor", calibrations);

    let (mut samples, mut data, mut poses, mut annotations) = (vec![], vec![], vec![], vec![]);
    for (k, moment) in drive.keyframes.iter().enumerate() {
        let (prev, next) = chain(k, count, keyframe);
        let time_us = moment.time_ns / 1000;
        samples
            .push(json!({"token": keyframe(k), "timestamp": time_us, "scene_token": "s", "prev": prev, "next": next}));
        let mut taken = |token: &str, sensor: &str, time_ns: i64, size: [u32; 2], pose, is_key_frame: bool| {
            data.push(json!({"token": token, "sample_token": keyframe(k), "ego_pose_token": token,
                "calibrated_sensor_token": sensor, "timestamp": time_ns / 1000, "fileformat": "",
                "is_key_frame": is_key_frame, "width": size[0], "height": size[1], "prev": "", "next": "",
                "filename": format!("{}/{token}.bin", form.folders[0])}));
            poses.push(posed(token, pose, offset));
        };
        taken(&format!("lidar-{k}"), "lidar", moment.time_ns, [0, 0], &moment.world_from_ego, true);
        for (time_ns, pose) in drive.path.moments() {
            let after_ns = time_ns - moment.time_ns;
            if after_ns > 0 && after_ns < canonical::PERIOD_NS {
                taken(&format!("lidar-at-{time_ns}"), "lidar", *time_ns, [0, 0], pose, false);
            }
        }
        for exposure in &moment.exposures {
            let (name, lens) = (&drive.rig[exposure.camera].name, &exposure.lens);
            let size = [lens.width_px, lens.height_px];
            taken(&format!("{name}-{k}"), name, exposure.time_ns, size, &exposure.world_from_ego, true);
        }
        for (i, object) in moment.boxes.iter().enumerate() {
            let mut row = posed(&format!("b{i}-{k}"), &object.cuboid.world_from_body, offset);
            let size = object.cuboid.size_m;
            (row["prev"], row["next"]) = {
                let (prev, next) = chain(k, count, |k| format!("b{i}-{k}"));
                (json!(prev), json!(next))
            };
            (row["sample_token"], row["instance_token"]) = (json!(keyframe(k)), json!(format!("i{i}")));
            (row["size"], row["visibility_token"]) = (json!([size.y, size.x, size.z]), json!(""));
            row["attribute_tokens"] = json!((form.category)(object.kind).1);
            (row["num_lidar_pts"], row["num_radar_pts"]) = (json!(object.lidar_points), json!(0));
            annotations.push(row);
        }
    }
    table("sample", samples);
    table("sample_data", data);
    table("ego_pose", poses);
    table("sample_annotation", annotations);
    let instance = |i: usize| {
        json!({"token": format!("i{i}"), "category_token": format!("c{i}"), "nbr_annotations": count,
        "first_annotation_token": format!("b{i}-0"), "last_annotation_token": format!("b{i}-{}", count - 1)})
    };
    table("instance", (0..drive.tracks.len()).map(instance).collect());
    let categories = drive.tracks.iter().enumerate();
    table(
        "category",
        categories
            .map(|(i, track)| json!({"token": format!("c{i}"), "name": (form.category)(track.kind).0, "description": ""}))
            .collect(),
    );
    table("attribute", vec![json!({"token": "with", "name": "cycle.with_rider", "description": ""})]);
    table("visibility", vec![]);
    let points = canonical::points_sensor();
    let point = |p: &DVec3| [p.x as f32, p.y as f32, p.z as f32, 0.0, 0.0].map(f32::to_le_bytes).concat();
    let bytes: Vec<u8> = points.iter().flat_map(point).collect();
    let folder = root.path().join(form.folders[1]);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join(format!("lidar-{}.bin", canonical::SWEPT)), &bytes).unwrap();
    for sweep in &drive.sweeps {
        std::fs::write(folder.join(format!("lidar-at-{}.bin", sweep.time_ns)), &bytes).unwrap();
    }
    root
}

fn put(root: &Path, file: &str, text: &str) {
    std::fs::create_dir_all(root.join(file).parent().unwrap()).unwrap();
    std::fs::write(root.join(file), text).unwrap();
}

/// The drive that comes back, which is the one that was written.
fn check(drive: &Drive, form: &Form) -> Drive {
    let (root, report) = (write(drive, form), Report::default());
    assert_eq!(NuScenes::versions(root.path()), [form.version]);
    let found = NuScenes::open(root.path(), form.version, None, &report).unwrap().drive("canonical", &report).unwrap();
    assert_eq!(differences(drive, &found, &TIGHT), [""; 0], "{:?}", report.entries());
    let said: Vec<_> = report.entries().into_iter().map(|entry| entry.what).collect();
    assert_eq!(said, ["no nuScenes map expansion for the drive's place"]);
    found
}

#[test]
fn nuscenes_gives_the_canonical_drive_back() {
    assert_eq!(check(&sayable(), &NUSCENES).dataset, "nuscenes");
    check(&canonical::without_between(sayable()), &NUSCENES);
}

#[test]
fn lyft_gives_the_canonical_drive_back() {
    let found = check(&canonical::without_between(sayable()), &LYFT);
    assert!(found.dataset == "lyft" && found.licence.contains("Lyft"), "{} {}", found.dataset, found.licence);
    assert!(found.ego_body.size_m.x > 4.8);
}
