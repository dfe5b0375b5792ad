//! What is written and painted on vehicles: names, displays, stripes of warning, and the faces that carry it.

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{Lettering, Material};

use crate::shape::{Model, Prism, Shape, rect};
use crate::surfaces::{Canvas, Texel};

/// A rectangle about a point, seen from where `right` runs to the right; its uvs run from 0 to 1.
pub(crate) fn decal(at: Vec3, right: Vec3, up: Vec3, size_m: Vec2) -> Shape {
    let (u, v) = (right * size_m.x / 2.0, up * size_m.y / 2.0);
    Shape::sheet(&[vec![at - u - v, at + u - v], vec![at - u + v, at + u + v]])
}

/// A decal on the left side (`side` 1) or the right one (−1), read by those who stand there.
pub(crate) fn on_side(side: f32, at: Vec3, size_m: Vec2) -> Shape {
    decal(at, Vec3::X * -side, Vec3::Z, size_m)
}

/// A decal that is read from behind.
pub(crate) fn on_back(at: Vec3, size_m: Vec2) -> Shape {
    decal(at, -Vec3::Y, Vec3::Z, size_m)
}

/// A decal that is read from the front.
pub(crate) fn on_front(at: Vec3, size_m: Vec2) -> Shape {
    decal(at, Vec3::Y, Vec3::Z, size_m)
}

/// A flat face of a size that looks along x from a point; uvs run from 0 to 1.
pub(super) fn face(size_m: Vec2, at: Vec3) -> Shape {
    let (y, z) = (size_m.x / 2.0, size_m.y / 2.0);
    let mut face = Shape::flat(&[vec2(-y, -z), vec2(y, -z), vec2(y, z), vec2(-y, z)]);
    face.uvs.iter_mut().for_each(|uv| *uv = *uv / size_m + 0.5);
    let stand = glam::Mat3::from_cols(Vec3::Y, Vec3::Z, Vec3::X);
    face.turned(glam::Quat::from_mat3(&stand)).moved(at)
}

/// What is painted of a skin inside a rectangle of its left or right side, (x, z), a little off it; uvs run from 0 to 1
/// as one reads there.
pub(super) fn on_skin(skin: &Shape, paint: u16, [low, high]: [Vec2; 2], is_left: bool) -> Shape {
    let prism = Prism::side(&rect(low.x, high.x, low.y, high.y), 0.4..=2.0);
    let (painted, _) = skin.clone().split_slot(paint);
    let mut decal = painted.split(&if is_left { prism } else { prism.mirrored() }).0;
    for ((p, n), uv) in decal.positions.iter_mut().zip(&decal.normals).zip(&mut decal.uvs) {
        let along = (p.x - low.x) / (high.x - low.x);
        *uv = vec2(if is_left { 1.0 - along } else { along }, (p.z - low.y) / (high.y - low.y));
        *p += *n * 0.002;
    }
    decal
}

/// A material that shows a picture.
pub(super) fn picture(
    name: &str,
    roughness: f32,
    px: [u32; 2],
    size_m: Vec2,
    paint: impl Fn(Vec2) -> Texel,
) -> Material {
    let map = Some(Canvas::new(px, size_m.to_array(), paint).color(name));
    Material { base_color_map: map, ..Material::plain(name, Vec3::ONE, roughness) }
}

/// A picture of flat colours, four samples a texel.
pub(super) fn painted(name: &str, size_m: Vec2, px: [u32; 2], color: impl Fn(Vec2) -> Vec3) -> Material {
    let texel_m = size_m / vec2(px[0] as f32, px[1] as f32) / 4.0;
    picture(name, 0.4, px, size_m, |p| {
        let spread = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        Texel::new(spread.iter().map(|&(x, y)| color(p + vec2(x, y) * texel_m)).sum::<Vec3>() / 4.0, 0.4)
    })
}

/// A word on a ground, for uvs from 0 to 1.
pub(super) fn word(name: &str, text: &str, size_m: Vec2, ink: Vec3, ground: Vec3) -> Material {
    let writing = Lettering::new(text);
    let letter = vec2(size_m.x * 0.86 / writing.width(), size_m.y * 0.62);
    let picture = |p: Vec2| if writing.distance((p - size_m / 2.0) / letter) < 0.11 { ink } else { ground };
    let across = 256.0;
    painted(name, size_m, [across as u32, (across * size_m.y / size_m.x / 8.0).round() as u32 * 8], picture)
}

/// A slot for a line of writing cut out of nothing; returns it and how wide the writing is where it is one high.
pub(crate) fn writing(model: &mut Model, text: &str, inks: &[Vec3]) -> (u16, f32) {
    let letters = Lettering::new(text);
    let size = vec2(letters.width() + 0.3, 1.4);
    let px = [(size.x * 44.0) as u32, 62];
    let canvas = Canvas::new(px, size.to_array(), |p| {
        let ink = letters.distance(p - size / 2.0) < 0.1;
        Texel { alpha: if ink { 1.0 } else { 0.0 }, ..Texel::new(Vec3::splat(0.95), 0.4) }
    });
    let map = Some(canvas.color(&format!("writing-{text}")));
    let material = Material { base_color_map: map, alpha_cutoff: 0.5, ..Material::plain("writing", inks[0], 0.4) };
    (model.slot(material, inks), size.x / size.y)
}

/// A slot for a display of amber lamps on black, uvs from 0 to 1 over `size_m`.
pub(crate) fn display(model: &mut Model, text: &str, size_m: Vec2) -> u16 {
    let letters = Lettering::new(text);
    let dots = vec2((20.0 * size_m.x / size_m.y).round(), 20.0);
    let px = (dots * 4.0).as_uvec2().to_array();
    let picture = picture(&format!("display-{text}-{}x{}", px[0], px[1]), 0.15, px, dots, |p| {
        let lamp = p.floor() + 0.5;
        let height = 11.0_f32.min(dots.x * 0.94 / letters.width());
        let lit = letters.distance((lamp - dots / 2.0) / height) < 0.09;
        let inside = p.distance(lamp) < 0.38;
        let dark = Vec3::splat(0.006);
        Texel::new(if lit && inside { vec3(0.95, 0.42, 0.02) } else { dark }, 0.15)
    });
    model.slot(picture, &[])
}

/// Stripes that slant over a tile, uvs in tiles; two colours.
pub(crate) fn slanted(model: &mut Model, name: &str, colors: [Vec3; 2]) -> u16 {
    let picture = picture(name, 0.4, [32, 32], Vec2::ONE, |p| {
        let first = (p.x + p.y).rem_euclid(1.0) < 0.5;
        Texel::new(colors[usize::from(first)], 0.4)
    });
    model.slot(picture, &[])
}

/// Yellow and black.
pub(crate) const HAZARD: [Vec3; 2] = [vec3(0.62, 0.4, 0.015), Vec3::splat(0.015)];
/// Red and white.
pub(crate) const RED_WHITE: [Vec3; 2] = [vec3(0.42, 0.012, 0.014), vec3(0.66, 0.66, 0.64)];

/// A shape's uvs multiplied: so many tiles across and up.
pub(crate) fn tiled(mut shape: Shape, tiles: Vec2) -> Shape {
    shape.uvs.iter_mut().for_each(|uv| *uv *= tiles);
    shape
}
