//! Where the light comes from.

use std::sync::Arc;

use glam::DVec3;

/// Everything that is infinitely far away.
///
/// Radiance is in units in which a white diffuse surface under a clear midday sun leaves about 1 (so the sky is
/// about 0.1 and a street lamp's glass a few); exposure brings it to the picture.
#[derive(Clone, Debug)]
pub struct Light {
    /// Sky.
    pub environment: Environment,
}

/// A sky.
#[derive(Clone, Debug)]
pub enum Environment {
    /// Computed.
    Sky(PhysicalSky),
    /// Photographed.
    Map(Arc<EnvironmentMap>),
}

/// A clear or clouded sky with the sun in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhysicalSky {
    /// Unit vector to the sun, World; below the horizon it is night.
    pub to_sun: DVec3,
    /// Linke turbidity, 1.7 (crystal clear) to 10 (hazy).
    pub turbidity: f64,
    /// Mean reflectance of the ground, 0 to 1.
    pub ground_albedo: f64,
    /// Share of the sky that is clouded, 0 to 1.
    pub cloud_cover: f64,
    /// Which clouds.
    pub cloud_seed: u64,
}

/// A latitude-longitude image of radiance, linear Rec. 709.
///
/// Row 0 is the zenith; column 0's left edge looks west (−x) and columns run through north, so the picture's middle
/// looks east (+x), as in a picture of the surroundings with z up.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentMap {
    /// Where it came from, for the manifest.
    pub name: String,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Radiance, row by row.
    pub rgb: Vec<[f32; 3]>,
}
