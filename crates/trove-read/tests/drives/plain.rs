//! TRoVE's own plain form: the canonical drive with every kind of georeference.

use std::path::Path;

use glam::{DQuat, DVec3};
use proj4rs::Proj;
use serde_json::{Value, json};
use tempfile::TempDir;
use trove_model::{Distortion, Drive, Frame, Lens, Pose, Report, World};
use trove_read::{DATASETS, ReadError};

use crate::canonical;
use crate::comparison::{TIGHT, differences};

/// A pose of the vehicle as a file says it: key and value.
type VehicleSaid<'a> = &'a dyn Fn(&Pose<World, trove_model::Ego>) -> (&'static str, Value);

/// How a file says where things are: georeference, and poses of vehicles and of anything else in World.
struct Said<'a> {
    georeference: Value,
    vehicle: VehicleSaid<'a>,
    /// From World to the file's; `None` where boxes are told from the vehicle.
    file_from_world: Option<&'a dyn Fn(DVec3, DQuat) -> (DVec3, DQuat)>,
}

pub(crate) fn read(root: &Path, report: &Report) -> Result<Drive, ReadError> {
    let dataset = DATASETS.iter().find(|dataset| (dataset.is_at)(root)).expect("a root of a dataset");
    assert_eq!(dataset.name, "trove");
    let source = (dataset.configure)(toml::Table::new()).unwrap()(root, None, report)?;
    let drives = source.drives();
    source.read(&drives[0].name, report)
}

pub(crate) fn put(root: &Path, file: &str, bytes: &[u8]) {
    std::fs::create_dir_all(root.join(file).parent().unwrap()).unwrap();
    std::fs::write(root.join(file), bytes).unwrap();
}

fn values(translation: DVec3, rotation: DQuat) -> Value {
    let DQuat { x, y, z, w } = rotation;
    json!({"translation_m": translation.to_array(), "rotation_wxyz": [w, x, y, z]})
}

fn posed<D: Frame, S: Frame>(pose: &Pose<D, S>) -> Value {
    values(pose.translation, pose.rotation)
}

fn camera(lens: &Lens, mounting: &Value) -> Value {
    let mut camera = json!({"width_px": lens.width_px, "height_px": lens.height_px, "fx_px": lens.fx_px,
        "fy_px": lens.fy_px, "cx_px": lens.cx_px, "cy_px": lens.cy_px, "ego_from_camera": mounting});
    if lens.distortion != Distortion::None {
        camera["lens_model"] = json!(lens.distortion.name());
        camera["distortion"] = json!(lens.distortion.coefficients());
    }
    camera
}

/// The drive in a folder, as JSON or as JSON Lines, with its sweep as `.bin`.
fn write(drive: &Drive, said: &Said, is_lines: bool) -> TempDir {
    let root = tempfile::tempdir().unwrap();
    let cameras: serde_json::Map<String, Value> =
        drive.rig.iter().map(|c| (c.name.clone(), camera(&c.lens, &posed(&c.ego_from_camera)))).collect();
    let mut header = json!({"trove_drive": 1, "name": "canonical", "georeference": said.georeference, "cameras": cameras,
        "licence": drive.licence, "ego_body": {"centre_m": drive.ego_body.centre_ego.to_array(),
        "size_m": drive.ego_body.size_m.to_array()}});
    let lidar = |file: &str| json!({"file": file, "ego_from_lidar": posed(&canonical::ego_from_lidar())});
    let on_path = |(time_ns, pose): &(i64, Pose<World, trove_model::Ego>)| {
        let (key, vehicle) = (said.vehicle)(pose);
        json!({"time_ns": time_ns, key: vehicle})
    };
    header["path"] = drive.path.moments().iter().map(on_path).collect();
    let between = |sweep: &trove_model::Sweep| json!({"time_ns": sweep.time_ns, "lidar": lidar("lidar/2.bin")});
    header["sweeps"] = drive.sweeps.iter().map(between).collect();
    let keyframe = |(k, moment): (usize, &trove_model::Keyframe)| {
        let mut value = json!({"time_ns": moment.time_ns, "token": moment.token});
        let (key, vehicle) = (said.vehicle)(&moment.world_from_ego);
        value[key] = vehicle;
        for exposure in &moment.exposures {
            let (key, vehicle) = (said.vehicle)(&exposure.world_from_ego);
            value["pictures"][&drive.rig[exposure.camera].name] =
                json!({"token": exposure.token, "time_ns": exposure.time_ns, key: vehicle});
        }
        let object = |object: &trove_model::ObjectBox| {
            let body = &object.cuboid.world_from_body;
            let mut value = json!({"track": drive.tracks[object.track].token, "kind": object.kind.name(),
                "category": object.category, "token": object.token, "size_m": object.cuboid.size_m.to_array(),
                "lidar_points": object.lidar_points});
            match said.file_from_world {
                Some(file_from_world) => {
                    let (translation, rotation) = file_from_world(body.translation, body.rotation);
                    value["world_from_body"] = values(translation, rotation);
                }
                None => value["ego_from_body"] = posed(&(moment.world_from_ego.inverse() * *body)),
            }
            value
        };
        value["boxes"] = moment.boxes.iter().map(object).collect();
        if moment.lidar.is_some() {
            value["lidar"] = lidar("lidar/2.bin");
            assert_eq!(k, canonical::SWEPT);
        }
        value
    };
    let keyframes: Vec<Value> = drive.keyframes.iter().enumerate().map(keyframe).collect();
    if is_lines {
        let lines: Vec<String> = std::iter::once(&header).chain(&keyframes).map(Value::to_string).collect();
        put(root.path(), "drive.jsonl", lines.join("\n").as_bytes());
    } else {
        header["keyframes"] = json!(keyframes);
        put(root.path(), "drive.json", serde_json::to_string_pretty(&header).unwrap().as_bytes());
    }
    let point = |p: &DVec3| [p.x as f32, p.y as f32, p.z as f32, 0.5].map(f32::to_le_bytes).concat();
    put(root.path(), "lidar/2.bin", &canonical::points_sensor().iter().flat_map(point).collect::<Vec<u8>>());
    root
}

fn check(drive: &Drive, said: &Said) {
    for is_lines in [false, true] {
        let (root, report) = (write(drive, said, is_lines), Report::default());
        let found = read(root.path(), &report).unwrap();
        assert_eq!(differences(drive, &found, &TIGHT), [""; 0], "{} {:?}", said.georeference, report.entries());
        assert_eq!((found.id.as_str(), found.licence.as_str()), ("canonical", "CC0"));
        assert_eq!(found.ego_body, drive.ego_body);
        assert_eq!(report.entries(), []);
    }
}

/// The drive in a frame that a function takes World to.
fn check_framed(drive: &Drive, georeference: Value, file_from_world: &dyn Fn(DVec3, DQuat) -> (DVec3, DQuat)) {
    let vehicle = |pose: &Pose<World, trove_model::Ego>| {
        let (translation, rotation) = file_from_world(pose.translation, pose.rotation);
        ("world_from_ego", values(translation, rotation))
    };
    check(drive, &Said { georeference, vehicle: &vehicle, file_from_world: Some(file_from_world) });
}

#[test]
fn a_local_frame_gives_the_canonical_drive_back() {
    let origin = |yaw: f64| json!({"local": {"origin_lat_deg": canonical::LAT_DEG, "origin_lon_deg": canonical::LON_DEG, "x_axis_yaw_rad": yaw}});
    check_framed(&canonical::drive(), origin(0.0), &|point, rotation| (point, rotation));
    let turn = DQuat::from_rotation_z(-0.6);
    check_framed(&canonical::drive(), origin(0.6), &|point, rotation| (turn * point, turn * rotation));
}

#[test]
fn a_utm_zone_gives_the_canonical_drive_back() {
    let grid = Proj::from_proj_string("+proj=utm +zone=17 +datum=WGS84 +units=m").unwrap();
    let geographic = Proj::from_proj_string("+proj=longlat +datum=WGS84").unwrap();
    let drive = canonical::drive();
    let utm = |world: DVec3| {
        let (lat_deg, lon_deg) = drive.projection.geo_from_world(world.truncate());
        let mut point = (lon_deg.to_radians(), lat_deg.to_radians(), 0.0);
        proj4rs::transform::transform(&geographic, &grid, &mut point).unwrap();
        DVec3::new(point.0, point.1, world.z)
    };
    let first = drive.keyframes[0].world_from_ego.translation;
    let north = (utm(first + DVec3::Y * 50.0) - utm(first - DVec3::Y * 50.0)).truncate().to_angle();
    let turn = DQuat::from_rotation_z(north - std::f64::consts::FRAC_PI_2);
    assert!(turn.angle_between(DQuat::IDENTITY) > 0.01, "the zone's north is another");
    check_framed(&drive, json!({"utm": {"zone": 17}}), &|point, rotation| (utm(point), turn * rotation));
}

#[test]
fn wgs84_gives_the_canonical_drive_back() {
    let drive = canonical::drive();
    let vehicle = |pose: &Pose<World, trove_model::Ego>| {
        let (lat_deg, lon_deg) = drive.projection.geo_from_world(pose.translation.truncate());
        let DQuat { x, y, z, w } = pose.rotation;
        let alt_m = pose.translation.z + 250.3;
        let value = json!({"lat_deg": lat_deg, "lon_deg": lon_deg, "alt_m": alt_m, "rotation_wxyz": [w, x, y, z]});
        ("geo_from_ego", value)
    };
    check(&drive, &Said { georeference: json!("wgs84"), vehicle: &vehicle, file_from_world: None });
}

#[test]
fn a_drive_that_lies_nowhere_says_so() {
    let mut drive = canonical::drive();
    drive.is_georeferenced = false;
    check_framed(&drive, json!("unknown"), &|point, rotation| (point, rotation));
    let near = json!({"near": {"lat_deg": 40.0, "lon_deg": -80.0}});
    check_framed(&drive, near, &|point, rotation| (point + DVec3::new(1e4, -2e5, 12.0), rotation));
}
