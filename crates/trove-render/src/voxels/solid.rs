//! Cells inside objects: from their middle, the way up and to all four sides ends first at one and the same object.
//!
//! Meshes need not be closed for that (buildings have no floor), and what is open to a side is outside: the road under a bus, a
//! gateway, a courtyard.

use glam::DVec3;
use rayon::prelude::*;
use trove_model::{GridShot, InstanceId, Occupancy, SensorRay};

use super::frame::{Frame, is_there, label};
use crate::PreparedScene;
use crate::accel::PACKET;
use crate::prepare::Carrier;
use crate::sight;

const WAYS: [DVec3; 5] = [DVec3::Z, DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y];

/// Fills cells of `found` that are free and inside objects.
pub(super) fn fill(scene: &PreparedScene, shot: &GridShot, frame: &Frame, found: &mut Occupancy) {
    let carrier = Carrier::new(scene, shot.absent);
    let free: Vec<usize> =
        (0..shot.plan.grid.len()).filter(|&cell| found.labels[cell] == shot.plan.classes.unlabelled).collect();
    let around = |cells: &[usize]| around(scene, shot, frame, &carrier, cells);
    let inside: Vec<Vec<(usize, u32)>> = free.par_chunks(PACKET).map(around).collect();
    for (cell, instance) in inside.into_iter().flatten() {
        found.labels[cell] = label(scene, shot, instance as usize);
        found.instances[cell] = scene.placed(instance).id;
    }
}

/// Which of some cells are inside which instance.
fn around(
    scene: &PreparedScene,
    shot: &GridShot,
    frame: &Frame,
    carrier: &Carrier,
    cells: &[usize],
) -> Vec<(usize, u32)> {
    let mut inside: Vec<(usize, Option<u32>)> = cells.iter().map(|&cell| (cell, None)).collect();
    for way in WAYS {
        let direction = frame.world_from_cells.transform_vector3(way).normalize();
        let ray = |&(cell, _): &(usize, _)| {
            let [x, y, z] = shot.plan.grid.cell(cell).map(|i| i as f64 + 0.5);
            SensorRay { origin: frame.world_from_cells.transform_point3(DVec3::new(x, y, z)), direction, time_s: 0.0 }
        };
        let rays: Vec<SensorRay> = inside.iter().map(ray).collect();
        let hits = sight::hits(scene, carrier, &rays);
        let id = |instance: u32| scene.placed(instance).id;
        let mut met = hits.into_iter().map(|hit| hit.map(|hit| hit.instance));
        inside.retain_mut(|(_, around)| {
            let Some(instance) = met.next().flatten() else { return false };
            let first = *around.get_or_insert(instance);
            id(instance) != InstanceId(0) && id(instance) == id(first) && is_there(scene, shot, instance as usize)
        });
        if inside.is_empty() {
            break;
        }
    }
    inside.into_iter().filter_map(|(cell, instance)| Some((cell, instance?))).collect()
}
