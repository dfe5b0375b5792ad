//! What street furniture is made of, and how its parts are laid.

use glam::{Mat3, Quat, Vec2, Vec3, vec2, vec3};
use trove_model::{Mapping, Material};

use crate::shape::{Model, Shape};
use crate::surfaces::{self, hash, step};

/// Galvanised steel.
pub(super) fn galvanised() -> Material {
    Material { dirt: 0.4, ..surfaces::set("metal/galvanised") }
}

/// Brushed stainless steel.
pub(super) fn stainless() -> Material {
    Material { dirt: 0.2, ..surfaces::set("metal/brushed") }
}

/// Steel that nobody painted.
pub(super) fn rusty() -> Material {
    surfaces::set("metal/rusted")
}

/// Painted metal, chipped and scratched.
pub(super) fn painted(color: Vec3) -> Material {
    Material { base_color: color, dirt: 0.4, ..surfaces::set("metal/painted") }
}

/// Plastic that has stood in the sun and was handled roughly.
pub(super) fn plastic(color: Vec3) -> Material {
    Material { base_color: color, dirt: 0.6, ..surfaces::set("plastic/scuffed") }
}

/// Black rubber.
pub(super) fn rubber() -> Material {
    surfaces::set("rubber/worn")
}

/// What is seen into only as darkness: slots, gaps, openings.
pub(super) fn dark() -> Material {
    Material::plain("dark", Vec3::splat(0.012), 0.9)
}

/// Oiled timber; shapes have uvs in metres, u along the grain (see [`board`]).
pub(super) fn timber() -> Material {
    Material { mapping: Mapping::Uv, dirt: 0.3, ..surfaces::set("wood/oiled") }
}

/// Timber that sun and rain made grey, with uvs as [`timber`].
pub(super) fn grey_timber() -> Material {
    Material { mapping: Mapping::Uv, dirt: 0.4, ..surfaces::set("wood/weathered") }
}

/// Cloth of a colour.
pub(super) fn cloth(color: Vec3) -> Material {
    Material { base_color: color, sheen: 0.3, dirt: 0.2, ..surfaces::set("fabric/woven") }
}

/// Coated cloth of a colour.
pub(super) fn tarpaulin(color: Vec3) -> Material {
    Material { base_color: color, ..surfaces::set("fabric/tarpaulin") }
}

/// Boxes of board.
pub(super) fn cardboard() -> Material {
    surfaces::set("paper/cardboard")
}

/// Cast concrete, of which no two pieces look alike.
pub(super) fn concrete() -> Material {
    Material { dirt: 0.6, ..surfaces::set("concrete/cast") }
}

/// A thin clear pane.
pub(super) fn glass() -> Material {
    surfaces::set("glass/pane")
}

/// Retroreflective sheeting of a colour.
pub(super) fn reflective(color: Vec3) -> Material {
    Material { base_color: color, dirt: 0.3, ..surfaces::set("sheeting/reflective") }
}

/// A box with slightly rounded edges, its middle at a point.
pub(super) fn bar(centre: Vec3, size: Vec3) -> Shape {
    Shape::rounded_block(size, (size.min_element() * 0.2).min(0.012)).moved(centre)
}

/// A box of timber with its grain along its longest side, cut from some place or other.
pub(super) fn board(centre: Vec3, size: Vec3) -> Shape {
    let along = if size.x >= size.y.max(size.z) {
        Vec3::X
    } else if size.y >= size.z {
        Vec3::Y
    } else {
        Vec3::Z
    };
    let mm = (centre * 1000.0).as_ivec3();
    let from = 7.0 * vec2(hash(mm.x, mm.y, mm.z as u32), hash(mm.x, mm.y, mm.z as u32 + 1));
    Shape::rounded_block(size, (size.min_element() * 0.16).min(0.006)).laid(along, from).moved(centre)
}

/// An upright cylinder from a point up; near the ground it has rings for [`rust_at_foot`].
pub(super) fn post(foot: Vec3, radius_m: f32, height_m: f32, around: usize) -> Shape {
    let rings = [0.0, 0.03, 0.07, 0.13, 0.24, 0.4].into_iter().filter(|z| *z < height_m).chain([height_m]);
    let ends = |z: f32| vec2(0.0, z);
    let profile: Vec<Vec2> =
        std::iter::once(ends(0.0)).chain(rings.map(|z| vec2(radius_m, z))).chain([ends(height_m)]).collect();
    Shape::lathe(&profile, around).moved(foot)
}

/// An upright mast that tapers from the first radius to the second, with rings for [`rust_at_foot`].
pub(super) fn mast_of(radii_m: [f32; 2], height_m: f32) -> Shape {
    let rings = [0.0, 0.04, 0.09, 0.16, 0.27, 0.45, height_m];
    let radius = |z: f32| radii_m[0] + (radii_m[1] - radii_m[0]) * z / height_m;
    Shape::tapered_tube(&rings.map(|z| (Vec3::Z * z, radius(z))), 16)
}

/// A square plate under a mast, held by four bolts.
pub(super) fn foot_plate(model: &mut Model, slot: u16, side_m: f32) {
    model.add(slot, Shape::rounded_block(vec3(side_m, side_m, 0.025), 0.006).moved(Vec3::Z * 0.0125));
    for (x, y) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)] {
        let at = vec3(x, y, 0.0) * (side_m / 2.0 - 0.05);
        model.add(slot, Shape::cylinder(0.022, 0.045, 6).moved(at));
        model.add(slot, Shape::cylinder(0.011, 0.075, 8).moved(at));
    }
}

/// Poles rust where dogs and salt reach them: lets a slot go brown over some centimetres above the ground.
pub(super) fn rust_at_foot(model: &mut Model, slot: u16, height_m: f32) {
    model.tint(move |at, p| {
        let around = hash((p.x * 200.0) as i32, (p.y * 200.0) as i32, 5);
        let share = step(height_m * (0.5 + around), 0.0, p.z);
        if at == slot { Vec3::ONE.lerp(vec3(0.34, 0.17, 0.09), 0.85 * share) } else { Vec3::ONE }
    });
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
