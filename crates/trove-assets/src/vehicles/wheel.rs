//! Wheels.

use std::f32::consts::TAU;

use glam::{Quat, Vec2, Vec3, vec2, vec3};
use serde::Deserialize;

use super::slots::Slots;
use crate::shape::Shape;

/// How the rim looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Rim {
    /// That many cast spokes.
    Spokes(usize),
    /// That many pairs of cast spokes.
    Pairs(usize),
    /// A plastic cover with that many holes.
    Cover(usize),
    /// Pressed steel with holes and a raised hub, as lorries and buses have it.
    Steel,
    /// Like `Steel`, seen from the outside of twin tyres.
    DeepSteel,
}

/// A wheel about the origin that turns about y, its outside towards +y.
pub(crate) fn wheel(slots: &Slots, radius_m: f32, width_m: f32, rim: Rim) -> Shape {
    let (r, half) = (radius_m, width_m / 2.0);
    let share = match rim {
        Rim::Spokes(_) | Rim::Pairs(_) => 0.7,
        Rim::Cover(_) => 0.66,
        Rim::Steel | Rim::DeepSteel => 0.62,
    };
    let bead = r * share;
    // Profiles are (radius, distance outwards), walked from the inside of the car to the outside.
    let groove = r - 0.008;
    let tyre = [
        vec2(r * 0.93, -half * 0.97),
        vec2(r, -half * 0.7),
        vec2(r, half * 0.05),
        vec2(groove, half * 0.1),
        vec2(groove, half * 0.2),
        vec2(r, half * 0.25),
        vec2(r, half * 0.68),
        vec2(r * 0.985, half * 0.86),
        vec2(r * 0.95, half * 0.97),
        vec2(bead + (r - bead) * 0.5, half * 1.02),
        vec2(bead + (r - bead) * 0.12, half * 0.95),
        vec2(bead, half * 0.84),
    ];
    let barrel = [vec2(bead * 1.02, half * 0.82), vec2(bead * 0.98, half * 0.89), vec2(bead * 0.94, half * 0.8)];
    let mut parts = vec![turned(&tyre, 24).slot(slots.rubber), turned(&barrel, 24).slot(slots.rim)];
    let back = [vec2(bead * 0.98, -half * 0.8), vec2(0.0, -half * 0.8)];
    parts.push(turned(&back, 16).inside_out().slot(slots.trim));
    let spoke = |angle: f32, slant: f32| {
        let (hub, outer, scale) = (r * 0.1, bead * 0.97, r / 0.32);
        let outline = [
            vec2(hub, -0.03 * scale),
            vec2(outer, -0.017 * scale + slant),
            vec2(outer, 0.017 * scale + slant),
            vec2(hub, 0.03 * scale),
        ];
        // Spokes bow outwards towards the hub.
        let spoke = Shape::extruded(&outline, half * 0.3).moved(Vec3::Z * half * 0.45);
        spoke.turned(Quat::from_rotation_z(angle)).upright().slot(slots.rim)
    };
    match rim {
        Rim::Spokes(_) | Rim::Pairs(_) => {
            let well = [vec2(bead * 0.94, half * 0.8), vec2(bead * 0.92, -half * 0.3), vec2(0.0, -half * 0.3)];
            parts.push(turned(&well, 16).slot(slots.seam));
            // The brake: a bright disc and its caliper.
            let disc = [vec2(bead * 0.8, -half * 0.1), vec2(bead * 0.8, half * 0.05), vec2(bead * 0.3, half * 0.05)];
            parts.push(turned(&disc, 18).slot(slots.disc));
            let caliper = Shape::rounded_block(vec3(bead * 0.3, half * 0.5, bead * 0.55), 0.02);
            parts.push(caliper.moved(vec3(bead * 0.68, half * 0.05, 0.0)).slot(slots.trim));
            match rim {
                Rim::Pairs(count) => {
                    for i in 0..count {
                        let angle = TAU * i as f32 / count as f32;
                        let apart = 0.8 / count as f32;
                        parts.extend([spoke(angle - apart * 0.5, -0.012), spoke(angle + apart * 0.5, 0.012)]);
                    }
                }
                Rim::Spokes(count) => parts.extend((0..count).map(|i| spoke(TAU * i as f32 / count as f32, 0.0))),
                _ => {}
            }
            let hub = r * 0.16;
            let cap = [vec2(hub, half * 0.4), vec2(hub * 0.9, half * 0.76), vec2(hub * 0.45, half * 0.7)];
            parts.push(turned(&cap, 16).slot(slots.rim));
            let badge = [vec2(hub * 0.45, half * 0.7), vec2(hub * 0.4, half * 0.76), vec2(0.0, half * 0.78)];
            parts.push(turned(&badge, 14).slot(slots.trim));
        }
        Rim::Cover(holes) => {
            let face = [
                vec2(bead * 0.97, half * 0.83),
                vec2(bead * 0.86, half * 0.95),
                vec2(bead * 0.4, half * 0.8),
                vec2(bead * 0.22, half * 0.93),
                vec2(0.0, half * 0.95),
            ];
            parts.push(turned(&face, 24).slot(slots.rim));
            for i in 0..holes {
                let outline =
                    [vec2(0.42, -0.035), vec2(0.8, -0.13), vec2(0.84, 0.0), vec2(0.8, 0.13), vec2(0.42, 0.035)];
                let hole = Shape::flat(&outline.map(|p| p * bead * vec2(1.0, 8.0 / holes as f32)));
                let hole = hole.bent(|p| p + Vec3::Z * (half * (0.8 + 0.15 * ((p.x / bead - 0.4) / 0.46)) + 0.004));
                let hole = hole.turned(Quat::from_rotation_z(TAU * i as f32 / holes as f32));
                parts.push(hole.upright().slot(slots.seam));
            }
        }
        Rim::Steel | Rim::DeepSteel => {
            let (face, hub) = if rim == Rim::Steel { (0.55, 0.95) } else { (-0.1, 0.35) };
            let dish = [
                vec2(bead * 0.94, half * 0.8),
                vec2(bead * 0.86, half * (face - 0.35)),
                vec2(bead * 0.62, half * face),
                vec2(bead * 0.4, half * face),
                vec2(bead * 0.36, half * hub),
                vec2(bead * 0.3, half * (hub + 0.05)),
                vec2(0.0, half * (hub + 0.05)),
            ];
            parts.push(turned(&dish, 24).slot(slots.rim));
            for i in 0..8 {
                let angle = TAU * (i as f32 + 0.5) / 8.0;
                let hole = Shape::flat(&round(bead * 0.075, 8)).upright();
                let centre = vec3(angle.cos(), 0.0, angle.sin()) * bead * 0.52;
                parts.push(hole.moved(centre + Vec3::Y * (half * face + 0.003)).slot(slots.seam));
            }
        }
    }
    Shape::join(parts)
}

/// A profile of (radius, distance) points turned about y.
fn turned(profile: &[Vec2], around: usize) -> Shape {
    Shape::lathe(profile, around).upright()
}

fn round(radius_m: f32, corners: usize) -> Vec<Vec2> {
    (0..corners).map(|i| Vec2::from_angle(TAU * i as f32 / corners as f32) * radius_m).collect()
}
