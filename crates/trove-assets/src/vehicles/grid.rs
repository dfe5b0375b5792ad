//! Surfaces over grids of points, and flat outlines.

use std::ops::{Add, Mul};

use glam::{Vec2, Vec3, vec2, vec3};

use crate::shape::Shape;

/// Columns of equally many points, (distance from the front, y, z); rows run upwards, columns backwards along the left
/// side, so that the surface is seen from outside.
pub(super) struct Grid(pub(super) Vec<Vec<Vec3>>);

impl Grid {
    /// The surface in x, y, z, a slot for each (column, row) of its cells.
    pub(super) fn shape(&self, slot: impl Fn(usize, usize) -> u16) -> Shape {
        let rows = self.0.first().map_or(0, Vec::len);
        let mut shape = Shape::default();
        for q in self.0.iter().flatten() {
            shape.positions.push(vec3(-q.x, q.y, q.z));
            shape.normals.push(Vec3::Z);
            shape.uvs.push(Vec2::ZERO);
        }
        for column in 1..self.0.len() {
            for row in 1..rows {
                let (a, b) = (((column - 1) * rows + row) as u32, (column * rows + row) as u32);
                let slot = slot(column - 1, row - 1);
                shape.triangles.extend([[a - 1, b, a], [a - 1, b - 1, b]]);
                shape.slots.extend([slot; 2]);
            }
        }
        // The middle's vertices have neighbours on the right too.
        let mut shape = shape.smooth(0.62);
        straighten(&mut shape);
        shape
    }
}

/// Normals in the plane y = 0 of the left half of something symmetric have no y.
pub(super) fn straighten(shape: &mut Shape) {
    for (p, n) in shape.positions.iter().zip(&mut shape.normals) {
        if p.y.abs() < 1e-4 && n.y.abs() < 0.8 {
            n.y = 0.0;
            *n = n.normalize_or(Vec3::Z);
        }
    }
}

/// A point of a polyline.
pub(super) trait Point: Copy + Add<Output = Self> + Mul<f32, Output = Self> {
    /// Distance between two.
    fn apart(self, other: Self) -> f32;
}

impl Point for Vec3 {
    fn apart(self, other: Self) -> f32 {
        self.distance(other)
    }
}

impl Point for Vec2 {
    fn apart(self, other: Self) -> f32 {
        self.distance(other)
    }
}

/// Three points about a corner that is rounded over a length.
fn turn<P: Point>(before: P, corner: P, after: P, reach: f32) -> [P; 3] {
    let towards = |other: P| {
        let t = (reach / corner.apart(other).max(1e-4)).min(0.45);
        corner * (1.0 - t) + other * t
    };
    let (a, b) = (towards(before), towards(after));
    [a, (a + b) * 0.25 + corner * 0.5, b]
}

/// A polyline with its inner corners rounded over a length each; those with length 0 stay.
pub(super) fn rounded<P: Point>(corners: &[(P, f32)]) -> Vec<P> {
    let mut points = vec![corners[0].0];
    for w in corners.windows(3) {
        if w[1].1 > 0.0 { points.extend(turn(w[0].0, w[1].0, w[2].0, w[1].1)) } else { points.push(w[1].0) }
    }
    points.extend(corners.last().map(|c| c.0));
    points
}

/// A polygon with all corners rounded over a length.
pub(super) fn soft(polygon: &[Vec2], reach: f32) -> Vec<Vec2> {
    let n = polygon.len();
    (0..n).flat_map(|i| turn(polygon[(i + n - 1) % n], polygon[i], polygon[(i + 1) % n], reach)).collect()
}

/// A convex polygon without corners that hardly turn.
pub(super) fn simple(polygon: &[Vec2]) -> Vec<Vec2> {
    let n = polygon.len();
    let turns = |i: &usize| {
        let (a, b) = (polygon[*i] - polygon[(i + n - 1) % n], polygon[(i + 1) % n] - polygon[*i]);
        a.angle_to(b).abs() > 0.02
    };
    (0..n).filter(turns).map(|i| polygon[i]).collect()
}

/// What of a convex polygon lies where `normal · p ≤ offset`.
pub(super) fn clipped(polygon: &[Vec2], normal: Vec2, offset: f32) -> Vec<Vec2> {
    let mut kept = Vec::new();
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (da, db) = (normal.dot(a) - offset, normal.dot(b) - offset);
        if da <= 0.0 {
            kept.push(a);
        }
        if (da <= 0.0) != (db <= 0.0) {
            kept.push(a.lerp(b, da / (da - db)));
        }
    }
    kept
}

/// A convex polygon, counter-clockwise, with its sides moved inwards.
pub(super) fn inset(polygon: &[Vec2], by: f32) -> Vec<Vec2> {
    let n = polygon.len();
    (0..n).fold(polygon.to_vec(), |left, i| {
        let (a, b) = (polygon[i], polygon[(i + 1) % n]);
        let out = -(b - a).perp().normalize_or_zero();
        clipped(&left, out, out.dot(a) - by)
    })
}

/// A convex polygon, either way round, with its sides moved outwards.
pub(super) fn outset(polygon: &[Vec2], by: f32) -> Vec<Vec2> {
    let n = polygon.len();
    let area: f32 = (0..n).map(|i| polygon[i].perp_dot(polygon[(i + 1) % n])).sum();
    let out = |a: Vec2, b: Vec2| -(b - a).perp().normalize_or_zero() * area.signum();
    (0..n)
        .map(|i| {
            let (before, here, after) = (polygon[(i + n - 1) % n], polygon[i], polygon[(i + 1) % n]);
            let (u, v) = (out(before, here), out(here, after));
            here + (u + v) * (by / (1.0 + u.dot(v)).max(0.3))
        })
        .collect()
}

/// An axis-aligned rectangle, counter-clockwise.
pub(super) fn rect(low: Vec2, high: Vec2) -> [Vec2; 4] {
    [low, vec2(high.x, low.y), high, vec2(low.x, high.y)]
}

/// The convex hull of points, counter-clockwise (Andrew's monotone chain).
pub(super) fn hull(mut points: Vec<Vec2>) -> Vec<Vec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |points: &mut dyn Iterator<Item = Vec2>| {
        let mut chain: Vec<Vec2> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                if (b - a).perp_dot(p - a) > 1e-7 {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut lower = half(&mut points.iter().copied());
    lower.extend(half(&mut points.iter().rev().copied()));
    lower
}
