//! Street names at corners, written in place: every plate lies along its street.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec2, Vec2, Vec3, vec2};
use trove_model::{Asset, ColorSpace, Kind, Lettering, Material, Outcome, Report, Role, Texture};

use super::junctions::Junction;
use super::yard::{Source, Wish, Yard};
use crate::geometry::segments::SegmentIndex;
use crate::pieces::Piece;

const TAGS: &[&str] = &["sign", "street-name"];
/// Further from the driven path than this no one reads a name, metres.
const READ_M: f64 = 120.0;
/// A corner is within this of its junction's middle, metres.
const CORNER_REACH_M: f64 = 32.0;
/// A pole behind the kerb, metres.
const OFF_KERB_M: f64 = 0.8;
/// A plate's picture, and the plate's size in metres.
const SIZE_PX: [u32; 2] = [384, 80];
const PLATE_M: Vec2 = vec2(0.96, 0.2);
/// Height of letters, strokes' half width in heights, and what a line may take of the plate.
const LETTER_M: f32 = 0.1;
const STROKE: f32 = 0.085;
const LINE_SHARE: f32 = 0.9;

/// A sign at one corner of every junction of named streets that is near enough to be read.
pub(super) fn place(junctions: &[Junction<'_>], yard: &mut Yard<'_, '_, '_>, report: &Report) -> Vec<Piece> {
    let library = yard.library;
    let Some(asset) = library.tagged(Kind::TrafficSign, TAGS).next() else { return Vec::new() };
    let path: Vec<DVec2> =
        yard.around.place.drive.keyframes.iter().map(|k| k.world_from_ego.translation.truncate()).collect();
    let path = SegmentIndex::new([path.as_slice()]);
    let mut written = BTreeMap::new();
    let mut signs = Vec::new();
    for junction in junctions.iter().filter(|j| path.nearest(j.centre, READ_M).is_some()) {
        let mut streets: Vec<(&str, DVec2)> = Vec::new();
        for arm in &junction.arms {
            let Some(name) = &arm.road.name else { continue };
            if !streets.iter().any(|(known, _)| known == name) {
                streets.push((name, arm.inward));
            }
        }
        let [(first, along), (second, _), ..] = streets[..] else { continue };
        let names = [first, second].map(|name| plate(name, yard, &mut written));
        if let Some(unwritten) = [first, second].iter().zip(&names).find_map(|(name, p)| p.is_none().then_some(name)) {
            report.note(Outcome::Dropped, "street name in letters that cannot be drawn", unwritten);
        }
        let [Some(first), Some(second)] = names else { continue };
        signs.extend(corner(junction, along, yard, asset).map(|world_from_mesh| Piece {
            mesh: Arc::clone(&asset.mesh),
            world_from_mesh,
            class: asset.class,
            materials: dressed(asset, &first, &second),
            kind: Some(asset.kind),
            asset: Some(asset.id.clone()),
        }));
    }
    signs
}

/// The asset's materials with both plates written on.
fn dressed(asset: &Asset, first: &Material, second: &Material) -> Vec<Material> {
    let of = |material: &Material| match material.role {
        Some(Role::NameAlongX) => first.clone(),
        Some(Role::NameAlongY) => second.clone(),
        _ => material.clone(),
    };
    asset.slots.iter().map(|slot| of(&slot.material)).collect()
}

/// Where the sign stands, with its x along a street: the free corner that is nearest to the middle.
fn corner<'a>(
    junction: &Junction<'_>,
    along: DVec2,
    yard: &mut Yard<'a, '_, '_>,
    asset: &'a Asset,
) -> Option<DAffine3> {
    let kerbs = yard.around.kerbs.near(junction.centre, CORNER_REACH_M);
    kerbs.iter().filter(|k| k.sidewalk).step_by(3).take(30).find_map(|kerb| {
        let position = kerb.position + kerb.outward * OFF_KERB_M;
        let yaw_rad = along.to_angle();
        let wish = Wish { kind: Kind::TrafficSign, tags: TAGS, position, yaw_rad, source: Source::MadeUp };
        let foot_world = position.extend(yard.around.stand.surface_m(position));
        let world_from_mesh = DAffine3::from_rotation_translation(DQuat::from_rotation_z(yaw_rad), foot_world);
        yard.take(asset, &wish).then_some(world_from_mesh)
    })
}

/// A plate with a name on it; `None` where the name cannot be written.
fn plate(name: &str, yard: &Yard<'_, '_, '_>, written: &mut BTreeMap<String, Option<Material>>) -> Option<Material> {
    let customs = &yard.locale.signs.name_plate;
    let shortened = |word: &str| {
        let word = word.to_uppercase();
        customs.short.iter().find(|[long, _]| *long == word).map_or(word, |[_, short]| short.clone())
    };
    let text: Vec<String> = name.split_whitespace().map(shortened).collect();
    let text = text.join(" ");
    let colors = [customs.ground, customs.ink].map(Vec3::from_array);
    written.entry(text.clone()).or_insert_with(|| paint(&text, colors)).clone()
}

fn paint(text: &str, [ground, ink]: [Vec3; 2]) -> Option<Material> {
    let writing = Lettering::new(text);
    if !writing.is_complete() {
        return None;
    }
    let line_m = PLATE_M.x * LINE_SHARE;
    let squeeze = (line_m / (writing.width() * LETTER_M)).min(0.8);
    let [width, height] = SIZE_PX;
    let texel_m = PLATE_M / vec2(width as f32, height as f32);
    // Coverage by the distance to the strokes, over a texel.
    let blur = texel_m.y / LETTER_M;
    let color = |x: u32, row: u32| {
        let p = (vec2(x as f32, (height - 1 - row) as f32) + 0.5) * texel_m - PLATE_M / 2.0;
        let rim = (PLATE_M / 2.0 - p.abs()).min_element();
        let stroke = (STROKE - writing.distance(p / (vec2(squeeze, 1.0) * LETTER_M))) / blur + 0.5;
        let frame = if (0.008..0.013).contains(&rim) { 1.0 } else { 0.0 };
        ground.lerp(ink, stroke.clamp(0.0, 1.0).max(frame))
    };
    let texels = (0..height).flat_map(|row| (0..width).map(move |x| (x, row)));
    let rgba = texels.map(|(x, row)| encoded(color(x, row))).collect();
    let name = format!("street name {text}");
    let texture = Texture { name: name.clone(), width, height, rgba, color_space: ColorSpace::Srgb };
    Some(Material { base_color_map: Some(Arc::new(texture)), dirt: 0.3, ..Material::plain(&name, Vec3::ONE, 0.35) })
}

/// sRGB's encoding (IEC 61966-2-1).
fn encoded(linear: Vec3) -> [u8; 4] {
    let encode = |c: f32| if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    let [r, g, b] = linear.to_array().map(|c| (encode(c) * 255.0 + 0.5) as u8);
    [r, g, b, 255]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_written_where_its_letters_are_known() {
        let colors = [Vec3::ZERO, Vec3::ONE];
        let material = paint("KARL-MARX-STRASSE", colors).unwrap();
        let texture = material.base_color_map.unwrap();
        let white = texture.rgba.iter().filter(|t| t[0] > 200).count() as f32 / texture.rgba.len() as f32;
        assert!((0.1..0.5).contains(&white), "{white}");
        assert!(paint("長安西路", colors).is_none());
    }
}
