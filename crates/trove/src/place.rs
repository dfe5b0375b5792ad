//! `[place]` recipes: a map without a drive.

use anyhow::{Context, Result};
use glam::DVec2;
use trove_build::PlacePlan;
use trove_model::{Bounds, Drive, DrivingSide, MapProjection, Report, Seed, StreetMap};

use crate::recipe::{PlaceSection, Recipe};
use crate::street_map::{relief, street_map};

/// Name of the scene in the output.
pub(crate) const NAME: &str = "place";
/// How many views a place has at most, before its roads are known.
pub(crate) const KEYFRAMES_HINT: usize = 20;
/// A day without weather: 2024-06-21 is the longest, and 15:00 by the sun has shadows of some length.
const SOLSTICE_NS: i64 = 1_718_928_000_000_000_000; // 2024-06-21 00:00 UTC

/// Where a place lies on earth, and the square that is built of it.
pub(crate) fn area(place: &PlaceSection) -> (MapProjection, Bounds) {
    let projection = MapProjection::spherical(place.lat_deg, place.lon_deg, DVec2::ZERO);
    (projection, Bounds::square(DVec2::ZERO, place.size_m))
}

/// Keyframes on the roads around a position, and the map that they come from.
pub(crate) fn drive(
    recipe: &Recipe,
    place: &PlaceSection,
    driving_side: DrivingSide,
    report: &Report,
) -> Result<(Drive, Option<StreetMap>)> {
    let (projection, area) = area(place);
    let map = street_map(recipe, &projection, area, driving_side, report)?;
    let (extract, mut map) = map.context("the recipe has no map.osm")?;
    map.relief = relief(recipe, &projection, area, report)?;
    let solar_hours = 15.0 - place.lon_deg / 15.0;
    let time_ns = SOLSTICE_NS + (solar_hours * 3600e9) as i64;
    let seed = Seed(recipe.seed).child("place");
    let plan = PlacePlan { name: NAME, projection, size_m: place.size_m, driving_side, time_ns };
    let drive = trove_build::place_drive(&map, &plan, seed, report)
        .with_context(|| format!("{}: around {}, {}", extract.display(), place.lat_deg, place.lon_deg))?;
    Ok((trove_build::on_relief(drive, &map), Some(map)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An extract whose nodes are the corners of a square of half a degree, without a way.
    fn square(lat_deg: f64, lon_deg: f64) -> String {
        let node = |id: u32, north: f64, east: f64| {
            format!("<node id='{id}' lat='{}' lon='{}'/>", lat_deg + 0.25 * north, lon_deg + 0.25 * east)
        };
        let corners = [node(1, -1.0, -1.0), node(2, -1.0, 1.0), node(3, 1.0, -1.0), node(4, 1.0, 1.0)];
        format!("<osm>{}</osm>", corners.concat())
    }

    #[test]
    fn a_place_without_roads_names_the_extract_that_it_was_looked_for_in() {
        let folder = tempfile::tempdir().unwrap();
        for (name, content) in
            [("far.osm", square(48.0, 2.0)), ("here.osm", square(1.3, 103.8)), ("empty.osm", "<osm></osm>".into())]
        {
            std::fs::write(folder.path().join(name), content).unwrap();
        }
        let error = |extracts: [&str; 2]| {
            let path = folder.path().join("recipe.toml");
            let place = "[place]\nlat_deg = 1.3\nlon_deg = 103.8\nsize_m = 200\n";
            std::fs::write(&path, format!("{place}[map]\nosm = {extracts:?}\n")).unwrap();
            format!("{:#}", {
                let (recipe, report) = (Recipe::read(&path).unwrap(), Report::default());
                drive(&recipe, recipe.place.as_ref().unwrap(), DrivingSide::Left, &report).unwrap_err()
            })
        };
        let found = error(["far.osm", "here.osm"]);
        assert!(found.starts_with("here.osm: around 1.3, 103.8: ") && found.contains("road"), "{found}");
        // Only an extract of another place is passed over.
        let found = error(["empty.osm", "here.osm"]);
        assert!(found.contains("empty.osm") && found.contains("nodes that have coordinates"), "{found}");
        let found = error(["far.osm", "far.osm"]);
        assert!(found.contains("far.osm") && found.contains("km away"), "{found}");
    }
}
