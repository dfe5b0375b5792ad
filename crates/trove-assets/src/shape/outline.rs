//! Flat outlines to cut and mark by, and polylines.

use std::ops::{Add, Mul};

use glam::{Vec2, Vec3, vec2, vec3};

/// An axis-aligned rectangle from `a0` to `a1` across and from `b0` to `b1` up, counter-clockwise.
pub(crate) fn rect(a0: f32, a1: f32, b0: f32, b1: f32) -> [Vec2; 4] {
    [vec2(a0, b0), vec2(a1, b0), vec2(a1, b1), vec2(a0, b1)]
}

/// A convex polygon with its corners rounded.
pub(crate) fn pane(corners: &[Vec2], radius_m: f32) -> Vec<Vec2> {
    let n = corners.len();
    let mut points = Vec::with_capacity(n * 3);
    for i in 0..n {
        let (before, corner, after) = (corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n]);
        let towards = |other: Vec2| corner.lerp(other, (radius_m / corner.distance(other).max(1e-4)).min(0.45));
        let (a, b) = (towards(before), towards(after));
        // Every corner is another plane to cut by: small ones are cut off straight.
        let steps: &[f32] = if radius_m < 0.075 { &[0.0, 1.0] } else { &[0.0, 0.5, 1.0] };
        points.extend(steps.iter().map(|&t| a.lerp(corner, t).lerp(corner.lerp(b, t), t)));
    }
    points
}

/// A polygon made smaller by about a width on every side.
pub(crate) fn shrunk(polygon: &[Vec2], by_m: f32) -> Vec<Vec2> {
    let middle = polygon.iter().sum::<Vec2>() / polygon.len() as f32;
    let (low, high) = polygon.iter().fold((Vec2::MAX, Vec2::MIN), |(l, h), &p| (l.min(p), h.max(p)));
    let scale = (1.0 - 2.0 * by_m / (high - low).max(Vec2::splat(1e-3))).max(Vec2::ZERO);
    polygon.iter().map(|&p| middle + (p - middle) * scale).collect()
}

/// A point of a polyline.
pub(crate) trait Point: Copy + Add<Output = Self> + Mul<f32, Output = Self> {
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
pub(crate) fn rounded<P: Point>(corners: &[(P, f32)]) -> Vec<P> {
    let mut points = vec![corners[0].0];
    for w in corners.windows(3) {
        if w[1].1 > 0.0 { points.extend(turn(w[0].0, w[1].0, w[2].0, w[1].1)) } else { points.push(w[1].0) }
    }
    points.extend(corners.last().map(|c| c.0));
    points
}

/// A polygon with all corners rounded over a length.
pub(crate) fn soft(polygon: &[Vec2], reach: f32) -> Vec<Vec2> {
    let n = polygon.len();
    (0..n).flat_map(|i| turn(polygon[(i + n - 1) % n], polygon[i], polygon[(i + 1) % n], reach)).collect()
}

/// A convex polygon without corners that hardly turn.
pub(crate) fn simple(polygon: &[Vec2]) -> Vec<Vec2> {
    let n = polygon.len();
    let turns = |i: &usize| {
        let (a, b) = (polygon[*i] - polygon[(i + n - 1) % n], polygon[(i + 1) % n] - polygon[*i]);
        a.angle_to(b).abs() > 0.02
    };
    (0..n).filter(turns).map(|i| polygon[i]).collect()
}

/// What of a convex polygon lies where `normal · p ≤ offset`.
pub(crate) fn clipped(polygon: &[Vec2], normal: Vec2, offset: f32) -> Vec<Vec2> {
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
pub(crate) fn inset(polygon: &[Vec2], by: f32) -> Vec<Vec2> {
    let n = polygon.len();
    (0..n).fold(polygon.to_vec(), |left, i| {
        let (a, b) = (polygon[i], polygon[(i + 1) % n]);
        let out = -(b - a).perp().normalize_or_zero();
        clipped(&left, out, out.dot(a) - by)
    })
}

/// A convex polygon, either way round, with its sides moved outwards.
pub(crate) fn outset(polygon: &[Vec2], by: f32) -> Vec<Vec2> {
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

/// The convex hull of points, counter-clockwise (Andrew's monotone chain).
pub(crate) fn hull(mut points: Vec<Vec2>) -> Vec<Vec2> {
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

/// Points of an arc about a centre in a vertical plane along x, angles from +x upwards.
pub(crate) fn arc(centre_xz: Vec2, radius_m: f32, from_rad: f32, to_rad: f32, steps: usize, y: f32) -> Vec<Vec3> {
    (0..=steps)
        .map(|i| from_rad + (to_rad - from_rad) * i as f32 / steps as f32)
        .map(|a| vec3(centre_xz.x + radius_m * a.cos(), y, centre_xz.y + radius_m * a.sin()))
        .collect()
}
