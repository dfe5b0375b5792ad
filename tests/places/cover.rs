//! How well a place seen from above covers what the maps say.

use glam::{DVec2, DVec3};
use trove_build::OnDisagreement;
use trove_model::{Bounds, Class, Drive, Polygon, Report, Scene, StreetMap};

use crate::drawing::{Drawing, Hit, Triangle, is_built, triangles};
use crate::mapped::Footprint;

/// Distance of the points that are compared, metres.
const STEP_M: f64 = 0.5;
/// The least share of the union in which map and place agree.
const ROAD_IOU: f64 = 0.9;
/// Of a building so much of its footprint may be seen as something else, and so many rays more: along its edges.
const UNSEEN_SHARE: f64 = 0.02;
const UNSEEN_RAYS: f64 = 4.0;
/// What hangs over open ground does so at least this high, metres: the undersides of models lie on the ground.
const OVERHANG_M: f64 = 1.8;
/// A recording moves its map by less than this, metres and radians.
const MOVED_M: f64 = 8.0;
const TURNED_RAD: f64 = 0.02;

/// The recorded drivable area against the built road, where the recording's map reaches.
pub(crate) fn road(scene: &Scene, drive: &Drive) -> Vec<String> {
    let Some(map) = &drive.lane_map else { return Vec::new() };
    let areas = map.drivable.iter().chain(&map.carparks);
    let mapped: Vec<(Bounds, &Polygon)> = areas.filter_map(|area| Some((area.bounds()?, area))).collect();
    // Around what is mapped no other road may be, up to a lane's width; a map without walkways is a map of lanes alone,
    // with holes where they meet.
    let beside_m = if map.walkways.is_empty() { 0.0 } else { 3.5 };
    let is_mapped = |p: DVec2| mapped.iter().any(|(bounds, area)| bounds.contains(p) && area.contains(p));
    let is_beside = |p: DVec2| {
        mapped.iter().any(|(bounds, area)| bounds.grown(beside_m).contains(p) && area.edge_distance_m(p) < beside_m)
    };
    let reach = |p: DVec2| is_mapped(p) || is_beside(p);
    let is_road = |class: Class| class == Class::Road;
    let iou = iou(scene, drive, is_road, is_mapped, reach);
    println!("{}: road IoU {iou:.3}", drive.id);
    (iou < ROAD_IOU).then(|| format!("IoU of the road with the drivable area is {iou:.3}")).into_iter().collect()
}

/// What has to be seen of a place's buildings.
pub(crate) struct Bar {
    /// The least share of the union in which what is mapped and what is seen agree.
    pub(crate) iou: f64,
    /// At most so many buildings of which a road takes more than [`UNSEEN_SHARE`].
    pub(crate) cut: usize,
    /// And so many of which more than that is not there and no road either.
    pub(crate) incomplete: usize,
    /// The least share of the rectangular ones that models of the built-in library stand for.
    pub(crate) modelled: f64,
    /// What shows of their insides in all views together, m².
    pub(crate) inside_m2: f64,
}

/// The buildings that rays from above see, against mapped footprints; both the share of all and each building count.
pub(crate) fn buildings(scene: &Scene, area: Bounds, mapped: &[Footprint], bar: &Bar, name: &str) -> Vec<String> {
    // Whether one on the border is built depends on where its middle is.
    let is_within = |f: &&Footprint| area.contains(f.bounds.min) && area.contains(f.bounds.max);
    let (within, across): (Vec<&Footprint>, Vec<&Footprint>) = mapped.iter().partition(is_within);
    if within.is_empty() {
        return vec!["no mapped building lies in the place".into()];
    }
    let built = triangles(scene, |i| is_built(scene, i));
    let drawing = Drawing::new(&built, area, (DVec3::NEG_Z, DVec3::X), STEP_M);
    let (mut both, mut either, mut over, mut rays) = (0u64, 0u64, 0u64, 0u64);
    // For each building its rays, those that do not see one there, and of these those that see a road.
    let mut of_each = vec![[0u32; 3]; within.len()];
    for ray in drawing.rays() {
        let p = drawing.position(ray[0].pixel).truncate();
        if !area.contains(p) {
            continue;
        }
        rays += 1;
        if across.iter().any(|f| f.contains(p)) {
            continue;
        }
        let class = scene.instances[built[ray[0].triangle as usize].instance].class;
        let is_seen = class == Class::Building;
        let mut is_mapped = false;
        for (counts, _) in of_each.iter_mut().zip(&within).filter(|(_, f)| f.contains(p)) {
            is_mapped = true;
            counts[0] += 1;
            counts[1] += u32::from(!is_seen);
            counts[2] += u32::from(class == Class::Road);
        }
        if is_seen && !is_mapped && hangs_over(ray, &built, scene) {
            over += 1;
            continue;
        }
        either += u64::from(is_mapped || is_seen);
        both += u64::from(is_mapped && is_seen);
    }
    let mut wrong = Vec::new();
    let all = (area.size_m() / STEP_M).element_product();
    if (rays as f64) < 0.99 * all {
        wrong.push(format!("{rays} of {all:.0} rays from above meet anything"));
    }
    let iou = both as f64 / either.max(1) as f64;
    let is_much = |part: u32, all: u32| f64::from(part) > UNSEEN_SHARE * f64::from(all) + UNSEEN_RAYS;
    let list = |is: &dyn Fn([u32; 3]) -> bool| -> Vec<String> {
        let those = within.iter().zip(&of_each).filter(|(_, counts)| is(**counts));
        those.map(|(f, [all, unseen, road])| format!("{} ({unseen} of {all} rays, {road} see a road)", f.id)).collect()
    };
    let cut = list(&|[all, _, road]| is_much(road, all));
    let incomplete = list(&|[all, unseen, road]| is_much(unseen - road, all));
    let (cuts, lacks, number) = (cut.len(), incomplete.len(), within.len());
    let seen = both as f64 / (either + over).max(1) as f64;
    println!(
        "{name}: IoU of footprints {iou:.4}, with what hangs over {seen:.4}; of {number} {cuts} are cut and {lacks} \
         incomplete"
    );
    if iou < bar.iou {
        wrong.push(format!("IoU of the buildings that are seen with mapped footprints is {iou:.4}"));
    }
    for (what, list, most) in [("cut by roads", cut, bar.cut), ("incomplete", incomplete, bar.incomplete)] {
        if list.len() > most {
            wrong.push(format!(
                "{} of {number} buildings are {what}, {most} are known: {}",
                list.len(),
                list.join(", ")
            ));
        }
    }
    wrong
}

/// Whether what a ray from above sees of a building hangs over open ground there: eaves, balconies, awnings.
fn hangs_over(ray: &[Hit], built: &[Triangle], scene: &Scene) -> bool {
    let is_building = |hit: &&Hit| scene.instances[built[hit.triangle as usize].instance].class == Class::Building;
    let lowest = ray.iter().rfind(is_building);
    let ground = ray.iter().find(|hit| !is_building(hit));
    lowest
        .zip(ground)
        .is_some_and(|(lowest, ground)| !lowest.from_front && ground.depth_m - lowest.depth_m > OVERHANG_M)
}

/// Footprints of a map that was not read from XML.
pub(crate) fn footprints(map: &StreetMap) -> Vec<Footprint> {
    let edges = |b: &trove_model::Building| b.footprint.edges().map(|(p, q)| [p, q]).collect();
    map.buildings.iter().map(|b| Footprint::new(b.id, edges(b))).collect()
}

/// Footprints as the recording moves its map: what two far corners of the map's buildings do, all do.
pub(crate) fn agreed(footprints: &[Footprint], drive: &Drive, map: &StreetMap) -> Vec<Footprint> {
    let area = trove_build::area(drive).unwrap();
    let side = crate::locale(drive.projection).driving_side;
    let moved = trove_build::agreed(drive, map, side, area, OnDisagreement::Warn, &Report::default()).unwrap();
    let corner = |map: &StreetMap, i: usize| map.buildings[i].footprint.exterior[0];
    let far = |&i: &usize| corner(map, i).distance(corner(map, 0));
    let last = (0..map.buildings.len()).max_by(|a, b| far(a).total_cmp(&far(b))).unwrap();
    let [from, to] = [map, &moved].map(|m| [corner(m, 0), corner(m, last)]);
    let turn_rad = (from[1] - from[0]).angle_to(to[1] - to[0]);
    assert!(to[0].distance(from[0]) < MOVED_M && turn_rad.abs() < TURNED_RAD, "{from:?} {to:?}");
    let moved = |p: DVec2| to[0] + DVec2::from_angle(turn_rad).rotate(p - from[0]);
    footprints.iter().map(|f| f.moved(moved)).collect()
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
    let drawing = Drawing::new(&built, area, (DVec3::NEG_Z, DVec3::X), STEP_M);
    let (mut both, mut either) = (0u64, 0u64);
    for ray in drawing.rays() {
        let p = drawing.position(ray[0].pixel).truncate();
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
