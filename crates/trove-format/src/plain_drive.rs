//! `drive.json`: a recorded drive in TRoVE's own plain form, which people write from their recordings and trove from other
//! datasets.
//!
//! `drive.jsonl` is the same with the keyframes left out of its first line, and one keyframe on every line that follows.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use trove_model::{Kind, MarkPattern, Paint};

use crate::{LensModel, names};

// Its reader takes keyframes and cameras as text, to read it piece by piece.
/// A drive. Its World is in metres, with z up; `georeference` says how x and y lie on the earth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Drive"))]
#[serde(deny_unknown_fields, bound(deserialize = "K: Deserialize<'de>, C: Deserialize<'de>"))]
pub struct PlainDrive<K = PlainKeyframe, C = PlainCamera> {
    /// Version of the form: 1.
    pub trove_drive: u32,
    /// Name of the drive, which becomes a folder's name; default: the name of the folder that the file lies in.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Name of the place, such as a city; it is only passed on.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub place: String,
    /// Licence of the recording, which everything made from it names.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub licence: String,
    /// How World lies on the earth; default: unknown, and then no street map is laid on the drive.
    #[serde(default)]
    pub georeference: PlainGeoreference,
    /// The recording vehicle's own box; default: that of an ordinary car.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ego_body: Option<PlainEgoBody>,
    /// The cameras by name.
    #[serde(default)]
    pub cameras: BTreeMap<String, C>,
    /// The road as the recording's own map has it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lane_map: Option<PlainLaneMap>,
    /// The vehicle between the keyframes too, in the order of time; default: no more is known than there.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<PlainMoment>,
    /// LiDAR sweeps between the keyframes, in the order of time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sweeps: Vec<PlainSweep>,
    /// The annotated moments in the order of time; in `drive.jsonl` they follow, one a line.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub keyframes: Vec<K>,
}

impl PlainDrive {
    /// The form's version.
    pub const VERSION: u32 = 1;
    /// The file's name.
    pub const NAME: &str = "drive.json";
    /// The name of the file with one keyframe a line.
    pub const LINES_NAME: &str = "drive.jsonl";

    /// The file's bytes, indented.
    pub fn to_json(&self) -> Vec<u8> {
        crate::file::pretty(self)
    }

    /// The bytes of `drive.jsonl`.
    #[allow(clippy::missing_panics_doc)] // serde_json refuses keys that are not strings, and nothing else
    pub fn to_json_lines(&self) -> Vec<u8> {
        let header = Self { keyframes: Vec::new(), ..self.clone() };
        let mut bytes = serde_json::to_vec(&header).expect("a drive has keys that are strings");
        for keyframe in &self.keyframes {
            bytes.push(b'\n');
            bytes.extend(serde_json::to_vec(keyframe).expect("a keyframe has keys that are strings"));
        }
        bytes.push(b'\n');
        bytes
    }
}

/// How World lies on the earth (WGS84).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Georeference"))]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PlainGeoreference {
    /// It is not known.
    #[default]
    Unknown,
    /// Poses of the vehicle are given as `geo_from_ego`, and boxes as `ego_from_body`.
    Wgs84,
    /// World's x and y are easting and northing of a UTM zone.
    Utm {
        /// 1 to 60.
        zone: u32,
        /// Whether northings are those of the southern hemisphere.
        #[serde(default)]
        is_south: bool,
    },
    /// World's origin is at a known place.
    Local {
        /// Latitude of World's origin.
        origin_lat_deg: f64,
        /// Longitude of World's origin.
        origin_lon_deg: f64,
        /// Where World's x axis points: radians counter-clockwise from east.
        #[serde(default)]
        x_axis_yaw_rad: f64,
        /// How many of World's metres a radian of longitude and of latitude have; default: true metres, on WGS84's ellipsoid.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        metres_per_rad: Option<[f64; 2]>,
    },
    /// Only whereabouts is known: enough for sun, season and customs, not for a street map.
    Near {
        /// Latitude.
        lat_deg: f64,
        /// Longitude.
        lon_deg: f64,
    },
}

/// A pose: from the frame that it is of to the one that its key begins with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Pose"))]
#[serde(deny_unknown_fields)]
pub struct PlainPose {
    /// Origin of the frame, metres.
    pub translation_m: [f64; 3],
    /// Rotation as a unit quaternion, w first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation_wxyz: Option<[f64; 4]>,
    /// Instead of `rotation_wxyz`, level: radians counter-clockwise, seen from above, from x; for a camera, from straight
    /// ahead to where it looks. Default: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yaw_rad: Option<f64>,
}

/// A vehicle's pose on the earth: to east, north, up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "GeoPose"))]
#[serde(deny_unknown_fields)]
pub struct PlainGeoPose {
    /// Latitude.
    pub lat_deg: f64,
    /// Longitude.
    pub lon_deg: f64,
    /// Height, metres, above whatever is the same for all keyframes; default: 0.
    #[serde(default)]
    pub alt_m: f64,
    /// Rotation to east, north, up as a unit quaternion, w first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation_wxyz: Option<[f64; 4]>,
    /// Instead of `rotation_wxyz`, level: radians counter-clockwise, seen from above, from east. Default: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yaw_rad: Option<f64>,
}

/// The recording vehicle's own box.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "EgoBody"))]
#[serde(deny_unknown_fields)]
pub struct PlainEgoBody {
    /// Centre of the box in Ego, metres.
    pub centre_m: [f64; 3],
    /// Length, width, height, metres.
    pub size_m: [f64; 3],
}

/// A camera: its lens and where it is mounted. Its axes are OpenCV's (x right, y down, z forward); pixel centres are at .5.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Camera"))]
#[serde(deny_unknown_fields)]
pub struct PlainCamera {
    /// Width of the picture, pixels.
    pub width_px: u32,
    /// Height of the picture, pixels.
    pub height_px: u32,
    /// Focal length along x, pixels.
    pub fx_px: f64,
    /// Focal length along y, pixels; default: as along x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fy_px: Option<f64>,
    /// Principal point, x; default: the picture's middle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cx_px: Option<f64>,
    /// Principal point, y; default: the picture's middle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cy_px: Option<f64>,
    /// How the lens distorts; default: not at all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lens_model: Option<LensModel>,
    /// The model's coefficients in OpenCV's order: k₁ k₂ p₁ p₂ k₃ k₄ k₅ k₆ of Brown-Conrady, k₁ k₂ k₃ k₄ of Kannala-Brandt;
    /// those left out are 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub distortion: Vec<f64>,
    /// Mounting; without a rotation it looks straight ahead.
    pub ego_from_camera: PlainPose,
}

/// An annotated moment. Ego is x forward, y left, z up; its origin is the middle of the rear axle on the ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Keyframe"))]
#[serde(deny_unknown_fields, bound(deserialize = "B: Deserialize<'de>, P: Deserialize<'de>"))]
pub struct PlainKeyframe<B = PlainBox, P = PlainPicture> {
    /// Nanoseconds since 1970 UTC; later than the keyframe before.
    pub time_ns: i64,
    /// The recording's own name of the moment.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub token: String,
    /// The vehicle in World.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub world_from_ego: Option<PlainPose>,
    /// Instead, where the georeference is `wgs84`: the vehicle on the earth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub geo_from_ego: Option<PlainGeoPose>,
    /// Who and what is there.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub boxes: Vec<B>,
    /// What the cameras took, by the cameras' names; default: a picture of every camera at the keyframe's time, not at hand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pictures: Option<BTreeMap<String, P>>,
    /// The LiDAR's points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lidar: Option<PlainLidar>,
}

/// A picture.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Picture"))]
#[serde(deny_unknown_fields)]
pub struct PlainPicture {
    /// Its path from the drive's folder; default: it is not at hand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The recording's own name of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub token: Option<String>,
    /// Middle of its exposure, nanoseconds since 1970 UTC; default: the keyframe's time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_ns: Option<i64>,
    /// The vehicle in World at that time; default: between the keyframes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub world_from_ego: Option<PlainPose>,
    /// Instead, where the georeference is `wgs84`: the vehicle on the earth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub geo_from_ego: Option<PlainGeoPose>,
    /// The camera as it was then, where it was calibrated anew.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera: Option<PlainCamera>,
}

/// An object at one moment. Body is x forward, y left, z up; its origin is the centre of the box.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Box"))]
#[serde(deny_unknown_fields)]
pub struct PlainBox {
    /// The object's own name, the same at all moments.
    pub track: String,
    /// What it is.
    #[serde(with = "names::kind")]
    #[cfg_attr(test, schemars(schema_with = "names::kind::schema"))]
    pub kind: Kind,
    /// The recording's own word for what it is; default: the kind's name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub category: Option<String>,
    /// The recording's own name of this annotation.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub token: String,
    /// Length, width, height, metres.
    pub size_m: [f64; 3],
    /// Its pose in World …
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub world_from_body: Option<PlainPose>,
    /// … or in the vehicle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ego_from_body: Option<PlainPose>,
    /// Velocity in World, metres per second; default: from where it is before and after.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity_mps: Option<[f64; 3]>,
    /// Whether it is a parked vehicle; default: unknown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parked: Option<bool>,
    /// Any words.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub attributes: Vec<String>,
    /// LiDAR points in the box; default: unknown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lidar_points: Option<u32>,
    /// Visible share, 0 to 1; default: unknown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub visibility: Option<f32>,
}

/// Where the vehicle was at a time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Moment"))]
#[serde(deny_unknown_fields)]
pub struct PlainMoment {
    /// Nanoseconds since 1970 UTC; later than the moment before.
    pub time_ns: i64,
    /// The vehicle in World.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub world_from_ego: Option<PlainPose>,
    /// Instead, where the georeference is `wgs84`: the vehicle on the earth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub geo_from_ego: Option<PlainGeoPose>,
}

/// A LiDAR sweep between keyframes; the vehicle is where `path` has it at that time, or else between the keyframes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Sweep"))]
#[serde(deny_unknown_fields)]
pub struct PlainSweep {
    /// Nanoseconds since 1970 UTC; later than the sweep before.
    pub time_ns: i64,
    /// The LiDAR's points.
    pub lidar: PlainLidar,
}

/// A LiDAR sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Lidar"))]
#[serde(deny_unknown_fields)]
pub struct PlainLidar {
    /// Its path from the drive's folder: `.bin` (x, y, z, intensity, each a little-endian float32), `.pcd` or `.las`; metres.
    pub file: String,
    /// Path of its labels, one byte a point: 0 other, 1 road, 2 sidewalk, 3 terrain, 4 vegetation, 5 building or other structure.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub labels: Option<String>,
    /// Mounting of the sensor; default: the points are in Ego.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ego_from_lidar: Option<PlainPose>,
    /// Whether the points are in World instead of in the sensor's axes; `ego_from_lidar` then says where the sensor is.
    #[serde(default)]
    pub is_in_world: bool,
}

/// The road as the recording's own map has it, x and y in World, metres.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "LaneMap"))]
#[serde(deny_unknown_fields, default)]
pub struct PlainLaneMap {
    /// Where vehicles can drive.
    pub drivable: Vec<PlainPolygon>,
    /// Lanes.
    pub lanes: Vec<PlainLane>,
    /// Walkways.
    pub walkways: Vec<PlainPolygon>,
    /// Pedestrian crossings.
    pub crossings: Vec<PlainPolygon>,
    /// Stop lines.
    pub stop_lines: Vec<PlainPolygon>,
    /// Parking areas.
    pub carparks: Vec<PlainPolygon>,
    /// Lines between directions of traffic.
    pub road_dividers: Vec<Vec<[f64; 2]>>,
    /// Lines between lanes of one direction.
    pub lane_dividers: Vec<Vec<[f64; 2]>>,
    /// Painted lines, where the map knows their paint; those that are above have none here.
    pub marks: Vec<PlainLaneMark>,
    /// Points of the ground, x, y and z in World, where the map has its height.
    pub ground: Vec<[f64; 3]>,
}

/// A painted line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "LaneMark"))]
#[serde(deny_unknown_fields)]
pub struct PlainLaneMark {
    /// Along its middle.
    pub line: Vec<[f64; 2]>,
    /// Its paint.
    #[serde(with = "names::paint")]
    #[cfg_attr(test, schemars(schema_with = "names::paint::schema"))]
    pub paint: Paint,
    /// Its pattern, the left side first as seen along the line.
    #[serde(with = "names::mark_pattern")]
    #[cfg_attr(test, schemars(schema_with = "names::mark_pattern::schema"))]
    pub pattern: MarkPattern,
}

/// A lane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Lane"))]
#[serde(deny_unknown_fields)]
pub struct PlainLane {
    /// The map's own name of it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub token: String,
    /// Surface.
    pub polygon: PlainPolygon,
    /// Centre line in driving direction; default: unknown.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub centreline: Vec<[f64; 2]>,
}

/// An area.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Polygon"))]
#[serde(deny_unknown_fields)]
pub struct PlainPolygon {
    /// Its outline; the last corner is not the first again.
    pub outline: Vec<[f64; 2]>,
    /// Outlines of its holes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub holes: Vec<Vec<[f64; 2]>>,
}
