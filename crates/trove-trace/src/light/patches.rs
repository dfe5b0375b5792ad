//! Which part of the sky lights a surface: a few patches, weighed by their light and by how a surface faces them.

use glam::Vec3;

/// Patches along each side of the upper hemisphere's square.
pub const ACROSS: usize = 8;

/// The patch of all that lies below the horizon; those above it come first, row by row.
pub const BELOW: usize = ACROSS * ACROSS;

/// Added to the cosine: gloss and bumps send light on that comes along the surface or from behind its smooth normal.
const FLOOR: f32 = 0.05;

/// What patches there are, for any surface.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Patches {
    columns: [Column; ACROSS],
    /// Light from below the horizon.
    below: f32,
}

/// A patch above the horizon.
#[derive(Clone, Copy, Default)]
pub struct Patch {
    /// Brightness times solid angle.
    pub light: f32,
    /// Mean direction of that light, not of unit length: its cosine is the light's mean one.
    pub middle: Vec3,
    /// How far directions of the patch are from there.
    pub reach: f32,
}

/// Patches one below the other, each number of all of them in one place: they are weighed and added up side by side.
#[derive(Clone, Copy, Default)]
#[repr(C)]
struct Column {
    light: [f32; ACROSS],
    /// Middles and reach, times the light.
    x: [f32; ACROSS],
    y: [f32; ACROSS],
    z: [f32; ACROSS],
    reach: [f32; ACROSS],
    /// 1 / (4 · reach).
    bend: [f32; ACROSS],
}

/// Weights of all patches for one surface.
struct Weights {
    /// By column and row.
    patches: [[f32; ACROSS]; ACROSS],
    rows: [f32; ACROSS],
    below: f32,
    total: f32,
}

impl Patches {
    /// From those above the horizon, row by row, and the light from below it.
    pub fn new(patches: &[Patch; BELOW], below: f32) -> Self {
        let mut columns = [Column::default(); ACROSS];
        for (i, patch) in patches.iter().enumerate() {
            let (row, column) = (i / ACROSS, &mut columns[i % ACROSS]);
            let middle = patch.middle * patch.light;
            (column.light[row], column.x[row], column.y[row], column.z[row]) =
                (patch.light, middle.x, middle.y, middle.z);
            column.reach[row] = (patch.reach * patch.light).max(f32::MIN_POSITIVE);
            column.bend[row] = 0.25 / column.reach[row];
        }
        Self { columns, below }
    }

    /// A patch for a surface that is lit from the side of `normal` (from both sides if it is 0), its probability, and two
    /// numbers to draw a direction of it with; `None` where all is dark.
    #[inline]
    pub fn draw(&self, normal: Vec3, [u0, u1]: [f32; 2]) -> Option<(usize, f32, [f32; 2])> {
        let weights = self.weights(normal);
        let u = u0 * weights.total;
        if u < weights.below {
            return Some((BELOW, weights.below / weights.total, [u / weights.below, u1]));
        }
        let (row, u0) = pick(&weights.rows, u - weights.below)?;
        let (column, u1) = pick(&weights.patches.map(|column| column[row]), u1 * weights.rows[row])?;
        Some((row * ACROSS + column, weights.patches[column][row] / weights.total, [u0, u1]))
    }

    /// Probability with which a patch is drawn for a surface.
    #[inline]
    pub fn probability(&self, normal: Vec3, patch: usize) -> f32 {
        let weights = self.weights(normal);
        let weight = if patch == BELOW { weights.below } else { weights.patches[patch % ACROSS][patch / ACROSS] };
        weight / weights.total.max(f32::MIN_POSITIVE)
    }

    #[inline(always)]
    fn weights(&self, normal: Vec3) -> Weights {
        let even = if normal == Vec3::ZERO { 1.0 } else { FLOOR };
        let mut patches = [[0.0f32; ACROSS]; ACROSS];
        let mut rows = [0.0f32; ACROSS];
        for (column, weights) in self.columns.iter().zip(&mut patches) {
            for i in 0..ACROSS {
                let cos = normal.x * column.x[i] + normal.y * column.y[i] + normal.z * column.z[i];
                // The mean of what is positive of all the cosines from cos − reach to cos + reach.
                let over = cos + column.reach[i];
                let over = if over > 0.0 { over } else { 0.0 };
                let curved = if over < 2.0 * column.reach[i] { over } else { 2.0 * column.reach[i] };
                weights[i] = curved * curved * column.bend[i] + (over - curved) + even * column.light[i];
                rows[i] += weights[i];
            }
        }
        // A ground of one brightness.
        let below = self.below * (0.25 * (1.0 - normal.z) + even);
        Weights { patches, rows, below, total: below + rows.iter().sum::<f32>() }
    }
}

/// Which of some weights a number below their sum falls on, and where in it, in [0, 1); `None` where all are 0.
#[inline(always)]
fn pick(weights: &[f32; ACROSS], mut left: f32) -> Option<(usize, f32)> {
    for (i, &weight) in weights.iter().enumerate() {
        if left < weight {
            return Some((i, left / weight));
        }
        left -= weight;
    }
    // Rounding has left a little behind the last one.
    weights.iter().rposition(|&weight| weight > 0.0).map(|last| (last, 1.0 - f32::EPSILON))
}
