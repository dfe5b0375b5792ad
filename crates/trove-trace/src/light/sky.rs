//! A latitude-longitude picture of everything infinitely far away, and how directions are drawn from it.

use core::f32::consts::{PI, TAU};

use glam::Vec3;

use super::cells::Cells;
use crate::math::{atan2, floor, length};

/// From this width on a cone is wider than any cell of the sky.
const WIDE_RAD: f32 = 0.1;

/// Radiance by direction: a picture for narrow cones, and cells for wide ones and for drawing directions.
#[derive(Clone, Copy)]
pub struct Sky<'a> {
    /// For narrow cones.
    pub picture: Picture<'a>,
    /// Whether the picture is looked up by cubic B-splines: what is soft itself shows no texels, however many pixels each of
    /// them covers. Else it is as sharp as a photograph is.
    pub is_smooth: bool,
    /// For wide ones.
    pub cells: Cells<'a>,
}

/// Radiance by azimuth and angle from the zenith.
#[derive(Clone, Copy)]
pub struct Picture<'a> {
    /// Texels of a row, all around from west through north.
    pub width: usize,
    /// Rows from the zenith to the nadir.
    pub height: usize,
    /// Row by row.
    pub rgb: &'a [[f32; 3]],
}

impl Sky<'_> {
    /// Radiance, for a ray that stands for a cone of `spread_rad`: a wide one does not need details, whose look-up waits
    /// for memory.
    #[inline]
    pub fn radiance(&self, direction: Vec3, spread_rad: f32) -> Vec3 {
        if spread_rad >= WIDE_RAD {
            self.cells.radiance(direction)
        } else if self.is_smooth {
            self.picture.smooth(direction)
        } else {
            self.picture.linear(direction)
        }
    }
}

impl Picture<'_> {
    /// Between its four nearest texels.
    #[inline]
    pub fn linear(&self, direction: Vec3) -> Vec3 {
        let (left, top, x, y) = self.place(direction);
        let upper = self.texel(left, top).lerp(self.texel(left + 1, top), x);
        let lower = self.texel(left, top + 1).lerp(self.texel(left + 1, top + 1), x);
        upper.lerp(lower, y)
    }

    /// Between its sixteen nearest texels, without an edge anywhere.
    #[inline]
    fn smooth(&self, direction: Vec3) -> Vec3 {
        let (left, top, x, y) = self.place(direction);
        let weights = |t: f32| {
            let (t2, t3, back) = (t * t, t * t * t, 1.0 - t);
            [back * back * back, 3.0 * t3 - 6.0 * t2 + 4.0, -3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0, t3].map(|w| w / 6.0)
        };
        let (columns, rows) = (weights(x), weights(y));
        let mut sum = Vec3::ZERO;
        for (row, weight) in (top - 1..).zip(rows) {
            let mut of_row = Vec3::ZERO;
            for (column, weight) in (left - 1..).zip(columns) {
                of_row += self.texel(column, row) * weight;
            }
            sum += of_row * weight;
        }
        sum
    }

    /// The texel at the upper left of a direction, and how far it lies from its centre to the next ones.
    #[inline(always)]
    fn place(&self, direction: Vec3) -> (i32, i32, f32, f32) {
        let (u, v) = uv_of(direction);
        let (x, y) = (u * self.width as f32 - 0.5, v * self.height as f32 - 0.5);
        let (left, top) = (floor(x), floor(y));
        (left as i32, top as i32, x - left, y - top)
    }

    /// A texel; the picture goes on behind its sides.
    #[inline(always)]
    fn texel(&self, x: i32, y: i32) -> Vec3 {
        let (width, height) = (self.width as i32, self.height as i32);
        Vec3::from_array(self.rgb[(y.clamp(0, height - 1) * width + x.rem_euclid(width)) as usize])
    }
}

/// Where a direction lies in a picture, as shares of width and height.
#[inline]
fn uv_of(direction: Vec3) -> (f32, f32) {
    let azimuth = atan2(direction.y, direction.x);
    let from_zenith = atan2(length(direction.truncate()), direction.z);
    ((0.5 - azimuth / TAU).clamp(0.0, 1.0), from_zenith / PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_left_edge_looks_west_and_the_middle_east() {
        assert!((uv_of(Vec3::Y).0 - 0.25).abs() < 1e-6);
        assert!((uv_of(Vec3::X).0 - 0.5).abs() < 1e-6);
        assert!(uv_of(Vec3::Z).1 < 1e-6);
    }
}
