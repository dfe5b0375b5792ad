//! Everything that lies on the ground: carriageway with its markings, sidewalks with their kerbs, land.

mod bends;
mod corners;
mod course;
mod cross_section;
mod decks;
mod evidence;
mod footings;
mod houses;
mod kerb;
mod land;
mod layout;
mod markings;
mod network;
mod plan;
mod seed_name;
#[cfg(test)]
mod tests;
mod wear;

use glam::DVec2;
use trove_model::{Bounds, Class, DrivingSide, Material, Mesh, Polygon, RoadPlan, Role, SurfaceKind};

pub use bends::with_bends;
pub(crate) use course::{Lane, LaneUse};
pub(crate) use footings::Footing;
pub(crate) use houses::HEADROOM_M;

use footings::Footings;
use seed_name::seed_name;

use crate::geometry::plane;
use crate::ground::{Apron, Drape, Land, Lawn, Ramps, Spans, apron};
use crate::pieces::Palette;
use crate::pieces::Piece;
use crate::place::Place;

/// The lowest of kerbs: what stands on the ground beside the road begins here, metres.
pub(crate) const KERB_M: f64 = 0.12;
/// Water lies this much below the road.
const WATER_M: f64 = -0.8;
/// The ground goes on this far beyond the place, to its horizon, metres: a relief is wanted that far.
pub const HORIZON_M: f64 = 2000.0;

/// The surfaces of a place.
#[derive(Clone, Debug)]
pub(crate) struct RoadSurfaces {
    /// Their meshes.
    pub pieces: Vec<Piece>,
    /// Where vehicles drive; polygons do not overlap.
    pub carriageway: Vec<Polygon>,
    /// Where it leads through houses; polygons do not overlap.
    pub passages: Vec<Polygon>,
    /// What each part of it is for, but for junctions.
    pub lanes: Vec<Lane>,
    /// Where grass grows; polygons do not overlap.
    pub lawns: Vec<Polygon>,
    /// How that grass looks.
    pub lawn: Lawn,
    /// The side of the road that traffic keeps to.
    pub driving_side: DrivingSide,
    /// Height of a kerb: sidewalks and land lie this much above the carriageway, but for ramps, metres.
    pub kerb_m: f64,
    /// What is told of them.
    pub plan: RoadPlan,
    ramps: Ramps,
    footings: Footings,
    /// Below roads above the ground.
    below: Footings,
}

impl RoadSurfaces {
    /// What lies under a point; land outside the place.
    pub(crate) fn footing(&self, position: DVec2) -> Footing {
        self.footings.at(position)
    }

    /// Whether a road runs above a point.
    pub(crate) fn is_below_deck(&self, position: DVec2) -> bool {
        self.below.at(position) == Footing::Carriageway
    }

    /// The carriageway around a footprint, with room for the kerb.
    pub(crate) fn carriageway_near(&self, footprint: &Polygon) -> Vec<Polygon> {
        near(&self.carriageway, footprint)
    }

    /// What of it leads through a footprint, with room for the kerb.
    pub(crate) fn passages_near(&self, footprint: &Polygon) -> Vec<Polygon> {
        near(&self.passages, footprint)
    }

    /// How much the surface lies above the height field at a point: 0 on the carriageway, a kerb's height elsewhere,
    /// less where kerbs are dropped.
    pub(crate) fn elevation_m(&self, position: DVec2) -> f64 {
        match self.footing(position) {
            Footing::Carriageway => 0.0,
            Footing::Sidewalk | Footing::Land => self.kerb_m * self.ramps.at(position),
            Footing::Water => WATER_M,
        }
    }
}

/// The part of a road around a footprint, with half a metre for the kerb.
fn near(road: &[Polygon], footprint: &Polygon) -> Vec<Polygon> {
    let Some(bounds) = footprint.bounds() else { return Vec::new() };
    let frame = [plane::rectangle(bounds.grown(2.0))];
    let near = |p: &&Polygon| p.bounds().is_some_and(|b| b.overlaps(&bounds));
    let road: Vec<Polygon> = road.iter().filter(near).cloned().collect();
    plane::grown(&plane::intersection(&road, &frame), 0.5)
}

/// Builds the surfaces of a place: the dataset's map where it has one, OpenStreetMap beyond it.
/// `spans` tells how high bridges and tunnels run, and `land` what lies beyond it, both where there is a relief.
pub(crate) fn surfaces(place: &Place<'_>, spans: &Spans, land: Option<Land<'_>>) -> RoadSurfaces {
    let Place { drive, map, is_assumed: _, invents: _, bounds, ground, library, locale, conditions, seeds, report } =
        *place;
    let seed = seeds.materials.child("roads");
    let kerb_m = locale.kerb.height_m;
    // Up to the end of the height field, where the apron begins.
    let field = Drape::new(ground).bounds();
    let bounds = Bounds { min: bounds.min.min(field.min), max: bounds.max.max(field.max) };
    let lift = decks::Lift { ground, spans };
    let layout = layout::layout(drive, map, locale.driving_side, bounds, &lift, report);
    let near = wear::near(drive);
    let (markings, covers) = rayon::join(
        || markings::markings(drive, map, &layout, &near, &locale.markings, seed.child("markings"), report),
        || land::covers(layout.land.clone(), &layout.car_parks, map, bounds),
    );
    let palette = Palette { library, report };
    // One surface of a kind in the whole place; kerbs of plain stone where the library has them.
    let material = |kind: SurfaceKind| {
        let tags: &[String] = match kind {
            SurfaceKind::Kerb => &locale.kerb.tags,
            SurfaceKind::Paving => &locale.surfaces.sidewalk,
            _ => &[],
        };
        let surface = palette.fitting(kind, tags, &mut seed.child(seed_name(kind)).random());
        let role = match kind {
            SurfaceKind::Kerb => Some(Role::Kerb),
            SurfaceKind::Paving if surface.tags.has("earth") => Some(Role::Unpaved),
            _ => surface.material.role,
        };
        Material { role, ..surface.material }
    };
    let paving = material(SurfaceKind::Paving);
    // Nobody lays kerb stones along trodden earth.
    let kerb_stone = if paving.role == Some(Role::Unpaved) { paving.clone() } else { material(SurfaceKind::Kerb) };

    let water = covers.iter().find(|c| c.kind == SurfaceKind::Water).map_or(&[][..], |c| &c.area);
    let areas = [
        (Footing::Carriageway, &layout.carriageway[..]),
        (Footing::Carriageway, &layout.ramps),
        (Footing::Sidewalk, &layout.kerb),
        (Footing::Sidewalk, &layout.pavement),
        (Footing::Sidewalk, &layout.tracks),
        (Footing::Water, water),
    ];
    let footings = Footings::new(bounds, &areas);
    let ramps = Ramps::new(ground, &layout.dropped, kerb::LOW_M / kerb_m);
    let drape = Drape::with_ramps(ground, &ramps);

    let surfacing = wear::Surfacing {
        drive,
        map,
        layout: &layout,
        markings: &markings,
        near: &near,
        customs: &locale.surfaces,
        palette: &palette,
        drape: &drape,
        seed: seed.child("surfacing"),
    };
    let mut pieces = surfacing.pieces();
    let mut put = |mesh: Mesh, class: Class, material: Material| {
        if !mesh.triangles.is_empty() {
            pieces.push(Piece::stuff(mesh, class, material));
        }
    };
    let on_border = |a: DVec2, b: DVec2| {
        let on = |limit: DVec2| ((a - limit).abs().max((b - limit).abs())).min_element() < 0.01;
        // Nor is there a kerb where a road begins to rise.
        let beyond = (a + b) / 2.0 - (b - a).perp().normalize_or_zero() * 0.05;
        on(bounds.min) || on(bounds.max) || layout.ramps.iter().any(|r| r.contains(beyond))
    };
    let mut kerb = drape.raised(&layout.kerb, kerb_m);
    wear::alignment::follow_edges(&mut kerb, &layout.carriageway, on_border);
    kerb.append(&drape.faces(&layout.carriageway, &kerb::profile(kerb_m), on_border), 0);
    put(kerb, Class::Sidewalk, kerb_stone);
    let mut pavement = drape.raised(&layout.pavement, kerb_m);
    surfacing.align(&mut pavement);
    put(pavement, Class::Sidewalk, paving);
    put(drape.raised(&layout.tracks, kerb_m), Class::Sidewalk, material(SurfaceKind::Asphalt));
    let lawn = Lawn::new(conditions, seeds.vegetation.child("roads").child("lawn"));
    for cover in &covers {
        let is_water = cover.kind == SurfaceKind::Water;
        let lift_m = if is_water { WATER_M } else { kerb_m };
        let mesh = match cover.kind {
            SurfaceKind::Grass => lawn.surface(&drape, &cover.area, lift_m),
            SurfaceKind::Water => drape.surface(&cover.area, lift_m),
            _ => drape.raised(&cover.area, lift_m),
        };
        let mut laid = material(cover.kind);
        laid.role = laid.role.or(cover.role());
        put(mesh, Class::Ground, laid);
        if is_water {
            let quay = drape.faces(&cover.area, &[DVec2::new(0.0, WATER_M), DVec2::new(0.0, kerb_m)], on_border);
            put(quay, Class::Ground, material(SurfaceKind::Concrete));
        }
    }
    let mut add = |mesh: Mesh, class: Class, kind: SurfaceKind| put(mesh, class, material(kind));
    let below = Footings::new(bounds, &[(Footing::Carriageway, &layout.above)]);
    let free = |p: DVec2| footings.at(p) != Footing::Carriageway;
    let decks = decks::meshes(&layout.decks, &layout.trenches, &drape, free);
    add(decks.asphalt, Class::Road, SurfaceKind::Asphalt);
    add(decks.paint, Class::Road, SurfaceKind::MarkingWhite);
    add(decks.concrete, Class::Void, SurfaceKind::Concrete);
    let Apron { land: mut beyond, sea } = apron(&drape, HORIZON_M, [kerb_m, WATER_M], land);
    lawn.color(&mut beyond);
    add(beyond, Class::Ground, SurfaceKind::Grass);
    add(sea, Class::Ground, SurfaceKind::Water);

    let lawns = covers.into_iter().filter(|c| c.kind == SurfaceKind::Grass).flat_map(|c| c.area).collect();
    let lanes = course::lanes(&layout.courses);
    let plan = plan::plan(&layout, &markings, &lanes, &drape);
    let driving_side = locale.driving_side;
    RoadSurfaces {
        driving_side,
        pieces,
        carriageway: layout.carriageway,
        passages: layout.passages,
        lanes,
        lawns,
        lawn,
        kerb_m,
        plan,
        ramps,
        footings,
        below,
    }
}
