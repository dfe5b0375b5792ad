//! Number plates. The numbers are nobody's.

use glam::{Vec2, Vec3, vec2, vec3};
use serde::Deserialize;
use trove_model::{Lettering, Material, Seed};

use super::decal::{painted, picture};
use crate::surfaces::Texel;

/// A plate as a file of plans has it: `[plate.NAME]`; colours are linear RGB.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlateDesign {
    /// The material's name.
    pub(crate) name: String,
    /// Width and height.
    pub(crate) size_m: [f32; 2],
    pub(crate) text: String,
    pub(crate) ink: [f32; 3],
    pub(crate) ground: [f32; 3],
    /// Colour of a field at its left end, or of a band along its top.
    pub(crate) field: Option<[f32; 3]>,
}

impl PlateDesign {
    /// The plate as a material, for uvs from 0 to 1.
    pub(super) fn material(&self) -> Material {
        let size = Vec2::from_array(self.size_m);
        let writing = Lettering::new(&self.text);
        let is_wide = size.x > 0.4;
        // Letters fill the plate beside its field, or below its band.
        let field = if self.field.is_some() { if is_wide { 0.09 } else { 0.2 } } else { 0.0 };
        let (centre, room) = if is_wide {
            (vec2(size.x * (0.5 + field / 2.0), size.y / 2.0), vec2(size.x * (0.93 - field), size.y * 0.66))
        } else {
            (vec2(size.x / 2.0, size.y * (0.5 - field / 2.5)), vec2(size.x * 0.9, size.y * 0.5))
        };
        let [ink_color, ground] = [self.ink, self.ground].map(Vec3::from_array);
        let letter = vec2(room.x / writing.width(), room.y);
        let picture = |p: Vec2| {
            let edge = p.min(size - p).min_element();
            let in_field = if is_wide { p.x < size.x * field } else { p.y > size.y * (1.0 - field) };
            let ink = writing.distance((p - centre) / letter) < 0.1;
            match self.field {
                _ if edge < 0.004 => ink_color.lerp(ground, 0.3),
                Some(color) if in_field => Vec3::from_array(color),
                _ if ink => ink_color,
                _ => ground,
            }
        };
        Material {
            dirt: 0.3,
            retroreflection: SHEETING,
            ..painted(&self.name, size, if is_wide { [256, 56] } else { [128, 64] }, picture)
        }
    }
}

/// Plates carry older, weaker sheeting than signs.
const SHEETING: f32 = 0.2;

/// Size of a number plate.
pub(crate) const PLATE_M: Vec2 = vec2(0.48, 0.12);

/// A number plate of [`PLATE_M`] whose characters are drawn by a name; they fit no country's scheme exactly.
pub(crate) fn any(name: &str) -> Material {
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
    let plate = picture(&format!("plate-{text}"), 0.35, [192, 48], PLATE_M, |p| {
        let q = p - PLATE_M / 2.0;
        let height = 0.072;
        let wide = (PLATE_M.x * 0.88 / (writing.width() * height)).min(1.0);
        let line = writing.distance(q / vec2(height * wide, height)) < 0.1;
        let rim = (q.abs() - PLATE_M / 2.0).max_element() > -0.005;
        Texel::new(if line || rim { ink } else { ground }, 0.35)
    });
    Material { retroreflection: SHEETING, ..plate }
}
