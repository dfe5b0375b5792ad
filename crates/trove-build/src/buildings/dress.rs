//! What a building wears: facade, ground floor, roof.

use glam::Vec3;
use trove_model::{Building, Material, Random, SurfaceKind};

use super::volumes::is_house;
use super::walls::Grid;
use crate::palette::Palette;

/// From this height on a building is a tower.
const TOWER_M: f64 = 45.0;
/// Up to this height an ordinary building is an old one.
const LOW_M: f64 = 16.0;

/// Materials in the order of [`super::shell::Slot`], and how facades are divided.
pub(super) struct Dress {
    pub materials: Vec<Material>,
    pub facade: Grid,
    /// Division and height of the ground floor; `None` where it looks like every other storey.
    pub ground_floor: Option<Grid>,
}

/// Draws what a building wears by its tags, its kind and its height.
pub(super) fn dress(
    building: &Building,
    kind: &str,
    height_m: f64,
    palette: &Palette<'_>,
    random: &mut Random,
) -> Dress {
    let facade = palette.fitting(SurfaceKind::Facade, facade_words(building, kind, height_m), random);
    let ground_floor =
        ground_floor_words(kind, height_m).map(|words| palette.fitting(SurfaceKind::FacadeGroundFloor, words, random));
    let trim = palette.fitting(SurfaceKind::Concrete, &[], random);
    let flat = palette.fitting(SurfaceKind::FlatRoof, &[], random);
    let tiles = palette.fitting(SurfaceKind::RoofTiles, &[], random);
    let mut wall = facade.material.clone();
    match building.color {
        Some(color) => wall.base_color = tinted(wall.base_color, color),
        None => wall.base_color *= shade(random),
    }
    let (mut flat_roof, mut pitched) = (flat.material, tiles.material);
    if let Some(color) = building.roof_color {
        flat_roof.base_color = tinted(flat_roof.base_color, color);
        pitched.base_color = tinted(pitched.base_color, color);
    }
    let (ground, grid) = match &ground_floor {
        Some(surface) => (surface.material.clone(), Some(Grid::of(surface))),
        None => (wall.clone(), None),
    };
    Dress {
        materials: vec![wall, ground, trim.material, flat_roof, pitched],
        facade: Grid::of(&facade),
        ground_floor: grid,
    }
}

fn facade_words(building: &Building, kind: &str, height_m: f64) -> &'static [&'static str] {
    match building.material.as_str() {
        "brick" => return &["brick", "victorian"],
        "glass" | "mirror" => return &["glass"],
        "metal" | "steel" => return &["metal"],
        "concrete" | "reinforced_concrete" => return &["slab", "ribbon", "panel"],
        "plaster" | "stucco" | "render" => return &["plaster"],
        "stone" | "sandstone" | "limestone" | "granite" => return &["victorian", "hotel"],
        "wood" | "timber_framing" => return &["plaster", "wood"],
        _ => {}
    }
    match kind {
        kind if is_house(kind) => &["brick-row", "plaster", "victorian"],
        "terrace" => &["brick-row", "victorian"],
        "industrial" | "warehouse" | "hangar" | "garage" | "garages" | "shed" => &["warehouse", "mill"],
        "hotel" => &["hotel"],
        "apartments" | "residential" | "dormitory" if height_m > LOW_M => &["slab", "panel", "mixed", "hotel", "brick"],
        "apartments" | "residential" | "dormitory" => &["brick", "plaster", "victorian", "mixed"],
        _ if height_m > TOWER_M => &["glass", "hotel", "ribbon", "panel"],
        "office" | "commercial" => &["glass", "ribbon", "panel", "mill"],
        "retail" | "supermarket" => &["mixed", "panel", "brick"],
        _ if height_m > LOW_M => &["mill", "ribbon", "panel", "glass", "mixed"],
        _ => &["brick", "victorian", "mixed", "plaster"],
    }
}

fn ground_floor_words(kind: &str, height_m: f64) -> Option<&'static [&'static str]> {
    match kind {
        kind if is_house(kind) => None,
        "garage" | "garages" | "shed" | "roof" | "carport" | "hut" | "church" | "cathedral" => None,
        "industrial" | "warehouse" | "hangar" => Some(&["loading"]),
        "office" | "commercial" | "hotel" => Some(&["lobby", "arcade"]),
        _ if height_m > TOWER_M => Some(&["lobby", "arcade"]),
        "apartments" | "residential" | "terrace" | "dormitory" => Some(&["entrances", "shops"]),
        "retail" | "supermarket" => Some(&["shops"]),
        _ => Some(&["shops", "entrances", "arcade"]),
    }
}

/// Houses of one material differ a little in shade and warmth.
fn shade(random: &mut Random) -> Vec3 {
    let (light, warm) = (random.range(0.82, 1.12), random.range(-0.05, 0.05));
    Vec3::new((light * (1.0 + warm)) as f32, light as f32, (light * (1.0 - warm)) as f32)
}

/// A texture's colour moved to a tagged one: its hue wins, half of the texture's own lightness stays.
fn tinted(base: Vec3, color: Vec3) -> Vec3 {
    let hue = color / color.max_element().max(0.05);
    (base * hue * (0.5 + color.max_element())).clamp(Vec3::splat(0.05), Vec3::splat(1.5))
}
