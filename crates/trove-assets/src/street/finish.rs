//! What street furniture is made of, and how its parts are laid.

use std::sync::LazyLock;

use glam::{Mat3, Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Mapping, Material};

use crate::shape::Shape;
use crate::surfaces;

/// Galvanised steel.
pub(super) fn galvanised() -> Material {
    Material { metalness: 0.6, dirt: 0.4, ..Material::plain("galvanised steel", vec3(0.36, 0.37, 0.38), 0.5) }
}

/// Brushed stainless steel.
pub(super) fn stainless() -> Material {
    Material { metalness: 1.0, ..Material::plain("stainless steel", vec3(0.56, 0.56, 0.55), 0.32) }
}

/// Painted metal.
pub(super) fn painted(color: Vec3) -> Material {
    Material { dirt: 0.4, ..Material::plain("paint", color, 0.42) }
}

/// Plastic that has stood in the sun.
pub(super) fn plastic(color: Vec3) -> Material {
    Material { dirt: 0.6, ..Material::plain("plastic", color, 0.5) }
}

/// Black rubber.
pub(super) fn rubber() -> Material {
    Material::plain("rubber", Vec3::splat(0.022), 0.8)
}

/// Weathered timber.
pub(super) fn timber() -> Material {
    Material::plain("timber", vec3(0.21, 0.125, 0.065), 0.7)
}

/// Cast concrete, of which no two pieces look alike.
pub(super) fn concrete() -> Material {
    static CONCRETE: LazyLock<Material> = LazyLock::new(|| {
        let cast = surfaces::concrete(vec3(0.31, 0.3, 0.28), [2.0, 2.0], 0.0, 35).material("concrete/cast", 2);
        Material { mapping: Mapping::Triplanar, dirt: 0.6, ..cast }
    });
    CONCRETE.clone()
}

/// A thin clear pane.
pub(super) fn glass() -> Material {
    Material { transmission: 0.92, ..Material::plain("glass", vec3(0.86, 0.93, 0.91), 0.03) }
}

/// Retroreflective sheeting of a colour.
pub(super) fn reflective(color: Vec3) -> Material {
    Material::plain("reflective sheeting", color, 0.35)
}

/// A box with slightly rounded edges, its middle at a point.
pub(super) fn bar(centre: Vec3, size: Vec3) -> Shape {
    Shape::rounded_block(size, (size.min_element() * 0.2).min(0.012)).moved(centre)
}

/// An upright cylinder from a point up.
pub(super) fn post(foot: Vec3, radius_m: f32, height_m: f32, around: usize) -> Shape {
    Shape::cylinder(radius_m, height_m, around).moved(foot)
}

/// An (x, z) profile, counter-clockwise seen from −y, swept over a width in y about 0.
pub(super) fn swept(profile_xz: &[Vec2], width_m: f32) -> Shape {
    Shape::extruded(profile_xz, width_m).turned(Quat::from_rotation_x(std::f32::consts::FRAC_PI_2)).moved(vec3(
        0.0,
        width_m / 2.0,
        0.0,
    ))
}

/// A flat shape made in (x, y) stood up to look along x: its x goes to y, its y to z.
pub(super) fn upright(shape: Shape) -> Shape {
    shape.turned(Quat::from_mat3(&Mat3::from_cols(Vec3::Y, Vec3::Z, Vec3::X)))
}

/// A regular polygon about the origin, its first corner at an angle.
pub(super) fn polygon(corners: usize, radius_m: f32, first_rad: f32) -> Vec<Vec2> {
    let angle = |i: usize| first_rad + std::f32::consts::TAU * i as f32 / corners as f32;
    (0..corners).map(|i| Vec2::from_angle(angle(i)) * radius_m).collect()
}

/// A rectangle about the origin with rounded corners.
pub(super) fn rounded(size: Vec2, radius_m: f32) -> Vec<Vec2> {
    let inner = size / 2.0 - radius_m;
    [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
        .iter()
        .enumerate()
        .flat_map(|(i, &(x, y))| {
            let corner = inner * vec2(x, y);
            (0..4).map(move |k| {
                corner + Vec2::from_angle((i as f32 + k as f32 / 3.0) * std::f32::consts::FRAC_PI_2) * radius_m
            })
        })
        .collect()
}
