//! Walls that the LiDAR saw, a piece a cube: from above a wall is a line, while leaves fill the plane.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};
use trove_model::{Cuboid, Keyframe, LidarClass};

/// Side of the cubes that geometry is judged in, metres.
const CUBE_M: f64 = 1.5;
/// Fewer points in a cube tell nothing.
const MIN_POINTS: f64 = 6.0;
/// A wall from above: at most this thick (standard deviation), at most this share of its length, and so long, metres.
const MAX_THICKNESS_M: f64 = 0.08;
const MAX_THICKNESS_SHARE: f64 = 0.25;
const MIN_RUN_M: f64 = 0.2;

/// A cube in which the points form an upright plane.
#[derive(Clone, Copy)]
pub(super) struct WallPiece {
    pub position: DVec2,
    /// Along the wall.
    pub axis: DVec2,
}

/// Sums of the points in a cube, seen from above and from its corner.
#[derive(Clone, Copy, Default)]
struct Sums {
    count: f64,
    sum: DVec2,
    squares: DVec2,
    product: f64,
}

/// The pieces of wall that a keyframe's sweep shows within `reach_m` and so high above the vehicle's wheels, in a fixed order.
/// Points on annotated objects are left out.
pub(super) fn wall_pieces(keyframe: &Keyframe, reach_m: f64, above_wheels_m: RangeInclusive<f64>) -> Vec<WallPiece> {
    let Some(sweep) = &keyframe.lidar else { return Vec::new() };
    let boxes: Vec<Cuboid> = keyframe.boxes.iter().map(|b| b.cuboid.grown(0.25)).collect();
    let labels = (sweep.classes.len() == sweep.points_world.len()).then_some(&sweep.classes);
    let mut cubes: BTreeMap<[i32; 3], Sums> = BTreeMap::new();
    for (i, point) in sweep.points_world.iter().enumerate() {
        let position = point.as_dvec3();
        if labels.is_some_and(|l| l[i] != LidarClass::Manmade) || position.distance(sweep.origin_world) > reach_m {
            continue;
        }
        let above_m = position.z - keyframe.world_from_ego.translation.z;
        if !above_wheels_m.contains(&above_m) || boxes.iter().any(|b| b.contains(position)) {
            continue;
        }
        let key = (position / CUBE_M).floor().as_ivec3();
        let p = (position - key.as_dvec3() * CUBE_M).truncate();
        let sums = cubes.entry(key.to_array()).or_default();
        sums.count += 1.0;
        sums.sum += p;
        sums.squares += p * p;
        sums.product += p.x * p.y;
    }
    cubes.iter().filter_map(|(key, sums)| sums.wall(DVec3::from_array(key.map(f64::from)) * CUBE_M)).collect()
}

impl Sums {
    /// The wall in a cube, if its points form a line seen from above.
    fn wall(&self, corner: DVec3) -> Option<WallPiece> {
        if self.count < MIN_POINTS {
            return None;
        }
        let mean = self.sum / self.count;
        let spread = self.squares / self.count - mean * mean;
        let across = self.product / self.count - mean.x * mean.y;
        let (middle, half) = (spread.element_sum() / 2.0, ((spread.x - spread.y) / 2.0).hypot(across));
        let [run_m, thickness_m] = [middle + half, middle - half].map(|v| v.max(0.0).sqrt());
        let axis = DVec2::from_angle((2.0 * across).atan2(spread.x - spread.y) / 2.0);
        let is_wall =
            run_m >= MIN_RUN_M && thickness_m <= MAX_THICKNESS_M && thickness_m <= MAX_THICKNESS_SHARE * run_m;
        is_wall.then_some(WallPiece { position: corner.truncate() + mean, axis })
    }
}
