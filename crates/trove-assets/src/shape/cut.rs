//! Cuts through shapes: windows marked, wheel arches taken out.

use std::f32::consts::TAU;
use std::ops::RangeInclusive;

use glam::{Vec2, Vec3, vec2, vec3};

use super::Shape;

/// A convex part of space.
#[derive(Clone, Debug)]
pub(crate) struct Prism {
    /// Inside is where `normal · p ≤ offset` for all.
    planes: Vec<(Vec3, f32)>,
}

impl Prism {
    /// A convex polygon of (x, z) points, either way round, swept over a range of y.
    pub(crate) fn side(polygon_xz: &[Vec2], y: RangeInclusive<f32>) -> Self {
        Self::swept(polygon_xz, Vec3::X, Vec3::Z, Vec3::Y, y)
    }

    /// A convex polygon of (y, z) points, either way round, swept over a range of x.
    pub(crate) fn front(polygon_yz: &[Vec2], x: RangeInclusive<f32>) -> Self {
        Self::swept(polygon_yz, Vec3::Y, Vec3::Z, Vec3::X, x)
    }

    /// A convex polygon of (x, y) points, either way round, swept over a range of z.
    pub(crate) fn top(polygon_xy: &[Vec2], z: RangeInclusive<f32>) -> Self {
        Self::swept(polygon_xy, Vec3::X, Vec3::Y, Vec3::Z, z)
    }

    /// A cylinder about an axis along y.
    pub(crate) fn round_side(centre_xz: Vec2, radius_m: f32, around: usize, y: RangeInclusive<f32>) -> Self {
        let polygon: Vec<Vec2> = (0..around)
            .map(|i| centre_xz + Vec2::from_angle(TAU * (i as f32 + 0.5) / around as f32) * radius_m)
            .collect();
        Self::side(&polygon, y)
    }

    /// Between two corners.
    pub(crate) fn between(low: Vec3, high: Vec3) -> Self {
        let square = [vec2(low.x, low.y), vec2(high.x, low.y), vec2(high.x, high.y), vec2(low.x, high.y)];
        Self::top(&square, low.z..=high.z)
    }

    /// Mirrored across y = 0.
    pub(crate) fn mirrored(&self) -> Self {
        Self { planes: self.planes.iter().map(|&(n, d)| (n * vec3(1.0, -1.0, 1.0), d)).collect() }
    }

    fn swept(polygon: &[Vec2], u: Vec3, v: Vec3, along: Vec3, range: RangeInclusive<f32>) -> Self {
        let middle = polygon.iter().sum::<Vec2>() / polygon.len() as f32;
        let mut planes = vec![(along, *range.end()), (-along, -*range.start())];
        for (i, &a) in polygon.iter().enumerate() {
            let b = polygon[(i + 1) % polygon.len()];
            let Some(mut normal) = (b - a).perp().try_normalize() else { continue };
            if normal.dot(middle - a) > 0.0 {
                normal = -normal;
            }
            planes.push((u * normal.x + v * normal.y, normal.dot(a)));
        }
        Self { planes }
    }
}

#[derive(Clone, Copy)]
struct Corner {
    position: Vec3,
    normal: Vec3,
    uv: Vec2,
}

impl Corner {
    fn towards(self, other: Self, t: f32) -> Self {
        Self {
            position: self.position.lerp(other.position, t),
            normal: self.normal.lerp(other.normal, t).normalize_or(self.normal),
            uv: self.uv.lerp(other.uv, t),
        }
    }
}

impl Shape {
    /// The surface inside a prism gets a slot; its edges are cut exactly.
    pub(crate) fn mark(self, prism: &Prism, slot: u16) -> Self {
        let (inside, outside) = self.split(prism);
        outside.and(inside.slot(slot))
    }

    /// `mark` on both sides of y = 0.
    pub(crate) fn mark_both(self, prism: &Prism, slot: u16) -> Self {
        self.mark(prism, slot).mark(&prism.mirrored(), slot)
    }

    /// Without the surface inside a prism.
    pub(crate) fn without(self, prism: &Prism) -> Self {
        self.split(prism).1
    }

    /// What is in a slot, and the rest.
    pub(crate) fn split_slot(self, slot: u16) -> (Self, Self) {
        let part = |wanted: bool| {
            let chosen = self.triangles.iter().zip(&self.slots).filter(|(_, s)| (**s == slot) == wanted);
            let (triangles, slots) = chosen.map(|(t, s)| (*t, *s)).unzip();
            let (positions, normals, uvs) = (self.positions.clone(), self.normals.clone(), self.uvs.clone());
            Self { positions, normals, uvs, triangles, slots }.without_unused_vertices()
        };
        (part(true), part(false))
    }

    /// The surface inside a prism, and the rest.
    pub(crate) fn split(mut self, prism: &Prism) -> (Self, Self) {
        let mut inside = Self::default();
        let triangles = std::mem::take(&mut self.triangles);
        let slots = std::mem::take(&mut self.slots);
        for (t, slot) in triangles.into_iter().zip(slots) {
            let outside =
                |&(normal, offset): &(Vec3, f32)| t.iter().all(|&i| normal.dot(self.positions[i as usize]) > offset);
            if prism.planes.iter().any(outside) {
                self.triangles.push(t);
                self.slots.push(slot);
                continue;
            }
            let mut left: Vec<Corner> = t
                .iter()
                .map(|&i| i as usize)
                .map(|i| Corner { position: self.positions[i], normal: self.normals[i], uv: self.uvs[i] })
                .collect();
            let mut rest: Vec<Vec<Corner>> = Vec::new();
            for &(normal, offset) in &prism.planes {
                let (kept, dropped) = halves(&left, |c| normal.dot(c.position) - offset);
                rest.extend((dropped.len() > 2).then_some(dropped));
                left = kept;
                if left.len() < 3 {
                    break;
                }
            }
            if left.len() < 3 {
                // Not touched after all: keep the triangle whole.
                self.triangles.push(t);
                self.slots.push(slot);
                continue;
            }
            inside.fan(&left, slot);
            rest.iter().for_each(|polygon| self.fan(polygon, slot));
        }
        (inside, self)
    }

    /// How far along a direction the surface reaches on the line through a point.
    pub(crate) fn outermost(&self, direction: Vec3, through: Vec3) -> Option<f32> {
        let (u, v) = direction.any_orthonormal_pair();
        let hits = self.triangles.iter().filter_map(|t| {
            let corners = t.map(|i| self.positions[i as usize]);
            let [p, q, r] = corners.map(|c| vec2((c - through).dot(u), (c - through).dot(v)));
            let weights = vec3(q.perp_dot(r), r.perp_dot(p), p.perp_dot(q));
            let sum = weights.x + weights.y + weights.z;
            let inside = weights.cmpge(Vec3::ZERO).all() || weights.cmple(Vec3::ZERO).all();
            (inside && sum != 0.0).then(|| weights.dot(Vec3::from(corners.map(|c| c.dot(direction)))) / sum)
        });
        hits.reduce(f32::max)
    }

    fn fan(&mut self, polygon: &[Corner], slot: u16) {
        let corners: Vec<u32> = polygon.iter().map(|c| self.vertex(c.position, c.normal, c.uv)).collect();
        for w in corners[1..].windows(2) {
            self.triangles.push([corners[0], w[0], w[1]]);
            self.slots.push(slot);
        }
    }
}

/// The parts of a convex polygon where the distance is ≤ 0 and where it is > 0; slivers are given to the first.
fn halves(polygon: &[Corner], distance: impl Fn(&Corner) -> f32) -> (Vec<Corner>, Vec<Corner>) {
    const SLIVER_M: f32 = 1e-5;
    let distances: Vec<f32> = polygon.iter().map(distance).collect();
    if distances.iter().all(|&d| d <= SLIVER_M) {
        return (polygon.to_vec(), Vec::new());
    }
    if distances.iter().all(|&d| d >= -SLIVER_M) {
        return (Vec::new(), polygon.to_vec());
    }
    let (mut kept, mut dropped) = (Vec::new(), Vec::new());
    for i in 0..polygon.len() {
        let k = (i + 1) % polygon.len();
        let (a, b, da, db) = (polygon[i], polygon[k], distances[i], distances[k]);
        if da <= 0.0 {
            kept.push(a)
        } else {
            dropped.push(a)
        }
        if (da <= 0.0) != (db <= 0.0) {
            let cut = a.towards(b, da / (da - db));
            kept.push(cut);
            dropped.push(cut);
        }
    }
    (kept, dropped)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mark_covers_its_area_and_loses_nothing() {
        let area = |shape: &Shape, slot: u16| -> f32 {
            let corner = |i: u32| shape.positions[i as usize];
            let marked = shape.triangles.iter().zip(&shape.slots).filter(|(_, s)| **s == slot);
            marked.map(|(&[a, b, c], _)| (corner(b) - corner(a)).cross(corner(c) - corner(a)).length() / 2.0).sum()
        };
        let window = Prism::side(&[vec2(-0.2, -0.1), vec2(0.3, -0.1), vec2(0.3, 0.1), vec2(-0.2, 0.1)], 0.0..=1.0);
        let shape = Shape::block(Vec3::ONE).mark(&window, 3);
        assert!((area(&shape, 3) - 0.1).abs() < 1e-5);
        assert!((area(&shape, 0) - 5.9).abs() < 1e-4);
        assert!((shape.volume_m3() - 1.0).abs() < 1e-4);
        assert!((area(&Shape::block(Vec3::ONE).without(&window), 0) - 5.9).abs() < 1e-4);
    }
}
