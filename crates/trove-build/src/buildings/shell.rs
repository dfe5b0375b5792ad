//! A building's mesh under construction.

use glam::{DVec2, DVec3, Vec2};
use trove_model::{Mesh, Polygon};

use crate::plane;

/// Slots of every extruded building, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Slot {
    Facade,
    GroundFloor,
    /// Copings, parapets' inner sides, soffits, plant.
    Trim,
    FlatRoof,
    PitchedRoof,
}

/// Flat-shaded faces in World, each with vertices of its own.
#[derive(Default)]
pub(super) struct Shell {
    mesh: Mesh,
}

impl Shell {
    /// A plane polygon, counter-clockwise from outside; what has no area is left out.
    pub(super) fn face(&mut self, slot: Slot, points: &[(DVec3, DVec2)]) {
        let first = self.mesh.positions.len() as u32;
        for i in 1..points.len().saturating_sub(1) {
            let (a, b, c) = (points[0].0, points[i].0, points[i + 1].0);
            if (b - a).cross(c - a).length() > 1e-6 {
                self.mesh.triangles.push([first, first + i as u32, first + i as u32 + 1]);
                self.mesh.slots.push(slot as u16);
            }
        }
        for &(p, uv) in points {
            self.mesh.positions.push(p.as_vec3());
            self.mesh.uvs.push(Vec2::new(uv.x as f32, uv.y as f32));
        }
    }

    /// A sloping or level face with texture coordinates that run along the slope, v upwards.
    pub(super) fn slope(&mut self, slot: Slot, points: &[DVec3]) {
        let Some(normal) = normal(points) else { return };
        let u = DVec3::Z.cross(normal).try_normalize().unwrap_or(DVec3::X);
        let v = normal.cross(u);
        let uv = |p: DVec3| DVec2::new(p.dot(u), p.dot(v));
        self.face(slot, &points.iter().map(|&p| (p, uv(p))).collect::<Vec<_>>());
    }

    /// A plane area at a height that may differ from point to point, seen from above or from below.
    pub(super) fn cover(&mut self, slot: Slot, area: &[Polygon], height_m: impl Fn(DVec2) -> f64, upwards: bool) {
        for [a, b, c] in area.iter().flat_map(plane::triangles) {
            let corners = if upwards { [a, b, c] } else { [a, c, b] };
            self.face(slot, &corners.map(|p| (p.extend(height_m(p)), p)));
        }
    }

    /// A closed box on its base, turned to `axis`.
    pub(super) fn block(&mut self, slot: Slot, centre: DVec3, axis: DVec2, size_m: DVec3) {
        let (x, y) = (axis * size_m.x / 2.0, axis.perp() * size_m.y / 2.0);
        let ring = [x + y, y - x, -x - y, x - y].map(|d| centre + d.extend(0.0));
        let up = DVec3::Z * size_m.z;
        for i in 0..4 {
            let (a, b) = (ring[i], ring[(i + 1) % 4]);
            self.slope(slot, &[a, b, b + up, a + up]);
        }
        self.slope(slot, &ring.map(|p| p + up));
    }

    pub(super) fn finish(self) -> Mesh {
        self.mesh
    }
}

fn normal(points: &[DVec3]) -> Option<DVec3> {
    let o = *points.first()?;
    points.windows(2).map(|w| (w[0] - o).cross(w[1] - o)).sum::<DVec3>().try_normalize()
}
