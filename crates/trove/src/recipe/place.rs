//! `[place]`: a place without a recorded drive.

use serde::{Deserialize, Serialize};

/// `[place]`
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct PlaceSection {
    /// Latitude of the middle.
    pub lat_deg: f64,
    /// Longitude of the middle.
    pub lon_deg: f64,
    /// Side of the square.
    #[serde(default = "default_place_size_m")]
    pub size_m: f64,
}

fn default_place_size_m() -> f64 {
    400.0
}
