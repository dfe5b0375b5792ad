//! Sheet metal: the cowl in front with its sills, the tub behind, what lies beneath.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Vec2, Vec3, vec2, vec3};

use super::measures::{FLOOR_M, FRONT_AXLE_M, REAR_AXLE_M, WHEEL_M};
use crate::shape::{Curve, Prism, Shape, arc};
use crate::vehicles::workshop::{Workshop, block, cut_out};

const SHEET_M: f32 = 0.012;
/// Half the width of the opening for the front wheel.
const WELL_M: f32 = 0.165;
/// Where the sills meet the tub (x), and half their width there (y).
const SILL: Vec2 = vec2(-1.52, 0.62);
const SILL_TOP_M: f32 = 0.42;
/// Heights of the rows that the cowl is made of.
const HEIGHTS_M: [f32; 12] = [0.28, 0.35, SILL_TOP_M, 0.445, 0.52, 0.6, 0.68, 0.76, 0.84, 0.92, 0.98, 1.03];

/// The bowed sheet below the windscreen.
pub(super) struct Cowl {
    front: Curve,
    /// Where its sides begin.
    edge: Curve,
    half: Curve,
    /// Where its sides end: far behind below, as sills, and soon above them.
    end: Curve,
}

impl Cowl {
    fn new() -> Self {
        Self {
            front: Curve::new(&[
                (0.28, -0.17),
                (0.44, -0.14),
                (0.58, -0.13),
                (0.75, -0.17),
                (0.9, -0.25),
                (1.03, -0.36),
            ]),
            edge: Curve::new(&[(0.28, -0.66), (0.6, -0.63), (0.9, -0.56), (1.03, -0.52)]),
            half: Curve::new(&[(0.28, 0.54), (0.44, 0.56), (0.62, 0.575), (0.85, 0.56), (1.03, 0.52)]),
            end: Curve::new(&[(0.28, SILL.x), (SILL_TOP_M, SILL.x), (0.445, -0.86), (0.6, -0.72), (1.03, -0.58)]),
        }
    }

    /// x of its outside at a place across and up.
    pub(super) fn at(&self, y: f32, z: f32) -> f32 {
        let across = (y.abs() / self.half.at(z)).min(1.0).powf(1.0 / 0.85);
        self.edge.at(z) + (self.front.at(z) - self.edge.at(z)) * (1.0 - across * across).powf(0.4)
    }

    /// From right to left.
    fn row(&self, z: f32) -> Vec<Vec3> {
        let (edge, half, end) = (self.edge.at(z), self.half.at(z), self.end.at(z));
        let side = (1..=3).rev().map(|i| {
            let x = edge + (end - edge) * i as f32 / 3.0;
            vec3(x, half + (SILL.y - half) * (x - edge) / (SILL.x - edge), z)
        });
        let right = side.clone().map(|p| p * vec3(1.0, -1.0, 1.0));
        let bow = (0..=14).map(|i| {
            let y = half * {
                let sin = (FRAC_PI_2 * (i as f32 / 7.0 - 1.0)).sin();
                sin.abs().powf(0.85) * sin.signum()
            };
            vec3(self.at(y, z), y, z)
        });
        right.chain(bow).chain(side.rev()).collect()
    }

    /// Its left edge, from the tub forwards and up.
    fn doorway(&self) -> Vec<Vec3> {
        let sill = self.row(SILL_TOP_M);
        let sill = sill[sill.len() - 3..].iter().rev().copied();
        let up = HEIGHTS_M.iter().filter(|z| **z > SILL_TOP_M).filter_map(|&z| self.row(z).last().copied());
        sill.chain(up).collect()
    }

    fn shape(&self) -> Shape {
        let mut rows: Vec<Vec<Vec3>> = HEIGHTS_M.iter().map(|&z| self.row(z)).collect();
        // The shelf on which the windscreen stands.
        let top = self.row(1.03);
        rows.push(top.iter().map(|p| vec3((p.x - 0.03).max(-0.58), p.y * 0.97, 1.05)).collect());
        rows.push(top.iter().map(|p| vec3(-0.58, p.y * 0.95, 1.05)).collect());
        let (low, high) = (FLOOR_M - 0.1, 0.52);
        let opening = [
            vec2(-WELL_M, low),
            vec2(WELL_M, low),
            vec2(WELL_M, high - 0.08),
            vec2(WELL_M * 0.6, high),
            vec2(-WELL_M * 0.6, high),
            vec2(-WELL_M, high - 0.08),
        ];
        Shape::sheet(&rows).smooth(0.9).without(&Prism::front(&opening, -0.6..=0.2))
    }
}

/// Builds the body and returns its cowl.
pub(super) fn build(work: &mut Workshop) -> Cowl {
    let slots = work.slots;
    let cowl = Cowl::new();
    work.add(slots.paint, cowl.shape().plate(SHEET_M));
    work.pair(slots.trim, Shape::tube(&cowl.doorway(), 0.011, 6));
    tub(work);
    well(work);
    let floor = [vec2(-0.6, 0.5), vec2(SILL.x, SILL.y - 0.016), vec2(-2.0, SILL.y - 0.016)];
    let floor: Vec<Vec2> = floor.into_iter().chain(floor.into_iter().rev().map(|p| p * vec2(1.0, -1.0))).collect();
    work.add(slots.trim, Shape::extruded(&floor, 0.02).moved(Vec3::Z * (FLOOR_M - 0.02)));
    // Engine and gearbox below the bench, the axle.
    work.add(slots.frame, block([0.62, 0.66, 0.3], [-2.2, 0.0, 0.33], 0.08));
    work.add(slots.frame, Shape::tube(&[0.5, -0.5].map(|y| vec3(-REAR_AXLE_M, y, WHEEL_M)), 0.035, 8));
    cowl
}

/// The body behind the doors.
fn tub(work: &mut Workshop) {
    let slots = work.slots;
    let front = Curve::new(&[(0.28, SILL.x), (0.44, -1.53), (0.7, -1.6), (0.97, -1.72)]);
    let half = Curve::new(&[(0.28, SILL.y), (0.42, 0.628), (0.6, 0.645), (0.9, 0.648), (0.97, 0.635)]);
    let back = Curve::new(&[(0.28, -2.53), (0.42, -2.6), (0.65, -2.635), (0.9, -2.635), (0.97, -2.615)]);
    let corner = 0.15;
    // From the left door backwards and around to the right one.
    let row = |z: f32| -> Vec<Vec3> {
        let (front, half, back) = (front.at(z), half.at(z), back.at(z));
        let side = (0..6).map(|i| vec3(front + (back + corner - front) * i as f32 / 6.0, half, z));
        let turn = (0..=5).map(|i| Vec2::from_angle(FRAC_PI_2 * i as f32 / 5.0));
        let turn = turn.map(|p| vec3(back + corner - p.y * corner, half - corner + p.x * corner, z));
        let left: Vec<Vec3> = side.chain(turn).collect();
        let right = left.iter().rev().map(|p| *p * vec3(1.0, -1.0, 1.0));
        left.iter().copied().chain(right).collect()
    };
    let heights = [0.28, 0.35, 0.42, 0.5, 0.6, 0.72, 0.84, 0.92, 0.97];
    let mut rows: Vec<Vec<Vec3>> = heights.iter().map(|&z| row(z)).collect();
    // A flange to which the hood is laced.
    rows.push(row(0.97).iter().map(|p| vec3(p.x.max(-2.58), p.y * 0.95, 0.975)).collect());
    let mut skin = Shape::sheet(&rows).smooth(0.9);
    let axle = vec2(-REAR_AXLE_M, WHEEL_M);
    let (radius, inner) = (0.28, 0.44);
    let cut = Prism::round_side(axle, radius, 24, inner..=1.0);
    skin = skin.without(&cut).without(&cut.mirrored());
    // Its rim follows the skin, around the corner at the back.
    let rim = |radius: f32| -> Vec<Vec3> {
        let on_skin = |p: Vec3| {
            let into = (back.at(p.z) + corner - p.x).clamp(0.0, corner);
            p + Vec3::Y * (half.at(p.z) - corner + (corner * corner - into * into).sqrt())
        };
        arc(axle, radius, 0.2, PI - 0.2, 16, 0.0).into_iter().map(on_skin).collect()
    };
    let inside: Vec<Vec3> = rim(radius).iter().map(|p| vec3(p.x, inner, p.z)).collect();
    work.pair(slots.seam, Shape::sheet(&[inside.clone(), rim(radius)]).plate(0.006));
    let wall: Vec<Vec2> = inside.iter().map(|p| vec2(p.x, p.z)).collect();
    work.pair(slots.seam, cut_out(&wall, 0.01).moved(Vec3::Y * inner));
    work.pair(slots.paint, Shape::tube(&rim(radius + 0.006), 0.015, 6));
    // A bead around it.
    work.add(slots.paint, Shape::tube(&row(0.76), 0.009, 5));
    work.add(slots.paint, skin.plate(SHEET_M));
    let edge: Vec<Vec3> = rows.iter().filter_map(|row| row.first().copied()).collect();
    work.pair(slots.trim, Shape::tube(&edge, 0.011, 6));
    // Slits through which the engine breathes.
    for i in 0..6 {
        let z = 0.4 + 0.022 * i as f32;
        work.add(slots.seam, block([0.012, 0.5, 0.009], [back.at(z) + 0.001, 0.0, z], 0.0));
    }
}

/// What the front wheel turns in.
fn well(work: &mut Workshop) {
    let slots = work.slots;
    let axle = vec2(-FRONT_AXLE_M, WHEEL_M);
    let radius = 0.3;
    // It begins behind the cowl.
    let row = |y: f32| arc(axle, radius, 1.0, PI + 0.1, 10, y);
    let roof = Shape::sheet(&[row(-WELL_M), row(WELL_M)]).plate(0.008);
    let mut side: Vec<Vec2> = row(0.0).iter().map(|p| vec2(p.x, p.z)).collect();
    side.push(vec2(side[0].x, side[side.len() - 1].y));
    let wall = cut_out(&side, 0.008).moved(Vec3::Y * WELL_M);
    work.add(slots.trim, roof.and(wall.both_sides()));
}
