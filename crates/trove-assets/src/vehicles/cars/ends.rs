//! Fronts and backs of cars: lamps, grilles, intakes, plates. Outlines are (share of half the width, height in metres),
//! heights measured from the nose, or from the tail, or from the sill where it says so.

use glam::{Vec2, Vec3, vec2, vec3};

use super::plan::{Back, Bars, Face, Profile};
use crate::shape::{Prism, Shape, outset, rect, soft};
use crate::vehicles::slots::Slots;

/// A front or a back on a body.
pub(super) struct End<'a> {
    pub(super) profile: &'a Profile,
    pub(super) slots: &'a Slots,
}

impl End<'_> {
    fn half(&self) -> f32 {
        self.profile.width_m / 2.0
    }

    fn outline(&self, points: &[(f32, f32)], from_m: f32) -> Vec<Vec2> {
        points.iter().map(|&(y, z)| vec2(y * self.half(), from_m + z)).collect()
    }

    fn ahead(polygon: &[Vec2]) -> Prism {
        Prism::front(polygon, -0.5..=0.2)
    }

    fn behind(&self, polygon: &[Vec2]) -> Prism {
        Prism::front(polygon, -self.profile.length_m - 0.2..=-self.profile.length_m + 0.34)
    }

    /// The left half of the shell with its front; what stands behind openings comes with it.
    pub(super) fn front(&self, shell: Shape, face: &Face) -> Shape {
        let (p, slots) = (self.profile, self.slots);
        let mut skin = shell;
        let mut parts = Vec::new();
        let sill = p.clearance_m;

        // Openings: their frame, then what lies a little deeper.
        let mut open = |skin: Shape, outline: &[Vec2], frame: (f32, u16), depth: f32| {
            let framed = skin.mark(&Self::ahead(&outset(outline, frame.0)), frame.1);
            // What lies behind reaches beyond the opening, so that no gap shows.
            let behind = framed.clone().split(&Self::ahead(&outset(outline, depth))).0;
            parts.push(behind.slot(slots.seam).moved(vec3(-depth, 0.0, 0.0)));
            framed.without(&Self::ahead(outline))
        };
        if face.bars != Bars::Closed {
            let outline = self.outline(&face.grille, p.nose_m);
            let frame = if face.is_chromed { (0.014, slots.chrome) } else { (0.012, slots.trim) };
            skin = open(skin, &outline, frame, 0.035);
        }
        if face.intake.len() > 2 {
            skin = open(skin, &self.outline(&face.intake, sill), (0.0, slots.trim), 0.04);
        }
        if face.vent.len() > 2 {
            skin = open(skin, &self.outline(&face.vent, sill), (0.012, slots.trim), 0.03);
        }
        let mut bars: Vec<Shape> = Vec::new();
        if let Bars::Across(_) | Bars::Upright(_) = face.bars {
            let ground = parts[0].clone();
            let outline = self.outline(&face.grille, p.nose_m);
            let (low, high) = outline.iter().fold((Vec2::MAX, Vec2::MIN), |(l, h), q| (l.min(*q), h.max(*q)));
            let cells: Vec<[Vec2; 4]> = match face.bars {
                Bars::Across(n) => (1..=n)
                    .map(|k| low.y + (high.y - low.y) * k as f32 / (n + 1) as f32)
                    .map(|z| rect(-0.1, high.x, z - 0.007, z + 0.007))
                    .collect(),
                Bars::Upright(n) => (0..n)
                    .map(|k| high.x * (2 * k) as f32 / (2 * n - 1) as f32)
                    .map(|y| rect(y - 0.012, y + 0.012, low.y, high.y))
                    .collect(),
                _ => Vec::new(),
            };
            let slot = match (face.bars, face.is_chromed) {
                (_, true) => slots.chrome,
                (Bars::Upright(_), false) => slots.paint,
                _ => slots.trim,
            };
            bars.extend(cells.iter().map(|c| ground.clone().split(&Self::ahead(c)).0.slot(slot).moved(Vec3::X * 0.02)));
        }
        parts.extend(bars);

        // Head lamps: a clear cover, its lining behind, light guide and projectors on that.
        let outline = soft(&self.outline(&face.lamp, p.nose_m), 0.02);
        let (cover, rest) = skin.split(&Self::ahead(&outline));
        skin = rest;
        let lining = cover.clone().slot(slots.bowl).moved(vec3(-0.045, -0.012, 0.0));
        let strip = self.outline(&face.strip, p.nose_m);
        let lining = if strip.len() > 2 { lining.mark(&Self::ahead(&strip), slots.strip) } else { lining };
        for q in self.outline(&face.bulbs, p.nose_m) {
            let at = lining.outermost(Vec3::X, vec3(0.0, q.x, q.y)).unwrap_or(-0.2);
            let r = face.bulb_m;
            let ring = [vec2(r * 1.25, 0.0), vec2(r * 1.2, 0.02), vec2(r, 0.024), vec2(r * 0.95, 0.005)];
            let turn = glam::Quat::from_rotation_y(std::f32::consts::FRAC_PI_2);
            parts.push(Shape::lathe(&ring, 14).turned(turn).moved(vec3(at, q.x, q.y)).slot(slots.chrome));
            let ball = Shape::ellipsoid(vec3(0.014, r, r), 12).moved(vec3(at + 0.012, q.x, q.y));
            parts.push(ball.slot(slots.lamp));
        }
        parts.extend([lining, cover.slot(slots.lens)]);
        parts.push(skin);
        Shape::join(parts)
    }

    /// Marks the back on the left half of shell or greenhouse.
    pub(super) fn back(&self, skin: Shape, back: &Back) -> Shape {
        let (p, slots) = (self.profile, self.slots);
        let tail = p.tail_m;
        let outline = soft(&self.outline(&back.lamp, tail), 0.015);
        let (cover, rest) = skin.split(&self.behind(&outline));
        let mut lining = cover.clone().slot(slots.tail).moved(vec3(0.035, -0.008, 0.0));
        for (part, slot) in [(&back.strip, slots.bright), (&back.white, slots.strip)] {
            if part.len() > 2 {
                lining = lining.mark(&self.behind(&self.outline(part, tail)), slot);
            }
        }
        // The reversing lamp's cover is clear.
        let mut cover = cover.slot(slots.red_glass);
        if back.white.len() > 2 {
            cover = cover.mark(&self.behind(&self.outline(&back.white, tail)), slots.lens);
        }
        Shape::join([rest, lining, cover])
    }

    /// Marks bumper, reflector and number plate's recess on the left half of the shell.
    pub(super) fn bumper(&self, skin: Shape, back: &Back) -> Shape {
        let (p, slots, half) = (self.profile, self.slots, self.half());
        let sill = p.clearance_m;
        let high = sill + back.black_m;
        let lower = [
            vec2(-0.1, sill - 0.1),
            vec2(half * 1.02, sill - 0.1),
            vec2(half * 0.84, sill + back.black_m * 0.8),
            vec2(half * 0.7, high),
            vec2(-0.1, high),
        ];
        let mut skin = skin.mark(&self.behind(&lower), slots.trim);
        let reflector = rect(half * 0.66, half * 0.84, high + 0.03, high + 0.055);
        skin = skin.mark(&self.behind(&reflector), slots.red);
        let z = p.tail_m + back.plate_m;
        skin.mark(&self.behind(&rect(-0.1, 0.3, z - 0.075, z + 0.085)), slots.trim)
    }
}
