//! Which datasets there are.

use crate::drive_source::Dataset;
use crate::{nuscenes, waymo};

/// Every dataset that can be read, in the order in which a folder is compared with them.
pub const DATASETS: &[Dataset] = &[nuscenes::DATASET, waymo::DATASET];
