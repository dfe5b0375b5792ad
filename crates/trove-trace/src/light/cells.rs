//! The sphere of directions in a few thousand cells: what wide cones see of it, and how directions are drawn from it.

use glam::Vec3;

use super::cdf::Cdf;
use super::patches::{ACROSS, BELOW, Patches};
use crate::math::unit;

/// Mean radiance by direction, with directions drawn in proportion to what comes from them to a surface, roughly: first a
/// patch by its light and the surface's normal, then one of the patch's cells by its brightness.
///
/// The upper and the lower hemisphere are squares of `side × side` cells, upper first: an octahedron's half flattened
/// and turned by 45° (Praun and Hoppe 2003), which needs no function but a division.
#[derive(Clone, Copy)]
pub struct Cells<'a> {
    /// A multiple of [`ACROSS`].
    pub side: usize,
    /// Row by row.
    pub cells: &'a [Cell],
    /// How patches are drawn.
    pub patches: &'a Patches,
    /// How cells of each patch are: above the horizon row by row, and that of all below.
    pub within: &'a [Within],
    /// As in [`Cdf`], of all patches, one after the other: of the rows, and then of the cells of each row.
    pub cumulative: &'a [f32],
    /// As in [`Cdf`], likewise.
    pub guide: &'a [u32],
}

/// What is seen in a cell.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Cell {
    /// On average over it.
    pub radiance: Vec3,
    /// Density over the squares' area with which it is drawn from its patch.
    pub density: f32,
}

/// The square of cells that makes a patch.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Within {
    /// Its first row, counted through both hemispheres.
    pub row: u32,
    /// Its first column.
    pub column: u32,
    /// Cells along each side.
    pub size: u32,
    /// Where its numbers begin in [`Cells::guide`].
    pub guide: u32,
    /// Where they begin in [`Cells::cumulative`].
    pub cumulative: u32,
}

impl<'a> Cells<'a> {
    /// For a surface that is lit from the side of `normal` (from both sides if it is 0), a direction, its mean radiance,
    /// and the density over solid angle with which it is drawn; `None` where all is dark.
    #[inline]
    pub fn draw(&self, normal: Vec3, u: [f32; 2]) -> Option<(Vec3, Vec3, f32)> {
        let (patch, probability, u) = self.patches.draw(normal, u)?;
        let within = &self.within[patch];
        let (row, along_row) = self.cdf(within, 0).draw(u[0]);
        let (column, along_column) = self.cdf(within, 1 + row).draw(u[1]);
        let (row, column) = (within.row as usize + row, within.column as usize + column);
        let cell = &self.cells[row * self.side + column];
        let share = |cell: usize, along: f32| (cell as f32 + along) / self.side as f32;
        let direction = direction_at(row >= self.side, share(column, along_column), share(row % self.side, along_row));
        Some((direction, cell.radiance, probability * cell.density / solid_angle_of_area(direction)))
    }

    /// Mean radiance around a direction.
    #[inline]
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        self.cells[self.at(direction).0].radiance
    }

    /// Density over solid angle with which a direction is drawn for a surface.
    #[inline]
    pub fn pdf(&self, normal: Vec3, direction: Vec3) -> f32 {
        let (cell, patch) = self.at(direction);
        self.patches.probability(normal, patch) * self.cells[cell].density / solid_angle_of_area(direction)
    }

    /// The cell and the patch of a direction.
    #[inline(always)]
    fn at(&self, direction: Vec3) -> (usize, usize) {
        let [x, y] = place_of(direction).map(|share| ((share * self.side as f32) as usize).min(self.side - 1));
        if direction.z < 0.0 {
            return ((self.side + y) * self.side + x, BELOW);
        }
        let block = self.side / ACROSS;
        (y * self.side + x, y / block * ACROSS + x / block)
    }

    /// How a patch's rows are drawn (list 0), or the cells of its rows (the lists after it).
    #[inline(always)]
    pub fn cdf(&self, within: &Within, list: usize) -> Cdf<'a> {
        let size = within.size as usize;
        let (guide, cumulative) = (within.guide as usize + list * size, within.cumulative as usize + list * (size + 1));
        Cdf { cumulative: &self.cumulative[cumulative..][..size + 1], guide: &self.guide[guide..][..size] }
    }
}

/// Where a direction lies in its hemisphere's square, 0 to 1.
#[inline]
pub fn place_of(direction: Vec3) -> [f32; 2] {
    let scale = 0.5 / direction.abs().element_sum();
    [(direction.x + direction.y) * scale + 0.5, (direction.x - direction.y) * scale + 0.5]
}

/// The direction at a place in a hemisphere's square.
#[inline]
pub fn direction_at(below: bool, u: f32, v: f32) -> Vec3 {
    let (x, y) = (u + v - 1.0, u - v);
    let z = (1.0 - x.abs() - y.abs()).max(0.0);
    unit(Vec3::new(x, y, if below { -z } else { z }))
}

/// Solid angle of a unit of a square's area around a direction.
#[inline]
pub fn solid_angle_of_area(direction: Vec3) -> f32 {
    let sum = direction.abs().element_sum();
    2.0 * sum * sum * sum
}
