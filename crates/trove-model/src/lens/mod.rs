//! The camera's projection.

mod distortion;

use glam::{DVec2, DVec3};

pub use distortion::Distortion;

/// Nothing nearer to the plane of the camera than this is projected by a lens that sees less than a half-space, metres.
const NEAR_M: f64 = 1e-3;

/// A camera's intrinsics; pixel centres are at .5.
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
    /// How it differs from a pinhole.
    pub distortion: Distortion,
}

impl Lens {
    /// Where a point in Camera falls, in pixels; `None` at or behind the camera (z < 1 mm; a fisheye sees behind it) and
    /// outside the lens's reach.
    pub fn project(&self, point_camera: DVec3) -> Option<DVec2> {
        if point_camera.z < NEAR_M && !self.distortion.sees_behind() {
            return None;
        }
        self.distortion.image_from_direction(point_camera).map(|p| self.pixel(p))
    }

    /// The unit direction in Camera that falls on `pixel`; `None` outside the lens's image circle.
    pub fn unproject(&self, pixel: DVec2) -> Option<DVec3> {
        let image = DVec2::new((pixel.x - self.cx_px) / self.fx_px, (pixel.y - self.cy_px) / self.fy_px);
        self.distortion.direction_from_image(image)
    }

    /// As [`Lens::project`], with directions outside the lens's reach turned towards the axis until they lie on its
    /// rim; for outlines of what is seen in part. z must be positive unless the lens sees behind the camera.
    pub fn project_onto_rim(&self, point_camera: DVec3) -> DVec2 {
        self.pixel(self.distortion.image_onto_rim(point_camera))
    }

    /// About the angle that a pixel covers around a unit direction in Camera, radians.
    pub fn pixel_rad(&self, direction_camera: DVec3) -> f64 {
        let at_centre = 1.0 / (self.fx_px * self.fy_px).sqrt();
        if self.distortion.sees_behind() { at_centre } else { at_centre * direction_camera.z }
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
            distortion: self.distortion,
        }
    }

    /// The same camera with the largest part of its picture's middle that has the aspect `width_px` : `height_px`, at that
    /// size. Pixels keep their shape.
    pub fn cropped(&self, width_px: u32, height_px: u32) -> Self {
        let (width, height) = (f64::from(self.width_px), f64::from(self.height_px));
        let scale = (f64::from(width_px) / width).max(f64::from(height_px) / height);
        Self {
            width_px,
            height_px,
            fx_px: self.fx_px * scale,
            fy_px: self.fy_px * scale,
            cx_px: (self.cx_px - 0.5 * width) * scale + 0.5 * f64::from(width_px),
            cy_px: (self.cy_px - 0.5 * height) * scale + 0.5 * f64::from(height_px),
            distortion: self.distortion,
        }
    }

    /// Whether a position in pixels lies in the image.
    pub fn contains(&self, pixel: DVec2) -> bool {
        pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < f64::from(self.width_px) && pixel.y < f64::from(self.height_px)
    }

    fn pixel(&self, image: DVec2) -> DVec2 {
        DVec2::new(self.fx_px * image.x + self.cx_px, self.fy_px * image.y + self.cy_px)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PINHOLE: Lens = Lens {
        width_px: 1600,
        height_px: 900,
        fx_px: 1266.4,
        fy_px: 1260.0,
        cx_px: 816.3,
        cy_px: 491.5,
        distortion: Distortion::None,
    };

    fn lens(width_px: u32, height_px: u32, [fx_px, fy_px, cx_px, cy_px]: [f64; 4], distortion: Distortion) -> Lens {
        Lens { width_px, height_px, fx_px, fy_px, cx_px, cy_px, distortion }
    }

    /// KITTI's colour camera 2 of 26 September 2011 as published, and typical ones: radial, the rational model, and two
    /// fisheyes that see 180° and 190°.
    fn typical() -> [Lens; 5] {
        let brown = |c: &[f64]| Distortion::brown_conrady(c).unwrap();
        let fisheye = |c: &[f64]| Distortion::kannala_brandt(c).unwrap();
        [
            lens(
                1392,
                512,
                [959.791, 956.9251, 696.0217, 224.1806],
                brown(&[-0.369_148_1, 0.196_868_1, 0.001_353_473, 0.000_567_758_7, -0.067_707_05]),
            ),
            lens(2048, 1550, [1683.5, 1683.5, 1025.4, 775.9], brown(&[-0.263_6, -0.058_66, 0.0, 0.0, 0.094_4])),
            lens(1280, 960, [913.2, 912.8, 638.4, 483.1], brown(&[0.54, -2.66, 7e-4, -2e-4, 1.53, 0.42, -2.49, 1.46])),
            lens(1024, 1024, [320.0, 320.0, 512.0, 512.0], fisheye(&[0.0, 0.0, 0.0, 0.0])),
            lens(1280, 966, [339.749, 339.749, 644.5, 480.1], fisheye(&[-0.0166, -0.0022, 0.001_1, -0.000_18])),
        ]
    }

    #[test]
    fn a_point_falls_where_opencv_has_it() {
        // OpenCV's documented formulas, worked out by hand for x/z = 0.5, y/z = 0.25.
        let point = DVec3::new(1.0, 0.5, 2.0);
        let bent = Distortion::brown_conrady(&[-0.3, 0.1, 0.01, -0.02]).unwrap();
        let seen = lens(1600, 900, [1000.0, 1000.0, 800.0, 450.0], bent).project(point).unwrap();
        assert!(seen.distance(DVec2::new(800.0 + 444.257_812_5, 450.0 + 228.378_906_25)) < 1e-9, "{seen}");
        // A fisheye's angle θ from the axis is at f·θ·(1 + k1·θ²): 45° to the right here.
        let fisheye = Distortion::kannala_brandt(&[0.1]).unwrap();
        let seen = lens(1600, 900, [500.0, 500.0, 800.0, 450.0], fisheye).project(DVec3::new(3.0, 0.0, 3.0)).unwrap();
        let angle = std::f64::consts::FRAC_PI_4;
        let expected = DVec2::new(800.0 + 500.0 * angle * (1.0 + 0.1 * angle * angle), 450.0);
        assert!(seen.distance(expected) < 1e-9, "{seen}");
    }

    #[test]
    fn a_point_behind_a_pinhole_is_not_seen_and_one_beside_a_fisheye_is() {
        assert_eq!(PINHOLE.project(DVec3::new(0.0, 0.0, -1.0)), None);
        let fisheye = typical()[3];
        // Without coefficients the distance from the middle is the angle itself.
        let beside = fisheye.project(DVec3::new(2.0, 0.0, 0.0)).unwrap();
        assert!((beside.x - 512.0 - 320.0 * std::f64::consts::FRAC_PI_2).abs() < 1e-9, "{beside}");
        assert!(fisheye.project(DVec3::new(0.1, 0.0, -1.0)).is_some());
    }

    #[test]
    fn a_scaled_camera_sees_the_same_directions() {
        for lens in [PINHOLE].into_iter().chain(typical()) {
            let (small, pixel) = (lens.scaled(0.5), DVec2::new(523.0, 256.0));
            assert!((small.unproject(pixel * 0.5).unwrap() - lens.unproject(pixel).unwrap()).length() < 1e-9);
        }
    }

    #[test]
    fn a_cropped_camera_sees_the_middle_of_the_picture() {
        // 1600×900 keeps its height: 1200 of its columns, at 8/15.
        let small = PINHOLE.cropped(640, 480);
        let scale = 480.0 / 900.0;
        assert!((small.fx_px - 1266.4 * scale).abs() < 1e-9 && (small.fy_px - 1260.0 * scale).abs() < 1e-9);
        let (cx_px, cy_px) = ((816.3 - 200.0) * scale, 491.5 * scale);
        assert!((small.cx_px - cx_px).abs() < 1e-9 && (small.cy_px - cy_px).abs() < 1e-9);
        // Wider than the recording: all columns, of the rows the middle.
        assert!((PINHOLE.cropped(800, 200).cy_px - (491.5 / 2.0 - 125.0)).abs() < 1e-9);
        for lens in [PINHOLE].into_iter().chain(typical()) {
            let (width, height) = (f64::from(lens.width_px), f64::from(lens.height_px));
            let small = lens.cropped(300, 200);
            let pixels_a_pixel = lens.fx_px / small.fx_px;
            for corner in [DVec2::ZERO, DVec2::new(300.0, 200.0), DVec2::new(31.5, 120.5)] {
                let pixel = (corner - DVec2::new(150.0, 100.0)) * pixels_a_pixel + DVec2::new(width, height) * 0.5;
                assert!(pixel.cmpge(DVec2::splat(-1e-9)).all() && pixel.x <= width + 1e-9 && pixel.y <= height + 1e-9);
                let (whole, part) = (lens.unproject(pixel), small.unproject(corner));
                assert_eq!(whole.is_some(), part.is_some(), "{lens:?}");
                assert!(whole.zip(part).is_none_or(|(whole, part)| (whole - part).length() < 1e-9), "{lens:?}");
            }
        }
        assert_eq!(PINHOLE.cropped(1600, 900), PINHOLE);
    }

    #[test]
    fn all_of_a_cameras_picture_is_in_its_lens_reach() {
        for lens in typical().iter().take(3) {
            for (x, y) in (0..=8).flat_map(|x| (0..=8).map(move |y| (f64::from(x) / 8.0, f64::from(y) / 8.0))) {
                let pixel = DVec2::new(x * f64::from(lens.width_px), y * f64::from(lens.height_px));
                assert!(lens.unproject(pixel).is_some(), "{lens:?} {pixel}");
            }
        }
    }

    #[test]
    fn what_folds_back_into_the_picture_is_not_seen() {
        // OpenCV would put this direction, 63° off the axis, beside one that is 20° off.
        let kitti = typical()[0];
        assert_eq!(kitti.project(DVec3::new(2.0, 0.0, 1.0)), None);
        let rim = kitti.project_onto_rim(DVec3::new(2.0, 0.0, 1.0));
        assert!(rim.x > 1300.0, "{rim}");
        assert!(
            (kitti.project_onto_rim(DVec3::new(0.2, 0.1, 1.0)) - kitti.project(DVec3::new(0.2, 0.1, 1.0)).unwrap())
                .length()
                < 1e-12
        );
    }

    #[test]
    fn a_pixel_outside_the_image_circle_shows_nothing() {
        // r = θ (1 − 0.1 θ²) grows until θ = 1.83, r = 1.22.
        let narrow = lens(800, 800, [200.0, 200.0, 400.0, 400.0], Distortion::kannala_brandt(&[-0.1]).unwrap());
        assert_eq!(narrow.unproject(DVec2::new(10.0, 10.0)), None);
        assert!(narrow.unproject(DVec2::new(400.0 + 243.0, 400.0)).is_some());
        assert_eq!(narrow.unproject(DVec2::new(400.0 + 245.0, 400.0)), None);
    }

    /// Of the whole sphere.
    const PANORAMA: Lens = Lens {
        width_px: 2000,
        height_px: 1000,
        fx_px: 1000.0 / std::f64::consts::PI,
        fy_px: 1000.0 / std::f64::consts::PI,
        cx_px: 1000.0,
        cy_px: 500.0,
        distortion: Distortion::Equirectangular,
    };

    #[test]
    fn a_panorama_sees_all_around_with_equal_steps_of_both_angles() {
        for (direction, pixel) in [
            (DVec3::Z, [1000.0, 500.0]),
            (DVec3::X, [1500.0, 500.0]),
            (DVec3::new(-1.0, 0.0, -1.0), [250.0, 500.0]),
            (DVec3::new(0.0, 1.0, 1.0), [1000.0, 750.0]),
            (DVec3::new(1e-12, 0.0, -1.0), [2000.0, 500.0]),
        ] {
            let found = PANORAMA.project(direction).unwrap();
            assert!(found.distance(DVec2::from_array(pixel)) < 1e-6, "{direction}: {found}");
        }
        assert_eq!(PANORAMA.unproject(DVec2::new(-1.0, 500.0)), None);
    }

    proptest! {
        #[test]
        fn unprojecting_and_projecting_returns_the_pixel(x in 0.0..1.0f64, y in 0.0..1.0f64, far in 0.1..500.0f64) {
            for lens in [PINHOLE, PANORAMA].into_iter().chain(typical()) {
                let pixel = DVec2::new(x * f64::from(lens.width_px), y * f64::from(lens.height_px));
                let Some(direction) = lens.unproject(pixel) else { continue };
                prop_assert!((direction.length() - 1.0).abs() < 1e-12);
                let back = lens.project(direction * far);
                prop_assert!(back.is_some_and(|back| (back - pixel).length() < 1e-6), "{back:?} {pixel} {lens:?}");
            }
        }

        #[test]
        fn no_lens_makes_a_panic_or_a_false_round_trip(
            c in prop::collection::vec(-2.0..2.0f64, 4..=8), x in -4.0..4.0f64, y in -4.0..4.0f64
        ) {
            let all = [Distortion::brown_conrady(&c), Distortion::kannala_brandt(&c[..4])];
            for distortion in all.into_iter().flatten() {
                let lens = lens(200, 200, [100.0, 100.0, 100.0, 100.0], distortion);
                let pixel = DVec2::new(x, y) * 100.0;
                if let Some(back) = lens.unproject(pixel).and_then(|d| lens.project(d)) {
                    prop_assert!((back - pixel).length() < 1e-6, "{back} {pixel} {lens:?}");
                }
            }
        }
    }
}
