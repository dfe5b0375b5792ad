//! Everything that lies on the ground: carriageway with its markings, sidewalks with their kerbs, land.

mod evidence;
mod land;
mod layout;
mod markings;
mod network;

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
    /// Where people walk, kerb stones included; polygons overlap neither each other nor the carriageway.
    pub sidewalks: Vec<Polygon>,
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
    let layout = layout::layout(drive, map, bounds, report);
    let (markings, covers) = rayon::join(
        || markings::markings(drive, map, &layout),
        || land::covers(layout.land.clone(), &layout.car_parks, map, bounds),
    );
    let palette = Palette { library, seed, report };
    let material = |kind: SurfaceKind| palette.material(kind, &format!("{kind:?}"));
    let drape = Drape::new(ground);

    let mut footings = PlaneRaster::new(bounds, FOOTING_CELL_M);
    footings.fill(&layout.pavement, 2);
    footings.fill(&layout.kerb, 2);
    footings.fill(&layout.carriageway, 1);
    for cover in covers.iter().filter(|c| c.kind == SurfaceKind::Water) {
        footings.fill(&cover.area, 3);
    }

    let mut pieces = Vec::new();
    let mut add = |mesh: Mesh, class: Class, material: Material, name: &str| {
        if !mesh.triangles.is_empty() {
            pieces.push(stuff(mesh, class, material, name));
        }
    };
    add(drape.surface(&layout.carriageway, 0.0), Class::Road, material(SurfaceKind::Asphalt), "carriageway");
    add(drape.surface(&markings.white, PAINT_M), Class::Road, material(SurfaceKind::MarkingWhite), "white markings");
    add(drape.surface(&markings.yellow, PAINT_M), Class::Road, material(SurfaceKind::MarkingYellow), "yellow markings");
    let on_border = |a: DVec2, b: DVec2| {
        let at = |side: fn(DVec2) -> f64, limit: f64| (side(a) - limit).abs() < 0.01 && (side(b) - limit).abs() < 0.01;
        at(|p| p.x, bounds.min.x) || at(|p| p.x, bounds.max.x) || at(|p| p.y, bounds.min.y) || at(|p| p.y, bounds.max.y)
    };
    let mut kerb = drape.surface(&layout.kerb, KERB_M);
    kerb.append(&drape.faces(&layout.carriageway, 0.0, KERB_M, on_border), 0);
    add(kerb, Class::Sidewalk, material(SurfaceKind::Kerb), "kerb");
    add(drape.surface(&layout.pavement, KERB_M), Class::Sidewalk, material(SurfaceKind::Paving), "pavement");
    for cover in &covers {
        let lift_m = if cover.kind == SurfaceKind::Water { WATER_M } else { KERB_M };
        let name = format!("land: {:?}", cover.kind);
        add(drape.surface(&cover.area, lift_m), Class::Ground, material(cover.kind), &name);
        if cover.kind == SurfaceKind::Water {
            let quay = drape.faces(&cover.area, WATER_M, KERB_M, on_border);
            add(quay, Class::Ground, material(SurfaceKind::Concrete), "quay");
        }
    }
    add(drape.apron(HORIZON_M, KERB_M), Class::Ground, material(SurfaceKind::Grass), "land beyond the place");

    let sidewalks = [layout.kerb, layout.pavement].concat();
    RoadSurfaces { pieces, carriageway: layout.carriageway, sidewalks, footings }
}

fn stuff(mesh: Mesh, class: Class, material: Material, name: &str) -> Piece {
    Piece {
        mesh: Arc::new(mesh),
        world_from_mesh: DAffine3::IDENTITY,
        class,
        materials: vec![material],
        kind: None,
        name: name.into(),
        asset: String::new(),
    }
}
