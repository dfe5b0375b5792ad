//! Drawing in a wall's own frame.

use glam::{DVec2, DVec3};

use crate::buildings::shell::{Shell, Slot};

/// An upright plane: x along the wall, y up (World's height), z out of it; right-handed.
#[derive(Clone, Copy, Debug)]
pub(super) struct WallFrame {
    origin: DVec2,
    along: DVec2,
    out: DVec2,
    pub length_m: f64,
    /// How far ledges reach beyond either end for each metre that they stand out, where they meet those of the next
    /// wall; `None` where they end.
    pub mitre: [Option<f64>; 2],
    /// How far the plane lies behind the wall's own, metres.
    pub set_back_m: f64,
}

impl WallFrame {
    /// From one end of a wall to the other, the building on the left.
    pub(super) fn between(a: DVec2, b: DVec2) -> Self {
        let along = (b - a).normalize_or(DVec2::X);
        Self { origin: a, along, out: -along.perp(), length_m: a.distance(b), mitre: [None; 2], set_back_m: 0.0 }
    }

    /// Where the wall runs to, as a share of a full turn, 0 to 1.
    pub(super) fn heading(&self) -> f64 {
        self.along.to_angle() / std::f64::consts::TAU + 0.5
    }

    pub(super) fn world(&self, p: DVec3) -> DVec3 {
        (self.origin + self.along * p.x + self.out * (p.z - self.set_back_m)).extend(p.y)
    }
}

/// Sides of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Right,
    Bottom,
    Top,
    Front,
}

/// Faces in a wall's frame; texture coordinates are metres along the frame's axes.
pub(super) struct Ink<'a> {
    pub shell: &'a mut Shell,
    pub frame: WallFrame,
}

impl Ink<'_> {
    /// A plane polygon, counter-clockwise from where it is seen.
    pub(super) fn face(&mut self, slot: Slot, points: &[DVec3]) {
        let [a, b, c] = [points[0], points[1], points[2]];
        let n = (b - a).cross(c - a).abs();
        let uv = |p: DVec3| {
            if n.z >= n.x && n.z >= n.y {
                DVec2::new(p.x, p.y)
            } else if n.x >= n.y {
                DVec2::new(p.z, p.y)
            } else {
                DVec2::new(p.x, p.z)
            }
        };
        let faces: Vec<(DVec3, DVec2)> = points.iter().map(|&p| (self.frame.world(p), uv(p))).collect();
        self.shell.face(slot, &faces);
    }

    /// The same with texture coordinates of one's own.
    pub(super) fn mapped(&mut self, slot: Slot, points: &[(DVec3, DVec2)]) {
        let faces: Vec<(DVec3, DVec2)> = points.iter().map(|&(p, uv)| (self.frame.world(p), uv)).collect();
        self.shell.face(slot, &faces);
    }

    /// A rectangle parallel to the wall that looks out, or in.
    pub(super) fn pane(&mut self, slot: Slot, low: DVec2, high: DVec2, z: f64, outwards: bool) {
        let mut ring = ring(low, high).map(|p| p.extend(z));
        if !outwards {
            ring.reverse();
        }
        self.face(slot, &ring);
    }

    /// A rectangle with a rectangle cut out of it, parallel to the wall.
    pub(super) fn frame(&mut self, slot: Slot, outer: [DVec2; 2], inner: [DVec2; 2], z: f64, outwards: bool) {
        let (o, i) = (ring(outer[0], outer[1]), ring(inner[0], inner[1]));
        for k in 0..4 {
            let next = (k + 1) % 4;
            let mut quad = [o[k], o[next], i[next], i[k]].map(|p| p.extend(z));
            if !outwards {
                quad.reverse();
            }
            self.face(slot, &quad);
        }
    }

    /// The four sides of a rectangular tube from `z[0]` to `z[1]`, seen from within; the slots are of floor, right side,
    /// ceiling, left side.
    pub(super) fn tube(&mut self, slots: [Slot; 4], low: DVec2, high: DVec2, z: [f64; 2]) {
        let ring = ring(low, high);
        for (k, &slot) in slots.iter().enumerate() {
            let (a, b) = (ring[k], ring[(k + 1) % 4]);
            self.face(slot, &[a.extend(z[1]), b.extend(z[1]), b.extend(z[0]), a.extend(z[0])]);
        }
    }

    /// A block without its back, which is in the wall.
    pub(super) fn block(&mut self, slot: Slot, low: DVec3, high: DVec3) {
        self.sides(slot, low, high, &[Side::Left, Side::Right, Side::Bottom, Side::Top, Side::Front]);
    }

    /// A block between two places along the wall, or to its end, where it meets that of the next wall.
    pub(super) fn ledge(&mut self, slot: Slot, [from, to]: [Option<f64>; 2], y: [f64; 2], out_m: f64) {
        let end = |at: Option<f64>, mitre: Option<f64>, corner: f64, sign: f64| match (at, mitre) {
            (Some(x), _) => ([x, x], true),
            (None, Some(slope)) => ([corner, corner + sign * slope * out_m], false),
            (None, None) => ([corner, corner], true),
        };
        let (left, left_ends) = end(from, self.frame.mitre[0], 0.0, -1.0);
        let (right, right_ends) = end(to, self.frame.mitre[1], self.frame.length_m, 1.0);
        let p = |x: f64, k: usize, z: f64| DVec3::new(x, y[k], z);
        // Between two inner corners a ledge that is wider than its wall would be turned inside out.
        if right[1] <= left[1] || right[0] <= left[0] {
            return;
        }
        let (root, z) = (if left_ends && right_ends { -0.02 } else { 0.0 }, out_m);
        let front = [p(left[1], 0, z), p(right[1], 0, z), p(right[1], 1, z), p(left[1], 1, z)];
        let back = [p(left[0], 0, root), p(right[0], 0, root), p(right[0], 1, root), p(left[0], 1, root)];
        self.face(slot, &front);
        // A mitre is closed too: the next wall may have a window there, or none of it.
        for k in 0..4 {
            let next = (k + 1) % 4;
            self.face(slot, &[front[next], front[k], back[k], back[next]]);
        }
    }

    /// Some sides of a block.
    pub(super) fn sides(&mut self, slot: Slot, low: DVec3, high: DVec3, sides: &[Side]) {
        let p = |x: usize, y: usize, z: usize| DVec3::new([low.x, high.x][x], [low.y, high.y][y], [low.z, high.z][z]);
        for side in sides {
            let face = match side {
                Side::Left => [p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0)],
                Side::Right => [p(1, 0, 1), p(1, 0, 0), p(1, 1, 0), p(1, 1, 1)],
                Side::Bottom => [p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)],
                Side::Top => [p(0, 1, 1), p(1, 1, 1), p(1, 1, 0), p(0, 1, 0)],
                Side::Front => [p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)],
            };
            self.face(slot, &face);
        }
    }

    /// A block that stands free.
    pub(super) fn solid(&mut self, slot: Slot, low: DVec3, high: DVec3) {
        self.block(slot, low, high);
        self.pane(slot, low.truncate(), high.truncate(), low.z, false);
    }

    /// A square bar from one point to another.
    pub(super) fn bar(&mut self, slot: Slot, from: DVec3, to: DVec3, thick_m: f64) {
        let ahead = (to - from).normalize_or(DVec3::X);
        let side = ahead.cross(if ahead.z.abs() > 0.9 { DVec3::X } else { DVec3::Z }).normalize_or(DVec3::Y);
        let up = side.cross(ahead);
        let corners = [side + up, side - up, -side - up, up - side].map(|d| d * thick_m / 2.0);
        for k in 0..4 {
            let (a, b) = (corners[k], corners[(k + 1) % 4]);
            self.face(slot, &[from + a, from + b, to + b, to + a]);
        }
        self.face(slot, &[from + corners[3], from + corners[2], from + corners[1], from + corners[0]]);
        self.face(slot, &corners.map(|c| to + c));
    }
}

/// Corners, counter-clockwise as seen from outside.
pub(super) fn ring(low: DVec2, high: DVec2) -> [DVec2; 4] {
    [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume by the divergence theorem; negative where faces look inwards.
    fn volume(shell: Shell) -> f64 {
        let mesh = shell.finish();
        let corner = |i: u32| mesh.positions[i as usize].as_dvec3();
        mesh.triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2])))).sum::<f64>() / 6.0
    }

    #[test]
    fn solids_and_bars_are_closed_and_look_outwards() {
        let frame = WallFrame::between(DVec2::new(3.0, 1.0), DVec2::new(5.0, 4.0));
        let mut shell = Shell::default();
        Ink { shell: &mut shell, frame }.solid(Slot::Trim, DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0));
        assert!((volume(shell) - 6.0).abs() < 1e-4);
        let mut shell = Shell::default();
        Ink { shell: &mut shell, frame }.bar(Slot::Trim, DVec3::ZERO, DVec3::new(0.0, 3.0, 4.0), 0.1);
        assert!((volume(shell) - 0.05).abs() < 1e-4);
        let mut shell = Shell::default();
        let (low, high) = (DVec2::ZERO, DVec2::new(1.0, 2.0));
        let mut ink = Ink { shell: &mut shell, frame };
        ink.tube([Slot::Trim; 4], low, high, [-3.0, 0.0]);
        ink.pane(Slot::Trim, low, high, -3.0, true);
        ink.pane(Slot::Trim, low, high, 0.0, false);
        assert!((volume(shell) + 6.0).abs() < 1e-4, "a room looks inwards");
    }
}
