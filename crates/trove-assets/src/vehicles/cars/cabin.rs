//! What is seen through a car's windows: seats, dashboard, who sits there.

use std::f32::consts::TAU;

use glam::{Quat, Vec2, Vec3, vec3};

use super::plan::CarPlan;
use super::shell::Shell;
use crate::shape::{Blend, Limb, Shape};
use crate::vehicles::slots::Slots;

/// How far the front seats' middles are from the car's.
const SEAT_M: f32 = 0.36;

/// Floor, door cards, dashboard, steering wheel and seats.
pub(super) fn interior(plan: &CarPlan, body: &Shell, slots: &Slots) -> Shape {
    let p = &plan.profile;
    let half = plan.half_m() - 0.13;
    let (front, rear) = (p.cowl.0 + 0.2, plan.glass_end_m[0].max(plan.seats_m[plan.seats_m.len() - 1] + 0.25));
    let belt = p.belt_m[0];
    let floor_m = p.clearance_m + 0.12;
    let slab = |size: Vec3, at: Vec3| Shape::block(size).moved(at);
    let mut dark = vec![slab(vec3(p.length_m - 0.5, plan.half_m() * 1.6, 0.02), vec3(-p.length_m / 2.0, 0.0, floor_m))];
    let mut wall = |a: f32, b: f32, z: f32| {
        let card = slab(vec3(b - a, 0.03, z - floor_m), vec3(-(a + b) / 2.0, half, (z + floor_m) / 2.0));
        dark.push(card.both_sides());
    };
    wall(front, (front + rear) / 2.0, belt - 0.03);
    wall((front + rear) / 2.0, rear, body.belt_m(rear).min(belt + 0.1) - 0.03);
    // Under the windscreen, and behind the seats.
    let dash = Shape::rounded_block(vec3(0.52, half * 2.0, 0.26), 0.07);
    dark.push(dash.moved(vec3(-p.cowl.0 - 0.42, 0.0, belt - 0.15)));
    dark.push(slab(vec3(0.4, half * 1.9, 0.02), vec3(-p.cowl.0 - 0.2, 0.0, belt - 0.06)));
    let last = plan.seats_m[plan.seats_m.len() - 1];
    if plan.blind_from_m < p.length_m {
        let high = body.rail_m(last) - 0.04;
        dark.push(slab(vec3(0.03, half * 2.0, high - floor_m), vec3(-last - 0.35, 0.0, (high + floor_m) / 2.0)));
    } else if !p.has_bed {
        let end = (p.deck.0 - p.screen_bow_m[1]).max(last + 0.25);
        let z = body.belt_m(last) - 0.03;
        dark.push(slab(vec3(end - last - 0.2, half * 1.75, 0.03), vec3(-(end + last + 0.2) / 2.0, 0.0, z)));
    } else {
        let high = belt - 0.05;
        dark.push(slab(vec3(0.03, half * 2.0, high - floor_m), vec3(-rear, 0.0, (high + floor_m) / 2.0)));
    }
    let driver = driver_m(plan);
    let hood = Shape::rounded_block(vec3(0.2, 0.36, 0.12), 0.05);
    dark.push(hood.moved(vec3(-p.cowl.0 - 0.52, driver, belt - 0.01)));
    let (s, z) = wheel_at(plan);
    let ring: Vec<Vec3> = (0..=18).map(|i| Vec2::from_angle(TAU * i as f32 / 18.0).extend(0.0) * 0.185).collect();
    let hub = Shape::ellipsoid(vec3(0.07, 0.08, 0.03), 10);
    let bar = Shape::block(vec3(0.035, 0.34, 0.012));
    let steering = Shape::tube(&ring, 0.015, 5).and(hub).and(bar).turned(Quat::from_rotation_y(-1.15));
    dark.push(steering.moved(vec3(-s, driver, z)));
    let mut parts = vec![Shape::join(dark).slot(slots.interior)];
    let screen = Shape::block(vec3(0.012, 0.24, 0.13)).moved(vec3(-p.cowl.0 - 0.64, 0.0, belt + 0.0));
    parts.push(screen.slot(slots.seam));
    let mirror = Shape::rounded_block(vec3(0.03, 0.22, 0.06), 0.015);
    parts.push(mirror.moved(vec3(-p.header.0 - 0.02, 0.0, p.header.1 - 0.11)).slot(slots.interior));
    for (row, &s) in plan.seats_m.iter().enumerate() {
        parts.push(seats(plan, body, row, s).slot(slots.seat));
    }
    Shape::join(parts)
}

fn driver_m(plan: &CarPlan) -> f32 {
    if plan.right_hand_drive { -SEAT_M } else { SEAT_M }
}

/// Distance from the front and height of the steering wheel's middle.
fn wheel_at(plan: &CarPlan) -> (f32, f32) {
    (plan.seats_m[0] - 0.52, plan.profile.belt_m[0] - 0.03)
}

/// Height of the cushions.
fn cushion_m(plan: &CarPlan) -> f32 {
    plan.profile.belt_m[0] - 0.42
}

fn seats(plan: &CarPlan, body: &Shell, row: usize, s: f32) -> Shape {
    let base = cushion_m(plan) - 0.1;
    let top = body.belt_m(s).min(plan.profile.belt_m[0] + 0.08) + 0.05;
    let width = plan.half_m() * 1.45;
    let places: &[(f32, f32)] = if row == 0 { &[(SEAT_M, 0.5), (-SEAT_M, 0.5)] } else { &[(0.0, width)] };
    let lean = Quat::from_rotation_y(-0.3);
    let mut parts = Vec::new();
    for &(y, width) in places {
        parts.push(Shape::rounded_block(vec3(0.5, width, 0.2), 0.07).moved(vec3(-s + 0.22, y, base)));
        let rest = Shape::rounded_block(vec3(0.13, width * 0.96, top - base + 0.12), 0.06).turned(lean);
        parts.push(rest.moved(vec3(-s - 0.08, y, (top + base) / 2.0)));
        let heads: &[f32] = if row == 0 { &[0.0] } else { &[0.36, -0.36] };
        for &dy in heads {
            let head = Shape::rounded_block(vec3(0.09, 0.25, 0.17), 0.045).turned(lean);
            parts.push(head.moved(vec3(-s - 0.2, y + dy, top + 0.1)));
        }
    }
    Shape::join(parts)
}

/// Someone on a front seat: at the wheel, or beside.
pub(super) fn occupant(plan: &CarPlan, drives: bool, slots: &Slots) -> Shape {
    let side = if drives { driver_m(plan) } else { -driver_m(plan) };
    let seat = vec3(-plan.seats_m[0] + 0.06, side, cushion_m(plan) + 0.1);
    // Low roofs are for people who lean back.
    let room = Shell::of(plan).rail_m(plan.seats_m[0]) - 0.01 - seat.z;
    let tall = (room / 0.87).min(1.0);
    let at = |x: f32, y: f32, z: f32| seat + vec3(x, y, z * tall);
    let (wheel_s, wheel_z) = wheel_at(plan);
    let hand = |y: f32| {
        if drives { vec3(-wheel_s - 0.03, side + y * 0.85, wheel_z + 0.02) } else { at(0.28, y * 0.7, 0.08) }
    };
    let neck = at(-0.15, 0.0, 0.55);
    let head = neck + vec3(0.04, 0.0, 0.14);
    let mut body = vec![
        Limb::new(at(0.0, 0.0, 0.05), at(-0.1, 0.0, 0.3), 0.12, 0.115).wide(Vec3::Y, 1.3),
        Limb::new(at(-0.1, 0.0, 0.3), at(-0.14, 0.0, 0.46), 0.115, 0.1).wide(Vec3::Y, 1.5),
    ];
    let mut hands = vec![Limb::new(neck - Vec3::Z * 0.05, head, 0.055, 0.05)];
    for y in [0.2, -0.2] {
        let (shoulder, hand) = (at(-0.13, y, 0.46), hand(y));
        let elbow = (shoulder + hand) / 2.0 + vec3(-0.03, y * 0.3, -0.13);
        body.extend([Limb::new(shoulder, elbow, 0.06, 0.05), Limb::new(elbow, hand, 0.048, 0.036)]);
        hands.push(Limb::new(hand, hand + vec3(0.06, 0.0, 0.02), 0.036, 0.03));
        body.push(Limb::new(at(0.05, y * 0.5, 0.03), at(0.5, y * 0.6, 0.08), 0.09, 0.065));
    }
    hands.push(Limb::new(head + vec3(0.0, 0.0, 0.03), head + vec3(0.01, 0.0, -0.04), 0.092, 0.068));
    hands.push(Limb::new(head + vec3(0.088, 0.0, 0.01), head + vec3(0.1, 0.0, -0.02), 0.012, 0.014));
    let hair = Limb::new(head + vec3(-0.03, 0.0, 0.02), head + vec3(-0.01, 0.0, 0.07), 0.094, 0.085);
    Shape::join([
        Blend::new(body, 0.05).surface(0.055).slot(slots.cloth),
        Blend::new(hands, 0.015).surface(0.034).slot(slots.skin),
        Blend::new(vec![hair], 0.02).surface(0.034).slot(slots.hair),
    ])
}
