//! `site.json`: what is known of a scene once one of its variations has been built.

use std::path::Path;

use serde::{Deserialize, Serialize};
use trove_model::{Drive, Kind, Locale, Provenance, Season};

use crate::{FormatError, Projection, ReportTable, file, names};

/// What was built for one variation of a scene: enough to go on after an interruption, and to write the manifest and the
/// report, without building it again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SiteFile {
    /// The drive that the scene was built from.
    pub drive: DriveRow,
    /// Where its parts came from.
    pub sources: Vec<Source>,
    /// What was dropped, substituted or guessed while it was read and built.
    pub report: ReportTable,
    /// Which asset stands for which recorded object, and how well it fits.
    #[serde(default)]
    pub fits: Vec<FitRow>,
    /// How the variation differs.
    pub factors: Factors,
    /// Whose customs it follows; null in folders written by earlier versions.
    #[serde(default)]
    pub locale: Option<LocaleRow>,
    /// SHA-256 of the recorded files that this scene alone is made from, LiDAR sweeps for one; null where there are none.
    #[serde(default)]
    pub recording: Option<String>,
    /// Of which keyframes and cameras the frames are, as the recipe had them when they were planned.
    #[serde(default)]
    pub planned: serde_json::Value,
    /// The frames that were planned: index of the keyframe in the drive, from 0, and the view (`ego.CAM_FRONT`).
    pub frames: Vec<(u32, String)>,
    /// The LiDAR sweeps that were planned, likewise (`ego.LIDAR_TOP`).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sweeps: Vec<(u32, String)>,
    /// The grids that were planned, likewise (`ego.OCC3D`).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub grids: Vec<(u32, String)>,
    /// The radars' cycles that were planned, likewise (`ego.RADAR_FRONT`).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub radars: Vec<(u32, String)>,
}

/// Whose customs a place follows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct LocaleRow {
    /// ISO 3166-1 code of the country (`GB`); null if unknown.
    pub country: Option<String>,
    /// The side of the road that traffic keeps to: `left` or `right`.
    pub driving_side: String,
    /// The unit of speed limits: `kmh` or `mph`.
    pub speed_unit: String,
}

impl From<&Locale> for LocaleRow {
    fn from(locale: &Locale) -> Self {
        Self {
            country: locale.country.clone(),
            driving_side: locale.driving_side.name().to_owned(),
            speed_unit: locale.signs.speed_unit.name().to_owned(),
        }
    }
}

/// A drive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct DriveRow {
    /// The dataset's name of it (`scene-0103`).
    pub scene: String,
    /// The dataset (`nuscenes`).
    pub dataset: String,
    /// The dataset's name of the place (`boston-seaport`); empty if unknown.
    #[serde(default)]
    pub place: String,
    /// Number of keyframes it has, rendered or not.
    pub keyframes: u32,
    /// The licence of the recording.
    pub licence: String,
    /// From latitude and longitude to World.
    pub projection: DriveProjection,
}

/// A drive's projection, with its type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct DriveProjection {
    /// Which formula it is.
    pub kind: ProjectionKind,
    /// Its parameters.
    #[serde(flatten)]
    pub projection: Projection,
}

/// A formula from latitude and longitude to a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ProjectionKind {
    /// World = (Δlon, Δlat) · `metres_per_rad` − `anchor_m`, angles in radians from the origin.
    Equirectangular,
}

/// Where something came from.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Source {
    /// What it is (`nuscenes scene-0103`, `boston-seaport.osm`).
    pub source: String,
    /// Its licence.
    pub licence: String,
}

/// How well the asset that stands for a recorded object fits its box.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FitRow {
    /// The dataset's token of the object's track.
    pub track: String,
    /// What the object is.
    #[serde(with = "names::kind")]
    #[cfg_attr(test, schemars(schema_with = "names::kind::schema"))]
    pub kind: Kind,
    /// Length, width and height of its box, medians over all keyframes, metres.
    pub size_m: [f64; 3],
    /// The chosen asset.
    pub chosen: AssetFitRow,
    /// Other assets, best first by `quality_m`.
    pub runners_up: Vec<AssetFitRow>,
}

/// How well an asset fits a box.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct AssetFitRow {
    /// The asset's id.
    pub asset: String,
    /// The paper's measure: IoU of the outlines seen from above times the lower height, metres, with the aspect kept.
    pub quality_m: f64,
    /// Intersection over union in three dimensions after fitting, 0 to 1.
    pub iou3d: f64,
}

/// How a variation differs. A factor without a quantity has the number of the variation whose seed it uses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Factors {
    /// Which models stand for recorded objects: a variation's number.
    pub assets: u32,
    /// Colours, wear and extras of vehicles: a variation's number.
    pub paint: u32,
    /// Who the pedestrians are: a variation's number.
    pub people: u32,
    /// Styles and colours of buildings: a variation's number.
    pub facades: u32,
    /// Surfaces of roads, sidewalks and land: a variation's number.
    pub materials: u32,
    /// Street furniture: a variation's number.
    pub furniture: u32,
    /// Plants, lawns and undergrowth: a variation's number.
    pub vegetation: u32,
    /// Latitude and longitude of the place whose customs, climate and sun it follows, degrees.
    pub place: [f64; 2],
    /// What plants, lawns and fallen leaves show.
    #[serde(with = "names::season")]
    #[cfg_attr(test, schemars(schema_with = "names::season::schema"))]
    pub season: Season,
    /// Sun and sky.
    pub light: LightFactor,
    /// Number of road users relative to the recorded number.
    pub traffic: f64,
    /// How wet the ground is, 0 (dry) to 1.
    pub wetness: f64,
    /// Meteorological optical range of fog, metres; absent in clear air.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub visibility_m: Option<f64>,
    /// Rain that falls, millimetres an hour; absent where none does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rain_mm_h: Option<f64>,
    /// Snow that falls, millimetres of water an hour; absent where none does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub snowfall_mm_h: Option<f64>,
    /// Share of level surfaces that snow covers, 0 to 1; absent where none lies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub snow: Option<f64>,
    /// What was added to the recipe's exposure, stops.
    pub exposure_ev: f64,
    /// Height of the cameras above their recorded positions, metres.
    pub camera_height_m: f64,
    /// Upward tilt of the cameras from their recorded views, degrees.
    pub camera_pitch_deg: f64,
    /// How many other vehicles may carry the rig.
    pub other_vehicles: u32,
}

/// Where the light comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum LightFactor {
    /// A computed sky.
    Sky {
        /// `sky`.
        environment: String,
        /// Elevation of the sun above the horizon, degrees; negative at night.
        sun_elevation_deg: f64,
        /// Azimuth of the sun, degrees clockwise from north.
        sun_azimuth_deg: f64,
        /// Linke turbidity, 1.7 (crystal clear) to 10 (hazy).
        turbidity: f64,
        /// Share of the sky covered by clouds, 0 to 1.
        clouds: f64,
    },
    /// A sky image.
    Picture {
        /// The file, as the recipe names it.
        environment: String,
        /// Its rotation counter-clockwise, degrees.
        rotation_deg: f64,
    },
}

impl From<&Drive> for DriveRow {
    fn from(drive: &Drive) -> Self {
        Self {
            scene: drive.id.clone(),
            dataset: drive.dataset.clone(),
            place: drive.place.clone(),
            keyframes: drive.keyframes.len() as u32,
            licence: drive.licence.clone(),
            projection: DriveProjection {
                kind: ProjectionKind::Equirectangular,
                projection: (&drive.projection).into(),
            },
        }
    }
}

impl From<&Provenance> for Source {
    fn from(provenance: &Provenance) -> Self {
        Self { source: provenance.source.clone(), licence: provenance.licence.clone() }
    }
}

impl SiteFile {
    /// The file's name.
    pub const NAME: &str = "site.json";

    /// Reads it from the folder of a variation; `None` where it is not there.
    ///
    /// # Errors
    /// A file that cannot be read or is damaged.
    pub fn read(folder: &Path) -> Result<Option<Self>, FormatError> {
        let path = folder.join(Self::NAME);
        let bytes = file::bytes_if_there(&path)?;
        bytes.map(|bytes| file::parsed(&path, &bytes, "what trove generate built for a scene")).transpose()
    }

    /// The file's bytes.
    pub fn to_json(&self) -> Vec<u8> {
        file::pretty(self)
    }
}
