//! Number plates and words on cars. The numbers are nobody's.

use std::sync::{Arc, LazyLock};

use glam::{Vec2, Vec3, vec2, vec3};
use trove_model::{Lettering, Material, Texture};

use crate::shape::{Prism, Shape};
use crate::surfaces::{Canvas, Texel};

/// A plate's look.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plate {
    name: &'static str,
    pub(super) size_m: [f32; 2],
    text: &'static str,
    ink: Vec3,
    ground: Vec3,
    /// Colour of a field at its left end, or of a band along its top.
    field: Option<Vec3>,
}

const WHITE: Vec3 = vec3(0.7, 0.7, 0.68);
const BLACK: Vec3 = vec3(0.01, 0.01, 0.011);
const EUROPE: [f32; 2] = [0.52, 0.11];
const AMERICA: [f32; 2] = [0.31, 0.155];

const PLATES: [Plate; 6] = {
    const BLUE: Vec3 = vec3(0.01, 0.05, 0.3);
    let europe = Plate {
        name: "plate/europe-1",
        size_m: EUROPE,
        text: "TRV-E 000",
        ink: BLACK,
        ground: WHITE,
        field: Some(BLUE),
    };
    let america = Plate {
        name: "plate/america-1",
        size_m: AMERICA,
        text: "TRV 000",
        ink: vec3(0.03, 0.05, 0.2),
        ground: WHITE,
        field: Some(vec3(0.12, 0.22, 0.5)),
    };
    let asia =
        Plate { name: "plate/asia-1", size_m: EUROPE, text: "TRV 0000 X", ink: WHITE, ground: BLACK, field: None };
    [
        europe,
        Plate { name: "plate/europe-2", text: "XX-O 0000", ..europe },
        america,
        Plate { name: "plate/america-2", text: "0XV OO0", ink: vec3(0.3, 0.03, 0.03), field: None, ..america },
        asia,
        Plate { name: "plate/britain-1", text: "XX00 TRV", ink: BLACK, ground: vec3(0.75, 0.6, 0.05), ..asia },
    ]
};

/// The plate that a car wears: of the region that its id names, or one in turn.
pub(super) fn plate_of(id: &str, turn: usize) -> (Plate, Material) {
    static MADE: LazyLock<Vec<(Plate, Material)>> =
        LazyLock::new(|| PLATES.iter().map(|p| (*p, p.material())).collect());
    let region = |plate: &Plate| plate.name.split(['/', '-']).nth(1).unwrap_or_default();
    let named = MADE.iter().find(|(plate, _)| id.contains(region(plate)));
    named.unwrap_or(&MADE[turn % MADE.len()]).clone()
}

impl Plate {
    fn material(&self) -> Material {
        let size = Vec2::from_array(self.size_m);
        let writing = Lettering::new(self.text);
        let is_wide = size.x > 0.4;
        // Letters fill the plate beside its field, or below its band.
        let field = if self.field.is_some() { if is_wide { 0.09 } else { 0.2 } } else { 0.0 };
        let (centre, room) = if is_wide {
            (vec2(size.x * (0.5 + field / 2.0), size.y / 2.0), vec2(size.x * (0.93 - field), size.y * 0.66))
        } else {
            (vec2(size.x / 2.0, size.y * (0.5 - field / 2.5)), vec2(size.x * 0.9, size.y * 0.5))
        };
        let letter = vec2(room.x / writing.width(), room.y);
        let picture = |p: Vec2| {
            let edge = p.min(size - p).min_element();
            let in_field = if is_wide { p.x < size.x * field } else { p.y > size.y * (1.0 - field) };
            let ink = writing.distance((p - centre) / letter) < 0.1;
            match self.field {
                _ if edge < 0.004 => self.ink.lerp(self.ground, 0.3),
                Some(color) if in_field => color,
                _ if ink => self.ink,
                _ => self.ground,
            }
        };
        Material { dirt: 0.3, ..painted(self.name, size, if is_wide { [256, 56] } else { [128, 64] }, picture) }
    }
}

/// A word on a ground, for uvs from 0 to 1.
pub(super) fn word(name: &str, text: &str, size_m: Vec2, ink: Vec3, ground: Vec3) -> Material {
    let writing = Lettering::new(text);
    let letter = vec2(size_m.x * 0.86 / writing.width(), size_m.y * 0.62);
    let picture = |p: Vec2| if writing.distance((p - size_m / 2.0) / letter) < 0.11 { ink } else { ground };
    let across = 256.0;
    painted(name, size_m, [across as u32, (across * size_m.y / size_m.x / 8.0).round() as u32 * 8], picture)
}

fn painted(name: &str, size_m: Vec2, px: [u32; 2], picture: impl Fn(Vec2) -> Vec3) -> Material {
    let texel_m = size_m / vec2(px[0] as f32, px[1] as f32) / 4.0;
    let canvas = Canvas::new(px, size_m.to_array(), |p| {
        let spread = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        Texel::new(spread.iter().map(|&(x, y)| picture(p + vec2(x, y) * texel_m)).sum::<Vec3>() / 4.0, 0.4)
    });
    let map: Arc<Texture> = canvas.color(name);
    Material { base_color_map: Some(map), ..Material::plain(name, Vec3::ONE, 0.4) }
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
pub(super) fn decal(skin: &Shape, paint: u16, [low, high]: [Vec2; 2], is_left: bool) -> Shape {
    let prism = Prism::side(&super::grid::rect(low, high), 0.4..=2.0);
    let (painted, _) = skin.clone().split_slot(paint);
    let mut decal = painted.split(&if is_left { prism } else { prism.mirrored() }).0;
    for ((p, n), uv) in decal.positions.iter_mut().zip(&decal.normals).zip(&mut decal.uvs) {
        let along = (p.x - low.x) / (high.x - low.x);
        *uv = vec2(if is_left { 1.0 - along } else { along }, (p.z - low.y) / (high.y - low.y));
        *p += *n * 0.002;
    }
    decal
}
