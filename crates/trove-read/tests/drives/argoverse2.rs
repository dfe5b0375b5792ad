//! Argoverse 2: the canonical drive as a log's tables.

use std::path::Path;

use arrow_ipc::CompressionType;
use glam::{DQuat, DVec2, DVec3};
use tempfile::TempDir;
use trove_model::{Distortion, Drive, Frame, Kind, Pose, Report, World};

use crate::canonical;
use crate::comparison::{TIGHT, differences};

#[path = "../argoverse2/fixture.rs"]
#[allow(dead_code)] // the reader's own tests use the rest
mod fixture;

#[path = "../argoverse2/utm.rs"]
mod grid;

use fixture::{ANNOTATIONS, Column, INTRINSICS, MOUNTS, POSES, Table, feather, load, pose_columns, put, words};
use grid::{PITTSBURGH_UTM_M, utm};

/// The dataset's vehicle frame has its origin in the rear axle.
const AXLE_HEIGHT_M: f64 = 0.325;
/// World's origin above the city's.
const HEIGHT_M: f64 = 231.0;

/// What Argoverse 2 can say: its pictures are without distortion.
fn sayable() -> Drive {
    let mut drive = canonical::with_cameras(canonical::drive(), ["ring_front_center", "ring_front_left"]);
    drive.sweeps.clear(); // every sweep is a keyframe's
    let lenses = drive.keyframes.iter_mut().flat_map(|k| &mut k.exposures).map(|e| &mut e.lens);
    lenses.chain(drive.rig.iter_mut().map(|c| &mut c.lens)).for_each(|lens| lens.distortion = Distortion::None);
    drive
}

fn row(rotation: DQuat, translation: DVec3) -> [f64; 7] {
    let (q, t) = (rotation, translation);
    [q.w, q.x, q.y, q.z, t.x, t.y, t.z]
}

fn in_ego<S: Frame>(axle_from_x: &Pose<trove_model::Ego, S>) -> [f64; 7] {
    row(axle_from_x.rotation, axle_from_x.translation - DVec3::Z * AXLE_HEIGHT_M)
}

/// Positions go over the earth to Pittsburgh's grid; its north is that at the first keyframe.
struct Grid {
    grid_from_world: DQuat,
    drive: Drive,
}

impl Grid {
    fn city(&self, world: DVec3) -> DVec3 {
        let (lat_deg, lon_deg) = self.drive.projection.geo_from_world(world.truncate());
        (utm(17, lat_deg, lon_deg) - PITTSBURGH_UTM_M).extend(world.z + HEIGHT_M)
    }

    fn pose<S: Frame>(&self, world_from_ego: &Pose<World, S>) -> [f64; 7] {
        let axle = world_from_ego.point(DVec3::Z * AXLE_HEIGHT_M);
        row(self.grid_from_world * world_from_ego.rotation, self.city(axle))
    }
}

fn grid_under(drive: &Drive) -> Grid {
    let first = drive.keyframes[0].world_from_ego.translation.truncate();
    let at = |world: DVec2| {
        let (lat_deg, lon_deg) = drive.projection.geo_from_world(world);
        utm(17, lat_deg, lon_deg)
    };
    let north = at(first + DVec2::Y * 50.0) - at(first - DVec2::Y * 50.0);
    Grid { grid_from_world: DQuat::from_rotation_z(DVec2::Y.angle_to(north)), drive: drive.clone() }
}

fn write(drive: &Drive) -> TempDir {
    let (root, grid) = (tempfile::tempdir().unwrap(), grid_under(drive));
    let table = |file: &str, table: Table| put(root.path(), file, &feather(&table, CompressionType::LZ4_FRAME));
    let mut poses: Vec<_> = drive.keyframes.iter().map(|k| (k.time_ns, grid.pose(&k.world_from_ego))).collect();
    for exposure in drive.keyframes.iter().flat_map(|k| &k.exposures) {
        poses.push((exposure.time_ns, grid.pose(&exposure.world_from_ego)));
        let name = &drive.rig[exposure.camera].name;
        put(root.path(), &format!("sensors/cameras/{name}/{}.jpg", exposure.time_ns), b"");
    }
    poses.extend(drive.path.moments().iter().map(|(time_ns, pose)| (*time_ns, grid.pose(pose))));
    poses.sort_by_key(|(time_ns, _)| *time_ns);
    poses.dedup_by_key(|(time_ns, _)| *time_ns);
    let stamps = Column::Int(poses.iter().map(|(time_ns, _)| *time_ns).collect());
    let rows: Vec<_> = poses.into_iter().map(|(_, pose)| pose).collect();
    table(POSES, [vec![("timestamp_ns", stamps)], pose_columns(&rows)].concat());
    calibration(drive, &table);
    annotations(drive, &table);
    for keyframe in &drive.keyframes {
        let Some(sweep) = &keyframe.lidar else { continue };
        let ego_from_world = keyframe.world_from_ego.inverse();
        let points: Vec<_> = sweep
            .points_world
            .iter()
            .map(|p| (ego_from_world.point(p.as_dvec3()) - DVec3::Z * AXLE_HEIGHT_M).as_vec3())
            .collect();
        let coordinate = |i: usize| Column::Single(points.iter().map(|p| p[i]).collect());
        let sweep = vec![("x", coordinate(0)), ("y", coordinate(1)), ("z", coordinate(2))];
        table(&format!("sensors/lidar/{}.feather", keyframe.time_ns), sweep);
    }
    put(root.path(), fixture::MAP, b"{}");
    root
}

fn calibration(drive: &Drive, table: &impl Fn(&str, Table)) {
    let names = || drive.rig.iter().map(|c| c.name.as_str());
    let mut mounts: Vec<_> = drive.rig.iter().map(|c| in_ego(&c.ego_from_camera)).collect();
    mounts.push(in_ego(&canonical::ego_from_lidar()));
    table(MOUNTS, [vec![("sensor_name", words(names().chain(["up_lidar"])))], pose_columns(&mounts)].concat());
    let pixels =
        |value: fn(&trove_model::Lens) -> f64| Column::Float(drive.rig.iter().map(|c| value(&c.lens)).collect());
    let sides =
        |value: fn(&trove_model::Lens) -> u32| Column::Short(drive.rig.iter().map(|c| value(&c.lens) as u16).collect());
    let intrinsics = vec![
        ("sensor_name", words(names())),
        ("fx_px", pixels(|l| l.fx_px)),
        ("fy_px", pixels(|l| l.fy_px)),
        ("cx_px", pixels(|l| l.cx_px)),
        ("cy_px", pixels(|l| l.cy_px)),
        ("width_px", sides(|l| l.width_px)),
        ("height_px", sides(|l| l.height_px)),
    ];
    table(INTRINSICS, intrinsics);
}

/// A cyclist is two boxes: the bicycle's from the wheels up, the rider's down from the head.
fn annotations(drive: &Drive, table: &impl Fn(&str, Table)) {
    let (mut stamps, mut tracks, mut categories) = (Vec::new(), Vec::new(), Vec::new());
    let (mut sizes, mut poses) = (Vec::new(), Vec::new());
    for keyframe in &drive.keyframes {
        for object in &keyframe.boxes {
            let ego_from_body = keyframe.world_from_ego.inverse() * object.cuboid.world_from_body;
            let size_m = object.cuboid.size_m;
            let parts = match object.kind {
                Kind::Car => vec![("REGULAR_VEHICLE", 0.0, size_m)],
                Kind::Adult => vec![("PEDESTRIAN", 0.0, size_m)],
                Kind::Truck => vec![("BOX_TRUCK", 0.0, size_m)],
                Kind::BicycleWithRider => vec![
                    ("BICYCLIST", 0.2, DVec3::new(size_m.y, size_m.y, size_m.z - 0.4)),
                    ("BICYCLE", -0.3, DVec3::new(size_m.x, size_m.y, size_m.z - 0.6)),
                ],
                other => panic!("{other:?} is not in the canonical drive"),
            };
            for (category, up_m, size_m) in parts {
                stamps.push(keyframe.time_ns);
                tracks.push(format!("{}-{category}", object.track));
                categories.push(category);
                sizes.push(size_m);
                let part = Pose::new(ego_from_body.rotation, ego_from_body.point(DVec3::Z * up_m));
                poses.push(in_ego::<trove_model::Body>(&part));
            }
        }
    }
    let count = stamps.len();
    let side = |i: usize| Column::Float(sizes.iter().map(|s: &DVec3| s[i]).collect());
    let columns = vec![
        ("timestamp_ns", Column::Int(stamps)),
        ("track_uuid", Column::Text(tracks)),
        ("category", words(categories)),
        ("length_m", side(0)),
        ("width_m", side(1)),
        ("height_m", side(2)),
        ("num_interior_pts", Column::Int(vec![1; count])),
    ];
    table(ANNOTATIONS, [columns, pose_columns(&poses)].concat());
}

fn read(root: &Path) -> Drive {
    load(root, &Report::default()).unwrap()
}

#[test]
fn the_canonical_drive_comes_back_from_argoverse_2() {
    let drive = sayable();
    assert_eq!(differences(&drive, &read(write(&drive).path()), &TIGHT), [""; 0]);
}
