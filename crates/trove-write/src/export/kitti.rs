//! KITTI's object and tracking benchmarks: pictures, calibrations and a line of 15 columns an object.

use std::fmt::Write as _;
use std::io::Write as _;

use glam::{DAffine3, DVec3};
use trove_format::{FrameFile, FrameTable, LensModel, ObjectRow};
use trove_model::LidarPoint;

use super::dataset::{Dataset, Finished};
use super::geometry::{affine, camera_from_body, camera_from_world};
use super::kinds;
use super::plan::Plan;
use super::unit::Unit;
use crate::{StoredSweep, WriteError};

/// `training/{image_2,label_2,calib,velodyne}`, a frame a number; `ImageSets` holds the splits.
pub(super) struct KittiObject;

/// `training/{image_02,label_02,calib}`, a sequence a number.
pub(super) struct KittiTracking;

impl Dataset for KittiObject {
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        for &i in frames {
            let frame = plan.open(&plan.frames[i])?;
            unit.link(&format!("training/image_2/{i:06}.png"), &frame.needed(FrameFile::Rgb)?)?;
            note_distortion(&frame.table, unit);
            let mut labels = String::new();
            for object in frame.table.objects.iter().filter_map(|object| label(&frame.table, object)) {
                let _ = writeln!(labels, "{object}"); // strings take everything
            }
            unit.write(&format!("training/label_2/{i:06}.txt"), labels.as_bytes())?;
            let sweep = plan.sweep(&plan.frames[i]).map(|sweep| plan.open_sweep(sweep)).transpose()?;
            let velodyne = sweep.as_ref().and_then(Velodyne::of);
            if let Some(velodyne) = &velodyne {
                unit.write(&format!("training/velodyne/{i:06}.bin"), &velodyne.points()?)?;
            }
            let calibration = calibration(&frame.table, velodyne.as_ref(), &OBJECT_NAMES);
            unit.write(&format!("training/calib/{i:06}.txt"), calibration.as_bytes())?;
        }
        Ok(())
    }

    fn finish(&self, finished: &Finished<'_>, unit: &mut Unit<'_>) -> Result<(), WriteError> {
        for split in &finished.plan.splits {
            unit.stream(&format!("ImageSets/{split}.txt"), |file| {
                let frames = finished.plan.frames.iter().enumerate().filter(|(_, frame)| frame.split == *split);
                frames.into_iter().try_for_each(|(i, _)| writeln!(file, "{i:06}"))
            })?;
        }
        Ok(())
    }
}

impl Dataset for KittiTracking {
    fn units(&self, plan: &Plan) -> Vec<Vec<usize>> {
        plan.sequences()
    }

    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let sequence = plan.frames[frames[0]].sequence;
        let mut labels = String::new();
        for &i in frames {
            let planned = &plan.frames[i];
            let frame = plan.open(planned)?;
            let index = planned.index;
            unit.link(&format!("training/image_02/{sequence:04}/{index:06}.png"), &frame.needed(FrameFile::Rgb)?)?;
            note_distortion(&frame.table, unit);
            if index == 0 {
                let calibration = calibration(&frame.table, None, &TRACKING_NAMES);
                unit.write(&format!("training/calib/{sequence:04}.txt"), calibration.as_bytes())?;
            }
            for object in &frame.table.objects {
                if let Some(line) = label(&frame.table, object) {
                    let _ = writeln!(labels, "{index} {} {line}", object.id); // strings take everything
                }
            }
        }
        unit.write(&format!("training/label_02/{sequence:04}.txt"), labels.as_bytes())
    }

    fn finish(&self, finished: &Finished<'_>, unit: &mut Unit<'_>) -> Result<(), WriteError> {
        // The devkit's list of sequences: name, and numbers of the first frame and of the one after the last.
        for split in &finished.plan.splits {
            unit.stream(&format!("evaluate_tracking.seqmap.{split}"), |file| {
                let first = |frames: &Vec<usize>| &finished.plan.frames[frames[0]];
                let sequences = finished.units.iter().filter(|frames| first(frames).split == *split);
                sequences.into_iter().try_for_each(|frames| {
                    writeln!(file, "{:04} empty {:06} {:06}", first(frames).sequence, 0, frames.len())
                })
            })?;
        }
        Ok(())
    }
}

/// Type, truncation, occlusion, alpha, 2D box, height, width, length, place, rotation; `None` for what KITTI does not label
/// and for what the picture does not show.
fn label(table: &FrameTable, object: &ObjectRow) -> Option<String> {
    let kind = kinds::kitti(object)?;
    let [left, top, right, bottom] = object.visible_box.and(object.amodal_box)?;
    let camera_from_body = camera_from_body(table, object);
    let [length, width, height] = object.size_m;
    // The place is the middle of the box's lower side.
    let place = camera_from_body.transform_point3(DVec3::new(0.0, 0.0, -height / 2.0));
    let forward = camera_from_body.transform_vector3(DVec3::X);
    let rotation = (-forward.z).atan2(forward.x);
    let alpha = wrapped(rotation - place.x.atan2(place.z));
    let (truncation, occlusion) = (object.truncation, occlusion(object.occlusion));
    Some(format!(
        "{kind} {truncation:.2} {occlusion} {alpha:.2} {left:.2} {top:.2} {right:.2} {bottom:.2} {height:.2} {width:.2} \
         {length:.2} {:.2} {:.2} {:.2} {rotation:.2}",
        place.x,
        place.y,
        place.z,
        left = f64::from(left),
        top = f64::from(top),
        right = f64::from(right),
        bottom = f64::from(bottom),
    ))
}

/// KITTI's three steps: fully visible, partly and largely occluded. Its annotators judged by eye; the shares are ours.
fn occlusion(share: f32) -> u8 {
    match share {
        ..0.1 => 0,
        ..0.5 => 1,
        _ => 2,
    }
}

pub(super) fn wrapped(angle: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    (angle + turn / 2.0).rem_euclid(turn) - turn / 2.0
}

const OBJECT_NAMES: [&str; 3] = ["R0_rect:", "Tr_velo_to_cam:", "Tr_imu_to_velo:"];
const TRACKING_NAMES: [&str; 3] = ["R_rect", "Tr_velo_cam", "Tr_imu_velo"];

/// A sweep in KITTI's axes (x forward, y left, z up, as the vehicle's), from where the LiDAR is.
struct Velodyne<'a> {
    sweep: &'a StoredSweep,
    world_from_velodyne: DAffine3,
    velodyne_from_lidar: DAffine3,
}

impl<'a> Velodyne<'a> {
    /// `None` where no vehicle carries it.
    fn of(sweep: &'a StoredSweep) -> Option<Self> {
        let world_from_ego = affine(sweep.table.world_from_ego.as_ref()?);
        let world_from_lidar = affine(&sweep.table.world_from_lidar);
        let world_from_velodyne = DAffine3::from_mat3_translation(world_from_ego.matrix3, world_from_lidar.translation);
        let velodyne_from_lidar = world_from_velodyne.inverse() * world_from_lidar;
        Some(Self { sweep, world_from_velodyne, velodyne_from_lidar })
    }

    /// x, y, z and reflectance (0 to 1), each a float32.
    fn points(&self) -> Result<Vec<u8>, WriteError> {
        let record = |point: &LidarPoint| {
            let p = self.velodyne_from_lidar.transform_point3(point.position_m);
            [p.x as f32, p.y as f32, p.z as f32, f32::from(point.intensity) / 255.0].map(f32::to_le_bytes)
        };
        Ok(self.sweep.points()?.iter().flat_map(record).collect::<Vec<_>>().concat())
    }
}

/// All four projections are the camera's own. Without a sweep the LiDAR's frame is the camera's with KITTI's axes.
fn calibration(
    table: &FrameTable,
    velodyne: Option<&Velodyne<'_>>,
    [rectification, camera_from_lidar, lidar_from_imu]: &[&str; 3],
) -> String {
    let k = &table.intrinsics;
    let row = |values: &[f64]| values.iter().map(|v| format!("{v:.12e}")).collect::<Vec<_>>().join(" ");
    let projection: Vec<f64> = k.iter().flat_map(|r| [r[0], r[1], r[2], 0.0]).collect();
    let mut text = String::new();
    for i in 0..4 {
        let _ = writeln!(text, "P{i}: {}", row(&projection)); // strings take everything
    }
    let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let mut axes = [0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    if let Some(Velodyne { world_from_velodyne, .. }) = velodyne {
        let camera_from_velodyne = camera_from_world(table) * *world_from_velodyne;
        let (m, t) = (camera_from_velodyne.matrix3.transpose(), camera_from_velodyne.translation);
        for (i, (row, t)) in [m.x_axis, m.y_axis, m.z_axis].into_iter().zip(t.to_array()).enumerate() {
            axes[4 * i..4 * i + 4].copy_from_slice(&[row.x, row.y, row.z, t]);
        }
    }
    let none = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    for (name, values) in [(rectification, &identity[..]), (camera_from_lidar, &axes), (lidar_from_imu, &none)] {
        let _ = writeln!(text, "{name} {}", row(values));
    }
    text
}

/// KITTI's pictures are rectified: the form has no place for a lens that distorts.
pub(super) fn note_distortion(table: &FrameTable, unit: &mut Unit<'_>) {
    if table.lens_model != LensModel::Pinhole {
        unit.clip("frames whose lens distorts, which the form does not tell", 1);
    }
}
