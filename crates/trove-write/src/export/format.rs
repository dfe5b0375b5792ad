//! The forms that there are.

use trove_model::ClassMap;

use super::cityscapes::Cityscapes;
use super::coco::{CocoInstances, CocoPanoptic};
use super::dataset::Dataset;
use super::kitti::{KittiObject, KittiTracking};
use super::kitti_dense::{KittiDepth, KittiFlow};
use super::kitti_step::KittiStep;
use super::label_pictures::{LabelPictures, MmSegmentation};
use super::video::Video;
use super::yolo::Yolo;

/// A form in which finished frames are written for other tools; docs/export.md says what each holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // docs/export.md says what they hold
pub enum DatasetFormat {
    Cityscapes,
    Coco,
    CocoPanoptic,
    Kitti,
    KittiTracking,
    KittiStep,
    KittiFlow,
    KittiDepth,
    MmSegmentation,
    Paper13,
    Yolo,
    YoloSegmentation,
    Video,
}

impl DatasetFormat {
    /// All that there are.
    pub const ALL: [Self; 13] = [
        Self::Cityscapes,
        Self::Coco,
        Self::CocoPanoptic,
        Self::Kitti,
        Self::KittiTracking,
        Self::KittiStep,
        Self::KittiFlow,
        Self::KittiDepth,
        Self::MmSegmentation,
        Self::Paper13,
        Self::Yolo,
        Self::YoloSegmentation,
        Self::Video,
    ];

    /// The name that it is asked for by.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cityscapes => "cityscapes",
            Self::Coco => "coco",
            Self::CocoPanoptic => "coco-panoptic",
            Self::Kitti => "kitti",
            Self::KittiTracking => "kitti-tracking",
            Self::KittiStep => "kitti-step",
            Self::KittiFlow => "kitti-flow",
            Self::KittiDepth => "kitti-depth",
            Self::MmSegmentation => "mmseg",
            Self::Paper13 => "paper13",
            Self::Yolo => "yolo",
            Self::YoloSegmentation => "yolo-seg",
            Self::Video => "video",
        }
    }

    /// The class map that its labels are numbered by where none is asked for; `None` for a form that has no such labels.
    pub fn class_map(self) -> Option<&'static str> {
        match self {
            Self::Cityscapes | Self::MmSegmentation | Self::Yolo | Self::YoloSegmentation => Some("cityscapes"),
            Self::Coco | Self::CocoPanoptic => Some("coco"),
            Self::KittiStep => Some("kitti-step"),
            Self::Paper13 => Some("paper13"),
            Self::Kitti | Self::KittiTracking | Self::KittiFlow | Self::KittiDepth | Self::Video => None,
        }
    }

    /// What writes it, with labels numbered by a map; `None` where the form needs one and there is none.
    pub(super) fn dataset(self, map: Option<ClassMap>) -> Option<Box<dyn Dataset>> {
        Some(match self {
            Self::Cityscapes => Box::new(Cityscapes { map: map? }),
            Self::Coco => Box::new(CocoInstances { map: map? }),
            Self::CocoPanoptic => Box::new(CocoPanoptic { map: map? }),
            Self::Kitti => Box::new(KittiObject),
            Self::KittiTracking => Box::new(KittiTracking),
            Self::KittiStep => Box::new(KittiStep { map: map? }),
            Self::KittiFlow => Box::new(KittiFlow),
            Self::KittiDepth => Box::new(KittiDepth),
            Self::MmSegmentation => Box::new(MmSegmentation { map: map? }),
            Self::Paper13 => Box::new(LabelPictures { map: map? }),
            Self::Yolo => Box::new(Yolo { map: map?, outlines: false }),
            Self::YoloSegmentation => Box::new(Yolo { map: map?, outlines: true }),
            Self::Video => Box::new(Video),
        })
    }
}
