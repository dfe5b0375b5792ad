//! The sun of a photographed sky: a few texels that give most of the light, and all of the noise unless they are known.

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use trove_model::{EnvironmentMap, luminance};

use super::dome::direction_of;

/// A photograph's sun with the glare around it lies within this angle of its middle.
const REACH_RAD: f32 = 1.0 * PI / 180.0;

/// Where the surroundings are measured.
const RING_RAD: [f32; 2] = [2.0 * PI / 180.0, 3.5 * PI / 180.0];

/// The sun outshines its surroundings by this factor; the brightest cloud does not.
const STANDS_OUT: f32 = 20.0;

/// Texels brighter than the surroundings by this factor belong to the sun.
const BELONGS: f32 = 4.0;

/// The sun gives at least this share of the light; a lamp on the horizon gives less.
const LEAST_SHARE: f32 = 0.01;

/// A sun that was taken out of a map.
pub(super) struct SunInMap {
    pub(super) to_sun: Vec3,
    /// Irradiance of a surface that faces it: what the map has lost.
    pub(super) irradiance: Vec3,
}

/// Takes the sun out of a map and fills its place with the light around it; `None`, and no change, where there is none.
pub(super) fn take_sun(map: &mut EnvironmentMap) -> Option<SunInMap> {
    let (width, height) = (map.width as usize, map.height as usize);
    let brightness = |map: &EnvironmentMap, i: usize| luminance(map.rgb[i].into());
    let solid_angle =
        |i: usize| TAU / width as f32 * 2.0 * (PI * 0.5 / height as f32).sin() * sin_at(i / width, height);
    let above = width * (height / 2);
    let brightest = (0..above).max_by(|&a, &b| brightness(map, a).total_cmp(&brightness(map, b)))?;
    let peak = direction_of(brightest % width, brightest / width, width, height);

    // Only rows and columns near it are looked at.
    let near = |centre: Vec3, low: f32, high: f32| -> Vec<usize> {
        let rows = |angle: f32| ((centre.z.clamp(-1.0, 1.0).acos() + angle) / PI * height as f32).max(0.0) as usize;
        let range = rows(-high - PI / height as f32)..(rows(high + PI / height as f32) + 1).min(height);
        let within = |i: &usize| {
            let angle = 2.0 * ((direction_of(i % width, i / width, width, height) - centre).length() * 0.5).asin();
            (low..high).contains(&angle)
        };
        (range.start * width..range.end * width).filter(within).collect()
    };
    let mean = |texels: &[usize]| {
        let sum: Vec3 = texels.iter().map(|&i| Vec3::from(map.rgb[i])).sum();
        sum / texels.len().max(1) as f32
    };
    let ring = near(peak, RING_RAD[0], RING_RAD[1]);
    let around = luminance(mean(&ring));
    if ring.is_empty() || brightness(map, brightest) < STANDS_OUT * around {
        return None;
    }
    let mut texels = near(peak, 0.0, REACH_RAD.max(1.5 * PI / height as f32));
    texels.retain(|&i| brightness(map, i) > BELONGS * around);
    // What remains there is what its rim has.
    let rim = mean(&near(peak, REACH_RAD, RING_RAD[0].max(REACH_RAD + 1.5 * PI / height as f32)));

    let (mut irradiance, mut to_sun) = (Vec3::ZERO, Vec3::ZERO);
    for &i in &texels {
        let light = (Vec3::from(map.rgb[i]) - rim).max(Vec3::ZERO) * solid_angle(i);
        irradiance += light;
        to_sun += direction_of(i % width, i / width, width, height) * luminance(light);
    }
    let all: f32 = (0..above).map(|i| brightness(map, i) * solid_angle(i)).sum();
    if luminance(irradiance) < LEAST_SHARE * all {
        return None;
    }
    for i in texels {
        map.rgb[i] = Vec3::from(map.rgb[i]).min(rim).to_array();
    }
    Some(SunInMap { to_sun: to_sun.normalize(), irradiance })
}

/// Sine of the angle from the zenith in the middle of a row.
fn sin_at(row: usize, height: usize) -> f32 {
    (PI * (row as f32 + 0.5) / height as f32).sin()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sky with a gradient, and a spot of some radius and radiance in it.
    fn sky(spot: Vec3, radius_rad: f32, radiance: f32) -> EnvironmentMap {
        let (width, height) = (1024, 512);
        let texel = |i: usize| {
            // Texels that the spot covers in part have a part of it.
            let (mut covered, n) = (0, 6);
            let d = direction_of(i % width, i / width, width, height);
            if (d - spot).length() < radius_rad + 0.02 {
                for k in 0..n * n {
                    let (x, y) = ((i % width) * n + k % n, (i / width) * n + k / n);
                    let d = direction_of(x, y, width * n, height * n);
                    covered += usize::from((d - spot).length() < radius_rad);
                }
            }
            let share = covered as f32 / (n * n) as f32;
            [0.2 + 0.3 * d.z.abs() + share * radiance, 0.3 + share * radiance, 0.5 + share * radiance * 0.8]
        };
        let rgb = (0..width * height).map(texel).collect();
        EnvironmentMap { name: String::new(), width: width as u32, height: height as u32, rgb }
    }

    fn facing(map: &EnvironmentMap, to: Vec3) -> Vec3 {
        let (width, height) = (map.width as usize, map.height as usize);
        let part = |i: usize| {
            let cos = direction_of(i % width, i / width, width, height).dot(to).max(0.0);
            let solid_angle = TAU / width as f32 * PI / height as f32 * sin_at(i / width, height);
            (Vec3::from(map.rgb[i]) * cos * solid_angle).as_dvec3()
        };
        (0..width * height).map(part).sum::<glam::DVec3>().as_vec3()
    }

    #[test]
    fn a_sun_that_is_taken_out_takes_its_light_along() {
        for (x, z, radius_deg, radiance) in [(0.7f32, 0.6f32, 0.27f32, 40_000.0), (-0.8, 0.05, 0.5, 3_000.0)] {
            let to_sun = Vec3::new(x, 0.3, z).normalize();
            let before = sky(to_sun, radius_deg.to_radians(), radiance);
            let mut after = before.clone();
            let sun = take_sun(&mut after).unwrap();
            let off_deg = (sun.to_sun - to_sun).length().to_degrees();
            assert!(off_deg < 0.1, "{off_deg}");
            let (all, kept) = (facing(&before, to_sun), facing(&after, to_sun) + sun.irradiance);
            assert!(((kept - all) / all).abs().max_element() < 0.01, "{kept} instead of {all}");
            assert!(after.rgb.iter().flatten().all(|&c| c < 1.0));
        }
    }

    #[test]
    fn overcast_skies_broad_lights_and_distant_lamps_are_no_sun() {
        let spot = Vec3::new(0.5, 0.5, 0.4).normalize();
        for (radius_deg, radiance) in [(0.3f32, 3.0), (8.0, 100.0), (0.2, 30.0)] {
            let mut map = sky(spot, radius_deg.to_radians(), radiance);
            let before = map.clone();
            assert!(take_sun(&mut map).is_none(), "{radius_deg} {radiance}");
            assert_eq!(map, before);
        }
        let mut black = EnvironmentMap { name: String::new(), width: 8, height: 4, rgb: vec![[0.0; 3]; 32] };
        assert!(take_sun(&mut black).is_none());
    }
}
