//! The files of a frame's folder.

use serde::{Deserialize, Serialize};
use trove_model::ExtraLabel;

use crate::MaskTable;

/// A file of a frame's folder beside `frame.json`; recipes name them in `output.files`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs)] // docs/output.md says what they hold
pub enum FrameFile {
    Radiance,
    Rgb,
    Class,
    Instance,
    Depth,
    Normal,
    FlowForward,
    FlowBackward,
    OccludedForward,
    OccludedBackward,
    Change,
    Panoptic,
    Range,
    NormalWorld,
    Albedo,
    Roughness,
    SceneFlowForward,
    SceneFlowBackward,
    ObjectCoordinates,
    Coverage,
    Part,
    Masks,
}

impl FrameFile {
    /// All that there are.
    pub const ALL: [Self; 22] = [
        Self::Radiance,
        Self::Rgb,
        Self::Class,
        Self::Instance,
        Self::Depth,
        Self::Normal,
        Self::FlowForward,
        Self::FlowBackward,
        Self::OccludedForward,
        Self::OccludedBackward,
        Self::Change,
        Self::Panoptic,
        Self::Range,
        Self::NormalWorld,
        Self::Albedo,
        Self::Roughness,
        Self::SceneFlowForward,
        Self::SceneFlowBackward,
        Self::ObjectCoordinates,
        Self::Coverage,
        Self::Part,
        Self::Masks,
    ];

    /// The file's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Radiance => "radiance.exr",
            Self::Rgb => "rgb.png",
            Self::Class => "class.png",
            Self::Instance => "instance.png",
            Self::Depth => "depth.exr",
            Self::Normal => "normal.exr",
            Self::FlowForward => "flow_forward.exr",
            Self::FlowBackward => "flow_backward.exr",
            Self::OccludedForward => "occluded_forward.png",
            Self::OccludedBackward => "occluded_backward.png",
            Self::Change => "change.png",
            Self::Panoptic => "panoptic.png",
            Self::Range => "range.exr",
            Self::NormalWorld => "normal_world.exr",
            Self::Albedo => "albedo.exr",
            Self::Roughness => "roughness.exr",
            Self::SceneFlowForward => "scene_flow_forward.exr",
            Self::SceneFlowBackward => "scene_flow_backward.exr",
            Self::ObjectCoordinates => "object_coordinates.exr",
            Self::Coverage => "coverage.png",
            Self::Part => "part.png",
            Self::Masks => MaskTable::NAME,
        }
    }

    /// Whether it is a picture.
    pub fn is_picture(self) -> bool {
        !matches!(self, Self::Masks)
    }

    /// Whether light has to be followed for it.
    pub fn shows_light(self) -> bool {
        matches!(self, Self::Radiance | Self::Rgb)
    }

    /// Whether a recipe that names no files gets it, if there is anything to write in it.
    pub fn is_usual(self) -> bool {
        !matches!(self, Self::Radiance | Self::Panoptic) && self.extra().is_none()
    }

    /// The label that it holds, where that is only made if it is asked for.
    pub fn extra(self) -> Option<ExtraLabel> {
        match self {
            Self::Range => Some(ExtraLabel::Range),
            Self::NormalWorld => Some(ExtraLabel::NormalWorld),
            Self::Albedo => Some(ExtraLabel::Albedo),
            Self::Roughness => Some(ExtraLabel::Roughness),
            Self::SceneFlowForward => Some(ExtraLabel::SceneFlowForward),
            Self::SceneFlowBackward => Some(ExtraLabel::SceneFlowBackward),
            Self::ObjectCoordinates => Some(ExtraLabel::ObjectCoordinates),
            Self::Coverage => Some(ExtraLabel::Coverage),
            Self::Part => Some(ExtraLabel::Part),
            Self::Masks => Some(ExtraLabel::AmodalMasks),
            Self::Radiance
            | Self::Rgb
            | Self::Class
            | Self::Instance
            | Self::Depth
            | Self::Normal
            | Self::FlowForward
            | Self::FlowBackward
            | Self::OccludedForward
            | Self::OccludedBackward
            | Self::Change
            | Self::Panoptic => None,
        }
    }
}
