//! Passenger cars and vans: a smooth shell with windows, lamps, wheels and gaps cut into it, and a cabin inside.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec2, Vec3, vec2, vec3};

use super::cabin;
use super::ends::End;
use super::fittings;
use super::plan::CarPlan;
use super::shell::{Shell, Skin};
use crate::shape::{Prism, Shape, clipped, hull, inset, outset, rect, simple, soft};
use crate::vehicles::slots::Slots;
use crate::vehicles::wheel::wheel;

/// Width of the gap around a door.
const GAP_M: f32 = 0.008;

impl CarPlan {
    /// The car, its front at x = 0.
    pub(crate) fn build(&self, slots: &Slots) -> Shape {
        let body = Shell::of(self);
        let skin = Skin {
            paint: slots.paint,
            glass: slots.glass,
            rear_glass: if self.dark_from_m < f32::INFINITY { slots.privacy } else { slots.glass },
            trim: slots.trim,
            under: slots.trim,
            lining: slots.lining,
            has_rear_window: self.blind_from_m > self.profile.length_m,
        };
        let end = End { profile: &self.profile, slots };
        let house = self.windows(body.greenhouse(&skin), &body, slots);
        let house = end.back(house, &self.back);

        let mut shell = self.cladding(body.lower(&skin), slots);
        shell = self.gaps(shell, &body, slots);
        shell = end.bumper(shell, &self.back);
        shell = end.back(shell, &self.back);
        let mut half = Vec::new();
        for &axle in &self.axles_m {
            let (cut, arch) = self.arch(shell, axle, slots);
            shell = cut;
            half.extend([arch, self.wheel(axle, slots)]);
        }
        half.push(fittings::on_the_side(self, &body, &shell, slots));
        half.push(end.front(shell, &self.face));
        half.push(house);
        let whole = Shape::join(half).both_sides();
        let cabin = cabin::interior(self, &body, slots);

        Shape::join([self.fuel_flap(whole, &body, slots), cabin, fittings::in_the_middle(self, &body, slots)])
    }

    fn windows(&self, house: Shape, body: &Shell, slots: &Slots) -> Shape {
        // The opening: over the doors, under the roof's edge, from the windscreen's side edge to its end.
        let [low_end, high_end] = self.glass_end_m.map(|s| s.min(self.blind_from_m));
        let (low_start, high_start) = (body.screen_side_m(0.05) - 0.04, body.screen_side_m(0.93) - 0.03);
        let steps = 6;
        let points = (0..=steps).flat_map(|i| {
            let t = i as f32 / steps as f32;
            let (a, b) = (low_start + (low_end - low_start) * t, high_start + (high_end - high_start) * t);
            [vec2(-a, body.belt_m(a) + 0.022), vec2(-b, body.rail_m(b) - 0.035)]
        });
        let opening = soft(&simple(&hull(points.collect())), 0.06);
        let mut house = house;
        if self.is_chromed {
            house = house.mark(&Prism::side(&outset(&opening, 0.014), 0.2..=2.0), slots.chrome);
        }
        house = house.mark(&Prism::side(&opening, 0.2..=2.0), slots.trim);
        let opening = inset(&opening, 0.016);
        let mut posts = vec![low_start - 1.0];
        posts.extend(self.pillars_m.iter().copied().filter(|&s| s < low_end - 0.05));
        posts.push(low_end.max(high_end) + 1.0);
        for w in posts.windows(2) {
            let pane = clipped(&opening, Vec2::X, -w[0] - 0.028);
            let pane = clipped(&pane, -Vec2::X, w[1] - 0.028);
            if pane.len() > 2 {
                let slot = if w[0] + 0.1 > self.dark_from_m { slots.privacy } else { slots.glass };
                house = house.mark(&Prism::side(&pane, 0.2..=2.0), slot);
            }
        }
        house
    }

    fn cladding(&self, skin: Shape, slots: &Slots) -> Shape {
        let sill = self.profile.clearance_m;
        let high = sill + if self.cladding { 0.16 } else { 0.045 };
        let length = self.profile.length_m;
        let skin = skin.mark(&Prism::side(&rect(-length - 0.1, 0.2, 0.0, high), 0.2..=2.0), slots.trim);
        if !self.cladding {
            return skin;
        }
        let arch = |skin: Shape, &axle: &f32| {
            let centre = vec2(-axle, self.wheel_radius_m + 0.01);
            skin.mark(&Prism::round_side(centre, self.arch_radius_m() + 0.055, 16, 0.3..=2.0), slots.trim)
        };
        self.axles_m.iter().fold(skin, arch)
    }

    /// Gaps between doors, bonnet, boot and bumpers.
    fn gaps(&self, skin: Shape, body: &Shell, slots: &Slots) -> Shape {
        let p = &self.profile;
        let sill = p.clearance_m + if self.cladding { 0.17 } else { 0.1 };
        let mut skin = skin;
        let mut line = |a: Vec2, b: Vec2| {
            let side = (b - a).perp().normalize_or_zero() * GAP_M / 2.0;
            let strip = [a - side, b - side, b + side, a + side];
            let shape = std::mem::take(&mut skin);
            skin = shape.mark(&Prism::side(&strip, 0.3..=2.0), slots.seam);
        };
        // Doors: the first gap leans with the windscreen, the last follows the wheel arch.
        let first = self.first_gap_m();
        let top = |s: f32| body.belt_m(s) + 0.03;
        let foot_m = sill + (top(first) - sill) * 0.62;
        line(vec2(-first, sill), vec2(-first, foot_m));
        line(vec2(-first, foot_m), vec2(-first - 0.05, top(first)));
        let mut last = first;
        for s in self.door_ends_m() {
            let (arch, radius) = (self.axles_m[1], self.arch_radius_m() + 0.05);
            let low = if s > arch - radius { vec2(-(arch - radius), sill) } else { vec2(-s, sill) };
            let bend = vec2(-s, (sill + (top(s) - sill) * 0.66).max(self.wheel_radius_m + radius * 0.75));
            line(low, if s > arch - radius { vec2(-(arch - radius * 0.86), bend.y - 0.22) } else { bend });
            if s > arch - radius {
                line(vec2(-(arch - radius * 0.86), bend.y - 0.22), bend);
            }
            line(bend, vec2(-s, top(s)));
            last = last.max(s.min(arch - radius));
        }
        if last > first {
            line(vec2(-last, sill), vec2(-first, sill));
        }
        // The front bumper meets the wing, the back bumper the quarter panel.
        let front = vec2(-self.axles_m[0] + self.arch_radius_m() * 0.85, self.wheel_radius_m + 0.24);
        line(front, vec2(front.x + 0.24, p.nose_m - 0.2));
        let rear = vec2(-self.axles_m[1] - self.arch_radius_m() * 0.95, self.wheel_radius_m + 0.17);
        line(rear, vec2(-p.length_m + 0.16, p.clearance_m + 0.44));
        self.lids(skin, body, slots)
    }

    /// Gaps around bonnet and boot lid, or tailgate.
    fn lids(&self, skin: Shape, body: &Shell, slots: &Slots) -> Shape {
        let (p, half) = (&self.profile, self.half_m());
        let lines = |skin: Shape, points: &[Vec2], prism: &dyn Fn(&[Vec2]) -> Prism| {
            points.windows(2).fold(skin, |skin, w| {
                let side = (w[1] - w[0]).perp().normalize_or_zero() * GAP_M / 2.0;
                skin.mark(&prism(&[w[0] - side, w[1] - side, w[1] + side, w[0] + side]), slots.seam)
            })
        };
        let above = |polygon: &[Vec2]| Prism::top(polygon, p.nose_m - 0.14..=2.0);
        let nose = |share: f32| vec2(-body.nose_s(half * share) - 0.015, half * share);
        let bonnet = [
            nose(0.0) - vec2(0.0, 0.05),
            nose(0.2),
            nose(0.4),
            nose(0.56),
            nose(0.68) - vec2(0.05, 0.0),
            vec2(-p.cowl.0 * 0.6, half * 0.79),
            vec2(-p.cowl.0 - p.screen_bow_m[0] * 0.7, half * 0.84),
        ];
        let skin = lines(skin, &bonnet, &above);
        let low = p.tail_m + self.back.lid_m;
        let rear =
            [vec2(-0.05, low), vec2(half * 0.6, low), vec2(half * 0.74, low + 0.06), vec2(half * 0.76, p.tail_m)];
        let skin = lines(skin, &rear, &|polygon| Prism::front(polygon, -p.length_m - 0.1..=-p.length_m + 0.35));
        if p.has_bed || p.length_m - p.deck.0 < 0.3 {
            return skin;
        }
        let boot =
            [vec2(-p.length_m + 0.02, half * 0.76), vec2(-p.deck.0 + 0.02, half * 0.74), vec2(-p.deck.0 - 0.03, -0.05)];
        lines(skin, &boot, &|polygon| Prism::top(polygon, p.tail_m - 0.12..=2.0))
    }

    /// A cover on the right side.
    fn fuel_flap(&self, skin: Shape, body: &Shell, slots: &Slots) -> Shape {
        let s = self.axles_m[1] + 0.08;
        let middle = vec2(-s, body.belt_m(s) - 0.17);
        let outline = soft(&rect(middle.x - 0.085, middle.x + 0.085, middle.y - 0.085, middle.y + 0.075), 0.03);
        let closed = outline.iter().chain(outline.first()).copied().collect::<Vec<_>>();
        let (painted, other) = skin.split_slot(slots.paint);
        let marked = closed.windows(2).fold(painted, |skin, w| {
            let side = (w[1] - w[0]).perp().normalize_or_zero() * GAP_M / 2.0;
            let strip = [w[0] - side, w[1] - side, w[1] + side, w[0] + side];
            skin.mark(&Prism::side(&strip, 0.5..=2.0).mirrored(), slots.seam)
        });
        marked.and(other)
    }

    /// A wheel arch cut out of the left half, with a dark well and a lip that follows the skin.
    fn arch(&self, skin: Shape, axle: f32, slots: &Slots) -> (Shape, Shape) {
        let radius = self.arch_radius_m();
        let centre = vec2(-axle, self.wheel_radius_m + 0.01);
        let inner = self.half_m() * 0.5;
        let angles: Vec<f32> = (0..=20).map(|i| -0.5 + (PI + 1.0) * i as f32 / 20.0).collect();
        let floor = self.profile.clearance_m + 0.02;
        let rim: Vec<Vec3> = angles
            .iter()
            .map(|a| centre + Vec2::from_angle(*a) * radius)
            .map(|q| {
                let through = vec3(q.x, 0.0, q.y.max(floor));
                let y = skin.outermost(Vec3::Y, through).unwrap_or(self.half_m() * 0.95);
                vec3(q.x, y, q.y.max(floor))
            })
            .collect();
        let row = |y: f32| rim.iter().map(|&q| vec3(q.x, y, q.z)).collect::<Vec<_>>();
        let well = Shape::sheet(&[row(inner), rim.clone()]).slot(slots.seam);
        let back: Vec<Vec2> = rim.iter().map(|q| vec2(q.x, q.z)).collect();
        let wall = Shape::flat(&back).turned(Quat::from_rotation_x(FRAC_PI_2)).inside_out();
        let wall = wall.moved(Vec3::Y * inner).slot(slots.seam);
        let lip_slot = if self.cladding { slots.trim } else { slots.paint };
        let lip = Shape::tube(&rim, if self.cladding { 0.014 } else { 0.008 }, 4).slot(lip_slot);
        let cut = Prism::round_side(centre, radius, 24, inner..=2.0);
        (skin.without(&cut), well.and(wall).and(lip))
    }

    fn wheel(&self, axle: f32, slots: &Slots) -> Shape {
        let width = 0.17 + self.wheel_radius_m * 0.14;
        let y = self.half_m() - width / 2.0 - 0.012;
        wheel(slots, self.wheel_radius_m, width, self.rim).moved(vec3(-axle, y, self.wheel_radius_m))
    }
}
