//! Where the grids around the vehicle are, and who looks into them.

use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};
use trove_model::{
    Bounds, Drive, Ego, GridFrame, GridPlan, GridShot, LidarShot, MapLayer, Polygon, Pose, RoadPlan, SensorFrame, Shot,
    Viewpoint, VoxelGrid, World,
};

use crate::geometry::plane_raster::PlaneRaster;
use crate::site::Site;

/// From one point to the next of those that mark a line's cells, in cells.
const STEP: f64 = 0.125;

/// The grids of a keyframe, one a plan with its name; none for a keyframe that the drive does not have. A grid in the axes of
/// a LiDAR is in the vehicle's where the drive has none.
///
/// Of `shots` and `lidars`, those of the keyframe, the recording vehicle's look into them.
pub fn grid_shots(
    drive: &Drive,
    site: &Site,
    keyframe: usize,
    plans: &[(String, Arc<GridPlan>)],
    shots: &[Shot],
    lidars: &[LidarShot],
) -> Vec<GridShot> {
    let Some(moment) = drive.keyframes.get(keyframe) else { return Vec::new() };
    let is_own = |shot: &&Shot| matches!(shot.viewpoint, Viewpoint::Recording { .. });
    let shot = |(name, plan): &(String, Arc<GridPlan>)| {
        let lidar = drive.lidars.first().filter(|_| plan.frame == GridFrame::Lidar);
        let ego_from_grid = lidar.map_or(Pose::<Ego, SensorFrame>::IDENTITY, |lidar| lidar.ego_from_lidar);
        let world_from_grid = moment.world_from_ego * ego_from_grid;
        GridShot {
            view: format!("ego.{name}"),
            plan: plan.clone(),
            map: map(&plan.grid, world_from_grid, moment.world_from_ego, site.roads()),
            world_from_grid,
            world_from_ego: moment.world_from_ego,
            time_ns: moment.time_ns,
            absent: Some(site.ego_id(drive)),
            cameras: shots.iter().filter(is_own).cloned().collect(),
            lidars: lidars.to_vec(),
        }
    };
    plans.iter().map(shot).collect()
}

/// What the roads are in each column of cells: areas where they hold its middle, lines wherever they pass.
fn map(
    grid: &VoxelGrid,
    world_from_grid: Pose<World, SensorFrame>,
    world_from_ego: Pose<World, Ego>,
    roads: &RoadPlan,
) -> Vec<u8> {
    let plane = Plane { grid_from_world: world_from_grid.affine().inverse(), ground: world_from_ego.affine() };
    let [nx, ny, _] = grid.counts;
    let low = grid.low_m.truncate();
    let size = DVec2::new(nx as f64, ny as f64);
    // A little less, so that rounding adds no column.
    let bounds = Bounds { min: low, max: low + (size - 1e-6) * grid.voxel_m };
    let mut cells = PlaneRaster::new(bounds, grid.voxel_m);
    let areas = [&roads.drivable, &roads.walkways, &roads.crossings];
    for (layer, area) in [MapLayer::Drivable, MapLayer::Walkway, MapLayer::Crossing].into_iter().zip(areas) {
        let area: Vec<Polygon> = area.iter().map(|polygon| plane.polygon(polygon)).collect();
        cells.mark(&area, layer.bit());
    }
    let lines = roads.lines.iter().map(|line| (MapLayer::Line, &line.points));
    for (layer, line) in lines.chain(roads.kerbs.iter().map(|kerb| (MapLayer::Kerb, kerb))) {
        let line: Vec<DVec2> = line.iter().map(|p| (plane.point(p.truncate()) - low) / grid.voxel_m).collect();
        let is_near = |p: &DVec2| p.cmpge(-size).all() && p.cmple(2.0 * size).all();
        for pair in line.windows(2).filter(|pair| pair.iter().any(is_near)) {
            let steps = (pair[0].distance(pair[1]) / STEP).ceil().max(1.0);
            for i in 0..=steps as u32 {
                cells.mark_cell(pair[0].lerp(pair[1], f64::from(i) / steps).floor().as_ivec2(), layer.bit());
            }
        }
    }
    let middles = (0..nx).flat_map(|x| (0..ny).map(move |y| grid.centre_m([x, y, 0]).truncate()));
    middles.map(|middle| cells.at(middle)).collect()
}

/// From World's plane straight down to the vehicle's ground, in a grid's axes.
struct Plane {
    grid_from_world: DAffine3,
    ground: DAffine3,
}

impl Plane {
    fn point(&self, p: DVec2) -> DVec2 {
        let (up, at) = (self.ground.matrix3.z_axis, self.ground.translation);
        let height_m = at.z - up.truncate().dot(p - at.truncate()) / up.z;
        self.grid_from_world.transform_point3(DVec3::new(p.x, p.y, height_m)).truncate()
    }

    fn polygon(&self, polygon: &Polygon) -> Polygon {
        let ring = |ring: &Vec<DVec2>| ring.iter().map(|&p| self.point(p)).collect();
        Polygon { exterior: ring(&polygon.exterior), holes: polygon.holes.iter().map(ring).collect() }
    }
}

#[cfg(test)]
mod tests {
    use glam::DQuat;
    use trove_model::{MarkPattern, Paint, PaintedLine};

    use super::*;

    #[test]
    fn a_turned_grid_on_a_slope_has_the_road_where_it_is() {
        // A road along World's y from x = -3 to 3, its line in the middle and a kerb at its western edge.
        let corners = [[-3.0, -90.0], [3.0, -90.0], [3.0, 90.0], [-3.0, 90.0]];
        let along = |x: f64| (-9..=9).map(|y| DVec3::new(x, 10.0 * f64::from(y), 0.0)).collect::<Vec<_>>();
        let line = PaintedLine { points: along(0.1), paint: Paint::White, pattern: MarkPattern::Solid, width_m: 0.1 };
        let roads = RoadPlan {
            drivable: vec![Polygon::simple(corners.map(DVec2::from_array).to_vec())],
            lines: vec![line],
            kerbs: vec![along(-3.0)],
            ..RoadPlan::default()
        };
        // The vehicle looks along the road, which rises by a tenth.
        let pitch = 0.1_f64.atan();
        let rotation = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2) * DQuat::from_rotation_y(-pitch);
        let at = DVec3::new(0.72, 5.0, 40.0);
        let grid = VoxelGrid { low_m: DVec3::new(-10.0, -5.0, -1.0), voxel_m: 0.5, counts: [40, 20, 4] };
        let found = map(&grid, Pose::new(rotation, at), Pose::new(rotation, at), &roads);
        assert_eq!(found.len(), 800);
        for (i, bits) in found.into_iter().enumerate() {
            // y to the left of the vehicle is west.
            let x = 0.72 - grid.centre_m([0, i % 20, 0]).y;
            let expected = [
                (MapLayer::Drivable, x.abs() < 3.0),
                (MapLayer::Line, (x - 0.1).abs() <= 0.25),
                (MapLayer::Kerb, (x + 3.0).abs() <= 0.25),
            ];
            let expected = expected.iter().filter(|(_, is_there)| *is_there).map(|(layer, _)| layer.bit()).sum::<u8>();
            assert_eq!(bits, expected, "{i}: x = {x}");
        }
    }
}
