//! The sky by day and by night, as a picture, and the sun in it.

use std::f32::consts::PI;

use glam::Vec3;
use hw_skymodel::rgb::{Channel, SkyParams, SkyState};
use rayon::prelude::*;
use trove_model::{EnvironmentMap, PhysicalSky};

use super::clouds::Clouds;
use super::{dome, sun};

/// Columns of the picture, and twice its rows.
const WIDTH: usize = 2560;

/// The same for the clear sky that only has to be summed.
const COARSE_WIDTH: usize = 128;

/// Mean irradiance above the atmosphere in the scale of [`trove_model::Light`]: under a clear midday sun (60° high,
/// turbidity 3) sun and sky together give a white diffuse surface a radiance of 1.
const SUN_OUTSIDE: f32 = 4.4;

/// From the scale of the Hosek–Wilkie data to that of [`trove_model::Light`]: the sky then gives 17 % of the midday
/// light, as it does on a clear day.
const SKY_SCALE: f32 = 0.0206;

/// Light of the night: the moonless sky over a town.
const NIGHT: Vec3 = Vec3::new(4e-4, 5e-4, 8e-4);

/// A sky ready to be drawn.
pub(super) struct BakedSky {
    pub(super) map: EnvironmentMap,
    pub(super) to_sun: Vec3,
    /// Irradiance of a surface that faces the sun.
    pub(super) sun_irradiance: Vec3,
}

/// Computes the picture of a sky.
pub(super) fn bake(sky: &PhysicalSky) -> BakedSky {
    let air = Air::new(sky);
    let (width, height) = (WIDTH, WIDTH / 2);
    // The clear sky, coarsely, lights the clouds and the ground below them.
    let coarse = upper_half(COARSE_WIDTH, |direction| air.radiance(direction));
    let from_clear_sky = irradiance_from_above(&coarse, COARSE_WIDTH);
    let clouds =
        Clouds::new(sky, air.sun_irradiance, from_clear_sky / PI, air.ground(air.sun_irradiance, from_clear_sky));
    let sun_irradiance = air.sun_irradiance * Clouds::sun_share(sky.cloud_cover);

    let mut rgb = upper_half(width, |direction| {
        let clear = air.radiance(direction);
        clouds.as_ref().map_or(clear, |clouds| clouds.before(clear, direction))
    });
    let ground = air.ground(sun_irradiance, irradiance_from_above(&rgb, width));
    rgb.resize(width * height, ground.to_array());
    let map = EnvironmentMap { name: "sky".into(), width: width as u32, height: height as u32, rgb };
    BakedSky { map, to_sun: air.to_sun, sun_irradiance }
}

/// The upper half of a picture, `width` texels wide.
fn upper_half(width: usize, radiance: impl Fn(Vec3) -> Vec3 + Sync) -> Vec<[f32; 3]> {
    let texel = |i: usize| radiance(dome::direction_of(i % width, i / width, width, width / 2)).to_array();
    (0..width * width / 4).into_par_iter().map(texel).collect()
}

/// Irradiance of level ground from the upper half of a picture.
fn irradiance_from_above(rgb: &[[f32; 3]], width: usize) -> Vec3 {
    let height = width / 2;
    let row = |y: usize| {
        let sum: Vec3 = rgb[y * width..(y + 1) * width].iter().map(|&c| Vec3::from(c)).sum();
        let sin_squared = |y: usize| (PI * y as f32 / height as f32).sin().powi(2);
        sum / width as f32 * PI * (sin_squared(y + 1) - sin_squared(y))
    };
    (0..height / 2).map(row).sum()
}

/// Cloudless air.
struct Air {
    state: SkyState,
    to_sun: Vec3,
    /// Share of the model's light that is left when the sun is below the horizon.
    twilight: f32,
    sun_irradiance: Vec3,
    ground_albedo: f32,
}

impl Air {
    fn new(sky: &PhysicalSky) -> Self {
        let to_sun = sky.to_sun.normalize();
        let elevation_rad = to_sun.z.clamp(-1.0, 1.0).asin();
        let turbidity = sky.turbidity.clamp(1.7, 10.0);
        let ground_albedo = sky.ground_albedo.clamp(0.0, 1.0) as f32;
        let params = SkyParams {
            elevation: elevation_rad.clamp(0.0, std::f64::consts::FRAC_PI_2) as f32,
            turbidity: turbidity as f32,
            albedo: [ground_albedo; 3],
        };
        let state = SkyState::new(&params).expect("the parameters were clamped to the model's range");
        // Illuminance falls tenfold for every 3° that the sun sinks.
        let twilight = 10f64.powf(elevation_rad.min(0.0).to_degrees() / 3.0) as f32;
        let sun_irradiance = sun::irradiance(elevation_rad, turbidity, SUN_OUTSIDE);
        Self { state, to_sun: to_sun.as_vec3(), twilight, sun_irradiance, ground_albedo }
    }

    /// Radiance of the sky without the sun's disk, in a direction above the horizon.
    fn radiance(&self, direction: Vec3) -> Vec3 {
        let from_zenith = direction.z.clamp(0.0, 1.0).acos();
        let from_sun = direction.dot(self.to_sun).clamp(-1.0, 1.0).acos();
        let channel = |c| self.state.radiance(from_zenith, from_sun, c).max(0.0);
        let day = Vec3::new(channel(Channel::R), channel(Channel::G), channel(Channel::B));
        day * SKY_SCALE * self.twilight + NIGHT
    }

    /// Radiance of the ground far away, from the irradiance facing the sun and that from the sky.
    fn ground(&self, from_sun: Vec3, from_sky: Vec3) -> Vec3 {
        (from_sky + from_sun * self.to_sun.z.max(0.0)) * self.ground_albedo / PI
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::luminance;

    fn clear(elevation_deg: f64) -> PhysicalSky {
        let (sin, cos) = elevation_deg.to_radians().sin_cos();
        PhysicalSky {
            to_sun: glam::DVec3::new(0.0, -cos, sin),
            turbidity: 3.0,
            ground_albedo: 0.2,
            cloud_cover: 0.0,
            cloud_seed: 1,
        }
    }

    /// Brightness of level ground: from the sun, from the sky.
    fn light(sky: &BakedSky) -> (f32, f32) {
        let from_sky = luminance(irradiance_from_above(&sky.map.rgb, sky.map.width as usize));
        (luminance(sky.sun_irradiance) * sky.to_sun.z.max(0.0), from_sky)
    }

    #[test]
    fn a_white_surface_under_a_clear_midday_sun_has_a_radiance_of_one() {
        let (sun, sky) = light(&bake(&clear(60.0)));
        assert!(((sun + sky) / std::f32::consts::PI - 1.0).abs() < 0.05, "sun {sun}, sky {sky}");
        assert!((sky / (sun + sky) - 0.17).abs() < 0.02, "sun {sun}, sky {sky}");
    }
}
