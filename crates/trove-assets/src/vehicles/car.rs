//! Passenger cars and vans: a smooth skin with windows, lamps, wheels and seams cut into it.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Quat, Vec2, Vec3, vec2, vec3};

use super::body::{Lines, Profile};
use super::palette::Palette;
use super::wheel::{Rim, wheel};
use crate::shape::{Prism, Shape};

/// A car to build.
#[derive(Clone, Debug)]
pub(crate) struct CarPlan {
    pub(crate) profile: Profile,
    /// Distances of the axles from the front.
    pub(crate) axles_m: [f32; 2],
    pub(crate) wheel_radius_m: f32,
    pub(crate) rim: Rim,
    /// Where the side windows are parted, from the front; a part is as long as a door.
    pub(crate) pillars_m: Vec<f32>,
    /// Where the side windows end.
    pub(crate) last_window_m: f32,
    /// Windows behind this distance are sheet metal (panel vans).
    pub(crate) blind_from_m: f32,
    /// Black plastic around the lower edge and the wheels.
    pub(crate) cladding: bool,
    /// Height and half width of the grille's opening.
    pub(crate) grille_m: [f32; 2],
    /// Height of the tail lamps: low ones beside the boot, or high ones beside the rear window.
    pub(crate) tall_tail_lamps: bool,
    /// Rails on the roof.
    pub(crate) roof_rails: bool,
    /// Rows of seats, as distances from the front.
    pub(crate) seats_m: Vec<f32>,
    /// Drives on the left: the wheel is on the right.
    pub(crate) right_hand_drive: bool,
}

impl CarPlan {
    /// The car, its front at x = 0.
    pub(crate) fn build(&self, palette: &Palette) -> Shape {
        let lines = Lines::new(&self.profile);
        let mut skin = lines.skin().slot(palette.paint);
        skin = self.windows(skin, &lines, palette);
        skin = self.ends(skin, palette);
        skin = self.seams(skin, &lines, palette);
        let mut parts = vec![self.interior(&lines, palette)];
        for &axle in &self.axles_m {
            let (cut, arch) = self.arch(skin, axle, palette);
            skin = cut;
            parts.extend([arch, self.wheels(axle, palette)]);
        }
        parts.push(self.fittings(&skin, &lines, palette));
        parts.push(self.ornaments(palette));
        parts.push(skin);
        Shape::join(parts)
    }

    fn half_m(&self) -> f32 {
        self.profile.width_m / 2.0
    }

    /// Where doors end: at every pillar but one that only parts off a small pane beside the windscreen.
    fn door_ends_m(&self) -> impl Iterator<Item = f32> {
        self.pillars_m.iter().copied().filter(|&s| s > self.profile.cowl.0 + 0.7)
    }

    fn windows(&self, skin: Shape, lines: &Lines, palette: &Palette) -> Shape {
        let p = &self.profile;
        // Side windows: under the roof's edge, over the shoulder, from the windscreen's post to the last one.
        let side = |margin: f32, from: f32, to: f32| -> Vec<Vec2> {
            let steps = 18;
            let samples = (0..=steps).map(|i| from + (to - from) * i as f32 / steps as f32);
            let points = samples.flat_map(|s| {
                let (low, high) = (lines.belt_m(s).y + 0.02 + margin, lines.rail_m(s).y - 0.05 - margin);
                (high > low + 0.02).then_some([vec2(-s, low), vec2(-s, high)])
            });
            hull(points.flatten().collect())
        };
        let first = p.cowl.0 + 0.2;
        let mut skin = skin;
        let outline = side(0.0, first, self.last_window_m.min(self.blind_from_m));
        skin = skin.mark_both(&Prism::side(&outline, 0.3..=2.0), palette.trim);
        let mut posts = vec![first];
        posts.extend(self.pillars_m.iter().copied().filter(|&s| s < self.last_window_m.min(self.blind_from_m)));
        posts.push(self.last_window_m.min(self.blind_from_m));
        for w in posts.windows(2) {
            let pane = side(0.018, w[0] + 0.025, w[1] - 0.025);
            if pane.len() > 2 {
                skin = skin.mark_both(&Prism::side(&pane, 0.3..=2.0), palette.glass);
            }
        }
        // Windscreen and rear window, seen from the front.
        let screen = |low: (f32, f32), high: (f32, f32), margin: f32| {
            let (below, above) = (lines.rail_m(low.0).x - 0.045 - margin, lines.rail_m(high.0).x - 0.05 - margin);
            let (from, to) = (low.1 + 0.02 + margin, high.1 - 0.03 - margin);
            [vec2(-below, from), vec2(below, from), vec2(above, to), vec2(-above, to)]
        };
        for (slot, margin) in [(palette.trim, 0.0), (palette.glass, 0.022)] {
            let front = screen(p.cowl, p.header, margin);
            skin = skin.mark(&Prism::front(&front, -p.header.0 - 0.3..=-p.cowl.0 + 0.3), slot);
            if self.blind_from_m > p.length_m {
                let back = screen(p.deck, p.rear_header, margin);
                skin = skin.mark(&Prism::front(&back, -p.length_m..=-p.rear_header.0 + 0.2), slot);
            }
        }
        skin
    }

    /// Grille, lamps, bumpers and number plates.
    fn ends(&self, skin: Shape, palette: &Palette) -> Shape {
        let p = &self.profile;
        let half = self.half_m();
        let (nose, tail) = (p.nose.1, p.tail.1.min(p.belt_m[1]));
        let rect = |y: f32, low: f32, high: f32| [vec2(-y, low), vec2(y, low), vec2(y, high), vec2(-y, high)];
        let front = |polygon: &[Vec2]| Prism::front(polygon, -0.55..=0.1);
        let back = |polygon: &[Vec2]| Prism::front(polygon, -p.length_m - 0.1..=-p.length_m + 0.4);
        let lower = p.clearance_m + 0.1;
        let mut skin = skin
            .mark(&front(&rect(half * 0.62, lower, lower + 0.13)), palette.trim)
            .mark(&back(&rect(half * 0.8, p.clearance_m - 0.1, lower + 0.05)), palette.trim);
        // Grille with bright bars.
        let [height, wide] = self.grille_m;
        let top = nose - 0.07;
        skin = skin.mark(&front(&rect(wide, top - height, top)), palette.seam);
        for k in 1..4 {
            let z = top - height * k as f32 / 4.0;
            skin = skin.mark(&front(&rect(wide - 0.03, z - 0.008, z + 0.008)), palette.chrome);
        }
        // Headlamps run around the corners.
        let lamp = [
            vec2(half * 0.56, nose - 0.16),
            vec2(half * 0.98, nose - 0.14),
            vec2(half * 0.98, nose - 0.045),
            vec2(half * 0.60, nose - 0.075),
        ];
        let inner = [
            vec2(half * 0.60, nose - 0.148),
            vec2(half * 0.95, nose - 0.13),
            vec2(half * 0.95, nose - 0.06),
            vec2(half * 0.63, nose - 0.085),
        ];
        skin = skin.mark_both(&front(&lamp), palette.trim).mark_both(&front(&inner), palette.lamp);
        let fog = [
            vec2(half * 0.68, lower + 0.03),
            vec2(half * 0.84, lower + 0.03),
            vec2(half * 0.84, lower + 0.1),
            vec2(half * 0.68, lower + 0.1),
        ];
        skin = skin.mark_both(&front(&fog), palette.trim);
        let tail_lamp = if self.tall_tail_lamps {
            [
                vec2(half * 0.8, tail - 0.2),
                vec2(half, tail - 0.2),
                vec2(half, tail + 0.3),
                vec2(half * 0.84, tail + 0.3),
            ]
        } else {
            [
                vec2(half * 0.5, tail - 0.2),
                vec2(half, tail - 0.21),
                vec2(half, tail - 0.06),
                vec2(half * 0.5, tail - 0.08),
            ]
        };
        skin = skin.mark_both(&back(&tail_lamp), palette.red);
        let blinker = rect(1.0, tail - 0.155, tail - 0.115).map(|q| vec2(half * 0.9 + q.x * half * 0.06, q.y));
        skin = skin.mark_both(&back(&blinker), palette.amber);
        // Two bulbs in every headlamp, reflectors in the rear bumper.
        for (y, z) in [(half * 0.71, nose - 0.112), (half * 0.84, nose - 0.102)] {
            for (radius, slot) in [(0.036, palette.seam), (0.028, palette.chrome)] {
                let bulb: Vec<Vec2> =
                    (0..10).map(|i| vec2(y, z) + Vec2::from_angle(TAU * i as f32 / 10.0) * radius).collect();
                skin = skin.mark_both(&front(&bulb), slot);
            }
        }
        let reflector = [(0.6, 0.0), (0.78, 0.0), (0.78, 0.035), (0.6, 0.035)];
        skin.mark_both(&back(&reflector.map(|(y, z)| vec2(half * y, lower + 0.09 + z))), palette.red)
    }

    /// Plates, a badge, an exhaust and an aerial, which stand off the skin.
    fn ornaments(&self, palette: &Palette) -> Shape {
        let p = &self.profile;
        let (nose, tail) = (p.nose.1, p.tail.1.min(p.belt_m[1]));
        let plate = |x: f32, z: f32| {
            let frame = Shape::rounded_block(vec3(0.02, 0.54, 0.13), 0.006).slot(palette.trim);
            let face = Shape::rounded_block(vec3(0.024, 0.51, 0.108), 0.004).slot(palette.plate);
            frame.and(face).moved(vec3(x, 0.0, z))
        };
        let rear_plate_m = if self.tall_tail_lamps || tail > 1.1 { tail - 0.28 } else { tail - 0.25 };
        let badge = Shape::ellipsoid(vec3(0.02, 0.055, 0.04), 14);
        let mut parts = vec![
            plate(-0.003, p.clearance_m + 0.27),
            plate(-p.length_m + 0.0, rear_plate_m),
            badge.moved(vec3(-0.035, 0.0, nose - 0.07 - self.grille_m[0] / 2.0)).slot(palette.chrome),
        ];
        let pipe = Shape::tube(&[vec3(0.25, 0.0, 0.0), Vec3::ZERO], 0.03, 10).slot(palette.chrome);
        parts.push(pipe.moved(vec3(-p.length_m + 0.06, self.half_m() * 0.6, p.clearance_m + 0.04)));
        let fin = Shape::ellipsoid(vec3(0.09, 0.02, 0.06), 12);
        let (s, z) = p.rear_header;
        parts.push(fin.moved(vec3(-s + 0.25, 0.0, z + 0.02)).slot(palette.paint));
        Shape::join(parts)
    }

    /// Gaps between doors, bonnet, boot and bumpers.
    fn seams(&self, skin: Shape, lines: &Lines, palette: &Palette) -> Shape {
        const GAP_M: f32 = 0.009;
        let p = &self.profile;
        let sill = p.clearance_m + 0.09;
        let mut skin = skin;
        let upright = |s: f32, lean: f32| {
            let top = lines.belt_m(s).y + 0.02;
            [vec2(-s - GAP_M, sill), vec2(-s, sill), vec2(-s - lean, top), vec2(-s - lean - GAP_M, top)]
        };
        let mut doors = vec![(p.cowl.0 + 0.12, 0.02)];
        doors.extend(self.door_ends_m().map(|s| (s, 0.0)));
        for (s, lean) in doors {
            skin = skin.mark_both(&Prism::side(&upright(s, lean), 0.5..=2.0), palette.seam);
        }
        let (from, to) = (-self.axles_m[1] + self.wheel_radius_m, -p.cowl.0 - 0.12);
        let low = [vec2(from, sill), vec2(to, sill), vec2(to, sill + GAP_M), vec2(from, sill + GAP_M)];
        skin = skin.mark_both(&Prism::side(&low, 0.5..=2.0), palette.seam);
        // Bonnet: along the fenders and across the nose.
        let (a, b) = (vec2(-p.nose.0 - 0.1, self.half_m() * 0.66), vec2(-p.cowl.0 - 0.05, self.half_m() * 0.8));
        let along = [a, b, b + vec2(0.0, GAP_M), a + vec2(0.0, GAP_M)];
        skin = skin.mark_both(&Prism::top(&along, p.nose.1 - 0.15..=p.cowl.1 + 0.1), palette.seam);
        // Boot lid or tailgate.
        let tail = p.tail.1.min(p.belt_m[1]);
        let width = self.half_m() * 0.78;
        let (low, high) = (tail - 0.33, tail - 0.33 + GAP_M);
        let line = [vec2(-width, low), vec2(width, low), vec2(width, high), vec2(-width, high)];
        skin = skin.mark(&Prism::front(&line, -p.length_m - 0.1..=-p.length_m + 0.3), palette.seam);
        if p.tail.0 - p.deck.0 > 1.0 {
            // The cover over a pick-up's bed.
            let (front, back, side) = (-p.deck.0 - 0.12, -p.tail.0 + 0.02, self.half_m() * 0.76);
            let cover = [vec2(front, -side), vec2(front, side), vec2(back, side), vec2(back, -side)];
            skin = skin.mark(&Prism::top(&cover, p.tail.1 - 0.12..=p.deck.1 + 0.1), palette.trim);
        }
        if self.cladding {
            let strip = |s: f32| [vec2(-s, 0.0), vec2(-s + 10.0, 0.0), vec2(-s + 10.0, 0.34), vec2(-s, 0.34)];
            skin = skin.mark_both(&Prism::side(&strip(p.length_m + 0.1), 0.2..=2.0), palette.trim);
        }
        skin
    }

    /// A wheel arch cut out on both sides, with a dark well and a lip that follows the skin.
    fn arch(&self, skin: Shape, axle: f32, palette: &Palette) -> (Shape, Shape) {
        let radius = self.wheel_radius_m * 1.1 + 0.02;
        let centre = vec2(-axle, self.wheel_radius_m + 0.015);
        let inner = self.half_m() * 0.52;
        let angles: Vec<f32> = (0..=24).map(|i| -0.45 + (TAU / 2.0 + 0.9) * i as f32 / 24.0).collect();
        let rim: Vec<Vec3> = angles
            .iter()
            .map(|a| centre + Vec2::from_angle(*a) * radius)
            .map(|q| {
                let z = q.y.max(self.profile.clearance_m + 0.03);
                vec3(q.x, skin.outside_at(q.x, z).unwrap_or(self.half_m() * 0.95), q.y)
            })
            .collect();
        let row = |y: f32| rim.iter().map(|&q| vec3(q.x, y, q.z)).collect::<Vec<_>>();
        let well = Shape::sheet(&[row(inner), rim.clone()]).slot(palette.seam);
        let back: Vec<Vec2> = rim.iter().map(|q| vec2(q.x, q.z)).collect();
        let wall = Shape::flat(&back).turned(Quat::from_rotation_x(FRAC_PI_2)).inside_out();
        let wall = wall.moved(Vec3::Y * inner).slot(palette.seam);
        let lip_slot = if self.cladding { palette.trim } else { palette.paint };
        let lip = Shape::tube(&rim, if self.cladding { 0.03 } else { 0.012 }, 6).slot(lip_slot);
        let cut = Prism::round_side(centre, radius, 32, inner..=2.0);
        let skin = skin.without(&cut).without(&cut.mirrored());
        (skin, well.and(wall).and(lip).both_sides())
    }

    fn wheels(&self, axle: f32, palette: &Palette) -> Shape {
        let width = 0.19 + self.wheel_radius_m * 0.1;
        let y = self.half_m() * 0.985 - width / 2.0 - 0.02;
        wheel(palette, self.wheel_radius_m, width, self.rim).moved(vec3(-axle, y, self.wheel_radius_m)).both_sides()
    }

    fn interior(&self, lines: &Lines, palette: &Palette) -> Shape {
        let p = &self.profile;
        let half = self.half_m() * 0.84;
        let mut parts = Vec::new();
        let (front, rear) = (-p.cowl.0 - 0.1, -self.last_window_m - 0.2);
        let floor = Shape::block(vec3(front - rear, half * 2.0, 0.02)).moved(vec3((front + rear) / 2.0, 0.0, 0.36));
        parts.push(floor);
        let dashboard = Shape::rounded_block(vec3(0.5, half * 2.0, 0.3), 0.08);
        parts.push(dashboard.moved(vec3(-p.cowl.0 - 0.4, 0.0, p.belt_m[0] - 0.16)));
        let driver = if self.right_hand_drive { -0.36 } else { 0.36 };
        let ring: Vec<Vec3> = (0..=16).map(|i| Vec2::from_angle(TAU * i as f32 / 16.0).extend(0.0) * 0.18).collect();
        let steering = Shape::tube(&ring, 0.016, 6).turned(Quat::from_rotation_y(-1.1));
        parts.push(steering.moved(vec3(-p.cowl.0 - 0.72, driver, p.belt_m[0] + 0.0)));
        for (row, &s) in self.seats_m.iter().enumerate() {
            let base = 0.42 + (p.belt_m[0] - 0.92).max(0.0);
            let back = lines.belt_m(s).y - 0.04;
            let places: &[(f32, f32)] = if row == 0 { &[(0.36, 0.5), (-0.36, 0.5)] } else { &[(0.0, half * 1.75)] };
            for &(y, width) in places {
                let cushion = Shape::rounded_block(vec3(0.5, width, 0.18), 0.06).moved(vec3(-s + 0.2, y, base));
                let rest = Shape::rounded_block(vec3(0.14, width, back - base + 0.1), 0.06)
                    .turned(Quat::from_rotation_y(-0.2))
                    .moved(vec3(-s - 0.12, y, (back + base) / 2.0));
                parts.extend([cushion, rest]);
                let heads: &[f32] = if row == 0 { &[0.0] } else { &[0.4, -0.4] };
                for &dy in heads {
                    let head = Shape::rounded_block(vec3(0.1, 0.25, 0.17), 0.05);
                    parts.push(head.moved(vec3(-s - 0.22, y + dy, back + 0.12)));
                }
            }
        }
        Shape::join(parts).slot(palette.interior)
    }

    /// Mirrors, handles, rails, exhaust.
    fn fittings(&self, skin: &Shape, lines: &Lines, palette: &Palette) -> Shape {
        let p = &self.profile;
        let s = p.cowl.0 + 0.42;
        let z = lines.belt_m(s).y + 0.06;
        let y = skin.outside_at(-s, z - 0.05).unwrap_or(self.half_m() * 0.9);
        let arm = Shape::rounded_block(vec3(0.07, 0.12, 0.04), 0.015).moved(vec3(-s, y + 0.03, z - 0.02));
        let shell = Shape::rounded_block(vec3(0.11, 0.17, 0.13), 0.045).moved(vec3(-s, y + 0.1, z + 0.04));
        let pane = Shape::block(vec3(0.004, 0.13, 0.09)).moved(vec3(-s - 0.055, y + 0.1, z + 0.04));
        let mut parts = vec![arm.slot(palette.trim), shell.slot(palette.paint), pane.slot(palette.chrome)];
        for s in self.door_ends_m().take(2) {
            let z = lines.belt_m(s).y - 0.13;
            if let Some(y) = skin.outside_at(-s + 0.18, z) {
                let handle = Shape::rounded_block(vec3(0.19, 0.03, 0.03), 0.012);
                parts.push(handle.moved(vec3(-s + 0.18, y + 0.012, z)).slot(palette.paint));
            }
        }
        if self.roof_rails {
            let rail: Vec<Vec3> = (0..=12)
                .map(|i| p.header.0 + 0.25 + (p.rear_header.0 - p.header.0 - 0.35) * i as f32 / 12.0)
                .enumerate()
                .map(|(i, s)| {
                    let q = lines.rail_m(s);
                    vec3(-s, q.x - 0.035, q.y + if i == 0 || i == 12 { 0.01 } else { 0.075 })
                })
                .collect();
            parts.push(Shape::tube(&rail, 0.016, 6).slot(palette.chrome));
        }
        let wiper = Shape::tube(
            &[vec3(-p.cowl.0 - 0.02, 0.1, p.cowl.1 + 0.03), vec3(-p.cowl.0 - 0.1, 0.6, p.cowl.1 + 0.045)],
            0.008,
            5,
        );
        let one = Shape::join(parts).both_sides();
        one.and(wiper.slot(palette.trim))
    }
}

/// The convex hull of points, counter-clockwise (Andrew's monotone chain).
fn hull(mut points: Vec<Vec2>) -> Vec<Vec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |points: &mut dyn Iterator<Item = Vec2>| {
        let mut chain: Vec<Vec2> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                if (b - a).perp_dot(p - a) > 1e-7 {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut lower = half(&mut points.iter().copied());
    lower.extend(half(&mut points.iter().rev().copied()));
    lower
}
