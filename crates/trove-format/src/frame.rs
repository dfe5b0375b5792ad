//! `frame.json`: the camera and one row an object.

use std::path::Path;

use serde::{Deserialize, Serialize};
use trove_model::{Class, Distortion, GlassLabels, Keypoints, Kind, MapProjection, Origin, State};

use crate::{FormatError, file, names, rows};

/// A 4×4 matrix, rows first, which takes a point with a 1 behind it.
pub type Matrix4 = [[f64; 4]; 4];

/// The whole of `frame.json`. World is x east, y north, z up, in metres from the drive's anchor; Camera is x right,
/// y down, z forward; Ego and Body are x forward, y left, z up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FrameTable {
    /// The drive (`scene-0103`).
    pub scene: String,
    /// The dataset (`nuscenes`).
    pub dataset: String,
    /// The dataset's name of the place (`boston-seaport`); empty if unknown.
    #[serde(default)]
    pub place: String,
    /// Number of the variation, from 0.
    #[serde(default)]
    pub variation: u32,
    /// Index of the moment in its drive, from 0: of the keyframe, unless there are moments between keyframes
    /// (`time.rate_hz`).
    pub keyframe: u32,
    /// The dataset's token of the keyframe; empty if there is none.
    #[serde(default)]
    pub keyframe_token: String,
    /// Time of the keyframe, nanoseconds since 1970 UTC.
    pub keyframe_time_ns: i64,
    /// Index of the recorded keyframe that this is; null at moments between keyframes (`time.rate_hz`), and in folders
    /// written by earlier versions, which have keyframes alone.
    #[serde(default)]
    pub recorded_keyframe: Option<u32>,
    /// The camera (`ego.CAM_FRONT`, `v1.CAM_FRONT`).
    pub view: String,
    /// Time of the middle of the exposure, nanoseconds since 1970 UTC; it differs from the keyframe's.
    pub time_ns: i64,
    /// The dataset's token of the recorded image that the view clones; empty if it clones none.
    #[serde(default)]
    pub source_token: String,
    /// Path of that image relative to the dataset's root; empty if it clones none.
    #[serde(default)]
    pub source_image: String,
    /// Width of the image, pixels.
    pub width_px: u32,
    /// Height of the image, pixels.
    pub height_px: u32,
    /// The camera matrix K, row-major, pixels; pixel centres are at .5.
    pub intrinsics: [[f64; 3]; 3],
    /// How the lens distorts.
    pub lens_model: LensModel,
    /// The model's coefficients: none of a pinhole; k₁ k₂ p₁ p₂ k₃ k₄ k₅ k₆ of Brown-Conrady, in OpenCV's order;
    /// k₁ k₂ k₃ k₄ of Kannala-Brandt.
    #[serde(default)]
    pub distortion: Vec<f64>,
    /// Exposure time of a row, seconds; 0 is an instant.
    #[serde(default)]
    pub exposure_s: f64,
    /// Time from the exposure of the first row to that of the last, seconds; 0 is a global shutter.
    #[serde(default)]
    pub readout_s: f64,
    /// Share of the glass before the lens that drops cover; left out where it is dry.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub drops: f64,
    /// From Camera to World, at the middle of the exposure, to which all labels belong.
    pub world_from_camera: Matrix4,
    /// The rotation of `world_from_camera` as a unit quaternion, w first.
    pub world_from_camera_rotation_wxyz: [f64; 4],
    /// The camera's position in World, metres.
    pub world_from_camera_translation_m: [f64; 3],
    /// The same camera at the previous keyframe, which `flow_backward.exr` points to; null if there is none.
    pub world_from_camera_previous: Option<Matrix4>,
    /// The same camera at the next keyframe, which `flow_forward.exr` points to; null if there is none.
    pub world_from_camera_next: Option<Matrix4>,
    /// From Ego to World, of the vehicle that carries the camera, at `time_ns`; null if none does.
    pub world_from_ego: Option<Matrix4>,
    /// Id of that vehicle if it is one of the scene's objects, which the camera does not see; null otherwise.
    pub carrier: Option<u32>,
    /// The dataset's token of that vehicle's track; empty for the recording vehicle and where there is none.
    #[serde(default)]
    pub carrier_track_token: String,
    /// From latitude and longitude to World.
    pub projection: Projection,
    /// What labels tell of panes of glass.
    #[serde(default)]
    pub glass: GlassPolicy,
    /// Radiance was multiplied by 2 to this power; null without an image.
    pub exposure_ev: Option<f64>,
    /// Samples per pixel.
    pub spp: u32,
    /// Whether the image was denoised.
    pub denoised: bool,
    /// The seed of its noise.
    pub seed: u64,
    /// Every object that would cover a pixel if nothing else were there, ordered by id.
    pub objects: Vec<ObjectRow>,
}

fn is_zero(n: &f64) -> bool {
    *n == 0.0
}

/// What labels tell of panes of glass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum GlassPolicy {
    /// The pane: what is behind it is hidden.
    #[default]
    Glass,
    /// What is behind it, as if no pane were there.
    Behind,
}

impl From<GlassPolicy> for GlassLabels {
    fn from(policy: GlassPolicy) -> Self {
        match policy {
            GlassPolicy::Glass => Self::Glass,
            GlassPolicy::Behind => Self::Behind,
        }
    }
}

impl From<GlassLabels> for GlassPolicy {
    fn from(glass: GlassLabels) -> Self {
        match glass {
            GlassLabels::Glass => Self::Glass,
            GlassLabels::Behind => Self::Behind,
        }
    }
}

/// How a lens distorts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum LensModel {
    /// Not at all.
    Pinhole,
    /// Radial (rational) and tangential, as in OpenCV.
    BrownConrady,
    /// Equidistant with a polynomial of the angle: a fisheye.
    KannalaBrandt,
    /// A panorama: columns are equal steps of longitude, rows of latitude, of 1/fx and 1/fy radians.
    Equirectangular,
}

impl LensModel {
    /// The lens with coefficients, those left out being 0.
    ///
    /// # Errors
    /// More coefficients than the model has, or ones that are not finite, as a line that begins with `distortion`.
    pub fn distortion(self, coefficients: &[f64]) -> Result<Distortion, String> {
        let (distortion, most) = match self {
            Self::Pinhole => (coefficients.is_empty().then_some(Distortion::None), 0),
            Self::BrownConrady => (Distortion::brown_conrady(coefficients), 8),
            Self::KannalaBrandt => (Distortion::kannala_brandt(coefficients), 4),
            Self::Equirectangular => (coefficients.is_empty().then_some(Distortion::Equirectangular), 0),
        };
        distortion.ok_or_else(|| {
            format!("distortion: expected at most {most} finite numbers for this lens, found {coefficients:?}")
        })
    }
}

/// World = (Δlon, Δlat) · `metres_per_rad` − `anchor_m`, angles in radians from the origin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Projection {
    /// Latitude of the origin, degrees north.
    pub origin_lat_deg: f64,
    /// Longitude of the origin, degrees east.
    pub origin_lon_deg: f64,
    /// World's origin in the dataset's own plane, metres east and north.
    pub anchor_m: [f64; 2],
    /// Metres in a radian of longitude and of latitude; null in folders of earlier versions: R·cos lat₀ and R, R = 6,378,137 m.
    #[serde(default)]
    pub metres_per_rad: Option<[f64; 2]>,
}

/// An object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ObjectRow {
    /// Its value in `instance.png`, the same in all views and keyframes of a scene.
    pub id: u32,
    /// Its class, by name.
    #[serde(with = "names::class")]
    #[cfg_attr(test, schemars(schema_with = "names::class::schema"))]
    pub class: Class,
    /// The class's value in `class.png`.
    pub class_id: u8,
    /// A finer category than its class.
    #[serde(with = "names::kind")]
    #[cfg_attr(test, schemars(schema_with = "names::kind::schema"))]
    pub kind: Kind,
    /// How it comes to be in the scene.
    pub origin: ObjectOrigin,
    /// The dataset's category; empty unless it was recorded.
    #[serde(default)]
    pub category: String,
    /// The dataset's token of the annotation; empty as for `category`.
    #[serde(default)]
    pub token: String,
    /// The dataset's token of the track; empty as for `category`.
    #[serde(default)]
    pub track_token: String,
    /// Id of the model that stands for it; empty for what was built for this place alone.
    #[serde(default)]
    pub asset: String,
    /// From Body to World; Body's origin is the centre of the object's box.
    pub world_from_body: Matrix4,
    /// Length, width and height of its box, metres.
    pub size_m: [f64; 3],
    /// Takes the model's points (x forward, y left, z up, origin on the ground in its middle, metres) to World, with scale;
    /// null for what was built for this place alone, and in folders of earlier versions.
    #[serde(default)]
    pub world_from_asset: Option<Matrix4>,
    /// Its paint, sRGB: the colour of its largest painted part; null where nothing of it is painted one colour or another.
    #[serde(default)]
    pub paint: Option<[u8; 3]>,
    /// Its velocity in World, metres per second; null if unknown.
    pub velocity_mps: Option<[f64; 3]>,
    /// How fast its heading turns, radians per second, positive to the left, from where it heads half a second before and
    /// after; null if unknown.
    #[serde(default)]
    pub yaw_rate_radps: Option<f64>,
    /// What it does, as far as the recording tells; empty if it does not.
    #[serde(default, with = "names::states")]
    #[cfg_attr(test, schemars(schema_with = "names::states::schema"))]
    pub states: Vec<State>,
    /// How many pixels show it.
    pub visible_px: u32,
    /// How many pixels would show it if nothing else were there.
    pub amodal_px: u32,
    /// First column, first row, last column and last row of the pixels that show it, inclusive; null if there are none.
    pub visible_box: Option<[u32; 4]>,
    /// The same for pixels that would if nothing else were there; null if there are none.
    pub amodal_box: Option<[u32; 4]>,
    /// Share of it that is outside the image, 0 to 1: of the area of its box's outline as projected, which is the hull of its
    /// corners before the camera.
    pub truncation: f32,
    /// Share of its amodal pixels hidden by other things, 0 to 1.
    pub occlusion: f32,
    /// Distance from the camera to the centre of its box, metres.
    pub range_m: f32,
    /// The 17 points of the person that it is or carries, in COCO's order (nose; then left and right: eye, ear, shoulder,
    /// elbow, wrist, hip, knee, ankle): column and row in pixels, and 2 where it is visible, 1 where something hides it;
    /// [0, 0, 0] outside the picture. Null for all else, and where they are not known.
    #[serde(default)]
    pub keypoints: Option<Keypoints<[f64; 3]>>,
    /// The same points in World, metres.
    #[serde(default)]
    pub keypoints_world_m: Option<Keypoints<[f64; 3]>>,
}

/// How an object comes to be in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ObjectOrigin {
    /// The dataset annotated it.
    Recorded,
    /// The vehicle that carried the cameras, which no dataset annotates.
    Carrier,
    /// A road user added by `variations.traffic`.
    Added,
    /// A building, a plant or street furniture.
    Scenery,
}

impl From<&Origin> for ObjectOrigin {
    fn from(origin: &Origin) -> Self {
        match origin {
            Origin::Recorded { .. } => Self::Recorded,
            Origin::Carrier => Self::Carrier,
            Origin::Added => Self::Added,
            Origin::Scenery => Self::Scenery,
        }
    }
}

impl From<&Distortion> for LensModel {
    fn from(distortion: &Distortion) -> Self {
        match distortion {
            Distortion::None => Self::Pinhole,
            Distortion::BrownConrady(_) => Self::BrownConrady,
            Distortion::KannalaBrandt(_) => Self::KannalaBrandt,
            Distortion::Equirectangular => Self::Equirectangular,
        }
    }
}

impl From<&MapProjection> for Projection {
    fn from(projection: &MapProjection) -> Self {
        Self {
            origin_lat_deg: projection.origin_lat_deg,
            origin_lon_deg: projection.origin_lon_deg,
            anchor_m: projection.anchor_m.to_array(),
            metres_per_rad: Some(projection.metres_per_rad.to_array()),
        }
    }
}

impl FrameTable {
    /// The file's name.
    pub const NAME: &str = "frame.json";

    /// Reads it from a frame's folder.
    ///
    /// # Errors
    /// A file that cannot be read or is damaged.
    pub fn read(folder: &Path) -> Result<Self, FormatError> {
        let path = folder.join(Self::NAME);
        file::parsed(&path, &file::bytes(&path)?, "a frame of trove generate")
    }

    /// The file's bytes: one line a field and one line an object.
    pub fn to_json(&self) -> Vec<u8> {
        rows::bytes(self)
    }
}
