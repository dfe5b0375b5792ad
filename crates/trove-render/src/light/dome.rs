//! A sky made ready: a picture of everything infinitely far away, and its cells.

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use trove_model::EnvironmentMap;
use trove_trace::light::{Picture, Sky};

use super::cells::SkyCells;

/// Radiance by direction.
pub(super) struct Dome {
    picture: EnvironmentMap,
    /// As in [`Sky`].
    is_smooth: bool,
    cells: SkyCells,
}

impl Dome {
    /// From a picture, with `side × side` cells a hemisphere, as for [`SkyCells::new`]; `share_below` scales how often
    /// directions below the horizon are drawn, which the ground mostly hides.
    pub(super) fn new(picture: EnvironmentMap, is_smooth: bool, side: usize, share_below: f64) -> Self {
        // As many look-ups a cell as it has texels, at least.
        let across = (picture.width as usize / 3).div_ceil(side).clamp(2, 16);
        let cells = SkyCells::new(side, across, share_below, |direction| view(&picture).linear(direction));
        Self { picture, is_smooth, cells }
    }

    /// To be looked up.
    pub(super) fn view(&self) -> Sky<'_> {
        Sky { picture: view(&self.picture), is_smooth: self.is_smooth, cells: self.cells.view() }
    }

    /// Irradiance of a level surface that looks up.
    pub(super) fn irradiance(&self) -> Vec3 {
        self.cells.irradiance()
    }
}

fn view(picture: &EnvironmentMap) -> Picture<'_> {
    Picture { width: picture.width as usize, height: picture.height as usize, rgb: &picture.rgb }
}

/// The direction at the centre of a texel of a `width × height` picture.
pub(super) fn direction_of(x: usize, y: usize, width: usize, height: usize) -> Vec3 {
    let azimuth = PI - TAU * (x as f32 + 0.5) / width as f32;
    let (sin_zenith, cos_zenith) = (PI * (y as f32 + 0.5) / height as f32).sin_cos();
    let (sin, cos) = azimuth.sin_cos();
    Vec3::new(sin_zenith * cos, sin_zenith * sin, cos_zenith)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    fn map(width: u32, height: u32, f: impl Fn(usize, usize) -> f32) -> EnvironmentMap {
        let texel = |i: u32| [f((i % width) as usize, (i / width) as usize); 3];
        EnvironmentMap { name: String::new(), width, height, rgb: (0..width * height).map(texel).collect() }
    }

    /// Directions that cover the sphere evenly, `n` of them (Fibonacci lattice).
    pub(in crate::light) fn even(n: u32) -> impl Iterator<Item = Vec3> {
        (0..n).map(move |i| {
            let z = 1.0 - 2.0 * (i as f32 + 0.5) / n as f32;
            let (sin, cos) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
            let r = (1.0 - z * z).sqrt();
            Vec3::new(r * cos as f32, r * sin as f32, z)
        })
    }

    #[test]
    fn what_is_drawn_adds_up_to_what_the_picture_shows() {
        let dome = Dome::new(
            map(64, 32, |x, y| if (x, y) == (15, 9) { 300.0 } else { 1.0 + y as f32 * 0.02 }),
            false,
            32,
            0.1,
        );
        let n = 400_000;
        let seen = |f: &dyn Fn(Vec3) -> f32| even(n).map(|d| f64::from(f(d))).sum::<f64>() / f64::from(n);
        let fine = seen(&|d| dome.view().radiance(d, 0.0).x * d.z.max(0.0)) * 4.0 * std::f64::consts::PI;
        let wide = seen(&|d| dome.view().radiance(d, 1.0).x * d.z.max(0.0)) * 4.0 * std::f64::consts::PI;
        let mut drawn = 0.0;
        for i in 0..400 * 400 {
            let u = [((i % 400) as f32 + 0.5) / 400.0, ((i / 400) as f32 + 0.5) / 400.0];
            let (d, radiance, pdf) = dome.view().cells.draw(Vec3::Z, u).unwrap();
            drawn += f64::from(radiance.x * d.z.max(0.0) / pdf) / 160_000.0;
        }
        let of_a_level_surface = f64::from(dome.irradiance().x);
        for (name, value) in [("wide", wide), ("drawn", drawn), ("irradiance", of_a_level_surface)] {
            assert!((value / fine - 1.0).abs() < 0.01, "{name}: {value} instead of {fine}");
        }
    }

    #[test]
    fn the_left_edge_looks_west_and_columns_run_through_north() {
        let dome = Dome::new(map(8, 4, |x, y| (10 * y + x) as f32), false, 8, 1.0);
        for (x, y) in [(0, 1), (3, 2), (7, 0)] {
            assert!((dome.view().radiance(direction_of(x, y, 8, 4), 0.0).x - (10 * y + x) as f32).abs() < 1e-3);
        }
    }

    #[test]
    fn a_smooth_picture_shows_no_texels_and_the_same_light() {
        let of = |is_smooth| Dome::new(map(64, 32, |x, _| if x < 32 { 0.0 } else { 1.0 }), is_smooth, 32, 1.0);
        let [linear, smooth] = [false, true].map(of);
        // Along the edge's normal, a hundred steps a texel.
        let bends = |dome: &Dome| {
            let at = |i: i32| dome.view().radiance(Vec3::new(1.0, 0.001 * -i as f32, 0.0).normalize(), 0.0).x;
            (-300..300).map(|i| (at(i - 1) - 2.0 * at(i) + at(i + 1)).abs()).fold(0.0, f32::max)
        };
        assert!(bends(&smooth) < 0.1 * bends(&linear), "{} {}", bends(&smooth), bends(&linear));
        let sum = |dome: &Dome| even(20_000).map(|d| dome.view().radiance(d, 0.0).x).sum::<f32>() / 20_000.0;
        assert!((sum(&smooth) - sum(&linear)).abs() < 1e-3 && (sum(&smooth) - 0.5).abs() < 1e-3);
    }
}
