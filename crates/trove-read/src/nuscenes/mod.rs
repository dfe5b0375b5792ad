//! nuScenes (v1.0) and relatives with its schema (Lyft Level 5): tables, LiDAR, CAN bus and map expansion → `Drive`.
//!
//! World is the dataset's global frame less the anchor: the first keyframe's ego position in x and y, rounded to whole
//! metres. The join is the devkit's: sample → sample_data → ego_pose, calibrated_sensor → sensor; sample_annotation →
//! instance → category, and attribute.

mod arcline;
mod between;
mod boxes;
mod can_bus;
mod centreline;
mod dataset;
mod drive;
mod exposures;
mod files;
mod index;
mod index_file;
mod keyframes;
mod kinds;
mod lane_map;
mod lidar;
mod place;
mod poses;
mod records;
mod relatives;
mod source;
mod table;
mod tables;

pub use dataset::{NuScenes, SceneSummary};
pub(crate) use source::DATASET;
