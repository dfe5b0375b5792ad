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
        match osm::read_in(recipe.map.geojson_frame, &recipe.at(path), projection, area, driving_side, report) {
            Ok(map) => return Ok(Some((path, trove_build::with_bends(map)))),
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

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;

    #[test]
    fn geojson_in_metres_is_a_map_where_the_recipe_says_so() {
        let folder = tempfile::tempdir().unwrap();
        let line = r#"{"type": "LineString", "coordinates": [[-50, 0], [50, 10]]}"#;
        let text = format!(
            r#"{{"type": "FeatureCollection", "features": [{{"type": "Feature", "properties": {{}}, "geometry": {line}}}]}}"#
        );
        std::fs::write(folder.path().join("roads.geojson"), text).unwrap();
        let read = |frame: &str| {
            let recipe = format!("[place]\nlat_deg = 60.0\nlon_deg = 25.0\n[map]\nosm = \"roads.geojson\"\n{frame}\n");
            let recipe = Recipe { folder: folder.path().to_owned(), ..Recipe::parse(&recipe).unwrap() };
            let projection = MapProjection::spherical(60.0, 25.0, DVec2::ZERO);
            let area = Bounds::square(DVec2::ZERO, 400.0);
            let found = street_map(&recipe, &projection, area, DrivingSide::Right, &Report::default());
            found.map(|map| map.unwrap().1)
        };
        // As degrees the road leads through Africa.
        assert!(read("").unwrap_err().to_string().contains("km away"));
        let map = read("geojson_frame = \"dataset\"").unwrap();
        assert!(map.roads[0].centreline[1].distance(DVec2::new(50.0, 10.0)) < 1e-6, "{:?}", map.roads);
        assert!(Recipe::parse("[place]\nlat_deg = 60.0\nlon_deg = 25.0\n[map]\ngeojson_frame = \"utm\"\n").is_err());
    }
}
