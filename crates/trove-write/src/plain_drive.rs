//! A recorded drive, from whatever dataset, in the plain form (docs/plain-drive.md).

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use glam::{DQuat, DVec2, DVec3};
use trove_files::{open_regular, write_atomically};
use trove_format::{
    LensModel, PlainBox, PlainCamera, PlainDrive, PlainEgoBody, PlainGeoreference, PlainKeyframe, PlainLane,
    PlainLaneMap, PlainLaneMark, PlainLidar, PlainMoment, PlainPicture, PlainPolygon, PlainPose, PlainSweep,
};
use trove_model::{
    Camera, Drive, Ego, Exposure, Frame, Lane, LaneMap, LaneMark, Lens, LidarClass, LidarSweep, ObjectBox, Outcome,
    Polygon, Pose, Report, World,
};

use crate::WriteError;

/// Which files go with a drive's records.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlainFiles {
    /// LiDAR sweeps, as `.bin`.
    pub lidar: bool,
    /// Pictures, as links to the dataset's where the file system has such, else as copies.
    pub pictures: bool,
}

/// Writes a drive into a folder of its own: `drive.jsonl`, last, and the files that are asked for. `root` is the folder of
/// the dataset that pictures are named from.
///
/// # Errors
/// What cannot be written; a picture that cannot be read is reported and left out.
pub fn write_plain_drive(
    drive: &Drive,
    root: &Path,
    folder: &Path,
    files: PlainFiles,
    report: &Report,
) -> Result<(), WriteError> {
    create(folder)?;
    let mut keyframes = Vec::new();
    for (k, keyframe) in drive.keyframes.iter().enumerate() {
        let mut pictures = BTreeMap::new();
        for exposure in &keyframe.exposures {
            let camera = &drive.rig[exposure.camera];
            let is_as_mounted = (camera.lens, camera.ego_from_camera) == (exposure.lens, exposure.ego_from_camera);
            let recalibrated = (!is_as_mounted).then(|| plain_camera(&exposure.lens, &exposure.ego_from_camera));
            let file = match &exposure.file {
                Some(file) if files.pictures => copied(&root.join(file), folder, &camera.name, k, report)?,
                _ => None,
            };
            pictures.insert(camera.name.clone(), picture(exposure, recalibrated, file));
        }
        let lidar = keyframe.lidar.as_ref().filter(|_| files.lidar);
        let lidar = lidar.map(|sweep| plain_lidar(sweep, &keyframe.world_from_ego, &format!("{k:06}"), folder));
        let lidar = lidar.transpose()?;
        keyframes.push(PlainKeyframe {
            time_ns: keyframe.time_ns,
            token: keyframe.token.clone(),
            world_from_ego: Some(pose(&keyframe.world_from_ego)),
            geo_from_ego: None,
            boxes: keyframe.boxes.iter().map(|object| plain_box(object, &drive.tracks[object.track].token)).collect(),
            pictures: Some(pictures),
            lidar,
        });
    }
    let mut sweeps = Vec::new();
    for (i, sweep) in drive.sweeps.iter().enumerate().filter(|_| files.lidar) {
        let Some(world_from_ego) = drive.world_from_ego_at(sweep.time_ns) else { continue };
        let lidar = plain_lidar(&sweep.lidar, &world_from_ego, &format!("between-{i:06}"), folder)?;
        sweeps.push(PlainSweep { time_ns: sweep.time_ns, lidar });
    }
    let moment = |(time_ns, world_from_ego): &(i64, Pose<World, Ego>)| PlainMoment {
        time_ns: *time_ns,
        world_from_ego: Some(pose(world_from_ego)),
        geo_from_ego: None,
    };
    let cameras = drive.rig.iter().map(|c| (c.name.clone(), plain_camera(&c.lens, &c.ego_from_camera)));
    let plain = PlainDrive {
        trove_drive: PlainDrive::VERSION,
        name: Some(drive.id.clone()),
        place: drive.place.clone(),
        licence: drive.licence.clone(),
        georeference: georeference(drive),
        ego_body: Some(PlainEgoBody {
            centre_m: drive.ego_body.centre_ego.to_array(),
            size_m: drive.ego_body.size_m.to_array(),
        }),
        cameras: cameras.collect(),
        lane_map: drive.lane_map.as_ref().map(lane_map),
        path: drive.path.moments().iter().map(moment).collect(),
        sweeps,
        keyframes,
    };
    write(&folder.join(PlainDrive::LINES_NAME), &plain.to_json_lines())
}

fn create(folder: &Path) -> Result<(), WriteError> {
    fs::create_dir_all(folder).map_err(WriteError::storage(folder, "make the folder"))
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    write_atomically(path, bytes).map_err(WriteError::storage(path, "write the file"))
}

fn georeference(drive: &Drive) -> PlainGeoreference {
    let (lat_deg, lon_deg) = drive.projection.geo_from_world(DVec2::ZERO);
    if !drive.is_georeferenced {
        return PlainGeoreference::Near { lat_deg, lon_deg };
    }
    PlainGeoreference::Local {
        origin_lat_deg: lat_deg,
        origin_lon_deg: lon_deg,
        x_axis_yaw_rad: 0.0,
        metres_per_rad: Some(drive.projection.metres_per_rad.to_array()),
    }
}

fn pose<Dst: Frame, Src: Frame>(pose: &Pose<Dst, Src>) -> PlainPose {
    let DQuat { x, y, z, w } = pose.rotation;
    PlainPose { translation_m: pose.translation.to_array(), rotation_wxyz: Some([w, x, y, z]), yaw_rad: None }
}

fn plain_camera(lens: &Lens, ego_from_camera: &Pose<Ego, Camera>) -> PlainCamera {
    let Lens { width_px, height_px, fx_px, fy_px, cx_px, cy_px, distortion } = lens;
    PlainCamera {
        width_px: *width_px,
        height_px: *height_px,
        fx_px: *fx_px,
        fy_px: Some(*fy_px),
        cx_px: Some(*cx_px),
        cy_px: Some(*cy_px),
        lens_model: Some(LensModel::from(distortion)),
        distortion: distortion.coefficients(),
        ego_from_camera: pose(ego_from_camera),
    }
}

fn picture(exposure: &Exposure, camera: Option<PlainCamera>, file: Option<String>) -> PlainPicture {
    PlainPicture {
        file,
        token: exposure.token.clone(),
        time_ns: Some(exposure.time_ns),
        world_from_ego: Some(pose(&exposure.world_from_ego)),
        geo_from_ego: None,
        camera,
    }
}

fn plain_box(object: &ObjectBox, track: &str) -> PlainBox {
    PlainBox {
        track: track.to_owned(),
        kind: object.kind,
        category: Some(object.category.clone()),
        token: object.token.clone(),
        size_m: object.cuboid.size_m.to_array(),
        world_from_body: Some(pose(&object.cuboid.world_from_body)),
        ego_from_body: None,
        velocity_mps: object.velocity_mps.map(|v| v.to_array()),
        parked: object.is_parked,
        attributes: object.attributes.clone(),
        lidar_points: object.lidar_points,
        visibility: object.visibility,
    }
}

/// A sweep's points stay in World, where they are the same to the last digit.
fn plain_lidar(
    sweep: &LidarSweep,
    world_from_ego: &Pose<World, Ego>,
    name: &str,
    folder: &Path,
) -> Result<PlainLidar, WriteError> {
    create(&folder.join("lidar"))?;
    let file = format!("lidar/{name}.bin");
    let point = |p: &glam::Vec3| [p.x, p.y, p.z, 0.0].map(f32::to_le_bytes).concat();
    write(&folder.join(&file), &sweep.points_world.iter().flat_map(point).collect::<Vec<u8>>())?;
    let labels = (!sweep.classes.is_empty()).then(|| format!("lidar/{name}.labels"));
    if let Some(labels) = &labels {
        let number = |class: &LidarClass| match class {
            LidarClass::Other => 0,
            LidarClass::Road => 1,
            LidarClass::Sidewalk => 2,
            LidarClass::Terrain => 3,
            LidarClass::Vegetation => 4,
            LidarClass::Manmade => 5,
        };
        write(&folder.join(labels), &sweep.classes.iter().map(number).collect::<Vec<u8>>())?;
    }
    let mounted = world_from_ego.inverse().point(sweep.origin_world);
    let ego_from_lidar = PlainPose { translation_m: mounted.to_array(), rotation_wxyz: None, yaw_rad: None };
    Ok(PlainLidar { file, labels, ego_from_lidar: Some(ego_from_lidar), is_in_world: true })
}

/// A picture's path from the drive's folder; `None` where it cannot be read.
fn copied(from: &Path, folder: &Path, camera: &str, k: usize, report: &Report) -> Result<Option<String>, WriteError> {
    let ending = from.extension().and_then(|e| e.to_str()).unwrap_or("jpg");
    let file = format!("pictures/{camera}/{k:06}.{ending}");
    let to = folder.join(&file);
    if let Err(error) = open_regular(from) {
        report.note(Outcome::Dropped, "picture that cannot be read", format!("{}: {error}", from.display()));
        return Ok(None);
    }
    create(&folder.join("pictures").join(camera))?;
    if !to.is_file() && fs::hard_link(from, &to).is_err() {
        fs::copy(from, &to).map_err(WriteError::storage(&to, "copy the picture"))?;
    }
    Ok(Some(file))
}

fn lane_map(map: &LaneMap) -> PlainLaneMap {
    let LaneMap {
        drivable,
        lanes,
        walkways,
        crossings,
        stop_lines,
        carparks,
        road_dividers,
        lane_dividers,
        marks,
        ground,
    } = map;
    let line = |line: &Vec<DVec2>| line.iter().map(DVec2::to_array).collect::<Vec<_>>();
    let polygon = |Polygon { exterior, holes }: &Polygon| PlainPolygon {
        outline: line(exterior),
        holes: holes.iter().map(line).collect(),
    };
    let polygons = |polygons: &[Polygon]| polygons.iter().map(polygon).collect();
    let lane = |Lane { token, polygon: surface, centreline }: &Lane| PlainLane {
        token: token.clone(),
        polygon: polygon(surface),
        centreline: line(centreline),
    };
    let mark = |mark: &LaneMark| PlainLaneMark { line: line(&mark.line), paint: mark.paint, pattern: mark.pattern };
    PlainLaneMap {
        drivable: polygons(drivable),
        lanes: lanes.iter().map(lane).collect(),
        walkways: polygons(walkways),
        crossings: polygons(crossings),
        stop_lines: polygons(stop_lines),
        carparks: polygons(carparks),
        road_dividers: road_dividers.iter().map(line).collect(),
        lane_dividers: lane_dividers.iter().map(line).collect(),
        marks: marks.iter().map(mark).collect(),
        ground: ground.iter().map(DVec3::to_array).collect(),
    }
}
