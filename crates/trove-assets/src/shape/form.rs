//! The form under construction and the simple solids.

use std::collections::HashMap;
use std::f32::consts::FRAC_PI_2;

use glam::{Affine3A, Quat, Vec2, Vec3, vec2};
use trove_model::Mesh;

/// Triangles under construction: a normal and a texture coordinate for every vertex, a slot for every triangle.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shape {
    pub(crate) positions: Vec<Vec3>,
    pub(crate) normals: Vec<Vec3>,
    pub(crate) uvs: Vec<Vec2>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) slots: Vec<u16>,
}

/// Faces that meet at less than this are one smooth surface, unless a caller says otherwise.
pub(super) const SMOOTH_RAD: f32 = 0.7;

impl Shape {
    /// A box about the origin, with sharp edges; uvs are metres on every side.
    pub(crate) fn block(size: Vec3) -> Self {
        let half = size / 2.0;
        let mut shape = Self::default();
        for (axis, u, v) in [(Vec3::X, Vec3::Y, Vec3::Z), (Vec3::Y, Vec3::Z, Vec3::X), (Vec3::Z, Vec3::X, Vec3::Y)] {
            for sign in [1.0, -1.0] {
                let v = v * sign;
                let base = shape.positions.len() as u32;
                for (s, t) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                    let p = (axis * sign + u * s + v * t) * half;
                    shape.vertex(p, axis * sign, vec2(p.dot(u), p.dot(v)));
                }
                shape.triangle(base, base + 1, base + 2);
                shape.triangle(base, base + 2, base + 3);
            }
        }
        shape
    }

    /// A box about the origin whose edges and corners are rounded off over `bevel_m`.
    pub(crate) fn rounded_block(size: Vec3, bevel_m: f32) -> Self {
        let bevel = bevel_m.min(size.min_element() / 2.0 * 0.999);
        let inner = size / 2.0 - Vec3::splat(bevel);
        let sign = |corner: u32| {
            Vec3::from_array(std::array::from_fn(|axis| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 }))
        };
        let mut shape = Self::default();
        // Vertex 3c + a is corner c's on the face across axis a.
        for corner in 0..8 {
            for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                let normal = axis * sign(corner);
                shape.vertex(inner * sign(corner) + normal * bevel, normal, Vec2::ZERO);
            }
        }
        let at = |corner: u32, axis: u32| 3 * corner + axis;
        for corner in 0..8 {
            shape.outward(at(corner, 0), at(corner, 1), at(corner, 2));
            for a in 0..3 {
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                if corner >> a & 1 == 0 {
                    // The rounded edge along axis a.
                    let far = corner | 1 << a;
                    shape.outward(at(corner, b), at(far, b), at(far, c));
                    shape.outward(at(corner, b), at(far, c), at(corner, c));
                }
                if corner >> b & 1 == 0 && corner >> c & 1 == 0 {
                    // The face across axis a.
                    let ring = [corner, corner | 1 << b, corner | 1 << b | 1 << c, corner | 1 << c];
                    shape.outward(at(ring[0], a), at(ring[1], a), at(ring[2], a));
                    shape.outward(at(ring[0], a), at(ring[2], a), at(ring[3], a));
                }
            }
        }
        shape
    }

    /// An ellipsoid about the origin with `around` meridians.
    pub(crate) fn ellipsoid(radii: Vec3, around: usize) -> Self {
        let rows = around / 2;
        let profile: Vec<Vec2> = (0..=rows)
            .map(|i| {
                let angle = std::f32::consts::PI * (i as f32 / rows as f32 - 0.5);
                vec2(if i == 0 || i == rows { 0.0 } else { angle.cos() }, angle.sin())
            })
            .collect();
        Self::lathe(&profile, around).scaled(radii).smooth(2.0)
    }

    /// A simple polygon (counter-clockwise seen from above) made thick from z = 0 up; uvs of top and bottom are its
    /// x and y.
    pub(crate) fn extruded(polygon: &[Vec2], height_m: f32) -> Self {
        let mut shape = Self::default();
        let n = polygon.len() as u32;
        for &p in polygon {
            shape.vertex(p.extend(height_m), Vec3::Z, p);
        }
        for &p in polygon {
            shape.vertex(p.extend(0.0), -Vec3::Z, p);
        }
        for [a, b, c] in ears(polygon) {
            shape.triangle(a, b, c);
            shape.triangle(n + a, n + c, n + b);
        }
        for i in 0..n {
            let j = (i + 1) % n;
            shape.triangle(n + i, n + j, j);
            shape.triangle(n + i, j, i);
        }
        shape.smooth(SMOOTH_RAD)
    }

    /// A flat polygon in z = 0 that is seen from above only; uvs are x and y.
    pub(crate) fn flat(polygon: &[Vec2]) -> Self {
        let mut shape = Self::default();
        for &p in polygon {
            shape.vertex(p.extend(0.0), Vec3::Z, p);
        }
        for [a, b, c] in ears(polygon) {
            shape.triangle(a, b, c);
        }
        shape
    }

    /// Several shapes as one.
    pub(crate) fn join(shapes: impl IntoIterator<Item = Self>) -> Self {
        shapes.into_iter().fold(Self::default(), Self::and)
    }

    /// This and another shape.
    pub(crate) fn and(mut self, other: Self) -> Self {
        let base = self.positions.len() as u32;
        self.positions.extend(other.positions);
        self.normals.extend(other.normals);
        self.uvs.extend(other.uvs);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + base)));
        self.slots.extend(other.slots);
        self
    }

    /// This and its mirror image across y = 0.
    pub(crate) fn both_sides(self) -> Self {
        let other = self.clone().scaled(Vec3::new(1.0, -1.0, 1.0));
        self.and(other)
    }

    /// Everything in one slot.
    pub(crate) fn slot(mut self, slot: u16) -> Self {
        self.slots.fill(slot);
        self
    }

    /// Moved by a vector.
    pub(crate) fn moved(mut self, by: Vec3) -> Self {
        self.positions.iter_mut().for_each(|p| *p += by);
        self
    }

    /// Turned about the origin.
    pub(crate) fn turned(self, by: Quat) -> Self {
        self.transformed(Affine3A::from_quat(by))
    }

    /// Turned from an axis along z to one along y.
    pub(crate) fn upright(self) -> Self {
        self.turned(Quat::from_rotation_x(-FRAC_PI_2))
    }

    /// Scaled about the origin; a negative factor mirrors.
    pub(crate) fn scaled(self, by: Vec3) -> Self {
        self.transformed(Affine3A::from_scale(by))
    }

    /// Put through an affine map.
    pub(crate) fn transformed(mut self, map: Affine3A) -> Self {
        let normal_map = map.matrix3.inverse().transpose();
        self.positions.iter_mut().for_each(|p| *p = map.transform_point3(*p));
        self.normals.iter_mut().for_each(|n| *n = (normal_map * *n).normalize_or(Vec3::Z));
        if map.matrix3.determinant() < 0.0 {
            self = self.inside_out_triangles();
        }
        self
    }

    /// Every vertex put through a map that need not be affine; normals are made anew.
    pub(crate) fn bent(mut self, map: impl Fn(Vec3) -> Vec3) -> Self {
        self.positions.iter_mut().for_each(|p| *p = map(*p));
        self.smooth(SMOOTH_RAD)
    }

    /// An open surface made into a plate, its other side `thickness_m` behind it.
    pub(crate) fn plate(self, thickness_m: f32) -> Self {
        let mut back = self.clone().inside_out();
        back.positions.iter_mut().zip(&back.normals).for_each(|(p, n)| *p += *n * thickness_m);
        self.and(back)
    }

    /// Seen from the other side.
    pub(crate) fn inside_out(mut self) -> Self {
        self.normals.iter_mut().for_each(|n| *n = -*n);
        self.inside_out_triangles()
    }

    /// Volume that a closed shape encloses; negative where it is inside out.
    #[cfg(test)]
    pub(crate) fn volume_m3(&self) -> f32 {
        let corner = |i: u32| self.positions[i as usize];
        self.triangles.iter().map(|&[a, b, c]| corner(a).dot(corner(b).cross(corner(c))) / 6.0).sum()
    }

    /// The mesh; without uvs where all are zero.
    pub(crate) fn into_mesh(self) -> Mesh {
        let Self { positions, normals, uvs, triangles, slots } = self.without_unused_vertices();
        let uvs = if uvs.iter().all(|&uv| uv == Vec2::ZERO) { Vec::new() } else { uvs };
        Mesh { positions, normals, uvs, triangles, slots, ..Mesh::default() }
    }

    pub(super) fn vertex(&mut self, position: Vec3, normal: Vec3, uv: Vec2) -> u32 {
        self.positions.push(position);
        self.normals.push(normal);
        self.uvs.push(uv);
        self.positions.len() as u32 - 1
    }

    pub(super) fn triangle(&mut self, a: u32, b: u32, c: u32) {
        self.triangles.push([a, b, c]);
        self.slots.push(0);
    }

    /// A triangle of a convex shape about the origin, whichever way round its corners come.
    fn outward(&mut self, a: u32, b: u32, c: u32) {
        let [p, q, r] = [a, b, c].map(|i| self.positions[i as usize]);
        if (q - p).cross(r - p).dot(p + q + r) < 0.0 { self.triangle(a, c, b) } else { self.triangle(a, b, c) }
    }

    fn inside_out_triangles(mut self) -> Self {
        self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        self
    }

    pub(super) fn without_unused_vertices(self) -> Self {
        let mut kept = Self { slots: self.slots, ..Self::default() };
        let mut place: HashMap<u32, u32> = HashMap::new();
        for t in &self.triangles {
            let t = t.map(|i| {
                *place.entry(i).or_insert_with(|| {
                    let i = i as usize;
                    kept.vertex(self.positions[i], self.normals[i], self.uvs[i])
                })
            });
            kept.triangles.push(t);
        }
        kept
    }
}

/// Triangles of a simple counter-clockwise polygon, by cutting off ears.
fn ears(polygon: &[Vec2]) -> Vec<[u32; 3]> {
    let at = |i: u32| polygon[i as usize];
    let turn = |a: Vec2, b: Vec2, c: Vec2| (b - a).perp_dot(c - a);
    let mut left: Vec<u32> = (0..polygon.len() as u32).collect();
    let mut triangles = Vec::new();
    while left.len() > 2 {
        let n = left.len();
        let corner = |i: usize| [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
        let ear = (0..n).find(|&i| {
            let [a, b, c] = corner(i).map(at);
            turn(a, b, c) > 0.0
                && left.iter().map(|&k| at(k)).all(|p| {
                    p == a || p == b || p == c || turn(a, b, p) < 0.0 || turn(b, c, p) < 0.0 || turn(c, a, p) < 0.0
                })
        });
        // A polygon that crosses itself has no ear left; any corner will do.
        let ear = ear.unwrap_or(0);
        triangles.push(corner(ear));
        left.remove(ear);
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solids_face_outwards_and_have_their_size() {
        let size = Vec3::new(2.0, 3.0, 4.0);
        let square = [vec2(0.0, 0.0), vec2(2.0, 0.0), vec2(2.0, 3.0), vec2(0.0, 3.0)];
        let notched = [vec2(0.0, 0.0), vec2(2.0, 0.0), vec2(0.5, 0.5), vec2(0.0, 2.0)];
        for (shape, volume, tolerance) in [
            (Shape::block(size), 24.0, 1e-4),
            (Shape::rounded_block(size, 0.05), 24.0, 0.1),
            (Shape::ellipsoid(size / 2.0, 48), 12.566, 0.2),
            (Shape::extruded(&square, 4.0), 24.0, 1e-4),
            (Shape::extruded(&notched, 4.0), 4.0, 1e-4),
            (Shape::block(size).scaled(Vec3::new(-1.0, 1.0, 1.0)), 24.0, 1e-4),
        ] {
            assert!((shape.volume_m3() - volume).abs() < tolerance, "{} for {volume}", shape.volume_m3());
            assert_eq!(shape.into_mesh().defect(), None);
        }
    }
}
