//! TRoVE's own plain form (`drive.json`, `drive.jsonl`; docs/plain-drive.md) → `Drive`.
//!
//! What is wrong in the file itself is an error that tells all of it, with its places, since whoever wrote it can mend it;
//! LiDAR files and pictures that cannot be used are reported and left out.

mod boxes;
mod camera;
mod drive;
mod earth;
mod exposures;
mod faults;
mod keyframes;
mod lane_map;
mod lidar;
mod parts;
mod poses;
mod source;

pub(crate) use drive::ORDINARY_CAR;
pub(crate) use source::DATASET;
