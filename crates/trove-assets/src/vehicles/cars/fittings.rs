//! What stands off a car's skin: mirrors, handles, wipers, rails, plates, exhaust.

use glam::{Quat, Vec3, vec2, vec3};

use super::plan::CarPlan;
use super::shell::Shell;
use crate::shape::{Prism, Shape};
use crate::vehicles::slots::Slots;
use crate::vehicles::wheel::{Rim, wheel};

/// Handles and rails of the left half.
pub(super) fn on_the_side(plan: &CarPlan, body: &Shell, shell: &Shape, slots: &Slots) -> Shape {
    let p = &plan.profile;
    let mut parts = Vec::new();
    for s in plan.door_ends_m().take(2) {
        let (s, z) = (s - 0.16, body.belt_m(s) - 0.115);
        if let Some(y) = shell.outermost(Vec3::Y, vec3(-s, 0.0, z)) {
            let handle = Shape::rounded_block(vec3(0.2, 0.022, 0.026), 0.01).slot(slots.paint);
            let slot = if plan.is_chromed { slots.chrome } else { slots.paint };
            parts.push(handle.slot(slot).moved(vec3(-s, y + 0.024, z)));
            let hollow = Shape::ellipsoid(vec3(0.06, 0.006, 0.026), 12).slot(slots.seam);
            parts.push(hollow.moved(vec3(-s, y - 0.001, z)));
            for end in [0.085, -0.085] {
                let foot = Shape::rounded_block(vec3(0.03, 0.03, 0.022), 0.008);
                parts.push(foot.slot(slot).moved(vec3(-s + end, y + 0.01, z)));
            }
        }
    }
    if plan.roof_rails {
        let (from, to) = (p.header.0 + 0.3, p.rear_header.0 - 0.15);
        let rail: Vec<Vec3> = (0..=10)
            .map(|i| from + (to - from) * i as f32 / 10.0)
            .enumerate()
            .map(|(i, s)| {
                let lift = if i == 0 || i == 10 { 0.0 } else { 0.06 };
                vec3(-s, plan.half_m() * (p.roof_share - 0.07), body.rail_m(s) + 0.015 + lift)
            })
            .collect();
        let slot = if plan.is_chromed { slots.chrome } else { slots.trim };
        parts.push(Shape::tube(&rail, 0.015, 6).slot(slot));
    }
    Shape::join(parts)
}

/// A pair of mirrors, which stand out beyond the body's width.
pub(super) fn mirrors(plan: &CarPlan, slots: &Slots) -> Shape {
    let body = Shell::of(plan);
    let s = body.screen_side_m(0.12) + 0.1;
    let scale = (plan.profile.belt_m[0] / 1.0).clamp(0.9, 1.3);
    let z = body.belt_m(s) + 0.035 + 0.07 * scale;
    let y = plan.half_m() - plan.profile.shoulder_m * 0.6 - 0.02;
    let square = |v: f32| v.abs().powf(0.75).copysign(v);
    let case =
        Shape::ellipsoid(Vec3::ONE, 16).bent(|p| vec3(p.x, square(p.y), square(p.z)) * vec3(0.1, 0.115, 0.075) * scale);
    let cut = Prism::between(vec3(-1.0, -1.0, -1.0), vec3(-0.035 * scale, 1.0, 1.0));
    let (_, case) = case.split(&cut);
    let case = case.slot(slots.paint);
    let lower = Prism::between(vec3(-1.0, -1.0, -1.0), vec3(1.0, 1.0, -0.045 * scale));
    let case = case.mark(&lower, slots.trim);
    let oval: Vec<glam::Vec2> = (0..16)
        .map(|i| glam::Vec2::from_angle(std::f32::consts::TAU * i as f32 / 16.0) * vec2(0.108, 0.068) * scale)
        .collect();
    let pane = Shape::flat(&oval).turned(Quat::from_rotation_z(std::f32::consts::FRAC_PI_2));
    let pane = pane.turned(Quat::from_rotation_y(-std::f32::consts::FRAC_PI_2)).moved(Vec3::X * -0.03 * scale);
    let foot = Shape::rounded_block(vec3(0.07, 0.16, 0.045), 0.02).moved(vec3(0.0, -0.08, -0.06 * scale));
    let one = Shape::join([case, pane.slot(slots.chrome), foot.slot(slots.trim)]);
    one.moved(vec3(-s, y + 0.115 * scale + 0.03, z)).both_sides()
}

/// Wipers, badges, plate frames, exhaust and aerial.
pub(super) fn in_the_middle(plan: &CarPlan, body: &Shell, slots: &Slots) -> Shape {
    let p = &plan.profile;
    let half = plan.half_m();
    let mut parts = Vec::new();
    // Wipers lie along the windscreen's foot.
    let on_screen = |y: f32, up: f32| {
        let bow = p.screen_bow_m[0] * (y.abs() / half / 0.9).powi(3);
        let s = p.cowl.0 + (p.header.0 - p.cowl.0) * up + bow;
        vec3(-s + 0.012, y, p.cowl.1 + (p.header.1 - p.cowl.1) * up + 0.022)
    };
    let turn = if plan.right_hand_drive { -1.0 } else { 1.0 };
    for (from, to) in [(0.02, 0.62), (-0.6, -0.04)] {
        let (a, b, middle) = (on_screen(from * turn, 0.03), on_screen(to * turn, 0.09), 0.5 * (from + to) * turn);
        let blade = [a, on_screen(middle, 0.075), b];
        parts.push(Shape::tube(&blade, 0.009, 5).slot(slots.seam));
        parts.push(Shape::tube(&[on_screen(from * turn, 0.0), on_screen(middle, 0.08)], 0.011, 5).slot(slots.trim));
    }
    let nose = p.rake_m[0] * 0.4 + 0.035;
    let badge = Shape::ellipsoid(vec3(0.012, 0.05, 0.045), 14).slot(slots.chrome);
    let ring = Shape::ellipsoid(vec3(0.014, 0.036, 0.032), 12).slot(slots.trim);
    let badge = badge.and(ring);
    parts.push(badge.clone().moved(vec3(
        -nose * if plan.face.badge_m > -0.1 { 1.0 } else { 0.5 },
        0.0,
        p.nose_m + plan.face.badge_m,
    )));
    let badge = badge.scaled(Vec3::splat(0.75));
    parts.push(badge.moved(vec3(-p.length_m + 0.033, 0.0, p.tail_m - 0.085)));
    let pipe = Shape::tube(&[vec3(0.25, 0.0, 0.0), vec3(0.0, 0.0, -0.01)], 0.03, 10).slot(slots.chrome);
    parts.push(pipe.moved(vec3(-p.length_m + 0.09, -half * 0.62, p.clearance_m + 0.115)));
    if plan.blind_from_m > p.length_m {
        let fin = Shape::ellipsoid(vec3(0.08, 0.016, 0.04), 12).slot(slots.paint);
        parts.push(fin.moved(vec3(-p.rear_header.0 + 0.22, 0.0, body.roof_m(p.rear_header.0 - 0.22))));
    }
    if plan.back.has_spare {
        let wheel = wheel(slots, plan.wheel_radius_m * 0.97, 0.2, Rim::Cover(6));
        let wheel = wheel.turned(Quat::from_rotation_z(std::f32::consts::FRAC_PI_2));
        parts.push(wheel.moved(vec3(-p.length_m - 0.05, 0.12, p.tail_m - 0.12)));
    }
    Shape::join(parts)
}
