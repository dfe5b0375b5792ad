//! v1's `Frame` → records.
//!
//! Pictures are passed over without being copied.

use std::collections::BTreeMap;

use glam::DVec3;

use super::fault::Unusable;
use super::map_message;
use super::records::{CameraRecord, LabelRecord, LaserRecord, MapFeature, Matrix, PictureRecord};
use crate::protobuf::{Fields, Malformed, doubles};
use trove_files::Budget;

/// More beams has no LiDAR.
const MOST_BEAMS: usize = 4096;

/// A frame, with its range images as they stand in the file.
pub(super) struct Frame<'a> {
    pub(super) context: Context,
    pub(super) time_us: i64,
    pub(super) global_from_vehicle: Matrix,
    pub(super) pictures: Vec<PictureRecord>,
    pub(super) lasers: Vec<Laser<'a>>,
    pub(super) labels: Vec<LabelRecord>,
    pub(super) map: Vec<MapFeature>,
    pub(super) map_from_global_m: DVec3,
}

/// What is the same in all frames of a segment.
#[derive(Default)]
pub(super) struct Context {
    pub(super) name: String,
    pub(super) location: String,
    pub(super) cameras: BTreeMap<i64, CameraRecord>,
    pub(super) lasers: BTreeMap<i64, LaserRecord>,
}

/// What a LiDAR saw: range images of its first and its second return, packed.
#[derive(Default)]
pub(super) struct Laser<'a> {
    pub(super) number: i64,
    pub(super) returns: [&'a [u8]; 2],
    /// The vehicle's poses at the pixels of both.
    pub(super) poses: &'a [u8],
}

/// Reads a frame.
pub(super) fn frame<'a>(message: &'a [u8], budget: &Budget) -> Result<Frame<'a>, Unusable> {
    let mut frame = Frame {
        context: Context::default(),
        time_us: 0,
        global_from_vehicle: [f64::NAN; 16],
        pictures: Vec::new(),
        lasers: Vec::new(),
        labels: Vec::new(),
        map: Vec::new(),
        map_from_global_m: DVec3::ZERO,
    };
    for field in Fields::new(message) {
        match field? {
            (1, value) => frame.context = context(value.bytes()?, budget)?,
            (2, value) => frame.time_us = value.varint()? as i64,
            (3, value) => frame.global_from_vehicle = matrix(value.bytes()?)?,
            (4, value) => {
                budget.take(1, size_of::<PictureRecord>())?;
                frame.pictures.push(picture(value.bytes()?)?);
            }
            (5, value) => {
                budget.take(1, size_of::<Laser>())?;
                frame.lasers.push(laser(value.bytes()?)?);
            }
            (6, value) => {
                budget.take(1, size_of::<LabelRecord>())?;
                frame.labels.push(label(value.bytes()?)?);
            }
            (10, value) => {
                budget.take(1, size_of::<MapFeature>())?;
                frame.map.push(map_message::feature(value.bytes()?, budget)?);
            }
            (11, value) => frame.map_from_global_m = map_message::point(value.bytes()?)?,
            _ => {}
        }
    }
    Ok(frame)
}

fn context(message: &[u8], budget: &Budget) -> Result<Context, Unusable> {
    let mut context = Context::default();
    for field in Fields::new(message) {
        match field? {
            (1, value) => context.name = value.text()?,
            (2, value) => {
                budget.take(1, size_of::<CameraRecord>())?;
                let (number, camera) = camera(value.bytes()?)?;
                context.cameras.entry(number).or_insert(camera);
            }
            (3, value) => {
                let (number, laser) = laser_calibration(value.bytes()?)?;
                budget.take(1 + laser.inclinations_rad.len() / 16, size_of::<LaserRecord>())?;
                context.lasers.entry(number).or_insert(laser);
            }
            (4, value) => {
                for field in Fields::new(value.bytes()?) {
                    if let (3, value) = field? {
                        context.location = value.text()?;
                    }
                }
            }
            _ => {}
        }
    }
    Ok(context)
}

fn camera(message: &[u8]) -> Result<(i64, CameraRecord), Malformed> {
    let (mut number, mut intrinsics) = (0, Vec::new());
    let mut camera =
        CameraRecord { intrinsics: [f64::NAN; 9], vehicle_from_camera: [f64::NAN; 16], width: 0, height: 0 };
    for field in Fields::new(message) {
        match field? {
            (1, value) => number = value.varint()? as i64,
            (2, value) => value.append_doubles_to(&mut intrinsics, 9)?,
            (3, value) => camera.vehicle_from_camera = matrix(value.bytes()?)?,
            (4, value) => camera.width = value.varint()? as i64,
            (5, value) => camera.height = value.varint()? as i64,
            _ => {}
        }
    }
    camera.intrinsics = intrinsics.try_into().unwrap_or([f64::NAN; 9]);
    Ok((number, camera))
}

fn laser_calibration(message: &[u8]) -> Result<(i64, LaserRecord), Malformed> {
    let mut number = 0;
    let mut laser = LaserRecord {
        inclinations_rad: Vec::new(),
        lowest_rad: f64::NAN,
        highest_rad: f64::NAN,
        vehicle_from_laser: [f64::NAN; 16],
    };
    for field in Fields::new(message) {
        match field? {
            (1, value) => number = value.varint()? as i64,
            (2, value) => value.append_doubles_to(&mut laser.inclinations_rad, MOST_BEAMS)?,
            (3, value) => laser.lowest_rad = value.double()?,
            (4, value) => laser.highest_rad = value.double()?,
            (5, value) => laser.vehicle_from_laser = matrix(value.bytes()?)?,
            _ => {}
        }
    }
    Ok((number, laser))
}

fn picture(message: &[u8]) -> Result<PictureRecord, Malformed> {
    let mut picture = PictureRecord {
        camera: 0,
        global_from_vehicle: [f64::NAN; 16],
        pose_s: f64::NAN,
        velocity_mps: DVec3::NAN,
        turning_rad_s: DVec3::NAN,
        trigger_s: f64::NAN,
        readout_done_s: f64::NAN,
    };
    for field in Fields::new(message) {
        match field? {
            (1, value) => picture.camera = value.varint()? as i64,
            (3, value) => picture.global_from_vehicle = matrix(value.bytes()?)?,
            (4, value) => {
                let [x, y, z, turning @ ..] = doubles(value.bytes()?, [1, 2, 3, 4, 5, 6])?.map(|v| v.unwrap_or(0.0));
                (picture.velocity_mps, picture.turning_rad_s) = (DVec3::new(x, y, z), DVec3::from_array(turning));
            }
            (5, value) => picture.pose_s = value.double()?,
            (7, value) => picture.trigger_s = value.double()?,
            (8, value) => picture.readout_done_s = value.double()?,
            _ => {}
        }
    }
    Ok(picture)
}

fn laser(message: &[u8]) -> Result<Laser<'_>, Malformed> {
    let mut laser = Laser::default();
    for field in Fields::new(message) {
        match field? {
            (1, value) => laser.number = value.varint()? as i64,
            (number @ (2 | 3), value) => {
                for field in Fields::new(value.bytes()?) {
                    match field? {
                        (2, value) => laser.returns[number as usize - 2] = value.bytes()?,
                        (4, value) if number == 2 => laser.poses = value.bytes()?,
                        _ => {}
                    }
                }
            }
            _ => {}
        }
    }
    Ok(laser)
}

fn label(message: &[u8]) -> Result<LabelRecord, Malformed> {
    let mut label = LabelRecord {
        id: String::new(),
        kind: 0,
        centre_ego: DVec3::NAN,
        size_m: DVec3::NAN,
        heading_rad: f64::NAN,
        velocity_mps: None,
        lidar_points: None,
    };
    for field in Fields::new(message) {
        match field? {
            (1, value) => {
                let numbers = doubles(value.bytes()?, [1, 2, 3, 5, 4, 6, 7])?;
                let [x, y, z, length, width, height, heading] = numbers.map(|v| v.unwrap_or(f64::NAN));
                label.centre_ego = DVec3::new(x, y, z);
                label.size_m = DVec3::new(length, width, height);
                label.heading_rad = heading;
            }
            (2, value) => {
                let [x, y, z] = doubles(value.bytes()?, [1, 2, 5])?;
                // Older frames tell the speed over ground alone.
                label.velocity_mps = x.zip(y).map(|(x, y)| DVec3::new(x, y, z.unwrap_or(0.0)));
            }
            (3, value) => label.kind = value.varint()? as i64,
            (4, value) => label.id = value.text()?,
            (7, value) => label.lidar_points = Some(value.varint()? as i64),
            _ => {}
        }
    }
    Ok(label)
}

/// A `Transform`; one of other than sixteen numbers is not a number throughout.
fn matrix(message: &[u8]) -> Result<Matrix, Malformed> {
    let mut numbers = Vec::with_capacity(16);
    for field in Fields::new(message) {
        if let (1, value) = field? {
            value.append_doubles_to(&mut numbers, 17)?;
        }
    }
    Ok(numbers.try_into().unwrap_or([f64::NAN; 16]))
}
