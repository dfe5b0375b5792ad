//! What comes down on surfaces, and what shelters from it.

use core::f32::consts::TAU;

use glam::{Vec2, Vec3, vec2};

use crate::material::holds_snow;
use crate::math::{floor, floor2, turn};
use crate::ray::Ray;
use crate::surface::{Exposure, Surface};

/// What is left of snow on vehicles that are on their way.
const DRIVEN: f32 = 0.45;
/// What falls slants by so much here and there, as a tangent, and the width of what has one slant, metres: where it ends is
/// uneven.
const SLANT: f32 = 0.08;
const SLANT_WIDE_M: f32 = 0.15;
/// Nothing nearer shelters: surfaces are layers of paint and patches, millimetres apart, metres.
const LAYERS_M: f32 = 0.03;
/// Wheels and feet sway by so much: the edge of a track is no line, metres.
const SWAY_M: f32 = 0.15;

/// What snow an instance bears.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub enum Bears {
    /// Where wheels and feet are.
    Ground,
    /// Less than what falls, which moves on with it.
    Driven,
    /// This share of what falls.
    Share(f32),
}

/// What comes down in the open.
#[derive(Clone, Copy, Debug)]
pub struct ComesDown<'a> {
    /// Share of level surfaces that snow covers, 0 to 1; `None` where there is no snow.
    pub snow: Option<f32>,
    /// What wheels and feet have left of it; `None`: it lies as it fell.
    pub left: Option<SnowLeft<'a>>,
    /// Millimetres of rain an hour.
    pub rain_mm_h: f32,
    /// When this is, seconds.
    pub moment_s: f32,
}

/// Shares of snow that are left on the ground, over World's plane; all of it outside.
#[derive(Clone, Copy, Debug)]
pub struct SnowLeft<'a> {
    /// World position of the south-west corner, metres; rows run north.
    pub origin: Vec2,
    /// Side of a cell, metres.
    pub cell_m: f32,
    /// Cells along x and y.
    pub size: [u32; 2],
    /// Row by row; 255: all of it.
    pub shares: &'a [u8],
}

impl SnowLeft<'_> {
    /// Share at a position, 0 to 1, bilinear between the cells' middles.
    pub fn at(&self, position: Vec2) -> f32 {
        let g = (position - self.origin) / self.cell_m - 0.5;
        let low = floor2(g);
        let (f, low) = (g - low, low.as_ivec2());
        let [width, height] = self.size;
        let share = |dx: i32, dy: i32| {
            let (x, y) = (low.x + dx, low.y + dy);
            let is_inside = x >= 0 && y >= 0 && x < width as i32 && y < height as i32;
            let place = || y as usize * width as usize + x as usize;
            if is_inside { f32::from(self.shares[place()]) / 255.0 } else { 1.0 }
        };
        let south = share(0, 0) * (1.0 - f.x) + share(1, 0) * f.x;
        let north = share(0, 1) * (1.0 - f.x) + share(1, 1) * f.x;
        south * (1.0 - f.y) + north * f.y
    }

    /// The mean share around a point, and how fast it grows along x and y.
    fn around(&self, at: Vec2) -> (f32, Vec2) {
        let [west, east] = [-SWAY_M, SWAY_M].map(|off_m| self.at(at + Vec2::X * off_m));
        let [south, north] = [-SWAY_M, SWAY_M].map(|off_m| self.at(at + Vec2::Y * off_m));
        ((west + east + south + north) / 4.0, vec2(east - west, north - south) / (2.0 * SWAY_M))
    }
}

/// What comes down on a point of what bears so much snow, as a ray sees it; `blocked` tells whether another ray meets
/// something that shelters.
#[inline(always)]
pub fn exposure(
    what: &ComesDown<'_>,
    bears: Bears,
    surface: &Surface,
    ray: &Ray,
    blocked: impl FnOnce(&Ray) -> bool,
) -> Exposure {
    let bare = Exposure::BARE;
    if !holds_snow(surface.outward_z()) || bears == Bears::Share(0.0) {
        return bare;
    }
    let at = surface.point.truncate() / SLANT_WIDE_M;
    let ([sin_x, _], [_, cos_y]) = (turned(at.x), turned(1.7 * at.y));
    let ([sin_y, _], [_, cos_x]) = (turned(at.y), turned(1.3 * at.x));
    let up = Vec3::Z + SLANT * Vec3::new(sin_x * cos_y, sin_y * cos_x, 0.0);
    if blocked(&Ray { t_min: LAYERS_M, ..ray.then(surface.leave(Vec3::Z), up) }) {
        return Exposure { is_open: false, ..bare };
    }
    let bare = Exposure { rain_mm_h: what.rain_mm_h, moment_s: what.moment_s, ..bare };
    let Some(snow) = what.snow else { return bare };
    match (bears, &what.left) {
        (Bears::Ground, Some(left)) => {
            let (left, left_grows) = left.around(surface.point.truncate());
            Exposure { snow, left, left_grows, ..bare }
        }
        (Bears::Ground, None) => Exposure { snow, ..bare },
        (Bears::Driven, _) => Exposure { snow: snow * DRIVEN, moves: true, ..bare },
        (Bears::Share(share), _) => Exposure { snow: snow * share, ..bare },
    }
}

/// Sine and cosine of an angle, radians.
fn turned(angle: f32) -> [f32; 2] {
    let turns = angle / TAU;
    let (sin, cos) = turn(turns - floor(turns));
    [sin, cos]
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;

    #[test]
    fn shares_are_those_of_cells_in_their_middles_and_all_of_it_outside() {
        let shares: Vec<u8> = (0..12).map(|i| (i % 4 * 20 + i / 4 * 60) as u8).collect();
        let left = SnowLeft { origin: vec2(-1.0, 2.0), cell_m: 0.5, size: [4, 3], shares: &shares };
        for (x, y) in [(0, 0), (3, 0), (1, 2)] {
            let middle = vec2(-1.0, 2.0) + (vec2(x as f32, y as f32) + 0.5) * 0.5;
            let expected = (x * 20 + y * 60) as f32 / 255.0;
            assert!((left.at(middle) - expected).abs() < 1e-6, "{x} {y}");
        }
        assert!((left.at(vec2(-0.5, 2.25)) - 10.0 / 255.0).abs() < 1e-6);
        assert_eq!(left.at(vec2(50.0, -3.0)), 1.0);
    }

    #[test]
    fn sines_are_those_of_any_angle() {
        for angle in [-40.0f32, -3.0, 0.0, 0.5, 100.0] {
            let [sin, cos] = turned(angle);
            assert!((sin - angle.sin()).abs() < 1e-5 && (cos - angle.cos()).abs() < 1e-5, "{angle}");
        }
    }
}
