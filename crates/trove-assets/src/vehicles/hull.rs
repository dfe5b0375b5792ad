//! Tall bodies of cross sections that lie above one another: cabs, buses, cabins of machines.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Vec2, Vec3, vec2, vec3};

use crate::shape::{Prism, Shape, arc, shrunk};

/// A horizontal cross section: a rectangle with rounded corners whose front and back are bowed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub(crate) z: f32,
    /// Foremost and rearmost x.
    pub(crate) front: f32,
    pub(crate) back: f32,
    pub(crate) half: f32,
    /// Radii of the front and of the rear corners.
    pub(crate) corner: [f32; 2],
    /// How far the middle of the front and of the back stands out beyond its sides.
    pub(crate) bow: [f32; 2],
}

/// Pieces that a corner is made of.
const CORNER: usize = 4;
/// Pieces that a front is made of between its corners.
const FRONT: usize = 6;

impl Row {
    /// Towards another row.
    fn towards(&self, other: &Self, t: f32) -> Self {
        let mix = |a: f32, b: f32| a + (b - a) * t;
        let both = |a: [f32; 2], b: [f32; 2]| [mix(a[0], b[0]), mix(a[1], b[1])];
        Self {
            z: mix(self.z, other.z),
            front: mix(self.front, other.front),
            back: mix(self.back, other.back),
            half: mix(self.half, other.half),
            corner: both(self.corner, other.corner),
            bow: both(self.bow, other.bow),
        }
    }

    /// How far a place across lies behind the front's (0) or in front of the back's (1) outermost point.
    fn set_back(&self, end: usize, y: f32) -> f32 {
        let share = (y / self.half).abs().min(1.0);
        let radius = self.corner[end];
        let into = (y.abs() - self.half + radius).clamp(0.0, radius);
        self.bow[end] * share * share + radius - (radius * radius - into * into).max(0.0).sqrt()
    }

    fn ring(&self) -> Vec<Vec3> {
        let across = |end: usize| {
            let radius = self.corner[end];
            let straight = self.half - radius;
            let arc = (0..=CORNER).map(move |i| FRAC_PI_2 * i as f32 / CORNER as f32);
            let right = arc.clone().map(move |a| -straight - radius * a.cos());
            let middle = (1..FRONT).map(move |i| straight * (2.0 * i as f32 / FRONT as f32 - 1.0));
            let left = arc.map(move |a| straight + radius * a.sin());
            right.chain(middle).chain(left).collect::<Vec<f32>>()
        };
        // Counter-clockwise seen from above: the front from right to left, then the back from left to right.
        let front = across(0).into_iter().map(|y| vec3(self.front - self.set_back(0, y), y, self.z));
        let back = across(1).into_iter().rev().map(|y| vec3(self.back + self.set_back(1, y), y, self.z));
        front.chain(back).collect()
    }
}

/// A body of rows from the lowest to the highest.
#[derive(Clone, Debug)]
pub(crate) struct Hull {
    rows: Vec<Row>,
}

impl Hull {
    pub(crate) fn new(rows: Vec<Row>) -> Self {
        Self { rows }
    }

    /// The closed skin.
    pub(crate) fn skin(&self) -> Shape {
        Shape::loft(&self.rows.iter().map(Row::ring).collect::<Vec<_>>()).smooth(0.5)
    }

    fn row_at(&self, z: f32) -> Row {
        let next = self.rows.partition_point(|r| r.z <= z).clamp(1, self.rows.len() - 1);
        let (a, b) = (&self.rows[next - 1], &self.rows[next]);
        a.towards(b, ((z - a.z) / (b.z - a.z).max(1e-6)).clamp(0.0, 1.0))
    }

    /// x of the front at a place across and up.
    pub(crate) fn front_at(&self, y: f32, z: f32) -> f32 {
        let row = self.row_at(z);
        row.front - row.set_back(0, y)
    }

    /// x of the back at a place across and up.
    pub(crate) fn back_at(&self, y: f32, z: f32) -> f32 {
        let row = self.row_at(z);
        row.back + row.set_back(1, y)
    }

    /// A panel that stands out from the front by `lift_m`, between two corners (y, z); its uvs run from 0 to 1.
    pub(crate) fn front_panel(&self, low: Vec2, high: Vec2, lift_m: f32) -> Shape {
        self.panel(low, high, |y, z| self.front_at(y, z), lift_m)
    }

    /// A panel that stands out from the back by `lift_m`.
    pub(crate) fn back_panel(&self, low: Vec2, high: Vec2, lift_m: f32) -> Shape {
        self.panel(vec2(high.x, low.y), vec2(low.x, high.y), |y, z| self.back_at(y, z), -lift_m)
    }

    fn panel(&self, low: Vec2, high: Vec2, x: impl Fn(f32, f32) -> f32, lift_m: f32) -> Shape {
        let columns = ((high.x - low.x).abs() / 0.22).ceil().clamp(1.0, 12.0);
        let rows = ((high.y - low.y) / 0.3).ceil().clamp(1.0, 6.0);
        let line = |f: f32, lift: f32, steps: f32| -> Vec<Vec3> {
            (0..=steps as usize)
                .map(|i| {
                    let p = low + (high - low) * vec2(i as f32 / steps, f);
                    vec3(x(p.x, p.y) + lift, p.x, p.y)
                })
                .collect()
        };
        let mut face: Vec<Vec<Vec3>> = (0..=rows as usize).map(|i| line(i as f32 / rows, lift_m, columns)).collect();
        let face_shape = Shape::sheet(&face);
        // Sides that go back into the body.
        face.iter_mut().for_each(|row| row.reverse());
        let (bottom, top) = (line(0.0, -lift_m, columns), line(1.0, -lift_m, columns));
        let edge =
            |at: usize| -> Vec<Vec3> { face.iter().map(|row| row[if at == 0 { row.len() - 1 } else { 0 }]).collect() };
        let inwards = |row: Vec<Vec3>| row.into_iter().map(|p| p - Vec3::X * lift_m * 2.0).collect::<Vec<_>>();
        let (left, right) = (edge(1), edge(0));
        Shape::join([
            face_shape,
            Shape::sheet(&[bottom, line(0.0, lift_m, columns)]),
            Shape::sheet(&[line(1.0, lift_m, columns), top]),
            Shape::sheet(&[left.clone(), inwards(left)]).inside_out(),
            Shape::sheet(&[right.clone(), inwards(right)]),
        ])
    }
}

/// A line drawn around a polygon on the sides of a skin, on both of them.
pub(crate) fn gap(skin: Shape, polygon_xz: &[Vec2], body: u16, line: u16) -> Shape {
    let side = |polygon: &[Vec2]| Prism::side(polygon, 0.4..=3.0);
    skin.mark_both(&side(polygon_xz), line).mark_both(&side(&shrunk(polygon_xz, 0.008)), body)
}

/// A cross section across x: its middle, half its size across and up, how round its corners are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Section {
    pub(crate) x: f32,
    pub(crate) z: f32,
    pub(crate) half: Vec2,
    pub(crate) corner: f32,
}

/// A body of cross sections about y = 0, from the rearmost to the foremost.
pub(crate) fn lying(sections: &[Section]) -> Shape {
    let ring = |s: &Section| -> Vec<Vec3> {
        let radius = s.corner.min(s.half.min_element() * 0.999);
        let middle = s.half - radius;
        // Counter-clockwise seen from the front: y to the right, z up.
        let arc = |corner: usize| {
            let signs = [vec2(1.0, 1.0), vec2(-1.0, 1.0), vec2(-1.0, -1.0), vec2(1.0, -1.0)][corner];
            (0..=CORNER).map(move |i| {
                let angle = FRAC_PI_2 * (corner as f32 + i as f32 / CORNER as f32);
                middle * signs + Vec2::from_angle(angle) * radius
            })
        };
        (0..4).flat_map(arc).map(|p| vec3(s.x, p.x, s.z + p.y)).collect()
    };
    Shape::loft(&sections.iter().map(ring).collect::<Vec<_>>()).smooth(0.5)
}

/// Cuts the arch of a wheel out of a skin, both sides; returns the dark wells behind it and the lips around it.
pub(crate) fn arch(skin: &mut Shape, axle_xz: Vec2, radius_m: f32, half_m: f32, depth_m: f32) -> (Shape, Shape) {
    let cut = Prism::round_side(axle_xz, radius_m, 24, half_m - depth_m..=half_m + 0.5);
    *skin = std::mem::take(skin).without(&cut).without(&cut.mirrored());
    let row = |y: f32| arc(axle_xz, radius_m + 0.004, -0.45, PI + 0.45, 18, y);
    let well = Shape::sheet(&[row(half_m - depth_m), row(half_m - 0.008)]);
    let wall = Shape::block(vec3(radius_m * 1.9, 0.02, radius_m * 1.5));
    let wall = wall.moved(vec3(axle_xz.x, half_m - depth_m, axle_xz.y + radius_m * 0.2));
    let lip = Shape::tube(&arc(axle_xz, radius_m + 0.012, -0.3, PI + 0.3, 18, half_m - 0.012), 0.022, 5);
    (well.and(wall).both_sides(), lip.both_sides())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hull() -> Hull {
        let row = |z: f32, front: f32| Row { z, front, back: -4.0, half: 1.0, corner: [0.2, 0.1], bow: [0.1, 0.0] };
        Hull::new(vec![row(0.0, 0.0), row(1.0, 0.0), row(2.0, -0.5)])
    }

    #[test]
    fn a_hull_is_closed_faces_outwards_and_its_front_is_where_it_says() {
        let skin = hull().skin();
        assert!((skin.volume_m3() - 15.3).abs() < 0.2, "{}", skin.volume_m3());
        assert!(hull().front_at(0.0, 0.5).abs() < 1e-5);
        assert!((hull().front_at(0.0, 1.5) + 0.25).abs() < 1e-5);
        assert!(hull().front_at(0.9, 0.5) < -0.1);
        let on_skin = |p: Vec3| skin.positions.iter().map(|q| q.distance(p)).fold(f32::INFINITY, f32::min) < 0.2;
        assert!(on_skin(vec3(hull().front_at(0.95, 1.0), 0.95, 1.0)));
    }

    #[test]
    fn panels_face_outwards() {
        let facing = |shape: &Shape, x: f32| shape.normals.iter().filter(|n| n.x * x > 0.7).count();
        let front = hull().front_panel(vec2(-0.3, 0.2), vec2(0.3, 0.6), 0.02);
        let back = hull().back_panel(vec2(-0.3, 0.2), vec2(0.3, 0.6), 0.02);
        assert!(facing(&front, 1.0) > 5 && facing(&front, -1.0) == 0);
        assert!(facing(&back, -1.0) > 5 && facing(&back, 1.0) == 0);
    }

    #[test]
    fn a_lying_body_has_its_volume() {
        let section = |x: f32| Section { x, z: 1.0, half: vec2(1.0, 0.5), corner: 0.05 };
        let volume = lying(&[section(-2.0), section(1.0)]).volume_m3();
        assert!((volume - 6.0).abs() < 0.05, "{volume}");
    }
}
