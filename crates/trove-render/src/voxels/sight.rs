//! Which cells cameras and LiDARs see: those that a ray passes before it meets a surface, and the one where it does.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use trove_model::{GridShot, Lens, LidarShot, SensorRay, Shot, VoxelGrid};

use super::frame::Frame;
use crate::PreparedScene;
use crate::accel::PACKET;
use crate::prepare::Carrier;
use crate::sight;

/// A surface is looked for so far behind where it is met, metres, since that may be on the border of two cells.
const INTO_M: f64 = 1e-3;
/// Rays of a camera across the narrowest view of a cell.
const ACROSS: f64 = 2.0;

/// Whether each cell is seen by cameras, and by LiDARs.
pub(super) fn seen(scene: &PreparedScene, shot: &GridShot, frame: &Frame) -> [Vec<bool>; 2] {
    let marks = [(); 2].map(|()| Marks::new(shot.plan.grid, frame));
    for camera in &shot.cameras {
        of_camera(scene, camera, &marks[0]);
    }
    for lidar in &shot.lidars {
        of_lidar(scene, lidar, &marks[1]);
    }
    marks.map(Marks::into_cells)
}

/// Rays through every n-th pixel, so near to each other that none of the grid's cells lies between them.
fn of_camera(scene: &PreparedScene, shot: &Shot, marks: &Marks) {
    let carrier = Carrier::of_labels(scene, None, shot);
    let step = marks.step_px(&shot.lens, shot.world_from_camera.translation);
    let pixels = |px: u32| (0..((f64::from(px) / step).ceil() as u32)).map(move |i| (f64::from(i) + 0.5) * step);
    let rows: Vec<f64> = pixels(shot.lens.height_px).collect();
    rows.into_par_iter().for_each(|v| {
        let ray = |u: f64| shot.lens.unproject(DVec2::new(u, v)).map(|direction| shot.label_ray(direction));
        let rays: Vec<SensorRay> = pixels(shot.lens.width_px).filter_map(ray).collect();
        for rays in rays.chunks(PACKET) {
            let seen = sight::seen(scene, &carrier, rays);
            rays.iter().zip(seen).for_each(|(ray, seen)| marks.pass(ray, seen.map(|seen| seen.range_m)));
        }
    });
}

/// The middles of its beams, of those that meet something that it can tell.
fn of_lidar(scene: &PreparedScene, shot: &LidarShot, marks: &Marks) {
    let carrier = Carrier::new(scene, shot.carrier);
    let scanner = &shot.scanner;
    (0..scanner.columns).into_par_iter().for_each(|column| {
        let rays: Vec<SensorRay> = (0..scanner.elevations_rad.len()).map(|ring| shot.ray(column, ring)).collect();
        for rays in rays.chunks(PACKET) {
            let seen = sight::seen(scene, &carrier, rays);
            for (ray, seen) in rays.iter().zip(seen) {
                if let Some(seen) = seen.filter(|seen| (scanner.nearest_m..=scanner.farthest_m).contains(&seen.range_m))
                {
                    marks.pass(ray, Some(seen.range_m));
                }
            }
        }
    });
}

/// Cells that have been seen; several threads may mark them, in any order.
struct Marks<'a> {
    grid: VoxelGrid,
    frame: &'a Frame,
    seen: Vec<AtomicBool>,
}

impl<'a> Marks<'a> {
    fn new(grid: VoxelGrid, frame: &'a Frame) -> Self {
        Self { grid, frame, seen: (0..grid.len()).map(|_| AtomicBool::new(false)).collect() }
    }

    fn into_cells(self) -> Vec<bool> {
        self.seen.into_iter().map(AtomicBool::into_inner).collect()
    }

    /// Pixels from one ray to the next.
    fn step_px(&self, lens: &Lens, eye_world: DVec3) -> f64 {
        let eye = self.frame.cells_from_world.transform_point3(eye_world);
        let farthest = eye.abs().max((self.grid.size() - eye).abs()).length();
        (lens.fx_px.min(lens.fy_px) / farthest / ACROSS).floor().max(1.0)
    }

    /// Marks the cells of a ray up to where it meets something; all in its way where it meets nothing (Amanatides and Woo 1987).
    fn pass(&self, ray: &SensorRay, range_m: Option<f64>) {
        let cells_from_world = &self.frame.cells_from_world;
        let from = cells_from_world.transform_point3(ray.origin);
        let way = cells_from_world.transform_vector3(ray.direction);
        let size = self.grid.size();
        let (a, b) = (-from / way, (size - from) / way);
        // A ray along a face has 0 / 0, which counts for nothing.
        let (near, far) = (a.min(b), a.max(b));
        let enters = near.to_array().into_iter().filter(|t| !t.is_nan()).fold(0.0, f64::max);
        let leaves = far.to_array().into_iter().filter(|t| !t.is_nan()).fold(f64::INFINITY, f64::min);
        let ends = range_m.map_or(leaves, |range_m| leaves.min(range_m + INTO_M));
        if enters >= ends {
            return;
        }
        let step = way.signum();
        let mut cell = (from + way * (enters + 1e-9)).floor().clamp(DVec3::ZERO, size - 1.0);
        let face = cell + (step + 1.0) / 2.0;
        let mut next = DVec3::select(way.cmpeq(DVec3::ZERO), DVec3::INFINITY, (face - from) / way);
        let period = way.recip().abs();
        loop {
            let [x, y, z] = cell.to_array().map(|i| i as usize);
            self.seen[self.grid.index([x, y, z])].store(true, Ordering::Relaxed);
            let axis = if next.x <= next.y && next.x <= next.z {
                0
            } else if next.y <= next.z {
                1
            } else {
                2
            };
            if next[axis] >= ends {
                return;
            }
            cell[axis] += step[axis];
            if cell[axis] < 0.0 || cell[axis] >= size[axis] {
                return;
            }
            next[axis] += period[axis];
        }
    }
}
