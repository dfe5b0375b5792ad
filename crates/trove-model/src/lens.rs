//! The camera's projection.

use glam::{DVec2, DVec3};

/// A pinhole camera's intrinsics; pixel centres are at .5.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Image width.
    pub width_px: u32,
    /// Image height.
    pub height_px: u32,
    /// Focal length along x.
    pub fx_px: f64,
    /// Focal length along y.
    pub fy_px: f64,
    /// Principal point, x.
    pub cx_px: f64,
    /// Principal point, y.
    pub cy_px: f64,
}

impl Lens {
    /// Where a point in Camera falls, in pixels; `None` at or behind the camera (z < 1 mm).
    pub fn project(&self, point_camera: DVec3) -> Option<DVec2> {
        (point_camera.z >= 1e-3).then(|| {
            DVec2::new(
                self.fx_px * point_camera.x / point_camera.z + self.cx_px,
                self.fy_px * point_camera.y / point_camera.z + self.cy_px,
            )
        })
    }

    /// The direction in Camera, with z = 1, that falls on `pixel`.
    pub fn unproject(&self, pixel: DVec2) -> DVec3 {
        DVec3::new((pixel.x - self.cx_px) / self.fx_px, (pixel.y - self.cy_px) / self.fy_px, 1.0)
    }

    /// The same camera at `scale` times the resolution, rounded to whole pixels and never below one.
    pub fn scaled(&self, scale: f64) -> Self {
        let width_px = ((f64::from(self.width_px) * scale).round() as u32).max(1);
        let height_px = ((f64::from(self.height_px) * scale).round() as u32).max(1);
        let sx = f64::from(width_px) / f64::from(self.width_px);
        let sy = f64::from(height_px) / f64::from(self.height_px);
        Self {
            width_px,
            height_px,
            fx_px: self.fx_px * sx,
            fy_px: self.fy_px * sy,
            cx_px: self.cx_px * sx,
            cy_px: self.cy_px * sy,
        }
    }

    /// Whether a position in pixels lies in the image.
    pub fn contains(&self, pixel: DVec2) -> bool {
        pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < f64::from(self.width_px) && pixel.y < f64::from(self.height_px)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LENS: Lens =
        Lens { width_px: 1600, height_px: 900, fx_px: 1266.4, fy_px: 1260.0, cx_px: 816.3, cy_px: 491.5 };

    #[test]
    fn a_point_behind_the_camera_is_not_seen() {
        assert_eq!(LENS.project(DVec3::new(0.0, 0.0, -1.0)), None);
    }

    #[test]
    fn a_scaled_camera_sees_the_same_directions() {
        let (small, pixel) = (LENS.scaled(0.25), DVec2::new(123.0, 456.0));
        assert!((small.unproject(pixel * 0.25) - LENS.unproject(pixel)).length() < 1e-9);
    }

    proptest! {
        #[test]
        fn unprojecting_and_projecting_returns_the_pixel(x in 0.0..1600.0f64, y in 0.0..900.0f64, z in 0.1..500.0f64) {
            let pixel = DVec2::new(x, y);
            prop_assert!((LENS.project(LENS.unproject(pixel) * z).unwrap() - pixel).length() < 1e-9);
        }
    }
}
