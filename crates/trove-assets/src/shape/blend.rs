//! Bodies of several limbs that flow into one another.

use std::collections::HashMap;

use glam::{UVec3, Vec2, Vec3, uvec3};

use super::Shape;

/// A bar between two points with a radius at each.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limb {
    from: Vec3,
    to: Vec3,
    radii_m: [f32; 2],
    /// Direction in which it is wider, and how much.
    wide: Option<(Vec3, f32)>,
    /// Cut off flat at `to`.
    blunt: bool,
}

impl Limb {
    /// Round at both ends.
    pub(crate) fn new(from: Vec3, to: Vec3, radius_from_m: f32, radius_to_m: f32) -> Self {
        Self { from, to, radii_m: [radius_from_m, radius_to_m], wide: None, blunt: false }
    }

    /// Radii multiplied along a direction.
    pub(crate) fn wide(self, direction: Vec3, factor: f32) -> Self {
        Self { wide: Some((direction.normalize_or(Vec3::Y), factor)), ..self }
    }

    /// Cut off flat at its second end.
    pub(crate) fn blunt(self) -> Self {
        Self { blunt: true, ..self }
    }

    /// About the distance to its surface, negative inside.
    fn distance_m(&self, mut p: Vec3) -> f32 {
        if let Some((direction, factor)) = self.wide {
            p -= direction * ((p - self.from).dot(direction) * (1.0 - 1.0 / factor));
        }
        let axis = self.to - self.from;
        let length = axis.length().max(1e-6);
        let t = (p - self.from).dot(axis) / (length * length);
        let clamped = t.clamp(0.0, 1.0);
        let radius = self.radii_m[0] + (self.radii_m[1] - self.radii_m[0]) * clamped;
        let distance = p.distance(self.from + axis * if self.blunt { t.max(0.0) } else { clamped }) - radius;
        if self.blunt { distance.max((t - 1.0) * length) } else { distance }
    }

    fn reach(&self) -> (Vec3, Vec3) {
        let widest = self.radii_m[0].max(self.radii_m[1]) * self.wide.map_or(1.0, |(_, f)| f.max(1.0));
        (self.from.min(self.to) - widest, self.from.max(self.to) + widest)
    }
}

/// Limbs whose surfaces flow into one another over `softness_m`.
#[derive(Clone, Debug)]
pub(crate) struct Blend {
    /// What it is made of.
    pub(crate) limbs: Vec<Limb>,
    /// How far around a joint the surfaces are rounded.
    pub(crate) softness_m: f32,
    /// Height under which there is nothing (soles).
    pub(crate) floor_m: f32,
}

impl Blend {
    /// Without a floor.
    pub(crate) fn new(limbs: Vec<Limb>, softness_m: f32) -> Self {
        Self { limbs, softness_m, floor_m: f32::NEG_INFINITY }
    }

    /// About the distance to the surface, negative inside.
    pub(crate) fn distance_m(&self, p: Vec3) -> f32 {
        let union = self.limbs.iter().map(|l| l.distance_m(p)).fold(f32::INFINITY, |a, b| {
            // Quilez's polynomial smooth minimum.
            let h = (self.softness_m - (a - b).abs()).max(0.0) / self.softness_m;
            a.min(b) - h * h * self.softness_m / 4.0
        });
        union.max(self.floor_m - p.z)
    }

    /// Its surface as quads of about `cell_m`, by naive surface nets, drawn onto the true surface.
    pub(crate) fn surface(&self, cell_m: f32) -> Shape {
        let reach = self.limbs.iter().map(Limb::reach).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let Some((low, high)) = reach else { return Shape::default() };
        let low = low - cell_m * 1.5;
        let size = ((high + cell_m * 1.5 - low) / cell_m).ceil().as_uvec3() + 1;
        let place = |g: UVec3| low + g.as_vec3() * cell_m;
        let index = |g: UVec3| ((g.z * size.y + g.y) * size.x + g.x) as usize;
        let grid = |end: UVec3| {
            (0..end.z).flat_map(move |z| (0..end.y).flat_map(move |y| (0..end.x).map(move |x| uvec3(x, y, z))))
        };
        let values: Vec<f32> = grid(size).map(|g| self.distance_m(place(g))).collect();

        // One vertex in every cell that the surface passes.
        let mut shape = Shape::default();
        let mut vertex_in: HashMap<UVec3, u32> = HashMap::new();
        for cell in grid(size - 1) {
            let corner = |k: u32| cell + uvec3(k & 1, k >> 1 & 1, k >> 2);
            let (mut sum, mut count) = (Vec3::ZERO, 0.0);
            for (a, axis) in (0..8u32).flat_map(|a| (0..3).map(move |axis| (a, axis))).filter(|(a, x)| a >> x & 1 == 0)
            {
                let (p, q) = (corner(a), corner(a | 1 << axis));
                let (u, v) = (values[index(p)], values[index(q)]);
                if (u < 0.0) != (v < 0.0) {
                    sum += place(p).lerp(place(q), u / (u - v));
                    count += 1.0;
                }
            }
            if count > 0.0 {
                let mut p = sum / count;
                for _ in 0..2 {
                    p -= self.gradient(p) * self.distance_m(p).clamp(-cell_m / 2.0, cell_m / 2.0);
                }
                vertex_in.insert(cell, shape.vertex(p, self.gradient(p), Vec2::ZERO));
            }
        }

        // One quad for every grid edge that the surface crosses.
        for g in grid(size - 1) {
            for axis in 0..3 {
                let unit = |k: usize| UVec3::from_array(std::array::from_fn(|i| u32::from(i == k % 3)));
                let (u, v) = (unit(axis + 1), unit(axis + 2));
                let starts_inside = values[index(g)] < 0.0;
                let crosses = starts_inside != (values[index(g + unit(axis))] < 0.0);
                if !crosses || (g * (u + v)).cmpeq(UVec3::ZERO).bitmask() & (u + v).cmpgt(UVec3::ZERO).bitmask() != 0 {
                    continue;
                }
                let mut quad = [g - u - v, g - v, g, g - u].map(|cell| vertex_in[&cell]);
                if !starts_inside {
                    quad.reverse();
                }
                shape.triangle(quad[0], quad[1], quad[2]);
                shape.triangle(quad[0], quad[2], quad[3]);
            }
        }
        shape
    }

    fn gradient(&self, p: Vec3) -> Vec3 {
        let step = 1e-3;
        let slope = |d: Vec3| self.distance_m(p + d * step) - self.distance_m(p - d * step);
        Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z)).normalize_or(Vec3::Z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blend_is_closed_faces_outwards_and_has_its_volume() {
        let ball = Blend::new(vec![Limb::new(Vec3::ZERO, Vec3::X, 0.5, 0.5)], 0.1).surface(0.06);
        assert!((ball.volume_m3() - 1.309).abs() < 0.03, "{}", ball.volume_m3());
        let flat = Blend::new(vec![Limb::new(Vec3::ZERO, Vec3::Z * 2.0, 0.3, 0.3).blunt().wide(Vec3::Y, 2.0)], 0.1);
        let (_, high) = flat.surface(0.05).into_mesh().bounds().unwrap();
        assert!((high.z - 2.0).abs() < 0.03 && (high.y - 0.6).abs() < 0.03, "{high}");
    }
}
