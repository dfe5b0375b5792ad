//! What is written and painted on heavy vehicles: number plates, names, displays, stripes of warning.

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{Lettering, Material, Seed};

use crate::shape::{Model, Shape};
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

fn picture(
    model: &mut Model,
    name: &str,
    roughness: f32,
    px: [u32; 2],
    size: Vec2,
    paint: impl Fn(Vec2) -> Texel,
) -> u16 {
    let canvas = Canvas::new(px, size.to_array(), paint);
    let map = Some(canvas.color(name));
    model.slot(Material { base_color_map: map, ..Material::plain(name, Vec3::ONE, roughness) }, &[])
}

/// Size of a number plate.
pub(crate) const PLATE_M: Vec2 = vec2(0.48, 0.12);

/// A slot for number plates whose characters are drawn by a name; they fit no country's scheme exactly.
pub(crate) fn number_plate(model: &mut Model, name: &str) -> u16 {
    let mut random = Seed(0x91a7e).child(name).random();
    let mut any = |from: &str| {
        let letters: Vec<char> = from.chars().collect();
        random.pick(&letters).copied().unwrap_or('X')
    };
    let (letters, digits) = ("ABCDEFGHJKLMNPRSTUVXYZ", "0123456789");
    let text: String =
        [letters, letters, letters, " ", digits, digits, digits, digits, letters].map(&mut any).iter().collect();
    let yellow = random.chance(0.25);
    let (ground, ink) =
        if yellow { (vec3(0.62, 0.45, 0.02), Vec3::splat(0.015)) } else { (Vec3::splat(0.66), Vec3::splat(0.02)) };
    let writing = Lettering::new(&text);
    picture(model, &format!("plate-{text}"), 0.35, [192, 48], PLATE_M, |p| {
        let q = p - PLATE_M / 2.0;
        let height = 0.072;
        let wide = (PLATE_M.x * 0.88 / (writing.width() * height)).min(1.0);
        let line = writing.distance(q / vec2(height * wide, height)) < 0.1;
        let rim = (q.abs() - PLATE_M / 2.0).max_element() > -0.005;
        Texel::new(if line || rim { ink } else { ground }, 0.35)
    })
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
    picture(model, &format!("display-{text}-{}x{}", px[0], px[1]), 0.15, px, dots, |p| {
        let lamp = p.floor() + 0.5;
        let height = 11.0_f32.min(dots.x * 0.94 / letters.width());
        let lit = letters.distance((lamp - dots / 2.0) / height) < 0.09;
        let inside = p.distance(lamp) < 0.38;
        let dark = Vec3::splat(0.006);
        Texel::new(if lit && inside { vec3(0.95, 0.42, 0.02) } else { dark }, 0.15)
    })
}

/// Stripes that slant over a tile, uvs in tiles; two colours.
pub(crate) fn slanted(model: &mut Model, name: &str, colors: [Vec3; 2]) -> u16 {
    picture(model, name, 0.4, [32, 32], Vec2::ONE, |p| {
        let first = (p.x + p.y).rem_euclid(1.0) < 0.5;
        Texel::new(colors[usize::from(first)], 0.4)
    })
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
