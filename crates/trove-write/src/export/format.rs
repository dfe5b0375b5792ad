//! The forms that there are.

use super::dataset::Dataset;
use super::kitti::{KittiObject, KittiTracking};

/// A form in which finished frames are written for other tools; docs/export.md says what each holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // docs/export.md says what they hold
pub enum DatasetFormat {
    Kitti,
    KittiTracking,
}

impl DatasetFormat {
    /// All that there are.
    pub const ALL: [Self; 2] = [Self::Kitti, Self::KittiTracking];

    /// The name that it is asked for by.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kitti => "kitti",
            Self::KittiTracking => "kitti-tracking",
        }
    }

    /// What writes it.
    pub(super) fn dataset(self) -> Box<dyn Dataset> {
        match self {
            Self::Kitti => Box::new(KittiObject),
            Self::KittiTracking => Box::new(KittiTracking),
        }
    }
}
