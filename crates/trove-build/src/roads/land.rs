//! What covers the ground beside the streets.

use trove_model::{Bounds, LandKind, Polygon, Role, StreetMap, SurfaceKind};

use crate::geometry::plane::{difference, grown, intersection, union};

/// Ground this near to a building is paved where the map says nothing.
const YARD_M: f64 = 14.0;

/// Cover by kind of land, the first that covers a point wins.
const COVERS: [(SurfaceKind, &[LandKind]); 7] = [
    (SurfaceKind::Water, &[LandKind::Water]),
    (SurfaceKind::Asphalt, &[LandKind::Parking]),
    (SurfaceKind::Grass, &[LandKind::Grass, LandKind::Garden, LandKind::Pitch]),
    (SurfaceKind::Paving, &[LandKind::Paved]),
    (SurfaceKind::Grass, &[LandKind::Park, LandKind::Wood, LandKind::Scrub]),
    (SurfaceKind::Soil, &[LandKind::Farmland]),
    (SurfaceKind::Gravel, &[LandKind::Sand, LandKind::Construction]),
];

/// A piece of land and what covers it.
pub(super) struct Cover {
    pub kind: SurfaceKind,
    pub area: Vec<Polygon>,
}

impl Cover {
    /// What part of the ground this is, where something was laid.
    pub(super) fn role(&self) -> Option<Role> {
        match self.kind {
            SurfaceKind::Paving | SurfaceKind::Concrete => Some(Role::Paved),
            SurfaceKind::Asphalt => Some(Role::CarPark),
            _ => None,
        }
    }
}

/// Divides the land among its covers: asphalt where vehicles parked, then as the map says, paved around buildings,
/// grass elsewhere.
pub(super) fn covers(land: Vec<Polygon>, car_parks: &[Polygon], map: Option<&StreetMap>, bounds: Bounds) -> Vec<Cover> {
    let mut left = land;
    let mut covers: Vec<Cover> = Vec::new();
    let mut take = |left: &mut Vec<Polygon>, kind: SurfaceKind, area: &[Polygon]| {
        let area = intersection(left, area);
        if !area.is_empty() {
            *left = difference(left, &area);
            match covers.iter_mut().find(|c| c.kind == kind) {
                Some(cover) => cover.area.extend(area),
                None => covers.push(Cover { kind, area }),
            }
        }
    };
    take(&mut left, SurfaceKind::Asphalt, car_parks);
    if let Some(map) = map {
        let near = |p: &Polygon| p.bounds().is_some_and(|b| b.overlaps(&bounds));
        for (surface, kinds) in COVERS {
            let pieces: Vec<Polygon> = map
                .land
                .iter()
                .filter(|l| kinds.contains(&l.kind) && near(&l.polygon))
                .map(|l| l.polygon.clone())
                .collect();
            if !pieces.is_empty() {
                take(&mut left, surface, &union(&pieces));
            }
        }
        let buildings: Vec<Polygon> = map.buildings.iter().map(|b| b.footprint.clone()).filter(near).collect();
        if !buildings.is_empty() {
            take(&mut left, SurfaceKind::Concrete, &grown(&union(&buildings), YARD_M));
        }
    }
    let rest = std::mem::take(&mut left);
    match covers.iter_mut().find(|c| c.kind == SurfaceKind::Grass) {
        Some(cover) => cover.area.extend(rest),
        None => covers.push(Cover { kind: SurfaceKind::Grass, area: rest }),
    }
    covers
}
