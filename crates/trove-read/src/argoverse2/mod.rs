//! Argoverse 2's sensor dataset: Feather tables, LiDAR sweeps, vector map and ground height → `Drive`.
//!
//! A log's poses lie in its city's frame, which is the city's UTM zone less an origin. World is that frame turned to true
//! north and stretched to true metres about the drive's anchor, the first keyframe's position in whole metres. The dataset's
//! vehicle frame has its origin in the middle of the rear axle; Ego is that lowered onto the ground. Sweeps and boxes are
//! given in the vehicle's frame at the sweep's time, and keyframes are the sweeps that have boxes (10 a second).

mod boxes;
mod calibration;
mod city;
mod clock;
mod dataset;
mod drive;
mod exposures;
mod feather;
mod frames;
mod ground;
mod kinds;
mod lane_map;
mod lidar;
mod npy;
mod poses;
mod riders;
mod source;

pub use dataset::{Argoverse2, LICENCE};
pub(crate) use source::DATASET;
