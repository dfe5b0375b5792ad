//! A building's mesh under construction.

use glam::{DVec2, DVec3, Vec2};
use trove_model::{Mesh, Polygon};

use crate::geometry::plane;

/// Slots of every extruded building, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Slot {
    Facade,
    GroundFloor,
    /// Copings, parapets' inner sides, soffits, plant.
    Trim,
    FlatRoof,
    PitchedRoof,
    /// Walls without windows: gables, chimneys.
    Gable,
    /// Gutters, air handlers, pipes, railings.
    Metal,
    /// Fascias, soffits and verges.
    Boards,
    /// Skylights, solar panels.
    Glazing,
    /// Walls between openings, of upper storeys and of the ground floor.
    Wall,
    GroundWall,
    /// Sills, lintels, surrounds, courses, cornices.
    Stone,
    /// Painted bands.
    Band,
    /// Balconies, floors and ceilings of arcades.
    Slab,
    /// Of windows, upstairs and on the ground floor.
    Frame,
    ShopFrame,
    Glass,
    Balustrade,
    Door,
    Roller,
    Shutter,
    /// Dark metal: railings, fire escapes.
    Iron,
    /// Pale metal: air conditioners, cages.
    Zinc,
    Pipe,
    /// Openings without a room, grilles.
    Dark,
    Curtain,
    CurtainWarm,
    Blind,
    RoomPale,
    RoomWarm,
    RoomFloor,
    RoomBack,
    /// Lamps in rooms, whose light is on in the dark.
    Lampshade,
    LightPanel,
    ShopPanel,
    /// Over signs.
    SignLamp,
    /// Lenses of lamps on walls.
    Lamp,
    /// Awnings, and every second stripe of theirs.
    Cloth,
    Stripe,
    Sign,
    /// Scaffolds' nets and planks.
    Net,
    Plank,
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
        self.slope(slot, &[ring[3], ring[2], ring[1], ring[0]]);
    }

    /// A closed body along rings of as many points each, whose k-th side (from point k to the next) has the k-th slot;
    /// its ends have the first.
    pub(super) fn sweep<const N: usize>(&mut self, slots: [Slot; N], rings: &[[DVec3; N]]) {
        let (Some(first), Some(last)) = (rings.first(), rings.last()) else { return };
        // Seen from ahead the rings have to run clockwise for their sides to look outwards.
        let ahead_m = |n: DVec3| rings.iter().map(|r| n.dot(r[0] - first[0])).find(|ahead_m| ahead_m.abs() > 1e-6);
        let flip = normal(first).and_then(ahead_m).is_some_and(|ahead_m| ahead_m > 0.0);
        let mut add = |slot: Slot, points: &mut [DVec3]| {
            if flip {
                points.reverse();
            }
            self.slope(slot, points);
        };
        for pair in rings.windows(2) {
            for k in 0..N {
                let next = (k + 1) % N;
                add(slots[k], &mut [pair[0][k], pair[1][k], pair[1][next], pair[0][next]]);
            }
        }
        add(slots[0], &mut first.clone());
        let mut end = *last;
        end.reverse();
        add(slots[0], &mut end);
    }

    /// A closed upright cylinder, or a cone frustum, on its base.
    pub(super) fn cylinder(&mut self, slot: Slot, foot: DVec3, radii_m: [f64; 2], height_m: f64, sides: usize) {
        let at = |i: usize, level: usize| {
            let turn = std::f64::consts::TAU * (i % sides) as f64 / sides as f64;
            foot + (DVec2::from_angle(turn) * radii_m[level]).extend(height_m * level as f64)
        };
        for i in 0..sides {
            self.slope(slot, &[at(i, 0), at(i + 1, 0), at(i + 1, 1), at(i, 1)]);
        }
        self.slope(slot, &(0..sides).map(|i| at(i, 1)).collect::<Vec<_>>());
        self.slope(slot, &(0..sides).rev().map(|i| at(i, 0)).collect::<Vec<_>>());
    }

    pub(super) fn finish(self) -> Mesh {
        self.mesh
    }
}

fn normal(points: &[DVec3]) -> Option<DVec3> {
    let o = *points.first()?;
    points.windows(2).map(|w| (w[0] - o).cross(w[1] - o)).sum::<DVec3>().try_normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::open_edges_and_volume;

    #[test]
    fn a_body_looks_outwards_wherever_it_goes_first() {
        let diamond = [[0.0, -1.0], [-1.0, 0.0], [0.0, 1.0], [1.0, 0.0]];
        let ring = |x: f64, z: f64| diamond.map(|[across, up]| DVec3::new(x, across, z + up));
        // Ahead, back, and first up in its own plane, as a verge does at a gable's upright end.
        for way in [vec![[2.0, 0.0]], vec![[-2.0, 0.0]], vec![[0.0, 0.5], [2.0, 0.5]], vec![[0.0, 0.5], [-2.0, 0.5]]] {
            let mut shell = Shell::default();
            let rings: Vec<_> = [[0.0; 2]].iter().chain(&way).map(|&[x, z]| ring(x, z)).collect();
            shell.sweep([Slot::Boards; 4], &rings);
            let (open, volume_m3) = open_edges_and_volume(&shell.finish());
            assert!(open.is_empty() && (volume_m3 - 4.0).abs() < 1e-6, "{way:?}: {volume_m3} m³");
        }
    }
}
