//! What a GeoJSON file's coordinates are.

use serde::{Deserialize, Serialize};

/// What the coordinates of GeoJSON files mean that do not say it themselves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum GeoJsonFrame {
    /// Longitude and latitude, degrees (RFC 7946).
    #[default]
    Wgs84,
    /// Metres in the dataset's own plane, such as a city frame of Argoverse 2; of a drive that has none, World's.
    Dataset,
}
