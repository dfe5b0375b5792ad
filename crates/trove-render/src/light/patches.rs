//! Which part of the sky lights a surface: a few patches, weighed by their light and by how a surface faces them.

use glam::Vec3;

/// Patches along each side of the upper hemisphere's square.
pub(super) const ACROSS: usize = 8;

/// The patch of all that lies below the horizon; those above it come first, row by row.
pub(super) const BELOW: usize = ACROSS * ACROSS;

/// Added to the cosine: gloss and bumps send light on that comes along the surface or from behind its smooth normal.
const FLOOR: f32 = 0.05;

/// What patches there are, for any surface.
pub(super) struct Patches {
    rows: [Row; ACROSS],
    /// Light from below the horizon.
    below: f32,
}

/// A patch above the horizon.
#[derive(Clone, Copy, Default)]
pub(super) struct Patch {
    /// Brightness times solid angle.
    pub(super) light: f32,
    /// Mean direction of that light, not of unit length: its cosine is the light's mean one.
    pub(super) middle: Vec3,
    /// How far directions of the patch are from there.
    pub(super) reach: f32,
}

/// Patches beside each other, with what belongs together for all of them in one place: four are weighed at a time.
#[derive(Clone, Copy, Default)]
struct Row {
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
    patches: [[f32; ACROSS]; ACROSS],
    /// Sums of the rows, and what lies below the horizon.
    rows: [f32; ACROSS + 1],
}

impl Patches {
    /// From those above the horizon, row by row, and the light from below it.
    pub(super) fn new(patches: &[Patch; BELOW], below: f32) -> Self {
        let mut rows = [Row::default(); ACROSS];
        for (i, patch) in patches.iter().enumerate() {
            let (row, i) = (&mut rows[i / ACROSS], i % ACROSS);
            let middle = patch.middle * patch.light;
            (row.light[i], row.x[i], row.y[i], row.z[i]) = (patch.light, middle.x, middle.y, middle.z);
            row.reach[i] = (patch.reach * patch.light).max(f32::MIN_POSITIVE);
            row.bend[i] = 0.25 / row.reach[i];
        }
        Self { rows, below }
    }

    /// A patch for a surface that is lit from the side of `normal` (from both sides if it is 0), its probability, and two
    /// numbers to draw a direction of it with; `None` where all is dark.
    pub(super) fn draw(&self, normal: Vec3, [u0, u1]: [f32; 2]) -> Option<(usize, f32, [f32; 2])> {
        let weights = self.weights(normal);
        let total = weights.total();
        if total <= 0.0 {
            return None;
        }
        let (row, u0) = pick(&weights.rows, u0);
        if row == ACROSS {
            return Some((BELOW, weights.rows[row] / total, [u0, u1]));
        }
        let (column, u1) = pick(&weights.patches[row], u1);
        // As it is told below: rows add up to a little more or less than their patches.
        Some((row * ACROSS + column, weights.patches[row][column] / total, [u0, u1]))
    }

    /// Probability with which a patch is drawn for a surface.
    pub(super) fn probability(&self, normal: Vec3, patch: usize) -> f32 {
        let weights = self.weights(normal);
        let weight =
            if patch == BELOW { weights.rows[ACROSS] } else { weights.patches[patch / ACROSS][patch % ACROSS] };
        weight / weights.total().max(f32::MIN_POSITIVE)
    }

    fn weights(&self, normal: Vec3) -> Weights {
        let even = if normal == Vec3::ZERO { 1.0 } else { FLOOR };
        let mut patches = [[0.0f32; ACROSS]; ACROSS];
        let mut rows = [0.0f32; ACROSS + 1];
        for ((row, weights), sum) in self.rows.iter().zip(&mut patches).zip(&mut rows) {
            for (i, weight) in weights.iter_mut().enumerate() {
                let cos = normal.x * row.x[i] + normal.y * row.y[i] + normal.z * row.z[i];
                // The mean of what is positive of all the cosines from cos − reach to cos + reach.
                let over = cos + row.reach[i];
                let over = if over > 0.0 { over } else { 0.0 };
                let curved = if over < 2.0 * row.reach[i] { over } else { 2.0 * row.reach[i] };
                *weight = curved * curved * row.bend[i] + (over - curved) + even * row.light[i];
            }
            *sum = weights.iter().sum();
        }
        // A ground of one brightness.
        rows[ACROSS] = self.below * (0.25 * (1.0 - normal.z) + even);
        Weights { patches, rows }
    }
}

impl Weights {
    fn total(&self) -> f32 {
        self.rows.iter().sum()
    }
}

/// Which of some weights, whose sum is positive, `u` in [0, 1) falls on, and where in it, again in [0, 1).
fn pick(weights: &[f32], u: f32) -> (usize, f32) {
    let mut left = u * weights.iter().sum::<f32>();
    for (i, &weight) in weights.iter().enumerate() {
        if left < weight {
            return (i, left / weight);
        }
        left -= weight;
    }
    // Rounding has left a little behind the last one.
    let last = weights.iter().rposition(|&weight| weight > 0.0).unwrap_or(0);
    (last, 1.0 - f32::EPSILON)
}
