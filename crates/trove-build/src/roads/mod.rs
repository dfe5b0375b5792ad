//! Everything that lies on the ground: carriageway with its markings, sidewalks with their kerbs, land.

mod course;
mod evidence;
mod land;
mod layout;
mod markings;
mod network;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::{DAffine3, DVec2};
use trove_model::{
    AssetLibrary, Bounds, Class, Drive, HeightField, Material, Mesh, Polygon, Report, Seed, StreetMap, SurfaceKind,
};

use crate::ground::Drape;
use crate::palette::Palette;
use crate::piece::Piece;
use crate::plane;
use crate::plane_raster::PlaneRaster;

/// Height of a kerb: sidewalks and land lie this much above the carriageway, metres.
pub(crate) const KERB_M: f64 = 0.12;
/// Paint lies this much above the road: more than rounding, less than is seen.
const PAINT_M: f64 = 0.004;
/// Water lies this much below the road.
const WATER_M: f64 = -0.8;
/// The ground goes on this far beyond the place, to its horizon.
const HORIZON_M: f64 = 2000.0;
/// The raster that answers what lies under a point.
const FOOTING_CELL_M: f64 = 0.25;

/// What lies under a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Footing {
    /// Road.
    Carriageway,
    /// Sidewalk with its kerb stones.
    Sidewalk,
    /// Neither.
    Land,
    /// Nothing stands here.
    Water,
}

/// The surfaces of a place.
#[derive(Clone, Debug)]
pub(crate) struct RoadSurfaces {
    /// Their meshes.
    pub pieces: Vec<Piece>,
    /// Where vehicles drive; polygons do not overlap.
    pub carriageway: Vec<Polygon>,
    footings: PlaneRaster,
}

impl RoadSurfaces {
    /// What lies under a point, to a quarter of a metre; land outside the place.
    pub(crate) fn footing(&self, position: DVec2) -> Footing {
        match self.footings.at(position) {
            1 => Footing::Carriageway,
            2 => Footing::Sidewalk,
            3 => Footing::Water,
            _ => Footing::Land,
        }
    }

    /// The carriageway around a footprint, with half a metre for the kerb.
    pub(crate) fn carriageway_near(&self, footprint: &Polygon) -> Vec<Polygon> {
        let Some(bounds) = footprint.bounds() else { return Vec::new() };
        let frame = [plane::rectangle(bounds.grown(2.0))];
        let near = |p: &&Polygon| p.bounds().is_some_and(|b| b.overlaps(&bounds));
        let road: Vec<Polygon> = self.carriageway.iter().filter(near).cloned().collect();
        plane::grown(&plane::intersection(&road, &frame), 0.5)
    }

    /// How much the surface lies above the height field at a point: 0 on the carriageway, [`KERB_M`] elsewhere.
    pub(crate) fn elevation_m(&self, position: DVec2) -> f64 {
        match self.footing(position) {
            Footing::Carriageway => 0.0,
            Footing::Sidewalk | Footing::Land => KERB_M,
            Footing::Water => WATER_M,
        }
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
    let drape = Drape::new(ground);
    // Up to the end of the height field, where the apron begins.
    let field = drape.bounds();
    let bounds = Bounds { min: bounds.min.min(field.min), max: bounds.max.max(field.max) };
    let layout = layout::layout(drive, map, bounds, report);
    let (markings, covers) = rayon::join(
        || markings::markings(drive, map, &layout),
        || land::covers(layout.land.clone(), &layout.car_parks, map, bounds),
    );
    let palette = Palette { library, report };
    // One surface of a kind in the whole place; kerbs of plain stone where the library has them.
    let material = |kind: SurfaceKind| {
        let words: &[&str] = if kind == SurfaceKind::Kerb { &["concrete", "stone"] } else { &[] };
        palette.fitting(kind, words, &mut seed.child(&format!("{kind:?}")).random()).material
    };

    let mut footings = PlaneRaster::new(bounds, FOOTING_CELL_M);
    footings.fill(&layout.pavement, 2);
    footings.fill(&layout.kerb, 2);
    footings.fill(&layout.carriageway, 1);
    for cover in covers.iter().filter(|c| c.kind == SurfaceKind::Water) {
        footings.fill(&cover.area, 3);
    }

    let mut pieces = Vec::new();
    let mut add = |mesh: Mesh, class: Class, kind: SurfaceKind| {
        if !mesh.triangles.is_empty() {
            pieces.push(stuff(mesh, class, material(kind)));
        }
    };
    add(drape.surface(&layout.carriageway, 0.0), Class::Road, SurfaceKind::Asphalt);
    add(drape.surface(&markings.white, PAINT_M), Class::Road, SurfaceKind::MarkingWhite);
    add(drape.surface(&markings.yellow, PAINT_M), Class::Road, SurfaceKind::MarkingYellow);
    let on_border = |a: DVec2, b: DVec2| {
        let on = |limit: DVec2| ((a - limit).abs().max((b - limit).abs())).min_element() < 0.01;
        on(bounds.min) || on(bounds.max)
    };
    let mut kerb = drape.surface(&layout.kerb, KERB_M);
    kerb.append(&drape.faces(&layout.carriageway, 0.0, KERB_M, on_border), 0);
    add(kerb, Class::Sidewalk, SurfaceKind::Kerb);
    add(drape.surface(&layout.pavement, KERB_M), Class::Sidewalk, SurfaceKind::Paving);
    for cover in &covers {
        let is_water = cover.kind == SurfaceKind::Water;
        let lift_m = if is_water { WATER_M } else { KERB_M };
        add(drape.surface(&cover.area, lift_m), Class::Ground, cover.kind);
        if is_water {
            add(drape.faces(&cover.area, WATER_M, KERB_M, on_border), Class::Ground, SurfaceKind::Concrete);
        }
    }
    add(drape.apron(HORIZON_M, KERB_M), Class::Ground, SurfaceKind::Grass);

    RoadSurfaces { pieces, carriageway: layout.carriageway, footings }
}

fn stuff(mesh: Mesh, class: Class, material: Material) -> Piece {
    Piece {
        mesh: Arc::new(mesh),
        world_from_mesh: DAffine3::IDENTITY,
        class,
        materials: vec![material],
        kind: None,
        asset: String::new(),
    }
}
