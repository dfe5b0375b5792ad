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
    look_up: LookUp,
    cells: Cells,
}

/// How a picture is looked up between its texels.
#[derive(Clone, Copy)]
pub(super) enum LookUp {
    /// As sharp as a photograph is.
    Linear,
    /// By cubic B-splines: what is soft itself shows no texels, however many pixels each of them covers.
    Smooth,
}

impl Dome {
    /// From a picture, with `side × side` cells a hemisphere, as for [`Cells::new`]; `share_below` scales how often directions below the
    /// horizon are drawn, which the ground mostly hides.
    pub(super) fn new(picture: EnvironmentMap, look_up: LookUp, side: usize, share_below: f64) -> Self {
        // As many look-ups a cell as it has texels, at least.
        let across = (picture.width as usize / 3).div_ceil(side).clamp(2, 16);
        let cells = Cells::new(side, across, share_below, |direction| interpolated(&picture, direction));
        Self { picture, look_up, cells }
    }

    /// Radiance, for a ray that stands for a cone of `spread_rad`: a wide one does not need details, whose look-up waits
    /// for memory.
    pub(super) fn radiance(&self, direction: Vec3, spread_rad: f32) -> Vec3 {
        match self.look_up {
            _ if spread_rad >= WIDE_RAD => self.cells.radiance(direction),
            LookUp::Linear => interpolated(&self.picture, direction),
            LookUp::Smooth => smooth(&self.picture, direction),
        }
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
    let (left, top, x, y) = place(picture, direction);
    let upper = texel(picture, left, top).lerp(texel(picture, left + 1, top), x);
    let lower = texel(picture, left, top + 1).lerp(texel(picture, left + 1, top + 1), x);
    upper.lerp(lower, y)
}

/// A picture between its sixteen nearest texels, without an edge anywhere.
fn smooth(picture: &EnvironmentMap, direction: Vec3) -> Vec3 {
    let (left, top, x, y) = place(picture, direction);
    let weights = |t: f32| {
        let (t2, t3) = (t * t, t * t * t);
        [(1.0 - t).powi(3), 3.0 * t3 - 6.0 * t2 + 4.0, -3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0, t3].map(|w| w / 6.0)
    };
    let (columns, rows) = (weights(x), weights(y));
    let row = |i: isize| (0..4).map(|k| texel(picture, left - 1 + k, top - 1 + i) * columns[k as usize]).sum::<Vec3>();
    (0..4).map(|i| row(i) * rows[i as usize]).sum()
}

/// The texel at the upper left of a direction, and how far it lies from its centre to the next ones.
fn place(picture: &EnvironmentMap, direction: Vec3) -> (isize, isize, f32, f32) {
    let (u, v) = uv_of(direction);
    let (x, y) = (u * picture.width as f32 - 0.5, v * picture.height as f32 - 0.5);
    (x.floor() as isize, y.floor() as isize, x - x.floor(), y - y.floor())
}

/// A texel of a picture that goes on behind its sides.
fn texel(picture: &EnvironmentMap, x: isize, y: isize) -> Vec3 {
    let (width, height) = (picture.width as isize, picture.height as isize);
    Vec3::from(picture.rgb[(y.clamp(0, height - 1) * width + x.rem_euclid(width)) as usize])
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
        let dome = Dome::new(
            map(64, 32, |x, y| if (x, y) == (15, 9) { 300.0 } else { 1.0 + y as f32 * 0.02 }),
            LookUp::Linear,
            32,
            0.1,
        );
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
        let dome = Dome::new(map(8, 4, |x, y| (10 * y + x) as f32), LookUp::Linear, 8, 1.0);
        for (x, y) in [(0, 1), (3, 2), (7, 0)] {
            assert!((dome.radiance(direction_of(x, y, 8, 4), 0.0).x - (10 * y + x) as f32).abs() < 1e-3);
        }
        assert!((uv_of(Vec3::Y).0 - 0.25).abs() < 1e-6);
        assert!((uv_of(Vec3::X).0 - 0.5).abs() < 1e-6);
        assert!(uv_of(Vec3::Z).1 < 1e-6);
    }

    #[test]
    fn a_smooth_picture_shows_no_texels_and_the_same_light() {
        let of = |look_up| Dome::new(map(64, 32, |x, _| if x < 32 { 0.0 } else { 1.0 }), look_up, 32, 1.0);
        let [linear, smooth] = [LookUp::Linear, LookUp::Smooth].map(of);
        // Along the edge's normal, a hundred steps a texel.
        let bends = |dome: &Dome| {
            let at = |i: i32| dome.radiance(Vec3::new(1.0, 0.001 * -i as f32, 0.0).normalize(), 0.0).x;
            (-300..300).map(|i| (at(i - 1) - 2.0 * at(i) + at(i + 1)).abs()).fold(0.0, f32::max)
        };
        assert!(bends(&smooth) < 0.1 * bends(&linear), "{} {}", bends(&smooth), bends(&linear));
        let sum = |dome: &Dome| even(20_000).map(|d| dome.radiance(d, 0.0).x).sum::<f32>() / 20_000.0;
        assert!((sum(&smooth) - sum(&linear)).abs() < 1e-3 && (sum(&smooth) - 0.5).abs() < 1e-3);
    }
}
