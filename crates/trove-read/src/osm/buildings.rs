//! Buildings with all that their tags tell, and the shops in them.

use std::collections::BTreeMap;

use glam::DVec2;
use trove_model::{Building, BuildingKind, Outcome, Polygon, Report};

use super::colors::linear_color;
use super::raw::Tags;
use super::tagged::Tagged;
use super::values::{decimal, heading_rad, length_m, year};
use super::vocabulary::{BUILDINGS, ROOF_SHAPES, ROOFS, Said, WALLS};

/// A storey's height where only `min_level` is tagged, metres.
const STOREY_M: f64 = 3.0;
/// A shop that is mapped at its door lies on the outline; so far from it counts as within, metres.
const DOOR_REACH_M: f64 = 1.0;
/// Side of the squares in which shops are looked up, metres.
const SQUARE_M: f64 = 50.0;

/// A building or a part of one.
pub(super) fn building(id: i64, footprint: Polygon, tags: &Tags, report: &Report) -> Building {
    let owner = if id < 0 { format!("relation {}", -id) } else { format!("way {id}") };
    let tagged = Tagged { tags, owner: &owner, report };
    let part = !tags.has("building");
    let height_m = tagged.number(&["height", "building:height", "est_height"], length_m, 0.1..=1000.0);
    let min_level = || tagged.number(&["building:min_level", "min_level"], decimal, 0.0..=200.0);
    let min_height_m = tagged
        .number(&["min_height", "building:min_height"], length_m, 0.0..=1000.0)
        .or_else(|| min_level().map(|levels| levels * STOREY_M))
        .filter(|&min_m| {
            let below = height_m.is_none_or(|height_m| min_m < height_m);
            if !below {
                tagged.refuse("min_height above the height", &format!("from {min_m} m up"));
            }
            below
        });
    Building {
        part,
        height_m,
        min_height_m: min_height_m.unwrap_or(0.0),
        levels: tagged.number(&["building:levels", "levels"], decimal, 0.0..=200.0),
        roof: tagged.word(&["roof:shape"], &ROOF_SHAPES),
        roof_height_m: tagged.number(&["roof:height"], length_m, 0.0..=200.0),
        roof_levels: tagged.number(&["roof:levels"], decimal, 0.0..=50.0),
        roof_material: tagged.word(&["roof:material"], &ROOFS),
        roof_direction_rad: tagged.parsed(&["roof:direction", "roof:slope:direction"], heading_rad),
        ridge_across: tagged.parsed(&["roof:orientation"], across).unwrap_or(false),
        material: tagged
            .word(&["building:material", "building:facade:material", "building:cladding", "material"], &WALLS),
        color: tagged.parsed(&["building:colour", "building:color", "building:facade:colour", "colour"], linear_color),
        roof_color: tagged.parsed(&["roof:colour", "roof:color"], linear_color),
        name: tags.get("name").to_owned(),
        year: tagged.parsed(&["start_date"], year),
        shop: is_shop(tags),
        ..Building::new(id, footprint, kind(&tagged, if part { "building:part" } else { "building" }))
    }
}

/// What a building was built as; a word that no table has is a kind all the same.
fn kind(tagged: &Tagged, key: &str) -> Option<BuildingKind> {
    match BUILDINGS.read(tagged.tags.get(key)) {
        Said::Meaning(kind) => Some(kind),
        Said::Nothing => None,
        Said::Unknown => {
            let example = format!("{}: {}", tagged.owner, tagged.tags.get(key));
            tagged.report.note(Outcome::Substituted, "osm: building of an unknown kind", example);
            Some(BuildingKind::Other)
        }
    }
}

fn across(text: &str) -> Option<bool> {
    match text {
        "across" => Some(true),
        "along" => Some(false),
        _ => None,
    }
}

/// Whether something is a place with a shop window at the street: a shop, a restaurant, a bank.
pub(super) fn is_shop(tags: &Tags) -> bool {
    let upstairs = !tags.get("level").is_empty() && !tags.get("level").split(';').any(|level| level.trim() == "0");
    let serves = matches!(
        tags.get("amenity"),
        "restaurant"
            | "cafe"
            | "bar"
            | "pub"
            | "fast_food"
            | "food_court"
            | "ice_cream"
            | "biergarten"
            | "nightclub"
            | "bank"
            | "bureau_de_change"
            | "pharmacy"
            | "post_office"
            | "cinema"
            | "theatre"
            | "casino"
            | "gambling"
            | "internet_cafe"
            | "car_rental"
            | "driving_school"
            | "veterinary"
            | "marketplace"
    );
    let sells = tags.has("shop") || tags.has("craft") || tags.get("building") == "retail";
    (serves || sells) && !upstairs && !tags.has("indoor")
}

/// Marks the buildings that a shop lies in or at.
pub(super) fn mark_shops(buildings: &mut [Building], shops: &[DVec2]) {
    let square = |p: DVec2| [(p.x / SQUARE_M).floor() as i64, (p.y / SQUARE_M).floor() as i64];
    let mut by_square: BTreeMap<[i64; 2], Vec<DVec2>> = BTreeMap::new();
    for &shop in shops {
        by_square.entry(square(shop)).or_default().push(shop);
    }
    for building in buildings.iter_mut().filter(|building| !building.shop) {
        let Some(bounds) = building.footprint.bounds().map(|b| b.grown(DOOR_REACH_M)) else { continue };
        let (low, high) = (square(bounds.min), square(bounds.max));
        let footprint = &building.footprint;
        let holds = |p: &DVec2| footprint.contains(*p) || footprint.edge_distance_m(*p) < DOOR_REACH_M;
        building.shop = (low[0]..=high[0]).any(|x| {
            let column = by_square.range([x, low[1]]..=[x, high[1]]);
            column.flat_map(|(_, shops)| shops).filter(|p| bounds.contains(**p)).any(holds)
        });
    }
}
