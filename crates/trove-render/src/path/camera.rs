//! Rays from the camera.

use glam::{DVec2, Vec3};
use trove_model::Shot;
use trove_trace::path::Cone;

use crate::motion::{MIDDLE, ray_time};
use crate::ray::Ray;

/// The ray through a position in the image and the cone that a pixel sees; `None` outside the lens's image circle.
///
/// `within`, 0 to 1, is where in its row's exposure the ray leaves.
pub(super) fn camera_ray(shot: &Shot, pixel: DVec2, within: f32) -> Option<(Ray, Cone)> {
    let direction_camera = shot.lens.unproject(pixel)?;
    let (world_from_camera, time) = if shot.shutter.is_instant() {
        (shot.world_from_camera, MIDDLE)
    } else {
        let row = (pixel.y / f64::from(shot.lens.height_px)).clamp(0.0, 1.0);
        let time_s = shot.shutter.time_s(row, f64::from(within));
        (shot.world_from_camera_at(time_s), ray_time(time_s))
    };
    let direction: Vec3 = world_from_camera.vector(direction_camera).as_vec3();
    let spread_rad = shot.lens.pixel_rad(direction_camera) as f32;
    let ray = Ray { time, ..Ray::new(world_from_camera.translation.as_vec3(), direction) };
    Some((ray, Cone { width_m: 0.0, spread_rad }))
}
