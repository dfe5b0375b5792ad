//! Which of a recipe's extracts covers a place.

use std::path::Path;

use anyhow::Result;
use trove_model::{Bounds, DrivingSide, MapProjection, Report, StreetMap};
use trove_read::{ReadError, osm};

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
