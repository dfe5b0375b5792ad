//! The made-up drive as nuScenes' thirteen tables.

use glam::{DMat3, DQuat, DVec2, DVec3};
use serde_json::{Value, json};
use trove_model::{Body, Pose, Seed, World};

use super::road_users::{self, RoadUser};
use super::street::{CROSSING_M, EASTBOUND_M, LAT_DEG, LON_DEG, PLACE};

/// Annotated moments, half a second apart as in nuScenes; the demo's picture is of the middle one.
pub(super) const KEYFRAMES: usize = 5;
const KEYFRAME_US: i64 = 500_000;
/// 2024-06-12 13:40 UTC: mid-afternoon at the place, so that the sun is high and shadows have some length.
const START_US: i64 = 1_718_199_600_000_000;
/// The recording vehicle at the middle keyframe, and its speed.
const EGO_X_M: f64 = -31.0;
const EGO_SPEED_MPS: f64 = 6.0;

/// Cameras: name, position in Ego, heading, focal length, and when they fire before the keyframe's time.
const CAMERAS: [(&str, [f64; 3], f64, f64, i64); 6] = [
    ("CAM_FRONT", [1.70, 0.0, 1.51], 0.0, 1260.0, 35_000),
    ("CAM_FRONT_RIGHT", [1.55, -0.50, 1.50], -55.0, 1260.0, 27_000),
    ("CAM_BACK_RIGHT", [1.02, -0.48, 1.56], -110.0, 1260.0, 20_000),
    ("CAM_BACK", [0.03, 0.0, 1.57], 180.0, 810.0, 10_000),
    ("CAM_BACK_LEFT", [1.03, 0.48, 1.56], 110.0, 1260.0, 1_000),
    ("CAM_FRONT_LEFT", [1.58, 0.50, 1.50], 55.0, 1260.0, 43_000),
];

/// A 32-digit token, as nuScenes has them.
pub(super) fn token(kind: &str, index: u64) -> String {
    let seed = Seed(0x7265_7665).child(kind).nth(index);
    format!("{:016x}{:016x}", seed.0, seed.nth(1).0)
}

/// The tables by name.
pub(super) fn tables() -> Vec<(&'static str, Value)> {
    let users = road_users::all();
    let mut categories: Vec<&str> = users.iter().map(|user| user.category).collect();
    let mut attributes: Vec<&str> = users.iter().map(|user| user.attribute).filter(|a| !a.is_empty()).collect();
    for names in [&mut categories, &mut attributes] {
        names.sort_unstable();
        names.dedup();
    }
    let named = |kind: &str, names: &[&str]| -> Value {
        let row = |name: &&str| json!({ "token": token_of(kind, name), "name": name, "description": "" });
        names.iter().map(row).collect()
    };
    let (sample_data, ego_pose) = recordings();
    vec![
        ("attribute", named("attribute", &attributes)),
        ("category", named("category", &categories)),
        ("visibility", json!([{ "token": "4", "level": "v80-100", "description": "" }])),
        ("sensor", sensors()),
        ("calibrated_sensor", calibrations()),
        ("log", json!([log()])),
        (
            "map",
            json!([{
                "token": token("map", 0),
                "category": "semantic_prior",
                "filename": "",
                "log_tokens": [token("log", 0)],
            }]),
        ),
        ("scene", json!([scene()])),
        ("sample", samples()),
        ("sample_data", sample_data),
        ("ego_pose", ego_pose),
        ("instance", instances(&users)),
        ("sample_annotation", annotations(&users)),
    ]
}

fn token_of(kind: &str, name: &str) -> String {
    token(&format!("{kind}/{name}"), 0)
}

fn log() -> Value {
    json!({
        "token": token("log", 0),
        "logfile": "trove-demo",
        "vehicle": "demo",
        "date_captured": "2024-06-12",
        "location": PLACE,
        "trove_origin_lat_deg": LAT_DEG,
        "trove_origin_lon_deg": LON_DEG,
        "trove_licence": "MIT OR Apache-2.0",
    })
}

fn scene() -> Value {
    json!({
        "token": token("scene", 0),
        "log_token": token("log", 0),
        "nbr_samples": KEYFRAMES,
        "first_sample_token": token("sample", 0),
        "last_sample_token": token("sample", KEYFRAMES as u64 - 1),
        "name": "demo-0001",
        "description": "a made-up crossing with parked and moving vehicles, people, riders and a work site",
    })
}

fn samples() -> Value {
    let row = |k: usize| {
        json!({
            "token": token("sample", k as u64),
            "timestamp": keyframe_us(k),
            "prev": neighbour("sample", k, -1),
            "next": neighbour("sample", k, 1),
            "scene_token": token("scene", 0),
        })
    };
    (0..KEYFRAMES).map(row).collect()
}

fn sensors() -> Value {
    let row = |camera: &(&str, [f64; 3], f64, f64, i64)| json!({ "token": token_of("sensor", camera.0), "channel": camera.0, "modality": "camera" });
    CAMERAS.iter().map(row).collect()
}

fn calibrations() -> Value {
    let row = |&(name, translation, heading_deg, focal_px, _): &(&str, [f64; 3], f64, f64, i64)| {
        json!({
            "token": token_of("calibrated_sensor", name),
            "sensor_token": token_of("sensor", name),
            "translation": translation,
            "rotation": wxyz(ego_from_camera(f64::to_radians(heading_deg))),
            "camera_intrinsic": [[focal_px, 0.0, 800.0], [0.0, focal_px, 450.0], [0.0, 0.0, 1.0]],
        })
    };
    CAMERAS.iter().map(row).collect()
}

/// A level camera that looks along a heading: its z is forward, its x right, its y down.
fn ego_from_camera(heading_rad: f64) -> DQuat {
    let forward = DVec2::from_angle(heading_rad).extend(0.0);
    DQuat::from_mat3(&DMat3::from_cols(forward.cross(DVec3::Z), -DVec3::Z, forward))
}

/// `sample_data` and `ego_pose`: every picture has a pose of its own.
fn recordings() -> (Value, Value) {
    let (mut pictures, mut poses) = (Vec::new(), Vec::new());
    for k in 0..KEYFRAMES {
        for (c, (name, _, _, _, before_us)) in CAMERAS.iter().enumerate() {
            let kind = format!("sample_data/{name}");
            let (token, time_us) = (token(&kind, k as u64), keyframe_us(k) - before_us);
            let x_m = EGO_X_M + EGO_SPEED_MPS * seconds_from_middle(time_us);
            poses.push(json!({
                "token": token,
                "timestamp": time_us,
                "rotation": [1.0, 0.0, 0.0, 0.0],
                "translation": [x_m + CROSSING_M[0], EASTBOUND_M[0] + CROSSING_M[1], 0.0],
            }));
            pictures.push(json!({
                "token": token,
                "sample_token": self::token("sample", k as u64),
                "ego_pose_token": token,
                "calibrated_sensor_token": token_of("calibrated_sensor", CAMERAS[c].0),
                "timestamp": time_us,
                "fileformat": "jpg",
                "is_key_frame": true,
                "height": 900,
                "width": 1600,
                "filename": format!("samples/{name}/demo__{name}__{time_us}.jpg"),
                "prev": neighbour(&kind, k, -1),
                "next": neighbour(&kind, k, 1),
            }));
        }
    }
    (Value::Array(pictures), Value::Array(poses))
}

fn instances(users: &[RoadUser]) -> Value {
    let row = |(i, user): (usize, &RoadUser)| {
        json!({
            "token": token("instance", i as u64),
            "category_token": token_of("category", user.category),
            "nbr_annotations": KEYFRAMES,
            "first_annotation_token": token(&annotation_kind(i), 0),
            "last_annotation_token": token(&annotation_kind(i), KEYFRAMES as u64 - 1),
        })
    };
    users.iter().enumerate().map(row).collect()
}

fn annotations(users: &[RoadUser]) -> Value {
    let mut rows = Vec::new();
    for (i, user) in users.iter().enumerate() {
        for k in 0..KEYFRAMES {
            let moved_m = user.speed_mps * seconds_from_middle(keyframe_us(k));
            let position = user.position + DVec2::from_angle(user.yaw_rad) * moved_m + DVec2::from_array(CROSSING_M);
            let centre = position.extend(user.ground_m + user.size_m.z / 2.0);
            let attributes: Vec<String> =
                Some(user.attribute).filter(|a| !a.is_empty()).map(|a| token_of("attribute", a)).into_iter().collect();
            rows.push(json!({
                "token": token(&annotation_kind(i), k as u64),
                "sample_token": token("sample", k as u64),
                "instance_token": token("instance", i as u64),
                "visibility_token": "4",
                "attribute_tokens": attributes,
                "translation": centre.to_array(),
                "size": [user.size_m.y, user.size_m.x, user.size_m.z],
                "rotation": wxyz(Pose::<World, Body>::from_yaw(user.yaw_rad, centre).rotation),
                "prev": neighbour(&annotation_kind(i), k, -1),
                "next": neighbour(&annotation_kind(i), k, 1),
                "num_lidar_pts": -1,
                "num_radar_pts": -1,
            }));
        }
    }
    Value::Array(rows)
}

fn annotation_kind(user: usize) -> String {
    format!("sample_annotation/{user}")
}

fn keyframe_us(k: usize) -> i64 {
    START_US + k as i64 * KEYFRAME_US
}

fn seconds_from_middle(time_us: i64) -> f64 {
    (time_us - keyframe_us(KEYFRAMES / 2)) as f64 * 1e-6
}

/// The token before or after number `k`; empty at the ends.
fn neighbour(kind: &str, k: usize, step: isize) -> String {
    match k.checked_add_signed(step) {
        Some(k) if k < KEYFRAMES => token(kind, k as u64),
        _ => String::new(),
    }
}

fn wxyz(q: DQuat) -> [f64; 4] {
    [q.w, q.x, q.y, q.z]
}
