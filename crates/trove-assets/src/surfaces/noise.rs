//! Noise that repeats with the texture.

use glam::{IVec2, Vec2, ivec2, vec2};

/// A random number in 0..1 for a lattice point.
pub(crate) fn hash(x: i32, y: i32, seed: u32) -> f32 {
    (bits(x, y, seed) >> 8) as f32 / (1 << 24) as f32
}

fn bits(x: i32, y: i32, seed: u32) -> u32 {
    let mut h = (x as u32).wrapping_mul(0x8da6_b343) ^ (y as u32).wrapping_mul(0xd816_3841);
    h ^= seed.wrapping_mul(0xcb1a_b31f);
    h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    h = (h ^ (h >> 12)).wrapping_mul(0x297a_2d39);
    h ^ (h >> 15)
}

/// A lattice over a texture, which has a whole number of cells each way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    cells: IVec2,
    cells_per_m: Vec2,
    seed: u32,
}

/// What a point is near to among points strewn one a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near {
    /// Distance to the nearest, in cells.
    pub(crate) first: f32,
    /// Distance to the second nearest, in cells.
    pub(crate) second: f32,
    /// A random number in 0..1 of the nearest.
    pub(crate) id: f32,
}

impl Noise {
    /// Features of about `feature_m` on a texture that covers `size_m`.
    pub(crate) fn new(size_m: Vec2, feature_m: f32, seed: u32) -> Self {
        Self::stretched(size_m, Vec2::splat(feature_m), seed)
    }

    /// Features of about `feature_m` across and up.
    pub(crate) fn stretched(size_m: Vec2, feature_m: Vec2, seed: u32) -> Self {
        let cells = (size_m / feature_m).round().max(Vec2::ONE);
        Self { cells: cells.as_ivec2(), cells_per_m: cells / size_m, seed }
    }

    /// The cell that a point in cells lies in, brought into the texture, and where in it the point lies.
    fn locate(&self, p: Vec2) -> (IVec2, Vec2) {
        let cell = ivec2(floor(p.x), floor(p.y));
        (ivec2(into(cell.x, self.cells.x), into(cell.y, self.cells.y)), p - cell.as_vec2())
    }

    /// Perlin's gradient noise at a point in metres, about −1 to 1.
    pub(crate) fn at(&self, p_m: Vec2) -> f32 {
        // Every seed's lattice lies elsewhere, lest the zeros of all octaves meet at the texture's edge.
        let shift = vec2((self.seed & 7) as f32, (self.seed >> 3 & 7) as f32) / 8.0 + 0.06;
        let (cell, f) = self.locate(p_m * self.cells_per_m + shift);
        let next = ivec2(into(cell.x + 1, self.cells.x), into(cell.y + 1, self.cells.y));
        let corner = |x: i32, y: i32, from: Vec2| {
            let (gx, gy) = GRADIENTS[(bits(x, y, self.seed) >> 28) as usize];
            gx * from.x + gy * from.y
        };
        let w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
        let (a, b) = (corner(cell.x, cell.y, f), corner(next.x, cell.y, f - Vec2::X));
        let (c, d) = (corner(cell.x, next.y, f - Vec2::Y), corner(next.x, next.y, f - Vec2::ONE));
        let (low, high) = (a + (b - a) * w.x, c + (d - c) * w.x);
        1.5 * (low + (high - low) * w.y)
    }

    /// Several octaves of [`Noise::at`], each half as large and half as strong; about −1 to 1.
    pub(crate) fn fbm(&self, p_m: Vec2, octaves: u32) -> f32 {
        let (mut layer, mut sum, mut weight) = (*self, 0.0, 0.6);
        for octave in 0..octaves {
            sum += layer.at(p_m) * weight;
            weight *= 0.5;
            layer.cells *= 2;
            layer.cells_per_m *= 2.0;
            layer.seed = self.seed.wrapping_add(101 * (octave + 1));
        }
        sum
    }

    /// [`Noise::fbm`] computed once on a grid fine enough for its smallest octave: quick where it is asked for often.
    pub(crate) fn field(&self, octaves: u32) -> Field {
        let size = self.cells * (4 << (octaves - 1));
        let cell_m = self.cells.as_vec2() / self.cells_per_m / size.as_vec2();
        let places = (0..size.y).flat_map(|y| (0..size.x).map(move |x| ivec2(x, y)));
        let values = places.map(|p| self.fbm(p.as_vec2() * cell_m, octaves)).collect();
        Field { size, per_m: 1.0 / cell_m, values }
    }

    /// Worley's cellular noise at a point in metres.
    pub(crate) fn near(&self, p_m: Vec2) -> Near {
        let (cell, f) = self.locate(p_m * self.cells_per_m);
        let (mut first, mut second, mut nearest) = (f32::INFINITY, f32::INFINITY, 0);
        for dy in -1..=1 {
            let y = into(cell.y + dy, self.cells.y);
            for dx in -1..=1 {
                let h = bits(into(cell.x + dx, self.cells.x), y, self.seed);
                let point = vec2((h & 0xffff) as f32, (h >> 16) as f32) / 65536.0;
                let d = (f - point - vec2(dx as f32, dy as f32)).length_squared();
                second = second.min(d.max(first));
                if d < first {
                    (first, nearest) = (d, h);
                }
            }
        }
        let id = (nearest.wrapping_mul(0x9e37_79b1) >> 8) as f32 / (1 << 24) as f32;
        Near { first: first.sqrt(), second: second.sqrt(), id }
    }
}

/// Noise on a grid that repeats with the texture.
#[derive(Clone, Debug)]
pub(crate) struct Field {
    size: IVec2,
    per_m: Vec2,
    values: Vec<f32>,
}

impl Field {
    /// Its value at a point in metres, between the grid's.
    pub(crate) fn at(&self, p_m: Vec2) -> f32 {
        let p = p_m * self.per_m;
        let cell = ivec2(floor(p.x), floor(p.y));
        let f = p - cell.as_vec2();
        let (x, y) = (into(cell.x, self.size.x), into(cell.y, self.size.y));
        let (right, above) = (into(x + 1, self.size.x), into(y + 1, self.size.y));
        let value = |x: i32, y: i32| self.values[(y * self.size.x + x) as usize];
        let low = value(x, y) + (value(right, y) - value(x, y)) * f.x;
        let high = value(x, above) + (value(right, above) - value(x, above)) * f.x;
        low + (high - low) * f.y
    }
}

/// A coordinate brought into the texture.
fn into(x: i32, cells: i32) -> i32 {
    if (0..cells).contains(&x) { x } else { x.rem_euclid(cells) }
}

/// The whole number below (`f32::floor` is a slow call where the processor's newer instructions are not asked for).
fn floor(x: f32) -> i32 {
    let whole = x as i32;
    whole - i32::from((whole as f32) > x)
}

/// Sixteen directions around the circle.
const GRADIENTS: [(f32, f32); 16] = {
    const A: f32 = 0.923_879_5;
    const B: f32 = 0.707_106_77;
    const C: f32 = 0.382_683_43;
    [
        (1.0, 0.0),
        (A, C),
        (B, B),
        (C, A),
        (0.0, 1.0),
        (-C, A),
        (-B, B),
        (-A, C),
        (-1.0, 0.0),
        (-A, -C),
        (-B, -B),
        (-C, -A),
        (0.0, -1.0),
        (C, -A),
        (B, -B),
        (A, -C),
    ]
};

/// 0 below `low`, 1 above `high`, smooth between.
pub(crate) fn step(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_repeats_with_the_texture_and_fills_its_range() {
        let size = vec2(3.0, 2.0);
        let noise = Noise::new(size, 0.3, 7);
        let mut range = (0.0f32, 0.0f32);
        for i in 0..200 {
            let p = vec2(hash(i, 0, 1), hash(i, 1, 1)) * size;
            let value = noise.fbm(p, 4);
            assert!((value - noise.fbm(p + size, 4)).abs() < 1e-3);
            assert!((noise.near(p).first - noise.near(p - size).first).abs() < 1e-3);
            range = (range.0.min(value), range.1.max(value));
        }
        assert!(range.0 < -0.4 && range.1 > 0.4 && range.0 > -1.2 && range.1 < 1.2, "{range:?}");
    }
}
