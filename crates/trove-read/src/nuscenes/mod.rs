//! nuScenes (v1.0) tables, LiDAR and map expansion → `Drive`.
//!
//! World is the dataset's global frame less the anchor: the first keyframe's ego position in x and y, rounded to whole
//! metres. The join is the devkit's: sample → sample_data → ego_pose, calibrated_sensor → sensor; sample_annotation →
//! instance → category, and attribute.

mod arcline;
mod boxes;
mod centreline;
mod dataset;
mod drive;
mod exposures;
mod index;
mod index_file;
mod keyframes;
mod kinds;
mod lane_map;
mod lidar;
mod place;
mod poses;
mod records;
mod source;
mod table;
mod tables;

pub use dataset::{LICENCE, NuScenes, SceneSummary};
pub(crate) use source::DATASET;
