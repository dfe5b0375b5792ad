//! Into which directions lamps shine.

use core::f32::consts::PI;

use glam::{Mat3, Vec3};

use crate::math::{atan2, length};

/// Radians to degrees.
const DEG: f32 = 180.0 / PI;

/// Tables of how brightly lamps shine into each direction, as `trove_model::Beam` has them, one after the other.
#[derive(Clone, Copy)]
pub struct Beams<'a> {
    /// Where each one's numbers are.
    pub tables: &'a [BeamTable],
    /// Of each beam: azimuths, elevations, and a row of shares for each elevation.
    pub numbers: &'a [f32],
}

/// Where a beam's numbers are.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct BeamTable {
    /// Of the azimuths.
    pub first: u32,
    /// How many.
    pub azimuths: u32,
    /// How many.
    pub elevations: u32,
}

/// A beam, turned.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Aim {
    /// Takes World's directions to the mesh's.
    pub mesh_from_world: Mat3,
    /// Index of its beam.
    pub beam: u32,
}

impl Beams<'_> {
    /// Share of the radiance that leaves into a direction of World, of any length but 0.
    #[inline]
    pub fn aimed(&self, aim: &Aim, direction: Vec3) -> f32 {
        self.share(aim.beam, aim.mesh_from_world * direction)
    }

    /// Share into a direction of the mesh: bilinear between those of the table, and as at its edge beyond.
    #[inline]
    pub fn share(&self, beam: u32, direction: Vec3) -> f32 {
        let BeamTable { first, azimuths, elevations } = self.tables[beam as usize];
        let numbers = &self.numbers[first as usize..];
        let (width, height) = (azimuths as usize, elevations as usize);
        let (azimuths, rest) = (&numbers[..width], &numbers[width..]);
        let (elevations, shares) = (&rest[..height], &rest[height..]);

        let azimuth = atan2(direction.y, direction.x);
        let elevation = atan2(direction.z, length(direction.truncate()));
        let (x, fx) = between(azimuths, azimuth * DEG);
        let (y, fy) = between(elevations, elevation * DEG);
        let (x1, y1) = ((x + 1).min(width - 1), (y + 1).min(height - 1));
        let share = |x: usize, y: usize| shares[y * width + x];
        let lower = share(x, y) * (1.0 - fx) + share(x1, y) * fx;
        let upper = share(x, y1) * (1.0 - fx) + share(x1, y1) * fx;
        lower * (1.0 - fy) + upper * fy
    }
}

/// Index of the last value that is not beyond `at`, and how far `at` is on its way to the next.
#[inline(always)]
fn between(values: &[f32], at: f32) -> (usize, f32) {
    let above = values.partition_point(|value| *value <= at);
    let below = above.saturating_sub(1);
    if above == 0 || above == values.len() {
        return (below, 0.0);
    }
    (below, (at - values[below]) / (values[above] - values[below]))
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use trove_model::{Beam, Seed};

    use super::*;

    #[test]
    fn shares_are_those_of_the_model() {
        let beams: [(&[f32], &[f32]); 3] = [
            (&[-10.0, 0.0, 20.0], &[-5.0, 5.0]),
            (&[0.0], &[-90.0, -30.0, 0.0, 45.0]),
            (&[-180.0, -90.0, 0.0, 90.0, 180.0], &[-90.0, 90.0]),
        ];
        let (mut random, mut tables, mut numbers, mut of_model) =
            (Seed(4).random(), Vec::new(), Vec::new(), Vec::new());
        for (azimuths, elevations) in beams {
            let shares: Vec<f32> = (0..azimuths.len() * elevations.len()).map(|_| random.unit() as f32).collect();
            let (width, height) = (azimuths.len() as u32, elevations.len() as u32);
            tables.push(BeamTable { first: numbers.len() as u32, azimuths: width, elevations: height });
            numbers.extend([azimuths, elevations, &shares].concat());
            of_model.push(Beam::new(azimuths.to_vec(), elevations.to_vec(), shares).unwrap());
        }
        let flat = Beams { tables: &tables, numbers: &numbers };
        for _ in 0..10_000 {
            let direction = Vec3::from_array(core::array::from_fn(|_| random.range(-2.0, 2.0) as f32));
            for (i, beam) in (0..).zip(&of_model) {
                let (here, there) = (flat.share(i, direction), beam.share(direction));
                assert!((here - there).abs() < 1e-4, "{direction}: {here} and {there}");
            }
        }
    }
}
