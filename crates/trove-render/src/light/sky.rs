//! The sky by day and by night, as a picture, and the sun in it.

use std::f32::consts::PI;

use glam::Vec3;
use hw_skymodel::rgb::{Channel, SkyParams, SkyState};
use rayon::prelude::*;
use trove_model::{EnvironmentMap, PhysicalSky, luminance};
use trove_trace::light::SUN_RADIUS_RAD;

use super::clouds::Clouds;
use super::{dome, sun};

/// Columns of the picture, and twice its rows.
const WIDTH: usize = 1280;

/// The same for the clear sky that only has to be summed.
const COARSE_WIDTH: usize = 128;

/// Mean irradiance above the atmosphere in the scale of [`trove_model::Light`]: under a clear midday sun (60° high,
/// turbidity 3) sun and sky together give a white diffuse surface a radiance of 1.
const SUN_OUTSIDE: f32 = 3.85;

/// From the scale of the Hosek–Wilkie data to that of [`trove_model::Light`]: the sky then gives 17 % of the midday
/// light, as it does on a clear day.
const SKY_SCALE: f32 = 0.0206;

/// Angle over which the moon's rim goes over into the sky: a texel.
const RIM_RAD: f32 = std::f32::consts::TAU / WIDTH as f32;

/// From the height of clouds the horizon is lower by this.
const CLOUD_DIP_RAD: f64 = 1.2 * std::f64::consts::PI / 180.0;

/// Colours of the zenith and of the horizon below the sun at dusk, relative to the model's.
const ZENITH_TINT: Vec3 = Vec3::new(0.62, 0.9, 1.55);
const GLOW_TINT: Vec3 = Vec3::new(1.45, 0.88, 0.5);

/// Light of the night: the moonless sky over a town.
const NIGHT: Vec3 = Vec3::new(6e-6, 5e-6, 5e-6);

/// A sky as the renderer shows it.
pub struct BakedSky {
    /// Everything but the sun's disk.
    pub map: EnvironmentMap,
    /// Unit vector to the sun, World.
    pub to_sun: Vec3,
    /// Irradiance of a surface that faces the sun, linear Rec. 709; 0 where none shines.
    pub sun_irradiance: Vec3,
}

/// Computes the picture of a sky.
pub fn bake_sky(sky: &PhysicalSky) -> BakedSky {
    let air = Air::new(sky);
    let moonlit =
        sky.moon.map(|moon| (Air::new(&PhysicalSky { to_sun: moon.to_moon, ..*sky }), moon.share_of_sun as f32));
    let without_disks = |direction: Vec3| {
        let by_moon = moonlit.as_ref().map_or(Vec3::ZERO, |(air, share)| air.radiance(direction) * *share);
        air.radiance(direction) + by_moon + NIGHT
    };
    let (width, height) = (WIDTH, WIDTH / 2);
    // The clear sky, coarsely, lights the clouds and the ground below them.
    let coarse = upper_half(COARSE_WIDTH, without_disks);
    let from_clear_sky = irradiance_from_above(&coarse, COARSE_WIDTH);
    let clouds = Clouds::new(sky, air.sun_aloft, from_clear_sky / PI, air.ground(air.sun_irradiance, from_clear_sky));
    let sun_irradiance = air.sun_irradiance * clouds.as_ref().map_or(1.0, Clouds::sun_share);

    let mut rgb = upper_half(width, |direction| {
        let moon = moonlit.as_ref().map_or(Vec3::ZERO, |(air, share)| air.disk(direction) * *share);
        let clear = without_disks(direction) + moon;
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
    /// The same at the clouds' height, where the sun rises earlier and sets later.
    sun_aloft: Vec3,
    /// How much of the light comes from a sun near the horizon, 0 to 1.
    dusk: f32,
    /// How much large particles whiten the sky, 0 to 1.
    whitened: f32,
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
        // Illuminance on level ground is some 2,000 lx at 3°, 600 lx at 0°, 3.4 lx at −6°, 0.008 lx at −12°; the model ends
        // too bright.
        let (low, sunken) = ((1.0 - elevation_rad.to_degrees() / 6.0).clamp(0.0, 1.0), (-elevation_rad).to_degrees());
        let sunken = sunken.max(0.0);
        let twilight = 10f64.powf(-0.5 * low - sunken * (0.3 + 0.009 * sunken)) as f32;
        let sun_irradiance = sun::irradiance(elevation_rad, turbidity, SUN_OUTSIDE);
        let sun_aloft = sun::irradiance(elevation_rad + CLOUD_DIP_RAD, turbidity, SUN_OUTSIDE);
        let dusk = (1.0 - (elevation_rad.to_degrees() - 1.0) / 14.0).clamp(0.0, 1.0) as f32;
        let whitened = (0.1 * (turbidity - 2.0)).clamp(0.0, 0.55) as f32;
        Self {
            state,
            to_sun: to_sun.as_vec3(),
            twilight,
            sun_irradiance,
            sun_aloft,
            dusk: dusk * dusk * (3.0 - 2.0 * dusk),
            whitened,
            ground_albedo,
        }
    }

    /// Radiance of the sky without the sun's disk, in a direction above the horizon.
    fn radiance(&self, direction: Vec3) -> Vec3 {
        let from_zenith = direction.z.clamp(0.0, 1.0).acos();
        let from_sun = direction.dot(self.to_sun).clamp(-1.0, 1.0).acos();
        let channel = |c| self.state.radiance(from_zenith, from_sun, c).max(0.0);
        let day = Vec3::new(channel(Channel::R), channel(Channel::G), channel(Channel::B));
        // The model has one kind of small particles; real haze has larger ones too, which scatter all colours alike.
        let day = day.lerp(Vec3::splat(luminance(day)), self.whitened);
        // It ends with the sun on the horizon, without ozone, which makes the twilight's zenith blue, and without the
        // long ways of the light, which redden the sky near the sun.
        let low = (1.0 - direction.z.max(0.0) / 0.5).clamp(0.0, 1.0).powi(2);
        let toward_sun = 0.5 + 0.5 * direction.dot(self.to_sun);
        let tint = ZENITH_TINT.lerp(GLOW_TINT, low * (0.25 + 0.75 * toward_sun * toward_sun));
        let tinted = day * tint * (luminance(day) / luminance(day * tint).max(f32::MIN_POSITIVE));
        day.lerp(tinted, self.dusk) * SKY_SCALE * self.twilight
    }

    /// Radiance of a disk as large as the sun's that gives its light, without an edge that texels would miss.
    fn disk(&self, direction: Vec3) -> Vec3 {
        let from_middle = direction.angle_between(self.to_sun);
        let share = ((SUN_RADIUS_RAD - from_middle) / RIM_RAD + 0.5).clamp(0.0, 1.0);
        self.sun_irradiance * share / (PI * SUN_RADIUS_RAD * SUN_RADIUS_RAD)
    }

    /// Radiance of the ground far away, from the irradiance facing the sun and that from the sky.
    fn ground(&self, from_sun: Vec3, from_sky: Vec3) -> Vec3 {
        (from_sky + from_sun * self.to_sun.z.max(0.0)) * self.ground_albedo / PI
    }
}

#[cfg(test)]
mod tests {
    use trove_model::Moon;

    use super::*;

    fn clear(elevation_deg: f64) -> PhysicalSky {
        let (sin, cos) = elevation_deg.to_radians().sin_cos();
        PhysicalSky {
            to_sun: glam::DVec3::new(0.0, -cos, sin),
            moon: None,
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
        let (sun, sky) = light(&bake_sky(&clear(60.0)));
        assert!(((sun + sky) / std::f32::consts::PI - 1.0).abs() < 0.05, "sun {sun}, sky {sky}");
        assert!((sky / (sun + sky) - 0.17).abs() < 0.02, "sun {sun}, sky {sky}");
    }

    #[test]
    fn a_full_moon_gives_a_quarter_of_a_lux_and_hides_behind_clouds() {
        let to_moon = glam::DVec3::new(0.4, -0.5, 0.8).normalize();
        let night = PhysicalSky { moon: Some(Moon { to_moon, share_of_sun: 2.5e-6 }), ..clear(-30.0) };
        let level_lx = |sky: &PhysicalSky| light(&bake_sky(sky)).1 * KLX * 1e3;
        let moonless = level_lx(&PhysicalSky { moon: None, ..night });
        let by_moon = level_lx(&night) - moonless;
        // Of a full moon 52° up: 0.318 lx above the air, 0.8 of it left, a cosine, and what the sky adds.
        assert!((0.17..0.3).contains(&by_moon), "{by_moon} lx");
        let disk = |sky: &PhysicalSky| {
            let map = bake_sky(sky).map;
            map.rgb.iter().map(|rgb| luminance(Vec3::from(*rgb))).fold(0.0, f32::max)
        };
        let overcast = PhysicalSky { cloud_cover: 1.0, ..night };
        assert!(disk(&night) > 0.05 && disk(&overcast) < 0.01 * disk(&night), "{} {}", disk(&night), disk(&overcast));
    }

    /// Kilolux in a unit of irradiance: 127.5 klx arrive above the atmosphere.
    const KLX: f32 = 127.5 / SUN_OUTSIDE;

    #[test]
    fn sun_and_sky_give_the_light_of_published_clear_days() {
        // IES 1984, Recommended practice for the calculation of daylight availability: sun 127.5 exp(−0.21 / sin h) klx,
        // clear sky 0.8 + 15.5 √sin h klx; means of many places.
        for elevation_deg in [10.0, 15.0, 25.0, 40.0, 60.0, 75.0] {
            let sky = bake_sky(&clear(elevation_deg));
            let sin = (elevation_deg.to_radians().sin()) as f32;
            let (normal, diffuse) = (luminance(sky.sun_irradiance) * KLX, light(&sky).1 * KLX);
            let (ies_normal, ies_diffuse) = (127.5 * (-0.21 / sin).exp(), 0.8 + 15.5 * sin.sqrt());
            assert!((normal / ies_normal - 1.0).abs() < 0.1, "sun {elevation_deg}°: {normal} klx, not {ies_normal}");
            assert!(
                (0.9..1.35).contains(&(diffuse / ies_diffuse)),
                "sky {elevation_deg}°: {diffuse}, not {ies_diffuse}"
            );
        }
    }

    #[test]
    fn a_clear_sky_is_as_bright_as_measured_and_brighter_than_the_road_at_its_horizon() {
        // Zenith luminance (1.376 T − 1.81) tan h + 0.38 kcd/m² (Karayel et al. 1984, San Francisco).
        for elevation_deg in [25.0f64, 40.0, 60.0] {
            let (sky, air) = (clear(elevation_deg), Air::new(&clear(elevation_deg)));
            let kcd = |direction: Vec3| luminance(air.radiance(direction)) * KLX;
            let measured = (1.376 * sky.turbidity - 1.81) * elevation_deg.to_radians().tan() + 0.38;
            let ratio = f64::from(kcd(Vec3::Z)) / measured;
            assert!((0.7..1.5).contains(&ratio), "zenith {elevation_deg}°: {ratio} of {measured}");
            let (sun, diffuse) = light(&bake_sky(&sky));
            // The sun stands in the south.
            let north = kcd(Vec3::new(0.0, 1.0, 0.17).normalize());
            let asphalt = 0.12 * (sun + diffuse) / PI * KLX;
            assert!((6.0..15.0).contains(&north) && north > 1.5 * asphalt, "{north} kcd/m² over {asphalt}");
        }
    }
}
