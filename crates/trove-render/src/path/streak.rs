//! What small things before the camera draw into the picture, flying while light is gathered.

use glam::{DVec2, DVec3, Vec3};
use trove_model::{Raster, Shot};

/// Farther ones are in the air, and nearer ones too blurred.
pub(super) const REACH_M: [f64; 2] = [0.3, 15.0];
/// Streaks that cover less of their pixels are not seen.
const LEAST_COVER: f64 = 0.002;
/// Opening of a car's camera, whose focus is far away.
pub(crate) const APERTURE_M: f64 = 3e-3;
/// What a picture that is taken in an instant takes it for.
const EXPOSURE_S: f64 = 1.0 / 250.0;

/// What a piece of water or a flake draws while light is gathered.
pub(super) struct Streak {
    ends_px: [DVec2; 2],
    width_px: f64,
    /// Pixels that it would cover if it stood.
    area_px: f64,
    /// Depth along the camera's axis; less than 0 behind a fisheye.
    pub(super) depth_m: f32,
    pub(super) place: Vec3,
}

impl Streak {
    /// Of what flies through a place in World in the exposure's middle; `None` where it is hardly seen.
    pub(super) fn new(shot: &Shot, place: DVec3, diameter_m: f64, velocity_mps: DVec3) -> Option<Self> {
        let point = shot.world_from_camera.inverse().point(place);
        let distance_m = point.length();
        if !(REACH_M[0]..=REACH_M[1]).contains(&distance_m) {
            return None;
        }
        let pixel_rad = shot.lens.pixel_rad(point / distance_m);
        let to_px = 1.0 / (distance_m * pixel_rad);
        let area_px = std::f64::consts::FRAC_PI_4 * (diameter_m * to_px).powi(2);
        let width_px = ((diameter_m + APERTURE_M) * to_px).max(1.0);
        let exposure_s = if shot.shutter.exposure_s > 0.0 { shot.shutter.exposure_s } else { EXPOSURE_S };
        let middle_px = shot.lens.project(point).filter(|pixel| shot.lens.contains(*pixel))?;
        let row = middle_px.y / f64::from(shot.lens.height_px);
        let ends_px = [0.0, 1.0].map(|within| {
            let after_s = shot.shutter.time_s(row, 0.5) + (within - 0.5) * exposure_s;
            shot.lens.project(shot.world_from_camera_at(after_s).inverse().point(place + velocity_mps * after_s))
        });
        let [Some(from), Some(to)] = ends_px else { return None };
        let cover = area_px / (width_px * (width_px + from.distance(to)));
        (cover > LEAST_COVER).then(|| Self {
            ends_px: [from, to],
            width_px,
            area_px,
            depth_m: point.z as f32,
            place: place.as_vec3(),
        })
    }
}

/// Share of each pixel's light that streaks before what it shows take the place of.
pub(super) fn cover(streaks: &[Streak], depth_m: &Raster<f32>) -> Raster<f32> {
    let mut cover = depth_m.map(|_| 0.0f32);
    for Streak { ends_px: [from, to], width_px, area_px, depth_m: own_m, .. } in streaks {
        let steps = (2.0 * from.distance(*to) / width_px).ceil().max(1.0);
        let radius = width_px / 2.0 + 0.5;
        // A soft disc of this radius has so many pixels.
        let whole = std::f64::consts::PI * (radius * radius - radius + 1.0 / 3.0);
        let share = (area_px / steps / whole) as f32;
        for step in 0..steps as u32 {
            let middle = from.lerp(*to, (f64::from(step) + 0.5) / steps);
            let [low, high] = [middle - radius, middle + radius].map(|p| p.floor().as_ivec2());
            for y in low.y.max(0)..=high.y.min(cover.height as i32 - 1) {
                for x in low.x.max(0)..=high.x.min(cover.width as i32 - 1) {
                    let away = middle.distance(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
                    let (x, y) = (x as u32, y as u32);
                    if away < radius && depth_m.at(x, y).abs() > own_m.abs() {
                        let pixel = cover.at_mut(x, y);
                        *pixel += (1.0 - *pixel) * share * (radius - away).min(1.0) as f32;
                    }
                }
            }
        }
    }
    cover
}

#[cfg(test)]
/// A camera that looks along y.
pub(super) fn looks_along_y() -> Shot {
    let lens = trove_model::Lens {
        width_px: 400,
        height_px: 300,
        fx_px: 320.0,
        fy_px: 320.0,
        cx_px: 200.0,
        cy_px: 150.0,
        distortion: trove_model::Distortion::None,
    };
    let north = glam::DQuat::from_mat3(&glam::DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y));
    Shot::new("test", lens, trove_model::Pose::new(north, DVec3::Z * 2.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drop_draws_a_streak_as_long_as_it_falls_and_covers_as_much_as_its_disc() {
        let (shot, diameter_m, ahead_m) = (looks_along_y(), 3e-3, 1.5);
        let streak = Streak::new(&shot, DVec3::new(0.1, ahead_m, 2.0), diameter_m, DVec3::NEG_Z * 8.0).unwrap();
        let [from, to] = streak.ends_px;
        let length_px = 8.0 * EXPOSURE_S * 320.0 / ahead_m;
        assert!((to - from - DVec2::Y * length_px).length() < 0.05, "{from} {to} {length_px}");
        let far = Raster::filled(400, 300, f32::INFINITY);
        let covered: f32 = cover(std::slice::from_ref(&streak), &far).data.iter().sum();
        let disc_px = std::f64::consts::FRAC_PI_4 * (diameter_m * 320.0 / ahead_m).powi(2);
        assert!((f64::from(covered) / disc_px - 1.0).abs() < 0.05, "{covered} {disc_px}");
        let near = Raster::filled(400, 300, 1.0);
        assert!(cover(&[streak], &near).data.iter().all(|share| *share == 0.0));
    }
}
