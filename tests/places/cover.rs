//! How well a place seen from above covers what the maps say.

use glam::{DVec2, DVec3};
use trove_model::{Bounds, Class, Drive, Polygon, Scene, StreetMap};

use crate::drawing::{Drawing, is_built, triangles};

/// Distance of the points that are compared, metres.
const STEP_M: f64 = 0.5;
/// The least share of the union in which map and place agree.
const ROAD_IOU: f64 = 0.9;
const BUILDING_IOU: f64 = 0.98;

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

/// The mapped footprints against the built buildings.
pub(crate) fn buildings(scene: &Scene, drive: &Drive, map: &StreetMap) -> Vec<String> {
    let area = trove_build::area(drive).unwrap();
    let inside: Vec<&Polygon> =
        map.buildings.iter().map(|b| &b.footprint).filter(|f| area.contains(f.centroid())).collect();
    if inside.is_empty() {
        return Vec::new();
    }
    let boxes: Vec<Option<Bounds>> = inside.iter().map(|f| f.bounds()).collect();
    let mapped = |p: DVec2| inside.iter().zip(&boxes).any(|(f, b)| b.is_some_and(|b| b.contains(p)) && f.contains(p));
    let iou = iou(scene, drive, |class| class == Class::Building, mapped, |_| true);
    println!("{}: building IoU {iou:.3}", drive.id);
    (iou < BUILDING_IOU).then(|| format!("IoU of buildings with their footprints is {iou:.3}")).into_iter().collect()
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
