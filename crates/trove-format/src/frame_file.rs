//! The files of a frame's folder.

use serde::{Deserialize, Serialize};

/// A picture of a frame's folder; recipes name them in `output.files`.
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
}

impl FrameFile {
    /// All that there are.
    pub const ALL: [Self; 11] = [
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
        }
    }

    /// Whether light has to be followed for it.
    pub fn shows_light(self) -> bool {
        matches!(self, Self::Radiance | Self::Rgb)
    }
}
