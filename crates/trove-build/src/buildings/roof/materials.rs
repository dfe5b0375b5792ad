//! What roofs are made of.

use glam::{Vec3, vec3};
use trove_model::{
    Building, BuildingCustoms, BuildingKind, Covering, Material, Random, RoofMaterial, RoofShape, SurfaceKind, Tags,
};

use crate::pieces::{Palette, tinted};

/// Materials of flat roofs, pitched roofs, gables, metal, boards and glazing, in the order of
/// [`super::super::shell::Slot`]; `facade` are the tags of the facade's surface, whose wall
/// goes on in gables.
pub(in crate::buildings) fn materials(
    building: &Building,
    customs: &BuildingCustoms,
    facade: &Tags,
    wall: Vec3,
    palette: &Palette<'_>,
    random: &mut Random,
) -> Vec<Material> {
    let mut flat = palette.fitting(SurfaceKind::FlatRoof, flat_tags(building, customs, random), random).material;
    let mut pitched =
        palette.fitting(SurfaceKind::RoofTiles, &pitched_tags(building, customs, random), random).material;
    let mut gable = palette.fitting(SurfaceKind::Wall, &gable_tags(facade, palette), random).material;
    // Roofs of one material differ a little in age.
    let age = random.range(0.85, 1.12) as f32;
    flat.base_color *= age;
    pitched.base_color *= age;
    gable.base_color *= wall;
    if let Some(color) = building.roof_color {
        flat.base_color = tinted(flat.base_color, color);
        pitched.base_color = tinted(pitched.base_color, color);
    }
    let grey = random.range(0.25, 0.5) as f32;
    let metal = Material { metalness: 0.6, ..Material::plain("roof metal", vec3(grey, grey, grey * 1.02), 0.45) };
    let paints = [vec3(0.6, 0.58, 0.54), vec3(0.3, 0.29, 0.28), vec3(0.16, 0.1, 0.06), vec3(0.08, 0.08, 0.085)];
    let boards = Material::plain("roof boards", random.pick(&paints).copied().unwrap_or(Vec3::splat(0.4)), 0.7);
    let glazing = Material { coat: 1.0, ..Material::plain("roof glazing", vec3(0.015, 0.02, 0.035), 0.08) };
    vec![flat, pitched, gable, metal, boards, glazing]
}

fn flat_tags(building: &Building, customs: &BuildingCustoms, random: &mut Random) -> &'static [&'static str] {
    let drawn = random.unit();
    let is_hall =
        building.kind.is_some_and(|k| k.is_works() || matches!(k, BuildingKind::Retail | BuildingKind::Supermarket));
    match building.roof_material {
        Some(RoofMaterial::Gravel | RoofMaterial::Stone) => &["gravel"],
        Some(RoofMaterial::Bitumen) => &["bitumen"],
        Some(RoofMaterial::Concrete) => &["membrane"],
        Some(RoofMaterial::Plants) => &["green"],
        _ => match () {
            _ if is_hall && drawn < 0.7 => &["membrane"],
            _ if drawn < customs.green_roof_share => &["green"],
            _ if drawn < 0.4 => &["bitumen"],
            _ if drawn < 0.7 => &["gravel"],
            _ => &["membrane"],
        },
    }
}

fn pitched_tags<'c>(building: &Building, customs: &'c BuildingCustoms, random: &mut Random) -> Vec<&'c str> {
    let drawn = random.unit();
    let is_crowned = matches!(building.roof, Some(RoofShape::Dome | RoofShape::Onion));
    match building.roof_material {
        Some(RoofMaterial::Tiles) => match building.roof_color {
            Some(color) if color.max_element() < 0.12 => vec!["dark"],
            _ => vec!["red"],
        },
        Some(RoofMaterial::Slate | RoofMaterial::Stone | RoofMaterial::Glass) => vec!["slate"],
        Some(RoofMaterial::Metal) => vec!["metal"],
        Some(RoofMaterial::Copper) => vec!["copper"],
        Some(RoofMaterial::Bitumen | RoofMaterial::Shingle) => vec!["shingle"],
        _ if is_crowned && drawn < 0.6 => vec!["copper"],
        _ if is_crowned => vec!["slate", "metal"],
        _ if building.kind.is_some_and(has_metal_roof) => vec!["metal"],
        _ => {
            let is_house = building.kind.is_some_and(BuildingKind::is_house);
            let own = if is_house { &customs.house_coverings } else { &customs.coverings };
            covering(if own.is_empty() { &customs.coverings } else { own }, drawn)
        }
    }
}

fn has_metal_roof(kind: BuildingKind) -> bool {
    kind.is_works() || kind.is_canopy() || matches!(kind, BuildingKind::Garage | BuildingKind::Shed)
}

/// The tags of the covering that a number from 0 to 1 falls on.
fn covering(coverings: &[Covering], drawn: f64) -> Vec<&str> {
    let mut left = drawn;
    let found = coverings.iter().find(|covering| {
        let is_it = left < covering.share;
        left -= covering.share;
        is_it
    });
    found.or(coverings.last()).map_or(Vec::new(), |covering| covering.tags.iter().map(String::as_str).collect())
}

/// The tags that a facade shares with walls: it has such a one between its windows.
fn gable_tags<'t>(facade: &'t Tags, palette: &Palette<'_>) -> Vec<&'t str> {
    let is_wall = |tag: &&str| palette.library.surfaces_of(SurfaceKind::Wall).any(|s| s.tags.has(tag));
    let shared: Vec<&str> = facade.iter().filter(is_wall).collect();
    if shared.is_empty() { vec!["plaster"] } else { shared }
}
