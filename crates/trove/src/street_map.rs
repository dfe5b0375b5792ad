//! Which of a recipe's extracts covers a place, and how high it lies.

use std::path::Path;

use anyhow::Result;
use trove_model::{Bounds, DrivingSide, MapProjection, Relief, Report, StreetMap};
use trove_read::{ReadError, osm, relief};

use crate::recipe::Recipe;

/// The map around a place from the first of the recipe's extracts that covers it, and that extract's path as the recipe
/// has it; `None` if the recipe has none.
pub(crate) fn street_map<'r>(
    recipe: &'r Recipe,
    projection: &MapProjection,
    area: Bounds,
    driving_side: DrivingSide,
    report: &Report,
) -> Result<Option<(&'r Path, StreetMap)>> {
    let mut elsewhere = None;
    for path in recipe.map.osm.paths() {
        match osm::read(&recipe.at(path), projection, area, driving_side, report) {
            Ok(map) => return Ok(Some((path, map))),
            Err(error @ ReadError::Elsewhere { .. }) => elsewhere = Some(error),
            Err(error) => return Err(error.into()),
        }
    }
    elsewhere.map_or(Ok(None), |error| Err(error.into()))
}

/// What the recipe's elevation files know of a place and of the land around it; `None` where that is nothing.
pub(crate) fn relief(
    recipe: &Recipe,
    projection: &MapProjection,
    area: Bounds,
    report: &Report,
) -> Result<Option<Relief>> {
    let paths: Vec<_> = recipe.map.elevation.paths().iter().map(|path| recipe.at(path)).collect();
    if paths.is_empty() {
        return Ok(None);
    }
    Ok(relief::read(&paths, projection, area.grown(trove_build::HORIZON_M), report)?)
}
