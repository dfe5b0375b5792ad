//! `[place]` recipes: a map without a drive.

use anyhow::{Context, Result};
use glam::DVec2;
use trove_model::{Bounds, Drive, MapProjection, Report, Seed, StreetMap};

use crate::recipe::Recipe;
use crate::sources::street_map;

/// Name of the scene in the output.
pub(crate) const NAME: &str = "place";
/// How many views a place has at most, before its roads are known.
pub(crate) const KEYFRAMES_HINT: usize = 20;
/// A day without weather: 2024-06-21 is the longest, and 15:00 by the sun has shadows of some length.
const SOLSTICE_NS: i64 = 1_718_928_000_000_000_000; // 2024-06-21 00:00 UTC

/// Keyframes on the roads around a position, and the map that they come from.
pub(crate) fn drive(recipe: &Recipe, report: &Report) -> Result<(Drive, Option<StreetMap>)> {
    let place = recipe.place.as_ref().context("the recipe has no [place]")?;
    let projection =
        MapProjection { origin_lat_deg: place.lat_deg, origin_lon_deg: place.lon_deg, anchor_m: DVec2::ZERO };
    let map = street_map(recipe, &projection, Bounds::square(DVec2::ZERO, place.size_m), report)?;
    let map = map.context("the recipe has no map.osm")?;
    let solar_hours = 15.0 - place.lon_deg / 15.0;
    let time_ns = SOLSTICE_NS + (solar_hours * 3600e9) as i64;
    let seed = Seed(recipe.seed).child("place");
    let drive = trove_build::place_drive(&map, projection, NAME, place.size_m, time_ns, seed, report)
        .with_context(|| format!("around {}, {}", place.lat_deg, place.lon_deg))?;
    Ok((drive, Some(map)))
}
