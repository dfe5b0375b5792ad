//! Where the ground is even: square blocks of cells that two triangles show as well as all of theirs.

use glam::UVec2;
use trove_model::{HeightField, Raster};

/// Blocks are up to 2 to the power of this many cells wide.
const LARGEST: u32 = 6;
/// Rounding of heights, metres.
const ROUNDING_M: f32 = 1e-4;

/// Moves nodes by up to `tolerance_m`, so that as large blocks as possible are even.
pub(super) fn evened(field: &mut HeightField, tolerance_m: f32) {
    let cells = UVec2::new(field.nodes.width, field.nodes.height) - 1;
    // Larger blocks first: smaller ones beside them find their common edge straight and leave it so.
    let mut even = Raster::filled(cells.x, cells.y, false);
    for level in (1..=LARGEST).rev() {
        let side = 1 << level;
        for y in (0..cells.y / side).map(|y| y * side) {
            for x in (0..cells.x / side).map(|x| x * side) {
                if *even.at(x, y) || unevenness_m(field, UVec2::new(x, y), side) > tolerance_m {
                    continue;
                }
                for dy in 0..=side {
                    for dx in 0..=side {
                        *field.nodes.at_mut(x + dx, y + dy) = between(field, UVec2::new(x, y), side, dx, dy);
                    }
                }
                for dy in 0..side {
                    for dx in 0..side {
                        *even.at_mut(x + dx, y + dy) = true;
                    }
                }
            }
        }
    }
}

/// Height over the two triangles of a block's corners.
fn between(field: &HeightField, min: UVec2, side: u32, dx: u32, dy: u32) -> f32 {
    let z = |x: u32, y: u32| *field.nodes.at(min.x + x * side, min.y + y * side);
    let (u, v) = (dx as f32 / side as f32, dy as f32 / side as f32);
    if dx >= dy {
        z(0, 0) + u * (z(1, 0) - z(0, 0)) + v * (z(1, 1) - z(1, 0))
    } else {
        z(0, 0) + v * (z(0, 1) - z(0, 0)) + u * (z(1, 1) - z(0, 1))
    }
}

/// The farthest that a block's nodes are from its two triangles.
fn unevenness_m(field: &HeightField, min: UVec2, side: u32) -> f32 {
    let mut worst = 0.0f32;
    for dy in 0..=side {
        for dx in 0..=side {
            let off_m = (field.nodes.at(min.x + dx, min.y + dy) - between(field, min, side, dx, dy)).abs();
            worst = worst.max(off_m);
        }
    }
    worst
}

/// Which blocks of a field are even and which have something uneven on them.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    /// By level, the blocks of 2^level cells.
    levels: Vec<Raster<Block>>,
}

#[derive(Clone, Copy, Debug)]
struct Block {
    even: bool,
    ramped: bool,
}

impl Blocks {
    /// `is_ramped` tells the cells on which things lie at changing heights above the ground.
    pub(super) fn new(field: &HeightField, is_ramped: impl Fn(UVec2) -> bool) -> Self {
        let cells = UVec2::new(field.nodes.width, field.nodes.height) - 1;
        let cell = |x, y| Block { even: true, ramped: is_ramped(UVec2::new(x, y)) };
        let mut levels = vec![Raster::from_fn(cells.x, cells.y, cell)];
        for level in 1..=LARGEST {
            let (side, below) = (1u32 << level, &levels[level as usize - 1]);
            let block = |x: u32, y: u32| {
                let parts = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| *below.at(2 * x + dx, 2 * y + dy));
                let even =
                    parts.iter().all(|p| p.even) && unevenness_m(field, UVec2::new(x, y) * side, side) < ROUNDING_M;
                Block { even, ramped: parts.iter().any(|p| p.ramped) }
            };
            levels.push(Raster::from_fn(cells.x / side, cells.y / side, block));
        }
        Self { levels }
    }

    /// Whether two triangles show a rectangle of cells, and whether it has ramps; `None` where it is no such block.
    pub(super) fn at(&self, min: UVec2, size: UVec2) -> Option<(bool, bool)> {
        let side = size.x;
        let level = side.trailing_zeros();
        let aligned = size.x == size.y && side.is_power_of_two() && min % side == UVec2::ZERO && level <= LARGEST;
        let blocks = self.levels.get(level as usize).filter(|_| aligned)?;
        let at = min / side;
        let block = (at.x < blocks.width && at.y < blocks.height).then(|| blocks.at(at.x, at.y))?;
        Some((block.even, block.ramped))
    }
}

/// Where to cut a range of cells in two, so that blocks come out whole.
pub(super) fn middle(from: u32, to: u32) -> u32 {
    // The multiple of the largest power of two within the range.
    let highest = (from ^ (to - 1)).ilog2();
    (to - 1) >> highest << highest
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn ranges_are_cut_at_the_roundest_number() {
        for (from, to, at) in [(0, 300, 256), (256, 300, 288), (0, 64, 32), (6, 8, 7), (5, 7, 6), (0, 2, 1)] {
            assert_eq!(middle(from, to), at, "{from}..{to}");
        }
    }

    #[test]
    fn an_even_field_is_a_few_blocks_and_a_hill_in_it_keeps_its_cells() {
        let hill = |x: u32, y: u32| {
            if x > 40 && y > 40 { 0.05 * (x as f32 * 0.9).sin() } else { 1.0 + 0.001 * (x % 3) as f32 }
        };
        let mut field = HeightField { origin: DVec2::ZERO, cell_m: 2.0, nodes: Raster::from_fn(65, 65, hill) };
        let before = field.clone();
        evened(&mut field, 0.005);
        let moved = field.nodes.data.iter().zip(&before.nodes.data).map(|(a, b)| (a - b).abs());
        assert!(moved.fold(0.0, f32::max) < 0.0051);
        let blocks = Blocks::new(&field, |cell| cell == UVec2::new(3, 3));
        assert_eq!(blocks.at(UVec2::ZERO, UVec2::splat(32)), Some((true, true)));
        assert_eq!(blocks.at(UVec2::new(48, 48), UVec2::splat(8)), Some((false, false)));
        assert_eq!(blocks.at(UVec2::new(1, 0), UVec2::splat(2)), None);
    }
}
