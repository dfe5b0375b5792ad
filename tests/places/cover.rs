//! How well a place seen from above covers what the maps say.

use glam::{DVec2, DVec3};
use trove_build::{OnDisagreement, Site};
use trove_model::{Bounds, Class, Drive, Polygon, Report, Scene, StreetMap};

use crate::drawing::{Drawing, is_built, triangles};

/// Distance of the points that are compared, metres.
const STEP_M: f64 = 0.5;
/// The least share of the union in which map and place agree.
const ROAD_IOU: f64 = 0.9;
/// Roads of which no map tells the width cut buildings in dense old towns; 0.98 is what is aimed at.
const BUILDING_IOU: f64 = 0.95;

/// The recorded drivable area against the built road, where the recording's map reaches.
pub(crate) fn road(scene: &Scene, drive: &Drive) -> Vec<String> {
    let Some(map) = &drive.lane_map else { return Vec::new() };
    let mapped: Vec<Polygon> = map.drivable.iter().chain(&map.carparks).cloned().collect();
    // Around what is mapped no other road may be, up to a lane's width; a map without walkways is a map of lanes alone,
    // with holes where they meet.
    let beside_m = if map.walkways.is_empty() { 0.0 } else { 3.5 };
    let reach = |p: DVec2| mapped.iter().any(|m| m.contains(p) || m.edge_distance_m(p) < beside_m);
    let is_road = |class: Class| class == Class::Road;
    let iou = iou(scene, drive, is_road, |p| mapped.iter().any(|m| m.contains(p)), reach);
    println!("{}: road IoU {iou:.3}", drive.id);
    (iou < ROAD_IOU).then(|| format!("IoU of the road with the drivable area is {iou:.3}")).into_iter().collect()
}

/// The mapped footprints, moved as the recording asks for, against those that were built.
pub(crate) fn buildings(site: &Site, drive: &Drive, map: &StreetMap) -> Vec<String> {
    let area = trove_build::area(drive).unwrap();
    let map = trove_build::agreed(
        drive,
        map,
        crate::locale(drive.projection).driving_side,
        area,
        OnDisagreement::Warn,
        &Report::default(),
    )
    .unwrap();
    let mapped = map.buildings.into_iter().map(|b| b.footprint).filter(|f| area.contains(f.centroid()));
    let (mapped, built) = (Footprints::new(mapped), Footprints::new(site.footprints().iter().cloned()));
    if mapped.0.is_empty() {
        return Vec::new();
    }
    let (mut both, mut either) = (0u64, 0u64);
    let steps = (area.size_m() / STEP_M).floor().as_u64vec2();
    for at in (0..steps.y).flat_map(|y| (0..steps.x).map(move |x| DVec2::new(x as f64, y as f64))) {
        let p = area.min + (at + 0.37) * STEP_M;
        let (is_mapped, is_built) = (mapped.cover(p), built.cover(p));
        either += u64::from(is_mapped || is_built);
        both += u64::from(is_mapped && is_built);
    }
    let iou = both as f64 / either.max(1) as f64;
    println!("{}: building IoU {iou:.3}", drive.id);
    (iou < BUILDING_IOU).then(|| format!("IoU of buildings with their footprints is {iou:.3}")).into_iter().collect()
}

/// Polygons with the rectangles around them.
struct Footprints(Vec<(Bounds, Polygon)>);

impl Footprints {
    fn new(polygons: impl Iterator<Item = Polygon>) -> Self {
        Self(polygons.filter_map(|p| Some((p.bounds()?, p))).collect())
    }

    fn cover(&self, p: DVec2) -> bool {
        self.0.iter().any(|(bounds, polygon)| bounds.contains(p) && polygon.contains(p))
    }
}

fn iou(
    scene: &Scene,
    drive: &Drive,
    is_it: impl Fn(Class) -> bool,
    mapped: impl Fn(DVec2) -> bool,
    counts: impl Fn(DVec2) -> bool,
) -> f64 {
    let area = trove_build::area(drive).unwrap();
    let built = triangles(scene, |i| is_built(scene, i));
    let drawing = Drawing::new(&built, area, DVec3::NEG_Z, STEP_M);
    let (mut both, mut either) = (0u64, 0u64);
    for ray in drawing.rays() {
        let p = drawing.position(ray[0].pixel);
        if !area.contains(p) {
            continue;
        }
        let is_there = is_it(scene.instances[built[ray[0].triangle as usize].instance].class);
        let is_mapped = mapped(p);
        if (is_there || is_mapped) && counts(p) {
            either += 1;
            both += u64::from(is_there && is_mapped);
        }
    }
    both as f64 / either.max(1) as f64
}
