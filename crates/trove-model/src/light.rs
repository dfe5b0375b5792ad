//! Where the light comes from, and what comes down through the air.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::{Precipitation, Puff, Snow};

/// Everything that is infinitely far away, the air before it, and what has come down through it.
///
/// Radiance is in units in which a white diffuse surface under a clear midday sun leaves about 1 (so the sky is
/// about 0.1 and a street lamp's glass a few); exposure brings it to the picture.
#[derive(Clone, Debug)]
pub struct Light {
    /// Sky.
    pub environment: Environment,
    /// Fog; `None`: clear air.
    pub fog: Option<Fog>,
    /// Rain or snow that falls, from clouds that the environment has or not; `None`: none does.
    pub falling: Option<Precipitation>,
    /// Where the wind carries it, World, metres a second.
    pub wind_mps: DVec2,
    /// Snow that lies; `None`: none does.
    pub snow: Option<Snow>,
    /// Spray: what the wheels of each vehicle have thrown up, one behind the other.
    pub spray: Vec<Vec<Puff>>,
    /// Seconds since the first keyframe, by which rings spread in puddles.
    pub moment_s: f64,
}

impl Light {
    /// In clear air, over bare ground.
    pub fn clear(environment: Environment) -> Self {
        let wind_mps = DVec2::ZERO;
        Self { environment, fog: None, falling: None, wind_mps, snow: None, spray: Vec::new(), moment_s: 0.0 }
    }
}

/// Droplets in the air, fewer the higher up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// Meteorological optical range at the ground, metres: of light that goes so far on a level way 5 % is left (WMO No. 8,
    /// by Koschmieder's law).
    pub visibility_m: f64,
    /// So far above the ground there is 1/e of it, metres.
    pub height_m: f64,
    /// z of the ground, World, metres.
    pub ground_z_m: f64,
}

impl Fog {
    /// What a metre takes from light at the ground, as the exponent of its loss.
    pub fn extinction_per_m(&self) -> f64 {
        20.0f64.ln() / self.visibility_m
    }
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
    /// The moon, where it is night and it is up.
    pub moon: Option<Moon>,
    /// Linke turbidity, 1.7 (crystal clear) to 10 (hazy).
    pub turbidity: f64,
    /// Mean reflectance of the ground, 0 to 1.
    pub ground_albedo: f64,
    /// Share of the sky that is clouded, 0 to 1.
    pub cloud_cover: f64,
    /// Which clouds.
    pub cloud_seed: u64,
}

/// The moon, of which its whole disk is taken to be lit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moon {
    /// Unit vector to it, World.
    pub to_moon: DVec3,
    /// Its light above the air as a share of the sun's: 2.5e-6 when it is full.
    pub share_of_sun: f64,
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

impl EnvironmentMap {
    /// The same surroundings turned counter-clockwise seen from above, by the nearest whole number of columns.
    pub fn turned(mut self, degrees: f64) -> Self {
        let width = self.width as usize;
        let columns = (degrees / 360.0 * width as f64).round() as i64;
        // Columns run clockwise.
        let shift = columns.rem_euclid(width.max(1) as i64) as usize;
        self.rgb.chunks_mut(width.max(1)).filter(|row| row.len() == width).for_each(|row| row.rotate_left(shift));
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_turned_by_a_quarter_shows_in_the_north_what_was_in_the_east() {
        let row: Vec<[f32; 3]> = (0..8).map(|x| [x as f32; 3]).collect();
        let map = EnvironmentMap { name: String::new(), width: 8, height: 4, rgb: row.repeat(4) };
        let turned = map.clone().turned(90.0);
        // East is the fifth column's left edge, north the third's.
        assert_eq!(turned.rgb[8 + 2], map.rgb[8 + 4]);
        assert_eq!(turned.turned(270.0), map);
    }
}
