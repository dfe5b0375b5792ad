//! A grid around the vehicle as it is written.

use trove_format::{GridClass, GridObject, GridTable};
use trove_model::{Class, ClassMap, GridForm, GridShot, InstanceId, MapLayer, Occupancy, Scene};

use crate::counted::{Counted, counted};
use crate::frame_table::{FrameMeta, matrix};
use crate::{npy, npz};

const LABELS: &str = "labels.npz";
const OCCUPANCY: &str = "occupancy.npy";
const MASKS: &str = "masks.npz";

/// A filled grid: its table and its cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Its folder below the output folder (`scene-0103/v00/k005/ego.OCC3D`), with `/` between the parts.
    pub path: String,
    /// Frame, classes and objects.
    pub table: GridTable,
    /// How it is written.
    pub form: GridForm,
    /// What fills it.
    pub cells: Occupancy,
    /// The number that stands for each column of cells, seen from above; y changes fastest.
    pub bev: Vec<u8>,
    /// What the roads are there, as bits of [`MapLayer`]; in the same order.
    pub map: Vec<u8>,
}

impl Grid {
    /// The grid of a scene.
    pub fn of(path: String, scene: &Scene, shot: &GridShot, cells: Occupancy, meta: &FrameMeta) -> Self {
        let (plan, classes) = (&shot.plan, &shot.plan.classes);
        let class = |class: &trove_model::MappedClass| GridClass {
            id: class.id,
            name: class.name.clone(),
            thing: class.thing,
            rgb: class.rgb,
        };
        let is_object = |id: &InstanceId| scene.instances.iter().any(|i| i.id == *id && i.object.is_some());
        let table = GridTable {
            scene: meta.scene.clone(),
            dataset: meta.dataset.clone(),
            place: meta.place.clone(),
            variation: meta.variation,
            keyframe: meta.keyframe,
            keyframe_token: meta.keyframe_token.clone(),
            recorded_keyframe: meta.recorded_keyframe,
            view: shot.view.clone(),
            time_ns: shot.time_ns,
            preset: plan.name.clone(),
            form: plan.form.name().into(),
            solid: plan.is_solid,
            low_m: plan.grid.low_m.to_array(),
            voxel_m: plan.grid.voxel_m,
            cells: plan.grid.counts.map(|count| count as u32),
            world_from_grid: matrix(shot.world_from_grid.affine()),
            world_from_ego: matrix(shot.world_from_ego.affine()),
            carrier: shot.absent.filter(is_object).map(|id| id.0),
            cameras: shot.cameras.iter().map(|camera| camera.view.clone()).collect(),
            lidars: shot.lidars.iter().map(|lidar| lidar.view.clone()).collect(),
            free: classes.unlabelled,
            classes: classes.classes.iter().map(class).collect(),
            map_layers: MapLayer::ALL.map(|layer| layer.name().to_owned()).to_vec(),
            projection: (&meta.projection).into(),
            objects: objects(scene, &cells.instances),
        };
        let bev = birds_eye(&cells.labels, shot);
        Self { path, table, form: plan.form, cells, bev, map: shot.map.clone() }
    }

    /// Names of the files in a finished grid's folder, in alphabetical order.
    pub fn files(form: GridForm) -> &'static [&'static str] {
        match form {
            GridForm::Dense => &[GridTable::NAME, LABELS],
            GridForm::Sparse => &[GridTable::NAME, MASKS, OCCUPANCY],
        }
    }

    /// The files' bytes, in the order of their names.
    pub(crate) fn encoded(&self) -> Vec<Vec<u8>> {
        let shape = self.table.cells.map(|count| count as usize);
        let mask = |seen: &[bool]| bytes(&shape, &seen.iter().map(|&seen| u8::from(seen)).collect::<Vec<_>>());
        let cells = &self.cells;
        let columns = [("bev", bytes(&shape[..2], &self.bev)), ("map", bytes(&shape[..2], &self.map))];
        let masks = [("mask_lidar", mask(&cells.seen_by_lidars)), ("mask_camera", mask(&cells.seen_by_cameras))];
        let table = self.table.to_json();
        match self.form {
            GridForm::Dense => {
                let instances: Vec<u8> = cells.instances.iter().flat_map(|id| id.0.to_le_bytes()).collect();
                let labels = [
                    ("semantics", bytes(&shape, &cells.labels)),
                    ("instance", npy::encode("'<u4'", &shape, &instances)),
                ];
                vec![table, npz::archive(&[&labels[..], &masks, &columns].concat())]
            }
            GridForm::Sparse => vec![table, npz::archive(&[&masks[..], &columns].concat()), self.occupied(shape)],
        }
    }

    /// Rows of z, y, x and number of every cell that is not free, in the order of z, y and x.
    fn occupied(&self, [nx, ny, nz]: [usize; 3]) -> Vec<u8> {
        let (mut rows, mut count) = (Vec::new(), 0);
        for (z, y, x) in (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| (z, y, x)))) {
            let label = self.cells.labels[(x * ny + y) * nz + z];
            if label != self.table.free {
                rows.extend(
                    [z as u16, y as u16, x as u16, label.into()].iter().flat_map(|number| number.to_le_bytes()),
                );
                count += 1;
            }
        }
        npy::encode("'<u2'", &[count, 4], &rows)
    }
}

fn bytes(shape: &[usize], values: &[u8]) -> Vec<u8> {
    npy::encode("'|u1'", shape, values)
}

/// What each column of cells, from the lowest up, shows from above.
fn birds_eye(labels: &[u8], shot: &GridShot) -> Vec<u8> {
    labels.chunks(shot.plan.grid.counts[2]).map(|column| from_above(column, &shot.plan.classes)).collect()
}

/// The highest thing, else what stands on the highest of road, sidewalk and ground, else that, else what is highest: crowns of
/// trees and bridges do not hide the road, and houses hide the ground below them.
fn from_above(column: &[u8], classes: &ClassMap) -> u8 {
    let flat = [Class::Road, Class::Sidewalk, Class::Ground].map(|class| classes.id(class));
    let is_filled = |label: &&u8| **label != classes.unlabelled;
    let is_thing = |label: &&u8| is_filled(label) && classes.class(**label).is_some_and(|class| class.thing);
    let on_ground = || {
        let ground = column.iter().rposition(|label| flat.contains(label) && is_filled(&label))?;
        // Where land rises beside it, the lowest cell of a house's inside is not told to be inside.
        column[ground + 1..].iter().take(2).find(is_filled).or(column.get(ground))
    };
    let top = || column.iter().rev().find(is_filled);
    column.iter().rev().find(is_thing).or_else(on_ground).or_else(top).copied().unwrap_or(classes.unlabelled)
}

/// Rows of the objects that fill cells.
fn objects(scene: &Scene, cells: &[InstanceId]) -> Vec<GridObject> {
    let row = |found: Counted| GridObject {
        id: found.id.0,
        class: found.class,
        kind: found.object.kind,
        origin: (&found.object.origin).into(),
        track_token: found.object.origin.track_token().unwrap_or_default().into(),
        world_from_body: matrix(found.object.cuboid.world_from_body.affine()),
        size_m: found.object.cuboid.size_m.to_array(),
        velocity_mps: found.object.velocity_mps.map(|velocity| velocity.to_array()),
        cells: found.count,
    };
    counted(scene, cells.iter().copied()).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn from_above_crowns_do_not_hide_the_road_and_houses_hide_the_ground() {
        const FREE: u8 = 17;
        let classes = ClassMap::named("occ3d").unwrap();
        for (column, expected) in [
            ([11, FREE, FREE, 16, 16], 11),     // a crown over the road
            ([14, 16, 16, FREE, FREE], 16),     // a hedge
            ([14, 15, 15, 15, 15], 15),         // a house
            ([14, FREE, 15, 15, 15], 15),       // a house on a slope
            ([11, 4, 4, FREE, 16], 4),          // a car below a crown
            ([11, 11, FREE, FREE, FREE], 11),   // a slope
            ([FREE, FREE, 15, FREE, FREE], 15), // a bridge over nothing
            ([FREE; 5], FREE),
        ] {
            assert_eq!(from_above(&column, &classes), expected, "{column:?}");
        }
    }
}
