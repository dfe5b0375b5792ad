//! What a camera returns.

use std::collections::BTreeSet;

use glam::DVec2;

use crate::{Class, InstanceId, Keypoints, Raster, Role};

/// A picture and its labels.
#[derive(Clone, Debug)]
pub struct Capture {
    /// The picture; `None` where only labels were asked for.
    pub color: Option<Color>,
    /// The labels.
    pub labels: Labels,
    /// Where what is met first differs from another scene's in the same view; `None` where there is no other.
    pub change: Option<Raster<bool>>,
    /// What it cost.
    pub stats: CaptureStats,
}

/// A picture.
#[derive(Clone, Debug)]
pub struct Color {
    /// Linear Rec. 709 radiance, denoised where that was asked for.
    pub radiance: Raster<[f32; 3]>,
    /// Exposed and tone-mapped, 8-bit sRGB.
    pub srgb: Raster<[u8; 3]>,
    /// The exposure that was used: radiance was multiplied by 2 to this power.
    pub exposure_ev: f64,
}

/// Labels of one picture: every value belongs to the ray through the pixel's centre.
#[derive(Clone, Debug)]
pub struct Labels {
    /// Classes; void outside the lens's image circle.
    pub class: Raster<Class>,
    /// Instance ids; 0 = none.
    pub instance: Raster<u32>,
    /// Metres along the camera's z axis; +inf = sky.
    pub depth_m: Raster<f32>,
    /// Unit geometric-surface normal in Camera, towards the camera; 0 = sky.
    pub normal: Raster<[f32; 3]>,
    /// Pixels (u right, v down) to the next keyframe; NaN = not defined.
    pub flow_forward: Raster<[f32; 2]>,
    /// Pixels to the previous keyframe; NaN = not defined.
    pub flow_backward: Raster<[f32; 2]>,
    /// Whether the next keyframe's picture shows what the pixel shows.
    pub occluded_forward: Raster<Occlusion>,
    /// Whether the previous keyframe's picture does.
    pub occluded_backward: Raster<Occlusion>,
    /// Labels that were asked for.
    pub extra: ExtraLabels,
    /// Every recorded object, and every road user like them, of which a pixel would be seen if nothing else were there, and all scenery of which one is
    /// seen, in the order of ids; without the object that carries the camera.
    pub objects: Vec<ObjectLabel>,
}

/// A label that is made where it is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)] // as the fields of `ExtraLabels`
pub enum ExtraLabel {
    Range,
    NormalWorld,
    Albedo,
    Roughness,
    SceneFlowForward,
    SceneFlowBackward,
    ObjectCoordinates,
    Coverage,
    Part,
    /// Of each object: [`ObjectLabel::amodal_mask`].
    AmodalMasks,
}

/// Labels that are made where they are asked for, each `None` otherwise.
#[derive(Clone, Debug, Default)]
pub struct ExtraLabels {
    /// Metres from the camera's centre, along the ray; +inf = sky.
    pub range_m: Option<Raster<f32>>,
    /// Unit geometric-surface normal in World, towards the camera; 0 = sky.
    pub normal_world: Option<Raster<[f32; 3]>>,
    /// Share of red, green and blue light (linear Rec. 709) that the material scatters diffusely, 0 to 1, dirt and water
    /// included: its base colour as far as it is neither metal nor glass; NaN = sky.
    pub albedo: Option<Raster<[f32; 3]>>,
    /// Perceptual roughness (the root of GGX's α), 0 to 1, under lacquer or water; NaN = sky.
    pub roughness: Option<Raster<f32>>,
    /// Metres in World that the point moves until the next keyframe; NaN = not defined.
    pub scene_flow_forward: Option<Raster<[f32; 3]>>,
    /// Metres in World from the point to where it was at the previous keyframe; NaN = not defined.
    pub scene_flow_backward: Option<Raster<[f32; 3]>>,
    /// The point in its object's box: from 0 at the back, right and bottom to 1 at the front, left and top, in the order of
    /// Body's axes, and a little beyond where the object is larger than its box; NaN = no object.
    pub object_coordinates: Option<Raster<[f32; 3]>>,
    /// Share of the pixel, in 255ths, that shows what its centre shows: the same object, or no object and the same class.
    pub coverage: Option<Raster<u8>>,
    /// The part of its object that the pixel shows, which is its material's role.
    pub part: Option<Raster<Option<Role>>>,
}

/// What labels tell of a pane of glass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GlassLabels {
    /// The pane.
    #[default]
    Glass,
    /// What is behind it, as if no pane were there.
    Behind,
}

/// Which labels a picture gets.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LabelSettings {
    /// What they tell of panes of glass.
    pub glass: GlassLabels,
    /// Those beside the usual ones.
    pub extra: BTreeSet<ExtraLabel>,
}

/// Whether the picture to which flow leads shows the same point: whether a ray from its camera reaches the point, or a place
/// nearer to it than a pixel's extent on the surface there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Occlusion {
    /// It does.
    Seen,
    /// Flow is not defined.
    Undefined,
    /// Something else is in front of it, or it is out of the picture.
    Hidden,
}

impl Occlusion {
    /// Its value in pictures of labels.
    pub fn value(self) -> u8 {
        match self {
            Self::Seen => 0,
            Self::Undefined => 128,
            Self::Hidden => 255,
        }
    }
}

/// Pixels from `min` to `max`, both included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelBox {
    /// Left and top pixel.
    pub min: [u32; 2],
    /// Right and bottom pixel.
    pub max: [u32; 2],
}

/// Pixels of a picture that belong to one object, within a box around them.
#[derive(Clone, Debug, PartialEq)]
pub struct Mask {
    /// First column and first row of the box.
    pub min: [u32; 2],
    /// Whether each pixel of the box belongs to it.
    pub pixels: Raster<bool>,
}

impl Mask {
    /// Of pixels that all lie within bounds.
    pub fn of(bounds: PixelBox, belongs: impl Fn(u32, u32) -> bool) -> Self {
        let PixelBox { min: [x0, y0], max: [x1, y1] } = bounds;
        Self { min: [x0, y0], pixels: Raster::from_fn(x1 + 1 - x0, y1 + 1 - y0, |x, y| belongs(x0 + x, y0 + y)) }
    }
}

/// What one picture shows of one object.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectLabel {
    /// The object.
    pub id: InstanceId,
    /// Pixels that show it.
    pub visible_px: u32,
    /// Smallest box around them; `None` where there are none.
    pub visible_box: Option<PixelBox>,
    /// Pixels that would show it if nothing else were there.
    pub amodal_px: u32,
    /// Smallest box around those.
    pub amodal_box: Option<PixelBox>,
    /// Those pixels; `None` unless they were asked for ([`ExtraLabel::AmodalMasks`]).
    pub amodal_mask: Option<Mask>,
    /// Share of it outside the image, 0 to 1, by the projected 3D box.
    pub truncation: f32,
    /// Share of its amodal pixels that other things hide, 0 to 1.
    pub occlusion: f32,
    /// From the camera to the centre of its box, metres.
    pub range_m: f32,
    /// Points of the person that it is or carries, each `None` outside the picture; `None` where they are not known.
    pub keypoints: Option<Keypoints<Option<SeenKeypoint>>>,
}

/// Where a picture shows a point of a person.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenKeypoint {
    /// Its place in the picture.
    pub pixel: DVec2,
    /// Whether nothing hides it but the skin and clothes that it lies in.
    pub is_visible: bool,
}

/// What a picture cost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CaptureStats {
    /// Rays traced, of all sorts.
    pub rays: u64,
    /// Samples of a pixel, mean over the picture.
    pub spp: f64,
    /// Whether the denoiser ran.
    pub denoised: bool,
    /// Why the processor followed its light instead of the graphics card that was to; `None` where none was.
    pub refused: Option<String>,
}
