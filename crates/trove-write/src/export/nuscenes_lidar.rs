//! nuScenes' LiDAR: `.pcd.bin`, and its labels by point in nuScenes-lidarseg's and Panoptic nuScenes' forms.

use std::collections::{BTreeMap, HashMap};

use serde_json::{Value, json};
use trove_format::{ObjectOrigin, SweptObject};
use trove_model::{Class, LidarPoint};

use super::kinds;
use super::nuscenes_rows::{VERSION, token};
use super::unit::Unit;
use crate::{StoredSweep, WriteError, npy, npz};

/// nuScenes' categories of points, by the numbers that lidarseg gives them; the first 23 after noise are those of boxes.
const CATEGORIES: [&str; 32] = [
    "noise",
    "animal",
    "human.pedestrian.adult",
    "human.pedestrian.child",
    "human.pedestrian.construction_worker",
    "human.pedestrian.personal_mobility",
    "human.pedestrian.police_officer",
    "human.pedestrian.stroller",
    "human.pedestrian.wheelchair",
    "movable_object.barrier",
    "movable_object.debris",
    "movable_object.pushable_pullable",
    "movable_object.trafficcone",
    "static_object.bicycle_rack",
    "vehicle.bicycle",
    "vehicle.bus.bendy",
    "vehicle.bus.rigid",
    "vehicle.car",
    "vehicle.construction",
    "vehicle.emergency.ambulance",
    "vehicle.emergency.police",
    "vehicle.motorcycle",
    "vehicle.trailer",
    "vehicle.truck",
    "flat.driveable_surface",
    "flat.other",
    "flat.sidewalk",
    "flat.terrain",
    "static.manmade",
    "static.other",
    "static.vegetation",
    "vehicle.ego",
];
const OWN_VEHICLE: u8 = 31;
/// Panoptic labels are a category's thousand and a number below the next.
const PANOPTIC: u16 = 1000;

/// Rows of the table of categories.
pub(super) fn categories() -> Vec<Value> {
    let row = |(index, name): (usize, &&str)| json!({ "token": token("category", name), "name": name, "description": "", "index": index });
    CATEGORIES.iter().enumerate().map(row).collect()
}

/// The numbers of a scene's objects within their categories, from 1.
pub(super) struct PanopticNumbers(HashMap<u32, u16>);

impl PanopticNumbers {
    /// Of the objects of all sweeps of a scene, in the order of their ids.
    pub(super) fn of<'a>(sweeps: impl Iterator<Item = &'a StoredSweep>) -> Self {
        let objects: BTreeMap<u32, &SweptObject> =
            sweeps.flat_map(|sweep| &sweep.table.objects).map(|object| (object.id, object)).collect();
        let (mut counts, mut numbers) = (HashMap::<u8, u16>::new(), HashMap::new());
        for (id, object) in objects {
            let Some(category) = of_object(object).filter(|category| *category != OWN_VEHICLE) else { continue };
            let count = counts.entry(category).or_default();
            *count += 1;
            numbers.insert(id, *count);
        }
        Self(numbers)
    }
}

/// A sweep's points as `.pcd.bin` (x, y, z, intensity, ring, each a float32); writes their labels beside.
pub(super) fn points(
    sweep: &StoredSweep,
    sample_data: &str,
    numbers: &PanopticNumbers,
    unit: &mut Unit<'_>,
) -> Result<Vec<u8>, WriteError> {
    let points = sweep.points()?;
    let objects: HashMap<u32, u8> =
        sweep.table.objects.iter().filter_map(|object| Some((object.id, of_object(object)?))).collect();
    let category = |point: &LidarPoint| objects.get(&point.instance.0).copied().unwrap_or(of_class(point.class));
    let categories: Vec<u8> = points.iter().map(category).collect();
    let panoptic: Vec<u16> = points
        .iter()
        .zip(&categories)
        .map(|(point, category)| {
            let number = numbers.0.get(&point.instance.0).copied().unwrap_or(0);
            u16::from(*category) * PANOPTIC + number.min(PANOPTIC - 1)
        })
        .collect();
    let crowded = numbers.0.values().filter(|number| **number >= PANOPTIC).count();
    unit.clip("objects of a category beyond 999, which share a panoptic number", crowded as u64);
    let numbers: Vec<u8> = panoptic.iter().flat_map(|number| number.to_le_bytes()).collect();
    let panoptic = npz::archive(&[("data", npy::encode("'<u2'", &[panoptic.len()], &numbers))]);
    for (table, ending, bytes) in [("lidarseg", "lidarseg.bin", categories), ("panoptic", "panoptic.npz", panoptic)] {
        let path = format!("{table}/{VERSION}/{sample_data}_{ending}");
        unit.write(&path, &bytes)?;
        unit.row(table, &json!({ "token": sample_data, "sample_data_token": sample_data, "filename": path }))?;
    }
    let record = |point: &LidarPoint| {
        let p = point.position_m;
        [p.x as f32, p.y as f32, p.z as f32, f32::from(point.intensity), f32::from(point.ring)].map(f32::to_le_bytes)
    };
    Ok(points.iter().flat_map(record).collect::<Vec<_>>().concat())
}

/// The category of a countable thing's points; `None` for what counts as a surface there.
fn of_object(object: &SweptObject) -> Option<u8> {
    if object.origin == ObjectOrigin::Carrier {
        return Some(OWN_VEHICLE);
    }
    number(kinds::nuscenes(object.kind).filter(|_| object.origin != ObjectOrigin::Scenery)?)
}

/// The category of a surface.
fn of_class(class: Class) -> u8 {
    match class {
        Class::Road => 24,
        Class::Sidewalk => 26,
        Class::Ground => 27,
        Class::Building | Class::Barrier | Class::TrafficSign => 28,
        Class::Tree | Class::Bush => 30,
        Class::Sky | Class::Void => 0,
        _ => 29,
    }
}

fn number(category: &str) -> Option<u8> {
    CATEGORIES.iter().position(|name| *name == category).map(|i| i as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_category_of_a_box_is_one_of_points() {
        let known = kinds::nuscenes_categories();
        assert!(known.len() > 10 && known.into_iter().all(|name| number(name).is_some_and(|i| (1..24).contains(&i))));
        assert_eq!([of_class(Class::Road), of_class(Class::Tree), of_class(Class::Building)], [24, 30, 28]);
        assert_eq!(CATEGORIES[usize::from(OWN_VEHICLE)], "vehicle.ego");
    }
}
