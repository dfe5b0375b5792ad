//! KITTI → `Drive`: raw recordings (synced and rectified, or extracted as the sensors wrote them), and the tracking and
//! object benchmarks, told apart by what is there.
//!
//! World is `MapProjection::spherical` about the first OXTS fix, so that a street map lies on the drive exactly. The devkit's
//! Mercator of scale cos(lat₀) has the same metres there and is longer by Δy²·tan(lat₀)/2R to the north: 9 cm at 1 km.
//! Ego stands on the ground below the IMU, which rides above the rear axle, in the middle of the car, where the Velodyne
//! is, and has the IMU's axes. KITTI's picture coordinates have the centres of pixels at whole numbers, ours at .5.

mod benchmark;
mod boxes;
mod calibration;
mod drive;
mod facts;
mod labels;
mod layout;
mod mounting;
mod oxts;
mod pictures;
mod raw;
mod source;
mod sweeps;
mod text;
mod times;
mod tracklets;

pub(crate) use source::DATASET;
pub use source::{Kitti, LICENCE};
