//! v2: a segment's Parquet components → records.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use glam::DVec3;
use trove_model::{Outcome, Report};

use super::fault;
use super::list_column::ListColumn;
use super::range_image::{self, Grid, Scan};
use super::records::{CameraRecord, FrameRecord, LabelRecord, LaserRecord, PictureRecord, Returns, Segment};
use super::{poses, vocabulary};
use crate::ReadError;
use crate::parquet::{Physical, Table};

/// The component that tells where the vehicle was: every segment has a file of it.
pub(super) const POSES: &str = "vehicle_pose";
/// The other components that are read.
const OTHERS: [&str; 7] =
    ["camera_calibration", "camera_image", "lidar_box", "lidar_calibration", "lidar", "lidar_pose", "stats"];

const TIME: &str = "key.frame_timestamp_micros";
const CAMERA: &str = "key.camera_name";
const LASER: &str = "key.laser_name";
/// `LaserName` of the LiDAR on the roof.
const TOP: i64 = 1;

/// Where a component of a segment lies.
pub(super) fn path(root: &Path, component: &str, segment: &str) -> PathBuf {
    root.join(component).join(format!("{segment}.parquet"))
}

/// The files that a segment is read from, as far as they are there.
pub(super) fn files(root: &Path, segment: &str) -> Vec<PathBuf> {
    let all = std::iter::once(POSES).chain(OTHERS).map(|component| path(root, component, segment));
    all.filter(|path| path.is_file()).collect()
}

/// How many frames a segment has; they are not read.
pub(super) fn frames(file: &Path) -> Result<usize, ReadError> {
    let rows = Table::open(file)?.rows();
    let found = || fault::damaged(file, "footer", "a number of rows", rows.to_string());
    usize::try_from(rows).map_err(|_| found())
}

/// Reads a segment, with the LiDAR of every so many frames.
pub(super) fn read(root: &Path, name: &str, lidar_every: usize, report: &Report) -> Result<Segment, ReadError> {
    let component = |component: &str, what: &str| {
        let path = path(root, component, name);
        if path.is_file() {
            return Table::open(&path).map(Some);
        }
        report.note(Outcome::Warned, &format!("Waymo segment without the component of its {what}"), path.display());
        Ok(None)
    };
    let mut segment = Segment { name: name.to_owned(), ..Segment::default() };
    segment.frames = read_poses(&Table::open(&path(root, POSES, name))?, report)?;
    if let Some(table) = component("stats", "place")? {
        let column = "[StatsComponent].location";
        segment.location = table.texts(column)?.into_iter().flatten().next().unwrap_or_default();
    }
    if let Some(table) = component("camera_calibration", "cameras")? {
        segment.cameras = read_cameras(&table)?;
    }
    let mut frame_at = HashMap::new();
    for (i, frame) in segment.frames.iter().enumerate() {
        frame_at.entry(frame.time_us).or_insert(i);
    }
    if let Some(table) = component("camera_image", "pictures")? {
        for (time_us, picture) in read_pictures(&table)? {
            match frame_at.get(&time_us) {
                Some(&frame) => segment.frames[frame].pictures.push(picture),
                None => report.note(Outcome::Dropped, "Waymo picture of no frame", time_us),
            }
        }
    }
    if let Some(table) = component("lidar_box", "boxes")? {
        for (time_us, label) in read_labels(&table)? {
            match frame_at.get(&time_us) {
                Some(&frame) => segment.frames[frame].labels.push(label),
                None => report.note(Outcome::Dropped, "Waymo label of no frame", format!("{time_us}-{}", label.id)),
            }
        }
    }
    let lidar = (component("lidar", "LiDAR")?, component("lidar_calibration", "LiDARs' calibrations")?);
    if let (Some(table), Some(calibrations)) = lidar {
        let moved = path(root, "lidar_pose", name);
        let moved = if moved.is_file() { Some(Table::open(&moved)?) } else { None };
        let lasers = read_lasers(&calibrations)?;
        let scans = Scans { table: &table, moved: moved.as_ref(), lasers: &lasers, lidar_every };
        scans.read_into(&mut segment.frames, &frame_at, report)?;
    }
    Ok(segment)
}

fn read_poses(table: &Table, report: &Report) -> Result<Vec<FrameRecord>, ReadError> {
    let times = table.integers(TIME)?;
    let matrices = table.arrays::<16>("[VehiclePoseComponent].world_from_vehicle.transform")?;
    let mut frames = Vec::new();
    for (row, (time_us, matrix)) in times.into_iter().zip(matrices).enumerate() {
        let example = || format!("{}: row {row}", table.path().display());
        let pose = matrix.and_then(|matrix| poses::pose::<_, _>(&matrix));
        match time_us.zip(pose) {
            Some((time_us, global_from_ego)) => frames.push(FrameRecord {
                time_us,
                global_from_ego,
                pictures: Vec::new(),
                labels: Vec::new(),
                returns: None,
            }),
            None => report.note(Outcome::Dropped, "Waymo frame: no time or no valid vehicle pose", example()),
        }
    }
    Ok(frames)
}

fn read_cameras(table: &Table) -> Result<BTreeMap<i64, CameraRecord>, ReadError> {
    const INTRINSICS: [&str; 9] = ["f_u", "f_v", "c_u", "c_v", "k1", "k2", "p1", "p2", "k3"];
    let mut columns = Vec::new();
    for name in INTRINSICS {
        columns.push(table.numbers(&format!("[CameraCalibrationComponent].intrinsic.{name}"))?);
    }
    let matrices = table.arrays::<16>("[CameraCalibrationComponent].extrinsic.transform")?;
    let widths = table.integers("[CameraCalibrationComponent].width")?;
    let heights = table.integers("[CameraCalibrationComponent].height")?;
    let mut cameras = BTreeMap::new();
    for (row, number) in camera_numbers(table)?.into_iter().enumerate() {
        cameras.entry(number).or_insert(CameraRecord {
            intrinsics: std::array::from_fn(|i| at(&columns[i], row).unwrap_or(f64::NAN)),
            vehicle_from_camera: at(&matrices, row).unwrap_or([f64::NAN; 16]),
            width: at(&widths, row).unwrap_or(0),
            height: at(&heights, row).unwrap_or(0),
        });
    }
    Ok(cameras)
}

/// Cameras' numbers; older files have their names. One that is neither is 0, which no camera has.
pub(super) fn camera_numbers(table: &Table) -> Result<Vec<i64>, ReadError> {
    if table.kind(CAMERA) == Some(Physical::Bytes) {
        let names = table.texts(CAMERA)?;
        return Ok(names
            .into_iter()
            .map(|name| vocabulary::camera_number(&name.unwrap_or_default()).unwrap_or(0))
            .collect());
    }
    Ok(table.integers(CAMERA)?.into_iter().map(|number| number.unwrap_or(0)).collect())
}

fn read_pictures(table: &Table) -> Result<Vec<(i64, PictureRecord)>, ReadError> {
    let column = |name: &str| table.numbers(&format!("[CameraImageComponent].{name}"));
    let vector = |name: &str| vectors(table, &format!("[CameraImageComponent].{name}"));
    let (times, cameras) = (table.integers(TIME)?, camera_numbers(table)?);
    let matrices = table.arrays::<16>("[CameraImageComponent].pose.transform")?;
    let velocities = vector("velocity.linear_velocity")?;
    let turning = vector("velocity.angular_velocity")?;
    let pose_s = column("pose_timestamp")?;
    let trigger_s = column("rolling_shutter_params.camera_trigger_time")?;
    let readout_done_s = column("rolling_shutter_params.camera_readout_done_time")?;
    let picture = |(row, time_us): (usize, Option<i64>)| {
        let picture = PictureRecord {
            camera: *cameras.get(row)?,
            global_from_vehicle: at(&matrices, row).unwrap_or([f64::NAN; 16]),
            pose_s: at(&pose_s, row).unwrap_or(f64::NAN),
            velocity_mps: velocities.get(row).copied().unwrap_or(DVec3::NAN),
            turning_rad_s: turning.get(row).copied().unwrap_or(DVec3::NAN),
            trigger_s: at(&trigger_s, row).unwrap_or(f64::NAN),
            readout_done_s: at(&readout_done_s, row).unwrap_or(f64::NAN),
        };
        Some((time_us?, picture))
    };
    Ok(times.into_iter().enumerate().filter_map(picture).collect())
}

fn read_labels(table: &Table) -> Result<Vec<(i64, LabelRecord)>, ReadError> {
    let name = |name: &str| format!("[LiDARBoxComponent].{name}");
    let (times, ids) = (table.integers(TIME)?, table.texts("key.laser_object_id")?);
    let (centres, sizes) = (vectors(table, &name("box.center"))?, vectors(table, &name("box.size"))?);
    let (headings, kinds) = (table.numbers(&name("box.heading"))?, table.integers(&name("type"))?);
    let has = |column: &str| table.kind(&name(column)).is_some();
    let points =
        if has("num_lidar_points_in_box") { table.integers(&name("num_lidar_points_in_box"))? } else { Vec::new() };
    let velocities = if has("speed.x") { vectors(table, &name("speed"))? } else { Vec::new() };
    let label = |((row, time_us), id): ((usize, Option<i64>), Option<String>)| {
        let label = LabelRecord {
            id: id.unwrap_or_default(),
            kind: at(&kinds, row).unwrap_or(0),
            centre_ego: centres.get(row).copied().unwrap_or(DVec3::NAN),
            size_m: sizes.get(row).copied().unwrap_or(DVec3::NAN),
            heading_rad: at(&headings, row).unwrap_or(f64::NAN),
            velocity_mps: velocities.get(row).copied().filter(|v| v.is_finite()),
            lidar_points: at(&points, row),
        };
        Some((time_us?, label))
    };
    Ok(times.into_iter().enumerate().zip(ids).filter_map(label).collect())
}

fn read_lasers(table: &Table) -> Result<BTreeMap<i64, LaserRecord>, ReadError> {
    let name = |name: &str| format!("[LiDARCalibrationComponent].{name}");
    let matrices = table.arrays::<16>(&name("extrinsic.transform"))?;
    let lowest = table.numbers(&name("beam_inclination.min"))?;
    let highest = table.numbers(&name("beam_inclination.max"))?;
    let values = name("beam_inclination.values");
    let mut inclinations = if table.kind(&values).is_some() { Some(ListColumn::new(table, &values)?) } else { None };
    let mut lasers = BTreeMap::new();
    for (row, number) in table.integers(LASER)?.into_iter().enumerate() {
        let inclinations_rad = match &mut inclinations {
            Some(column) => column.numbers(row)?,
            None => Vec::new(),
        };
        lasers.entry(number.unwrap_or(0)).or_insert(LaserRecord {
            inclinations_rad,
            lowest_rad: at(&lowest, row).unwrap_or(f64::NAN),
            highest_rad: at(&highest, row).unwrap_or(f64::NAN),
            vehicle_from_laser: at(&matrices, row).unwrap_or([f64::NAN; 16]),
        });
    }
    Ok(lasers)
}

/// The components of the LiDARs.
struct Scans<'a> {
    table: &'a Table,
    /// The vehicle's poses at the pixels of the top LiDAR.
    moved: Option<&'a Table>,
    lasers: &'a BTreeMap<i64, LaserRecord>,
    lidar_every: usize,
}

impl Scans<'_> {
    fn read_into(
        &self,
        frames: &mut [FrameRecord],
        frame_at: &HashMap<i64, usize>,
        report: &Report,
    ) -> Result<(), ReadError> {
        let origin_ego = self.lasers.get(&TOP).and_then(range_image::origin_ego).unwrap_or_default();
        let mut moved = match self.moved {
            Some(table) => Some((rows_by_key(table)?, Images::new(table, "[LiDARPoseComponent].range_image_return1")?)),
            None => None,
        };
        for part in ["range_image_return1", "range_image_return2"] {
            let name = format!("[LiDARComponent].{part}");
            if self.table.kind(&format!("{name}.values")).is_none() {
                continue;
            }
            let mut images = Images::new(self.table, &name)?;
            for ((time_us, number), row) in rows_by_key(self.table)? {
                let Some(&frame) = frame_at.get(&time_us) else { continue };
                if !frame.is_multiple_of(self.lidar_every) {
                    continue;
                }
                let example = format!("{}: row {row}", self.table.path().display());
                let dropped = |why: &str| report.note(Outcome::Dropped, &format!("Waymo range image: {why}"), &example);
                let Some(laser) = self.lasers.get(&number) else {
                    dropped("LiDAR without calibration");
                    continue;
                };
                let Some(image) = images.get(row).inspect_err(|_| dropped("values of another shape"))? else {
                    continue;
                };
                let pose_row = moved.as_ref().and_then(|(rows, _)| rows.get(&(time_us, number)).copied());
                let poses = match (&mut moved, pose_row) {
                    (Some((_, poses)), Some(row)) => poses.get(row)?,
                    _ => None,
                };
                let frame = &mut frames[frame];
                let returns = frame.returns.get_or_insert_with(|| Returns { origin_ego, points_ego: Vec::new() });
                let global_from_ego = &frame.global_from_ego;
                let scan = Scan { laser, image: &image, poses: poses.as_ref(), global_from_ego };
                if let Err(why) = scan.append_to(&mut returns.points_ego) {
                    dropped(why);
                }
            }
        }
        Ok(())
    }
}

/// A component's row for a frame's time and a LiDAR, in the order of the rows.
fn rows_by_key(table: &Table) -> Result<BTreeMap<(i64, i64), usize>, ReadError> {
    let (times, lasers) = (table.integers(TIME)?, table.integers(LASER)?);
    let mut rows = BTreeMap::new();
    for (row, (time_us, number)) in times.into_iter().zip(lasers).enumerate() {
        if let Some(key) = time_us.zip(number) {
            rows.entry(key).or_insert(row);
        }
    }
    Ok(rows)
}

/// Range images, each a list of values and a list of their shape.
struct Images<'a> {
    values: ListColumn<'a>,
    shapes: ListColumn<'a>,
}

impl<'a> Images<'a> {
    fn new(table: &'a Table, name: &str) -> Result<Self, ReadError> {
        let column = |part: &str| ListColumn::new(table, &format!("{name}.{part}"));
        Ok(Self { values: column("values")?, shapes: column("shape")? })
    }

    /// The image of a row; `None` where there is none.
    fn get(&mut self, row: usize) -> Result<Option<Grid>, ReadError> {
        let (shape, values) = (self.shapes.integers(row)?, self.values.numbers(row)?);
        if shape.is_empty() && values.is_empty() {
            return Ok(None);
        }
        let found = format!("{} values of shape {shape:?}", values.len());
        let image = Grid::new(&shape, values.into_iter().map(|value| value as f32).collect());
        image.map(Some).ok_or_else(|| self.values.damaged(row, "a range image as large as its shape says", found))
    }
}

/// Three columns of numbers that end in x, y and z; NaN where there is none.
fn vectors(table: &Table, name: &str) -> Result<Vec<DVec3>, ReadError> {
    let column = |axis: &str| table.numbers(&format!("{name}.{axis}"));
    let (x, y, z) = (column("x")?, column("y")?, column("z")?);
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    Ok(x.into_iter().zip(y).zip(z).map(|((x, y), z)| DVec3::new(number(x), number(y), number(z))).collect())
}

fn at<T: Copy>(column: &[Option<T>], row: usize) -> Option<T> {
    column.get(row).copied().flatten()
}
