//! Wheels.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Quat, Vec2, Vec3, vec2, vec3};

use super::palette::Palette;
use crate::shape::Shape;

/// How the rim looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rim {
    /// That many cast spokes.
    Spokes(usize),
    /// Pressed steel with holes and a raised hub, as lorries and buses have it.
    Steel,
    /// Like `Steel`, seen from the outside of twin tyres.
    DeepSteel,
}

/// A wheel about the origin that turns about y, its outside towards +y.
pub(crate) fn wheel(palette: &Palette, radius_m: f32, width_m: f32, rim: Rim) -> Shape {
    let (r, half) = (radius_m, width_m / 2.0);
    let share = if let Rim::Spokes(_) = rim { 0.68 } else { 0.62 };
    let bead = r * share;
    // Profiles are (radius, distance outwards), walked from the inside of the car to the outside.
    let tyre = [
        vec2(bead * 0.96, -half * 0.85),
        vec2(bead * 1.05, -half * 0.95),
        vec2(r * 0.9, -half),
        vec2(r * 0.975, -half * 0.86),
        vec2(r, -half * 0.6),
        vec2(r, half * 0.6),
        vec2(r * 0.975, half * 0.86),
        vec2(r * 0.9, half),
        vec2(bead * 1.05, half * 0.95),
        vec2(bead, half * 0.84),
    ];
    let barrel = [vec2(bead * 1.02, half * 0.82), vec2(bead * 0.97, half * 0.88), vec2(bead * 0.93, half * 0.8)];
    let mut parts = vec![turned(&tyre, 28).slot(palette.rubber), turned(&barrel, 28).slot(palette.rim)];
    let back = [vec2(bead * 0.98, -half * 0.85), vec2(0.0, -half * 0.85)];
    parts.push(turned(&back, 20).inside_out().slot(palette.trim));
    match rim {
        Rim::Spokes(count) => {
            let well = [vec2(bead * 0.94, half * 0.8), vec2(bead * 0.92, half * 0.2), vec2(0.0, half * 0.2)];
            parts.push(turned(&well, 24).slot(palette.seam));
            let (hub, outer) = (r * 0.13, bead * 0.95);
            for i in 0..count {
                let mirror = [vec2(hub * 0.6, -0.022), vec2(outer, -0.03), vec2(outer, 0.03), vec2(hub * 0.6, 0.022)];
                let spoke = Shape::extruded(&mirror.map(|p| p * vec2(1.0, r / 0.32)), half * 0.25)
                    .moved(Vec3::Z * half * 0.52)
                    .turned(Quat::from_rotation_z(TAU * i as f32 / count as f32));
                parts.push(upright(spoke).slot(palette.rim));
            }
            let cap = [vec2(hub, half * 0.5), vec2(hub * 0.95, half * 0.78), vec2(0.0, half * 0.82)];
            parts.push(turned(&cap, 16).slot(palette.rim));
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
            parts.push(turned(&dish, 24).slot(palette.rim));
            for i in 0..8 {
                let angle = TAU * (i as f32 + 0.5) / 8.0;
                let hole = upright(Shape::flat(&round(bead * 0.075, 8)));
                let centre = vec3(angle.cos(), 0.0, angle.sin()) * bead * 0.52;
                parts.push(hole.moved(centre + Vec3::Y * (half * face + 0.003)).slot(palette.seam));
            }
        }
    }
    Shape::join(parts)
}

/// A profile of (radius, distance) points turned about y.
fn turned(profile: &[Vec2], around: usize) -> Shape {
    upright(Shape::lathe(profile, around))
}

/// From an axis along z to one along y.
pub(crate) fn upright(shape: Shape) -> Shape {
    shape.turned(Quat::from_rotation_x(-FRAC_PI_2))
}

fn round(radius_m: f32, corners: usize) -> Vec<Vec2> {
    (0..corners).map(|i| Vec2::from_angle(TAU * i as f32 / corners as f32) * radius_m).collect()
}
