//! A bus's front, back and roof.

use glam::{Vec2, Vec3, vec2, vec3};

use super::body::{BusPlan, SKIRT_M, framed};
use crate::shape::{Prism, Shape, pane, rect, shrunk};
use crate::vehicles::decal::{display, on_side};
use crate::vehicles::hull::{Hull, Section, lying};
use crate::vehicles::workshop::{Workshop, block};

impl BusPlan {
    /// Windscreen, display, lamps, bumper, wipers, mirrors.
    pub(super) fn front(&self, work: &mut Workshop, hull: &Hull, skin: Shape) -> Shape {
        let slots = work.slots;
        let ahead = |polygon: &[Vec2]| Prism::front(polygon, -0.75..=0.2);
        let half = self.half();
        let low = self.front_low_m;
        let high = if self.coach { self.roof() - 0.42 } else { self.decks[0].1 + 0.06 };
        let mut skin = skin;
        // The black face, glass in it, a post where there are two panes.
        let sign = 0.3;
        let top = if self.decks.len() > 1 { high + sign + 0.06 } else { (high + sign + 0.04).min(self.roof() - 0.07) };
        let face = rect(-half + 0.02, half - 0.02, low - 0.02, top);
        skin = skin.mark(&ahead(&pane(&face, 0.18)), slots.trim);
        let glass = rect(-half + 0.06, half - 0.06, low + 0.03, high - 0.02);
        skin = skin.mark(&ahead(&pane(&glass, 0.16)), slots.glass);
        if !self.coach {
            skin = skin.mark(&ahead(&rect(-0.012, 0.012, low, high)), slots.trim);
        }
        let room = (top - high - 0.06).max(0.14);
        let (a, b) = (vec2(-half * 0.78, high + 0.015), vec2(half * 0.78, high + 0.015 + room));
        let lamps = display(&mut work.model, self.route, b - a);
        work.add(lamps, hull.front_panel(a, b, 0.006));
        if let [_, (low, high)] = *self.decks {
            let upper = rect(-half + 0.06, half - 0.06, low, high + 0.02);
            skin = skin.mark(&ahead(&pane(&upper, 0.16)), slots.trim);
            skin = skin.mark(&ahead(&pane(&shrunk(&upper, 0.045), 0.14)), slots.glass);
        }
        // Bumper, flap, lamps.
        skin = skin.mark(&ahead(&rect(-3.0, 3.0, SKIRT_M + 0.17, SKIRT_M + 0.18)), slots.seam);
        skin = framed(
            skin,
            &pane(&rect(-half * 0.5, half * 0.5, SKIRT_M + 0.25, low - 0.1), 0.05),
            -0.75..=0.2,
            slots.paint,
            slots.seam,
        );
        let z = SKIRT_M + 0.36;
        let outline = rect(half * 0.56, half * 0.97, z - 0.085, z + 0.1);
        let bowls = [(half * 0.64, z, 0.07), (half * 0.77, z, 0.07), (half * 0.885, z + 0.005, 0.055)];
        skin = work.headlamps(skin, hull, &outline, &bowls);
        skin = skin.mark_both(&ahead(&rect(half * 0.97, half * 1.01, z - 0.06, z + 0.08)), slots.amber);
        let fog = vec3(hull.front_at(half * 0.7, SKIRT_M + 0.1) + 0.004, half * 0.7, SKIRT_M + 0.1);
        work.pair(slots.lamp, Shape::ellipsoid(vec3(0.015, 0.06, 0.04), 14).moved(fog));
        work.number_plate(vec3(hull.front_at(0.0, SKIRT_M + 0.1) + 0.012, 0.0, SKIRT_M + 0.1), true);
        let emblem = hull.front_panel(vec2(-half * 0.4, low - 0.16), vec2(half * 0.4, low - 0.13), 0.012);
        work.add(slots.chrome, emblem);
        for side in [1.0, -1.0] {
            let pivot = vec2(side * half * 0.12, low - 0.01);
            work.wiper(hull, pivot, vec2(side * half * 0.82, low + 0.1));
        }
        // Mirrors: held from above, in front of the corners.
        let z = if self.coach { high + 0.05 } else { high - 0.12 };
        let hold = |dz: f32| vec3(hull.front_at(half * 0.8, z) - 0.05, half * 0.86, z + dz);
        let at = vec3(hull.front_at(half * 0.8, z) + 0.2, half + 0.08, z - 0.36);
        work.mirror([hold(0.0), hold(-0.1)], at, vec3(0.11, 0.22, 0.4));
        skin
    }

    /// Rear window, engine flap, lamps, plate.
    pub(super) fn back(&self, work: &mut Workshop, hull: &Hull, skin: Shape) -> Shape {
        let slots = work.slots;
        let x = -self.length_m - 0.2..=-self.length_m + 0.6;
        let behind = |polygon: &[Vec2]| Prism::front(polygon, x.clone());
        let half = self.half();
        let mut skin = skin.mark(&behind(&rect(-3.0, 3.0, SKIRT_M - 0.1, SKIRT_M + 0.22)), slots.trim);
        for (deck, &(low, high)) in self.decks.iter().enumerate() {
            let low = if deck == 0 { low.max(1.72) } else { low };
            if high > low + 0.3 {
                let window = rect(-half * 0.8, half * 0.8, low, high);
                skin = skin.mark(&behind(&pane(&window, 0.12)), slots.trim);
                skin = skin.mark(&behind(&pane(&shrunk(&window, 0.04), 0.1)), slots.glass);
            }
        }
        let flap = rect(-half * 0.66, half * 0.66, SKIRT_M + 0.3, 1.6);
        skin = framed(skin, &pane(&flap, 0.06), x.clone(), slots.second, slots.seam);
        for k in 0..7 {
            let z = 0.78 + 0.06 * k as f32;
            skin = skin.mark(&behind(&rect(-half * 0.5, half * 0.5, z, z + 0.03)), slots.seam);
        }
        // Round lamps above one another in black columns.
        let column = rect(half * 0.72, half * 0.93, 0.72, 1.5);
        skin = skin.mark_both(&behind(&pane(&column, 0.07)), slots.trim);
        for (k, slot) in [slots.white, slots.red, slots.red, slots.amber].into_iter().enumerate() {
            let (y, z) = (half * 0.825, 0.82 + 0.19 * k as f32);
            for side in [1.0, -1.0] {
                work.tail_lens(slot, vec3(hull.back_at(y, z) - 0.008, side * y, z), 0.075);
            }
        }
        let z = self.roof() - 0.3;
        for side in [1.0, -1.0] {
            work.tail_lens(slots.red, vec3(hull.back_at(half * 0.75, z) - 0.006, side * half * 0.75, z), 0.045);
        }
        work.add(slots.red, hull.back_panel(vec2(-0.2, z), vec2(0.2, z + 0.04), 0.012));
        work.number_plate(vec3(hull.back_at(0.0, 0.66) - 0.014, 0.0, 0.66), false);
        let size = vec2(0.5, 0.2);
        let low = if self.coach { 2.62 } else { 1.5_f32.max(self.decks[0].0 + 0.62) };
        let at = vec2(half * 0.3, low);
        let number = self.route.split(' ').next().unwrap_or("");
        let lamps = display(&mut work.model, number, size);
        if !self.coach {
            work.add(lamps, hull.back_panel(at - size / 2.0, at + size / 2.0, 0.008));
        }
        work.add(
            slots.trim,
            Shape::tube(
                &[
                    vec3(-self.length_m + 0.5, half - 0.5, SKIRT_M),
                    vec3(-self.length_m + 0.06, half - 0.5, SKIRT_M - 0.02),
                ],
                0.045,
                10,
            ),
        );
        skin
    }

    /// What stands on the roof: cooling, batteries, hatches; and the display on the side.
    pub(super) fn roof_units(&self, work: &mut Workshop, ends: [bool; 2]) {
        let slots = work.slots;
        let roof = self.roof();
        let room = self.height_m - roof;
        let unit = |s: f32, length: f32, wide: f32| -> Shape {
            let section = |x: f32, inset: f32| Section {
                x: -s + x,
                z: roof + room / 2.0 - 0.02,
                half: vec2(wide - inset, room / 2.0 + 0.02 - inset * 0.4),
                corner: 0.085,
            };
            lying(&[
                section(-length / 2.0, 0.12),
                section(-length / 2.0 + 0.12, 0.02),
                section(-length / 2.0 + 0.3, 0.0),
                section(length / 2.0 - 0.3, 0.0),
                section(length / 2.0 - 0.12, 0.02),
                section(length / 2.0, 0.12),
            ])
        };
        if room > 0.1 {
            let front = if ends[0] { 0.3 } else { 0.5 };
            work.add(slots.paint, unit(self.length_m * front, (self.length_m * 0.3).min(2.9), 0.86));
            if self.length_m > 8.0 {
                work.add(slots.white, unit(self.length_m * 0.72, 2.2, 0.82));
                for k in 0..2 {
                    let fan = Shape::cylinder(0.3, 0.02, 24).moved(vec3(
                        -self.length_m * 0.72 + 0.7 * (k as f32 - 0.5),
                        0.0,
                        self.height_m - 0.02,
                    ));
                    work.add(slots.trim, fan);
                }
            }
        } else {
            for t in [0.25, 0.7] {
                work.add(slots.white, block([0.75, 0.75, 0.05], [-self.length_m * t, 0.0, roof + 0.015], 0.02));
            }
        }
        let size = vec2(0.85, 0.2);
        if !self.coach && ends[0] {
            let lamps = display(&mut work.model, self.route, size);
            let (from, width) = self.doors_m[0];
            let at = vec3(-from - width - 0.65, self.door_side * (self.half() - 0.012), self.decks[0].1 - 0.12);
            work.add(slots.trim, Shape::block(vec3(size.x + 0.06, 0.02, size.y + 0.05)).moved(at));
            work.add(lamps, on_side(self.door_side, at + Vec3::Y * self.door_side * 0.012, size));
        }
        let count = (self.length_m / 2.6) as usize;
        for i in 0..count {
            let x = -self.length_m * (i as f32 + 0.5) / count as f32;
            if self.axles_m.iter().all(|a| (x + a).abs() > self.wheel_m + 0.25) {
                work.pair(slots.amber, block([0.1, 0.012, 0.035], [x, self.half() + 0.001, SKIRT_M + 0.3], 0.004));
            }
        }
    }
}
