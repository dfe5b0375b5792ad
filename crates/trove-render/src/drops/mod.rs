//! Drops on the glass before a lens: blurred, and each a small picture of wide surroundings.
//!
//! A drop turns neighbouring rays far apart, which a denoiser would take for noise, so what drops show comes from a picture of
//! its own that sees all that they see; they are laid over the shot's once both have been denoised.

mod glass;

use glam::{DVec2, DVec3, DVec4};
use rayon::prelude::*;
use trove_model::{Distortion, Lens, LensDrops, Raster, Shot, Shutter};

use crate::path::falling::field_rad;
use crate::path::streak::APERTURE_M;
use glass::{GLASS_M, Glass};

/// A drop turns no ray farther: one that leaves along its surface, and how far from its axis it came.
const TURN_RAD: f64 = 0.8;
/// Beyond the picture there are drops whose blur reaches into it.
const BEYOND_RAD: f64 = 0.12;
/// Of the picture of what drops see, pixels a radian: they show it many times smaller.
const WIDE_PX_RAD: f64 = 90.0;
/// Rays along each side of a pixel.
const SIDE: u32 = 3;

/// The picture that has all that drops before a shot's lens see: a fisheye's in the same place.
pub(crate) fn wide(shot: &Shot) -> Shot {
    let reach_rad = (field_rad(shot) + TURN_RAD).min(std::f64::consts::PI);
    let half_px = (reach_rad * WIDE_PX_RAD).ceil();
    let lens = Lens {
        width_px: 2 * half_px as u32,
        height_px: 2 * half_px as u32,
        fx_px: WIDE_PX_RAD,
        fy_px: WIDE_PX_RAD,
        cx_px: half_px,
        cy_px: half_px,
        distortion: Distortion::EQUIDISTANT,
    };
    Shot { lens, shutter: Shutter::INSTANT, seed: shot.seed.child("drops"), ..shot.clone() }
}

/// Lays drops over a shot's picture, given the [`wide`] one.
pub(crate) fn draw(shot: &Shot, drops: LensDrops, wide: &Raster<[f32; 3]>, picture: &mut Raster<[f32; 3]>) {
    let glass = Glass::new(drops, field_rad(shot) + BEYOND_RAD);
    let half_px = f64::from(wide.width) / 2.0;
    let around = Around { picture: wide, half_px };
    let radius_px = picture_of(picture, |x, y| {
        let direction = shot.lens.unproject(DVec2::new(x + 0.5, y + 0.5))?;
        Some(0.5 * APERTURE_M / GLASS_M / shot.lens.pixel_rad(direction))
    });
    let margin = radius_px.iter().flatten().fold(0.0, |most: f64, r| most.max(*r)).ceil() as usize + 1;
    let sharp = Sums::new(picture, margin, |at| in_focus(&shot.lens, &glass, &around, at));
    let (width, radii) = (picture.width as usize, &radius_px);
    picture.data.par_iter_mut().enumerate().for_each(|(i, rgb)| {
        let Some(radius) = radii[i] else { return };
        let seen = sharp.disc(i % width, i / width, radius);
        // Where there is no drop the picture keeps its bytes.
        if seen.w > 0.0 {
            let own = DVec3::from_array(rgb.map(f64::from));
            *rgb = (own * (1.0 - seen.w) + seen.truncate()).as_vec3().to_array();
        }
    });
}

/// What a function says of each pixel.
fn picture_of<T: Send>(size: &Raster<[f32; 3]>, of: impl Fn(f64, f64) -> T + Sync) -> Vec<T> {
    let (width, count) = (size.width as usize, size.data.len());
    (0..count).into_par_iter().map(|i| of((i % width) as f64, (i / width) as f64)).collect()
}

/// What the drops in a pixel's place would show if the lens were focused on them: radiance, and the share of the pixel that
/// they cover.
fn in_focus(lens: &Lens, glass: &Glass, around: &Around<'_>, corner: DVec2) -> DVec4 {
    let mut sum = DVec4::ZERO;
    for i in 0..SIDE * SIDE {
        let within = DVec2::new(f64::from(i % SIDE) + 0.5, f64::from(i / SIDE) + 0.5) / f64::from(SIDE);
        let Some(direction) = lens.unproject(corner + within) else { continue };
        let Some(drop) = glass.before(direction) else { continue };
        let radiance = drop.onwards(direction).map_or(DVec3::ZERO, |(on, share)| around.at(on) * share);
        sum += radiance.extend(1.0);
    }
    sum / f64::from(SIDE * SIDE)
}

/// The picture of what drops see.
struct Around<'a> {
    picture: &'a Raster<[f32; 3]>,
    /// From its middle to its rim.
    half_px: f64,
}

impl Around<'_> {
    /// Radiance from a direction, unit, Camera.
    fn at(&self, direction: DVec3) -> DVec3 {
        let across = direction.truncate();
        let place = across.normalize_or_zero() * across.length().atan2(direction.z) * WIDE_PX_RAD + self.half_px - 0.5;
        let last = f64::from(self.picture.width - 1);
        let place = place.clamp(DVec2::ZERO, DVec2::splat(last));
        let (low, part) = (place.floor(), place - place.floor());
        let pixel = |x: f64, y: f64| {
            let rgb = self.picture.at((low.x + x).min(last) as u32, (low.y + y).min(last) as u32);
            DVec3::from_array(rgb.map(f64::from))
        };
        let row = |y: f64| pixel(0.0, y).lerp(pixel(1.0, y), part.x);
        row(0.0).lerp(row(1.0), part.y)
    }
}

/// A picture with a margin, as sums along its rows.
struct Sums {
    margin: usize,
    /// Numbers in a row.
    stride: usize,
    /// Of all pixels of the row to the left.
    sums: Vec<DVec4>,
}

impl Sums {
    /// `of`: what a pixel holds, by its upper left corner.
    fn new(size: &Raster<[f32; 3]>, margin: usize, of: impl Fn(DVec2) -> DVec4 + Sync) -> Self {
        let (columns, rows) = (size.width as usize + 2 * margin, size.height as usize + 2 * margin);
        let stride = columns + 1;
        let mut sums = vec![DVec4::ZERO; stride * rows];
        sums.par_chunks_mut(stride).enumerate().for_each(|(y, row)| {
            for x in 0..columns {
                let corner = DVec2::new(x as f64, y as f64) - margin as f64;
                row[x + 1] = row[x] + of(corner);
            }
        });
        Self { margin, stride, sums }
    }

    /// The mean over a disc about a pixel's middle.
    fn disc(&self, x: usize, y: usize, radius: f64) -> DVec4 {
        let (mut sum, mut area) = (DVec4::ZERO, 0.0);
        let middle = (x + self.margin) as f64 + 0.5;
        let reach = radius.floor() as usize;
        for row in y + self.margin - reach..=y + self.margin + reach {
            let away = row as f64 - (y + self.margin) as f64;
            // A disc smaller than a pixel is the pixel.
            let half = (radius * radius - away * away).max(0.25).sqrt();
            let row = &self.sums[row * self.stride..(row + 1) * self.stride];
            sum += up_to(row, middle + half) - up_to(row, middle - half);
            area += 2.0 * half;
        }
        sum / area
    }
}

/// A row's sum up to a place.
fn up_to(row: &[DVec4], place: f64) -> DVec4 {
    let low = place.floor() as usize;
    let next = (low + 1).min(row.len() - 1);
    row[low] + (row[next] - row[low]) * (place - low as f64)
}
