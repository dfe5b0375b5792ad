//! Surfaces over grids of points.

use glam::{Vec2, Vec3, vec3};

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
