//! The smooth skin of a car: cross sections whose corners follow lines drawn along the car.
//!
//! Distances along the car, `s`, are measured from the front end backwards; x = −s.

use glam::{Vec2, Vec3, vec2, vec3};

use crate::shape::{Curve, Shape};

/// Exponent of the superellipse that the ends are rounded by, seen from the side; 2 would be an ellipse.
const ROUNDNESS: f32 = 3.0;

/// The side view of a car, in metres: points are (distance from the front, height).
#[derive(Clone, Debug)]
pub(crate) struct Profile {
    pub(crate) length_m: f32,
    /// Widest point of the body.
    pub(crate) width_m: f32,
    /// Under the sills.
    pub(crate) clearance_m: f32,
    /// Leading edge of the bonnet.
    pub(crate) nose: (f32, f32),
    /// Bonnet meets windscreen.
    pub(crate) cowl: (f32, f32),
    /// Windscreen meets roof.
    pub(crate) header: (f32, f32),
    /// Highest point of the roof.
    pub(crate) peak: (f32, f32),
    /// Roof meets rear window.
    pub(crate) rear_header: (f32, f32),
    /// Rear window meets boot.
    pub(crate) deck: (f32, f32),
    /// Upper rear edge of the boot.
    pub(crate) tail: (f32, f32),
    /// Lower edge of the side windows at the front and at the back.
    pub(crate) belt_m: [f32; 2],
    /// Half width of the roof, a share of half the width.
    pub(crate) roof_share: f32,
    /// How far the front and the back are bowed in plan.
    pub(crate) bow_m: [f32; 2],
    /// Over how much length the front and the back are rounded in side view.
    pub(crate) round_m: [f32; 2],
}

/// The lines along a car that its cross sections hang on.
#[derive(Clone, Debug)]
pub(crate) struct Lines {
    profile: Profile,
    top: Curve,
    /// Where along `top` the line between windscreen and side window is, for a place along the car.
    rail_from: Curve,
    rail_drop: Curve,
    rail_share: Curve,
    belt: Curve,
    belt_share: Curve,
    width_share: Curve,
}

impl Lines {
    pub(crate) fn new(profile: &Profile) -> Self {
        let p = profile;
        let length = p.length_m;
        let top = Curve::rounded(
            &[
                (0.0, p.nose.1 - 0.04),
                p.nose,
                (p.nose.0.mul_add(0.45, p.cowl.0 * 0.55), p.nose.1.mul_add(0.3, p.cowl.1 * 0.7)),
                p.cowl,
                p.header,
                p.peak,
                p.rear_header,
                p.deck,
                p.tail,
                (length, p.tail.1 - 0.06),
            ],
            0.13,
        );
        let (screen, rear) = (0.16, 0.1_f32.min((length - p.deck.0) * 0.3));
        let rail_from = Curve::new(&[
            (0.0, 0.0),
            (p.cowl.0 * 0.5, p.cowl.0 * 0.5),
            (p.cowl.0 + screen, p.cowl.0),
            (p.header.0 + screen * 0.6, p.header.0),
            (p.peak.0, p.peak.0),
            (p.rear_header.0 - rear * 0.6, p.rear_header.0),
            (p.deck.0 - rear, p.deck.0),
            (length, length),
        ]);
        let rail_drop = Curve::new(&[
            (0.0, 0.02),
            (p.cowl.0, 0.012),
            (p.header.0, 0.035),
            (p.peak.0, 0.07),
            (p.rear_header.0, 0.05),
            (p.deck.0, 0.015),
            (length, 0.02),
        ]);
        let roof = p.roof_share;
        let rail_share = Curve::new(&[
            (0.0, 0.60),
            (p.cowl.0, 0.80),
            (p.header.0, roof + 0.02),
            (p.peak.0, roof),
            (p.rear_header.0, roof - 0.01),
            (p.deck.0, roof.mul_add(0.5, 0.38)),
            (length, roof.mul_add(0.5, 0.36)),
        ]);
        let mid_bonnet = p.cowl.0 * 0.55;
        let belt = Curve::new(&[
            (0.0, p.nose.1 - 0.11),
            (mid_bonnet, top.at(mid_bonnet) - 0.075),
            (p.cowl.0 + 0.1, p.belt_m[0]),
            (p.deck.0.min(length - 0.35), p.belt_m[1]),
            (length, p.tail.1.min(p.belt_m[1]) - 0.06),
        ]);
        let belt_share =
            Curve::new(&[(0.0, 0.9), (p.cowl.0, 0.945), (p.peak.0, 0.95), (p.deck.0, 0.935), (length, 0.92)]);
        let width_share = Curve::new(&[
            (0.0, 0.88),
            (p.cowl.0 * 0.3, 0.95),
            (p.cowl.0 * 0.75, 0.99),
            (p.peak.0, 1.0),
            (p.rear_header.0.min(length - 0.9), 0.995),
            (length - 0.35, 0.955),
            (length, 0.89),
        ]);
        Self { profile: profile.clone(), top, rail_from, rail_drop, rail_share, belt, belt_share, width_share }
    }

    /// (y, z) of the line between the side and the roof, on the left.
    pub(crate) fn rail_m(&self, s: f32) -> Vec2 {
        let z = self.top.at(self.rail_from.at(s)).min(self.top.at(s)) - self.rail_drop.at(s);
        vec2(self.half_width_m(s) * self.rail_share.at(s), z)
    }

    /// (y, z) of the shoulder, on the left.
    pub(crate) fn belt_m(&self, s: f32) -> Vec2 {
        vec2(self.half_width_m(s) * self.belt_share.at(s), self.belt.at(s).min(self.rail_m(s).y - 0.01))
    }

    fn half_width_m(&self, s: f32) -> f32 {
        self.profile.width_m / 2.0 * self.width_share.at(s)
    }

    /// The left half of a cross section from the middle of the floor to the middle of the roof, (y, z).
    fn half_section(&self, s: f32) -> Vec<Vec2> {
        let half = self.half_width_m(s);
        let floor = self.profile.clearance_m;
        let (belt, rail, top) = (self.belt_m(s), self.rail_m(s), self.top.at(s));
        let waist = floor + (belt.y - floor) * 0.62;
        let lower = floor + (belt.y - floor) * 0.28;
        let glass = (belt + rail) / 2.0 + vec2(0.018, 0.01) * ((rail.y - belt.y) / 0.4).clamp(0.0, 1.0);
        let crown = vec2(rail.x * 0.55, rail.y + (top - rail.y) * 0.8);
        let corners = [
            (vec2(0.0, floor), 0.0),
            (vec2(half * 0.82, floor), 0.04),
            (vec2(half * 0.955, floor + 0.06), 0.05),
            (vec2(half * 0.985, lower), 0.12),
            (vec2(half, waist), 0.1),
            (belt, 0.045),
            (glass, 0.16),
            (rail, 0.085),
            (crown, 0.25),
            (vec2(0.0, top), 0.0),
        ];
        rounded(&corners)
    }

    /// A whole cross section, counter-clockwise seen from the front, at its place along the car.
    fn section(&self, s: f32) -> Vec<Vec3> {
        let p = &self.profile;
        let half = self.half_section(s);
        // Towards the ends the section closes onto a line, like a superellipse.
        let close = |distance: f32, reach: f32| {
            let t = (1.0 - distance / reach).clamp(0.0, 1.0);
            (1.0 - t.powf(ROUNDNESS)).max(0.0).powf(1.0 / ROUNDNESS)
        };
        let (front, back) = (close(s, p.round_m[0]), close(p.length_m - s, p.round_m[1]));
        let core = if s < p.length_m / 2.0 { p.nose.1 * 0.72 } else { p.tail.1.min(p.belt_m[1]) * 0.66 };
        let place = |q: Vec2, side: f32| {
            let shrink = front * back;
            let y = q.x * side * (0.93 + 0.07 * shrink);
            let z = core + (q.y - core) * shrink;
            let bow = (q.x / (p.width_m / 2.0)).powf(2.8);
            let fade = |distance: f32| (1.0 - distance / 0.9).clamp(0.0, 1.0).powi(2);
            let x = -s - p.bow_m[0] * bow * fade(s) + p.bow_m[1] * bow * fade(p.length_m - s);
            vec3(x, y, z)
        };
        let left = half.iter().map(|&q| place(q, 1.0));
        let right = half[1..half.len() - 1].iter().rev().map(|&q| place(q, -1.0));
        left.chain(right).collect()
    }

    /// The closed skin.
    pub(crate) fn skin(&self) -> Shape {
        let p = &self.profile;
        let end = |reach: f32| {
            [0.0f32, 0.25, 0.45, 0.62, 0.75, 0.86, 0.94, 1.0]
                .map(|f| reach * (1.0 - (1.0 - f.powf(ROUNDNESS)).max(0.0).powf(1.0 / ROUNDNESS)))
        };
        let mut stations: Vec<f32> = end(p.round_m[0]).to_vec();
        stations.extend(end(p.round_m[1]).map(|d| p.length_m - d));
        let knots = [p.cowl, p.header, p.rear_header, p.deck];
        stations.extend(knots.iter().flat_map(|k| [k.0 - 0.06, k.0, k.0 + 0.06]));
        let steps = ((p.length_m - p.round_m[0] - p.round_m[1]) / 0.13) as usize;
        let span = p.length_m - p.round_m[0] - p.round_m[1];
        stations.extend((1..steps).map(|i| p.round_m[0] + span * i as f32 / steps as f32));
        stations.sort_by(f32::total_cmp);
        stations.dedup_by(|a, b| (*a - *b).abs() < 0.004);
        let rings: Vec<Vec<Vec3>> = stations.iter().rev().map(|&s| self.section(s)).collect();
        Shape::loft(&rings).smooth(0.6)
    }
}

/// A polyline with its corners rounded over a length each; three points a corner.
fn rounded(corners: &[(Vec2, f32)]) -> Vec<Vec2> {
    let mut points = vec![corners[0].0];
    for w in corners.windows(3) {
        let (corner, reach) = w[1];
        let towards = |other: Vec2| {
            let length = corner.distance(other).max(1e-4);
            corner.lerp(other, (reach / length).min(0.45))
        };
        let (before, after) = (towards(w[0].0), towards(w[2].0));
        points.extend([before, (before + after) / 4.0 + corner / 2.0, after]);
    }
    points.extend(corners.last().map(|c| c.0));
    points
}
