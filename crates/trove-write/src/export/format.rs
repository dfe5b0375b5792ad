//! The forms that there are.

use trove_model::ClassMap;

use super::bop::Bop;
use super::cityscapes::Cityscapes;
use super::coco::{CocoInstances, CocoPanoptic};
use super::dataset::Dataset;
use super::hdf5::Hdf5;
use super::kitti::{KittiObject, KittiTracking};
use super::kitti_dense::{KittiDepth, KittiFlow};
use super::kitti_step::KittiStep;
use super::label_pictures::{LabelPictures, MmSegmentation};
use super::mcap::Mcap;
use super::nuimages::NuImages;
use super::nuscenes::NuScenes;
use super::openlabel::OpenLabel;
use super::openlane::OpenLane;
use super::point_clouds::{self, PointClouds};
use super::video::Video;
use super::virtual_kitti::VirtualKitti2;
use super::web_dataset::WebDataset;
use super::yolo::Yolo;

/// A form in which finished frames are written for other tools; docs/export.md says what each holds.
#[derive(Clone, Copy, Debug)]
pub struct DatasetFormat(&'static Form);

#[derive(Debug)]
struct Form {
    name: &'static str,
    kind: Kind,
}

/// What writes a form.
#[derive(Debug)]
enum Kind {
    /// One without numbers of classes, or with its own names alone.
    Plain(fn() -> Box<dyn Dataset>),
    /// One whose labels are numbered by a class map, and the map where none is asked for.
    Classes(&'static str, fn(ClassMap) -> Box<dyn Dataset>),
}

use Kind::{Classes, Plain};

static FORMS: [Form; 24] = [
    Form { name: "bop", kind: Plain(|| Box::new(Bop)) },
    Form { name: "cityscapes", kind: Classes("cityscapes", |map| Box::new(Cityscapes { map })) },
    Form { name: "coco", kind: Classes("coco", |map| Box::new(CocoInstances { map })) },
    Form { name: "coco-panoptic", kind: Classes("coco", |map| Box::new(CocoPanoptic { map })) },
    Form { name: "hdf5", kind: Plain(|| Box::new(Hdf5)) },
    Form { name: "kitti", kind: Plain(|| Box::new(KittiObject)) },
    Form { name: "kitti-depth", kind: Plain(|| Box::new(KittiDepth)) },
    Form { name: "kitti-flow", kind: Plain(|| Box::new(KittiFlow)) },
    Form { name: "kitti-step", kind: Classes("kitti-step", |map| Box::new(KittiStep { map })) },
    Form { name: "kitti-tracking", kind: Plain(|| Box::new(KittiTracking)) },
    Form { name: "las", kind: Classes("asprs", |map| Box::new(PointClouds { map, form: point_clouds::Form::Las })) },
    Form { name: "mcap", kind: Plain(|| Box::new(Mcap)) },
    Form { name: "mmseg", kind: Classes("cityscapes", |map| Box::new(MmSegmentation { map })) },
    Form { name: "nuimages", kind: Plain(|| Box::new(NuImages)) },
    Form { name: "nuscenes", kind: Plain(|| Box::new(NuScenes)) },
    Form { name: "openlabel", kind: Plain(|| Box::new(OpenLabel)) },
    Form { name: "openlane", kind: Plain(|| Box::new(OpenLane)) },
    Form { name: "paper13", kind: Classes("paper13", |map| Box::new(LabelPictures { map })) },
    Form { name: "pcd", kind: Classes("trove20", |map| Box::new(PointClouds { map, form: point_clouds::Form::Pcd })) },
    Form { name: "video", kind: Plain(|| Box::new(Video)) },
    Form { name: "vkitti2", kind: Plain(|| Box::new(VirtualKitti2)) },
    Form { name: "webdataset", kind: Plain(|| Box::new(WebDataset)) },
    Form { name: "yolo", kind: Classes("cityscapes", |map| Box::new(Yolo { map, outlines: false })) },
    Form { name: "yolo-seg", kind: Classes("cityscapes", |map| Box::new(Yolo { map, outlines: true })) },
];

impl DatasetFormat {
    /// All that there are, by their names.
    pub fn all() -> impl Iterator<Item = Self> {
        FORMS.iter().map(Self)
    }

    /// The form of a name; `None` where none is called that.
    pub fn named(name: &str) -> Option<Self> {
        Self::all().find(|format| format.name() == name)
    }

    /// The name that it is asked for by.
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// The class map that its labels are numbered by where none is asked for; `None` for a form without such labels.
    pub(super) fn class_map(self) -> Option<ClassMap> {
        match self.0.kind {
            Plain(_) => None,
            Classes(name, _) => ClassMap::named(name),
        }
    }

    /// What writes it with labels numbered by a map; `None` where there is a map that it does not know what to do with, or
    /// none that it needs.
    pub(super) fn dataset(self, map: Option<ClassMap>) -> Option<Box<dyn Dataset>> {
        match (&self.0.kind, map) {
            (Plain(make), None) => Some(make()),
            (Classes(_, make), Some(map)) => Some(make(map)),
            _ => None,
        }
    }
}
