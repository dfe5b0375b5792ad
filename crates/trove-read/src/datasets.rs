//! Which datasets there are.

use crate::drive_source::Dataset;
use crate::{argoverse2, gps, kitti, nuscenes, plain, waymo};

/// Every dataset that can be read, in the order in which a folder is compared with them.
pub const DATASETS: &[Dataset] =
    &[nuscenes::DATASET, kitti::DATASET, argoverse2::DATASET, waymo::DATASET, plain::DATASET, gps::DATASET];
