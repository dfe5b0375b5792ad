//! A latitude-longitude picture of everything infinitely far away, and how directions are drawn from it.

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use trove_model::EnvironmentMap;

use super::cells::Cells;

/// From this width on a cone is wider than any cell of the sky.
const WIDE_RAD: f32 = 0.1;

/// Radiance by direction: a picture for narrow cones, and cells for wide ones and for drawing directions.
pub(super) struct Dome {
    picture: EnvironmentMap,
    cells: Cells,
}

impl Dome {
    /// From a picture, with `side × side` cells a hemisphere, as for [`Cells::new`]; `share_below` scales how often directions below the
    /// horizon are drawn, which the ground mostly hides.
    pub(super) fn new(picture: EnvironmentMap, side: usize, share_below: f64) -> Self {
        // As many look-ups a cell as it has texels, at least.
        let across = (picture.width as usize / 3).div_ceil(side).clamp(2, 16);
        let cells = Cells::new(side, across, share_below, |direction| interpolated(&picture, direction));
        Self { picture, cells }
    }

    /// Radiance, for a ray that stands for a cone of `spread_rad`: a wide one does not need details, whose look-up waits
    /// for memory.
    pub(super) fn radiance(&self, direction: Vec3, spread_rad: f32) -> Vec3 {
        if spread_rad < WIDE_RAD { interpolated(&self.picture, direction) } else { self.cells.radiance(direction) }
    }

    /// For a surface that is lit from the side of `normal` (from both sides if it is 0), a direction, what comes from
    /// around it, and the density over solid angle with which it is drawn; `None` where all is dark.
    pub(super) fn draw(&self, normal: Vec3, u: [f32; 2]) -> Option<(Vec3, Vec3, f32)> {
        self.cells.draw(normal, u)
    }

    /// Density over solid angle with which a direction is drawn for a surface.
    pub(super) fn pdf(&self, normal: Vec3, direction: Vec3) -> f32 {
        self.cells.pdf(normal, direction)
    }

    /// Irradiance of a level surface that looks up.
    pub(super) fn irradiance(&self) -> Vec3 {
        self.cells.irradiance()
    }
}

/// A picture between its four nearest texels.
fn interpolated(picture: &EnvironmentMap, direction: Vec3) -> Vec3 {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let (u, v) = uv_of(direction);
    let (x, y) = (u * width as f32 - 0.5, v * height as f32 - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let column = |i: f32| (i as isize).rem_euclid(width as isize) as usize;
    let row = |i: f32| (i.max(0.0) as usize).min(height - 1);
    let texel = |x: f32, y: f32| Vec3::from(picture.rgb[row(y) * width + column(x)]);
    let upper = texel(left, top).lerp(texel(left + 1.0, top), x - left);
    let lower = texel(left, top + 1.0).lerp(texel(left + 1.0, top + 1.0), x - left);
    upper.lerp(lower, y - top)
}

/// Where a direction lies in the picture, as shares of width and height.
fn uv_of(direction: Vec3) -> (f32, f32) {
    let azimuth = direction.y.atan2(direction.x);
    let from_zenith = direction.truncate().length().atan2(direction.z);
    ((0.5 - azimuth / TAU).clamp(0.0, 1.0), from_zenith / PI)
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
        let dome =
            Dome::new(map(64, 32, |x, y| if (x, y) == (15, 9) { 300.0 } else { 1.0 + y as f32 * 0.02 }), 32, 0.1);
        let n = 400_000;
        let seen = |f: &dyn Fn(Vec3) -> f32| even(n).map(|d| f64::from(f(d))).sum::<f64>() / f64::from(n);
        let fine = seen(&|d| dome.radiance(d, 0.0).x * d.z.max(0.0)) * 4.0 * std::f64::consts::PI;
        let wide = seen(&|d| dome.radiance(d, 1.0).x * d.z.max(0.0)) * 4.0 * std::f64::consts::PI;
        let mut drawn = 0.0;
        for i in 0..400 * 400 {
            let u = [((i % 400) as f32 + 0.5) / 400.0, ((i / 400) as f32 + 0.5) / 400.0];
            let (d, radiance, pdf) = dome.draw(Vec3::Z, u).unwrap();
            drawn += f64::from(radiance.x * d.z.max(0.0) / pdf) / 160_000.0;
        }
        let of_a_level_surface = f64::from(dome.irradiance().x);
        for (name, value) in [("wide", wide), ("drawn", drawn), ("irradiance", of_a_level_surface)] {
            assert!((value / fine - 1.0).abs() < 0.01, "{name}: {value} instead of {fine}");
        }
    }

    #[test]
    fn the_left_edge_looks_west_and_columns_run_through_north() {
        let dome = Dome::new(map(8, 4, |x, y| (10 * y + x) as f32), 8, 1.0);
        for (x, y) in [(0, 1), (3, 2), (7, 0)] {
            assert!((dome.radiance(direction_of(x, y, 8, 4), 0.0).x - (10 * y + x) as f32).abs() < 1e-3);
        }
        assert!((uv_of(Vec3::Y).0 - 0.25).abs() < 1e-6);
        assert!((uv_of(Vec3::X).0 - 0.5).abs() < 1e-6);
        assert!(uv_of(Vec3::Z).1 < 1e-6);
    }
}
