//! What a drive tells about the ground's height.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use trove_model::{Drive, LidarClass, LidarSweep, ObjectBox};

/// Weight of the driven path against one box: the vehicle certainly stood on the ground.
const PATH_WEIGHT: f64 = 4.0;
/// At this range a box's weight is half: datasets with plane ego poses (nuScenes) carry the vehicle's pitch, so
/// heights seen from afar are off by decimetres.
const HALF_WEIGHT_RANGE_M: f64 = 15.0;
/// Boxes of one track nearer to each other than this are one standing object.
const STANDING_M: f64 = 1.0;
/// Weight of a height in the dataset's map, which was surveyed and averaged.
const MAPPED_WEIGHT: f64 = 1.0;
/// Side of the cells that LiDAR points are gathered in, and the range within which they are dense enough.
const LIDAR_CELL_M: f64 = 2.0;
const LIDAR_REACH_M: f64 = 30.0;

/// The height of the carriageway's level somewhere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Observation {
    pub position: DVec2,
    pub height_m: f64,
    /// 1 is a box seen from near by.
    pub weight: f64,
}

/// Everything known, standing objects once; `kerb_m` is the height of the place's kerbs.
pub(super) fn observations(drive: &Drive, kerb_m: f64) -> Vec<Observation> {
    let path = drive.keyframes.iter().map(|k| {
        let at = k.world_from_ego.translation;
        Observation { position: at.truncate(), height_m: at.z, weight: PATH_WEIGHT }
    });
    let between = drive.sweeps.par_iter().map(|sweep| &sweep.lidar);
    let sweeps = drive.keyframes.par_iter().filter_map(|k| k.lidar.as_ref()).chain(between);
    let sweeps: Vec<_> = sweeps.flat_map_iter(lidar_ground).collect();
    path.chain(standing_once(drive, kerb_m))
        .chain(sweeps)
        .chain(mapped(drive, kerb_m))
        .filter(|o| o.position.is_finite() && o.height_m.is_finite())
        .collect()
}

/// Heights in the dataset's map; those beside the road are brought to the carriageway's level.
fn mapped(drive: &Drive, kerb_m: f64) -> Vec<Observation> {
    let Some(map) = &drive.lane_map else { return Vec::new() };
    let areas: Vec<_> = map.drivable.iter().chain(&map.carparks).filter_map(|p| Some((p, p.bounds()?))).collect();
    let is_road = |p: DVec2| areas.iter().any(|(area, bounds)| bounds.contains(p) && area.contains(p));
    let observation = |point: &DVec3| {
        let position = point.truncate();
        let height_m = point.z - if is_road(position) { 0.0 } else { kerb_m };
        Observation { position, height_m, weight: MAPPED_WEIGHT }
    };
    map.ground.par_iter().map(observation).collect()
}

/// The bottom of every annotated box, brought to the carriageway's level.
pub(super) fn box_bottoms(drive: &Drive, kerb_m: f64) -> impl Iterator<Item = Observation> + '_ {
    drive.keyframes.iter().flat_map(move |k| {
        let ego = k.world_from_ego.translation.truncate();
        k.boxes.iter().map(move |b| box_bottom(drive, kerb_m, b, ego))
    })
}

fn box_bottom(drive: &Drive, kerb_m: f64, object: &ObjectBox, ego: DVec2) -> Observation {
    let down = DVec3::new(0.0, 0.0, -object.cuboid.size_m.z / 2.0);
    let bottom = object.cuboid.world_from_body.point(down);
    let position = bottom.truncate();
    let raised = drive.lane_map.as_ref().is_some_and(|m| {
        m.walkways.iter().any(|p| p.contains(position)) && !m.drivable.iter().any(|p| p.contains(position))
    });
    let range = position.distance(ego) / HALF_WEIGHT_RANGE_M;
    let height_m = bottom.z - if raised { kerb_m } else { 0.0 };
    Observation { position, height_m, weight: 1.0 / (1.0 + range * range) }
}

/// Box bottoms, those of one standing object averaged.
fn standing_once(drive: &Drive, kerb_m: f64) -> Vec<Observation> {
    let mut by_track: BTreeMap<usize, Vec<Vec<Observation>>> = BTreeMap::new();
    for keyframe in &drive.keyframes {
        let ego = keyframe.world_from_ego.translation.truncate();
        for object in &keyframe.boxes {
            let bottom = box_bottom(drive, kerb_m, object, ego);
            let groups = by_track.entry(object.track).or_default();
            match groups.last_mut() {
                Some(group) if group[0].position.distance(bottom.position) < STANDING_M => group.push(bottom),
                _ => groups.push(vec![bottom]),
            }
        }
    }
    by_track.values().flatten().map(|group| mean(group)).collect()
}

/// The weighted mean; it weighs no more than its best member twice.
fn mean(group: &[Observation]) -> Observation {
    let total: f64 = group.iter().map(|o| o.weight).sum();
    let best = group.iter().map(|o| o.weight).fold(0.0, f64::max);
    let height_m = group.iter().map(|o| o.height_m * o.weight).sum::<f64>() / total;
    let position = group.iter().map(|o| o.position * o.weight).sum::<DVec2>() / total;
    Observation { position, height_m, weight: total.min(2.0 * best) }
}

/// Low returns of a sweep, one a cell: labelled ground where the dataset has labels, else what a street's slope allows.
fn lidar_ground(sweep: &LidarSweep) -> Vec<Observation> {
    let mut cells: BTreeMap<(i64, i64), Vec<f64>> = BTreeMap::new();
    let origin = sweep.origin_world;
    for (i, p) in sweep.points_world.iter().map(|p| p.as_dvec3()).enumerate() {
        let range_m = p.truncate().distance(origin.truncate());
        let ground = match sweep.classes.get(i) {
            Some(class) => matches!(class, LidarClass::Road | LidarClass::Sidewalk | LidarClass::Terrain),
            // The sensor rides 1.5–2 m above the road.
            None => (origin.z - p.z - 1.8).abs() < 0.4 + 0.05 * range_m,
        };
        if ground && range_m < LIDAR_REACH_M && p.is_finite() {
            let cell = (p.truncate() / LIDAR_CELL_M).floor();
            cells.entry((cell.x as i64, cell.y as i64)).or_default().push(p.z);
        }
    }
    let low = |((x, y), mut heights): ((i64, i64), Vec<f64>)| {
        heights.sort_by(f64::total_cmp);
        let position = (DVec2::new(x as f64, y as f64) + 0.5) * LIDAR_CELL_M;
        let range = position.distance(origin.truncate()) / HALF_WEIGHT_RANGE_M;
        (heights.len() >= 3).then(|| Observation {
            position,
            height_m: heights[heights.len() / 5],
            weight: 0.5 / (1.0 + range * range),
        })
    };
    cells.into_iter().filter_map(low).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use glam::Vec3;
    use trove_model::Sweep;

    #[test]
    fn sweeps_between_the_keyframes_see_the_ground_too() {
        let mut drive = testing::drive();
        let before = observations(&drive, 0.15);
        let points_world = (0..400).map(|i| Vec3::new(210.0 + 0.1 * (i % 20) as f32, 7.0 + 0.1 * (i / 20) as f32, 0.3));
        let origin_world = DVec3::new(200.0, 8.0, 2.1);
        let lidar = LidarSweep { origin_world, points_world: points_world.collect(), classes: Vec::new() };
        drive.sweeps = vec![Sweep { time_ns: drive.keyframes[0].time_ns + 1, lidar }];
        let seen: Vec<_> = observations(&drive, 0.15).into_iter().filter(|o| o.position.x > 205.0).collect();
        assert!(before.iter().all(|o| o.position.x < 205.0), "nothing else knows of it");
        assert!(!seen.is_empty() && seen.iter().all(|o| (o.height_m - 0.3).abs() < 1e-6), "{seen:?}");
    }

    #[test]
    fn mapped_heights_beside_the_road_are_brought_down_by_the_kerb() {
        let mut drive = testing::drive();
        // The street's carriageway ends at y = 12.
        let ground = [DVec3::new(0.0, 11.0, 2.0), DVec3::new(0.0, 13.0, 2.15)];
        drive.lane_map.as_mut().unwrap().ground = ground.to_vec();
        let heights: Vec<_> = mapped(&drive, 0.15).iter().map(|o| o.height_m).collect();
        assert!(heights.iter().all(|h| (h - 2.0).abs() < 1e-12), "{heights:?}");
        let count = |drive: &Drive| observations(drive, 0.15).len();
        assert_eq!(count(&drive), count(&testing::drive()) + 2);
    }
}
