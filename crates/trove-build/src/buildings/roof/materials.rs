//! What roofs are made of.

use glam::{Vec3, vec3};
use trove_model::{Building, BuildingKind, Material, Random, RoofMaterial, RoofShape, SurfaceKind, Tags};

use crate::buildings::region::Region;
use crate::pieces::{Palette, tinted};

/// Materials of flat roofs, pitched roofs, gables, metal, boards and glazing, in the order of
/// [`super::super::shell::Slot`]; `facade` are the tags of the facade's surface, whose wall
/// goes on in gables.
pub(in crate::buildings) fn materials(
    building: &Building,
    region: Region,
    facade: &Tags,
    wall: Vec3,
    palette: &Palette<'_>,
    random: &mut Random,
) -> Vec<Material> {
    let mut flat = palette.fitting(SurfaceKind::FlatRoof, flat_tags(building, region, random), random).material;
    let mut pitched = palette.fitting(SurfaceKind::RoofTiles, pitched_tags(building, region, random), random).material;
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

fn flat_tags(building: &Building, region: Region, random: &mut Random) -> &'static [&'static str] {
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
            _ if drawn < 0.07 && region != Region::NorthAmerica => &["green"],
            _ if drawn < 0.4 => &["bitumen"],
            _ if drawn < 0.7 => &["gravel"],
            _ => &["membrane"],
        },
    }
}

fn pitched_tags(building: &Building, region: Region, random: &mut Random) -> &'static [&'static str] {
    let drawn = random.unit();
    let is_crowned = matches!(building.roof, Some(RoofShape::Dome | RoofShape::Onion));
    match building.roof_material {
        Some(RoofMaterial::Tiles) => match building.roof_color {
            Some(color) if color.max_element() < 0.12 => &["dark"],
            _ => &["red"],
        },
        Some(RoofMaterial::Slate | RoofMaterial::Stone | RoofMaterial::Glass) => &["slate"],
        Some(RoofMaterial::Metal) => &["metal"],
        Some(RoofMaterial::Copper) => &["copper"],
        Some(RoofMaterial::Bitumen | RoofMaterial::Shingle) => &["shingle"],
        _ if is_crowned && drawn < 0.6 => &["copper"],
        _ if is_crowned => &["slate", "metal"],
        _ => match (building.kind, region) {
            (Some(kind), _)
                if kind.is_works() || kind.is_canopy() || matches!(kind, BuildingKind::Garage | BuildingKind::Shed) =>
            {
                &["metal"]
            }
            (_, Region::NorthAmerica) if drawn < 0.8 => &["shingle"],
            (_, Region::NorthAmerica) => &["slate", "metal"],
            (_, Region::Mediterranean) => &["red"],
            (_, Region::EastAsia) => {
                if drawn < 0.6 {
                    &["dark"]
                } else {
                    &["metal"]
                }
            }
            (_, Region::TropicalAsia) => {
                if drawn < 0.7 {
                    &["red"]
                } else {
                    &["metal"]
                }
            }
            (Some(kind), _) if kind.is_house() && drawn < 0.3 => &["dark"],
            _ if drawn < 0.65 => &["red"],
            _ if drawn < 0.85 => &["dark"],
            _ => &["slate"],
        },
    }
}

/// The tags that a facade shares with walls: it has such a one between its windows.
fn gable_tags<'t>(facade: &'t Tags, palette: &Palette<'_>) -> Vec<&'t str> {
    let is_wall = |tag: &&str| palette.library.surfaces_of(SurfaceKind::Wall).any(|s| s.tags.has(tag));
    let shared: Vec<&str> = facade.iter().filter(is_wall).collect();
    if shared.is_empty() { vec!["plaster"] } else { shared }
}
