//! nuScenes' names for things, in ours.

use trove_model::{Kind, LidarClass};

/// The 23 categories of annotated objects.
const CATEGORIES: [(&str, Kind); 23] = [
    ("animal", Kind::Animal),
    ("human.pedestrian.adult", Kind::Adult),
    ("human.pedestrian.child", Kind::Child),
    ("human.pedestrian.construction_worker", Kind::ConstructionWorker),
    ("human.pedestrian.personal_mobility", Kind::PersonalMobility),
    ("human.pedestrian.police_officer", Kind::PoliceOfficer),
    ("human.pedestrian.stroller", Kind::Stroller),
    ("human.pedestrian.wheelchair", Kind::Wheelchair),
    ("movable_object.barrier", Kind::Barrier),
    ("movable_object.debris", Kind::Debris),
    ("movable_object.pushable_pullable", Kind::PushablePullable),
    ("movable_object.trafficcone", Kind::TrafficCone),
    ("static_object.bicycle_rack", Kind::BicycleRack),
    ("vehicle.bicycle", Kind::Bicycle),
    ("vehicle.bus.bendy", Kind::ArticulatedBus),
    ("vehicle.bus.rigid", Kind::Bus),
    ("vehicle.car", Kind::Car),
    ("vehicle.construction", Kind::ConstructionVehicle),
    ("vehicle.emergency.ambulance", Kind::Ambulance),
    ("vehicle.emergency.police", Kind::PoliceCar),
    ("vehicle.motorcycle", Kind::Motorcycle),
    ("vehicle.trailer", Kind::Trailer),
    ("vehicle.truck", Kind::Truck),
];

/// Attribute of a cycle that somebody rides.
pub(super) const WITH_RIDER: &str = "cycle.with_rider";
/// Attribute of a cycle that stands or is pushed.
pub(super) const WITHOUT_RIDER: &str = "cycle.without_rider";

/// What a category is, a cycle without its rider; `None` for a name that is not nuScenes'.
pub(super) fn kind_of_category(category: &str) -> Option<Kind> {
    CATEGORIES.iter().find(|(name, _)| *name == category).map(|(_, kind)| *kind)
}

/// The same cycle with a rider; `None` for what is no cycle.
pub(super) fn with_rider(kind: Kind) -> Option<Kind> {
    match kind {
        Kind::Bicycle => Some(Kind::BicycleWithRider),
        Kind::Motorcycle => Some(Kind::MotorcycleWithRider),
        _ => None,
    }
}

/// The lidarseg categories that are not objects, with the number they have in the published label files.
const LIDARSEG: [(u8, &str, LidarClass); 6] = [
    (24, "flat.driveable_surface", LidarClass::Road),
    (25, "flat.other", LidarClass::Terrain),
    (26, "flat.sidewalk", LidarClass::Sidewalk),
    (27, "flat.terrain", LidarClass::Terrain),
    (28, "static.manmade", LidarClass::Manmade),
    (30, "static.vegetation", LidarClass::Vegetation),
];

/// What each number in a lidarseg file means, by the dataset's own numbering where its categories carry one.
pub(super) fn lidar_classes(numbered: &[(u8, &str)]) -> [LidarClass; 256] {
    let mut classes = [LidarClass::Other; 256];
    for &(number, name) in numbered {
        if let Some((_, _, class)) = LIDARSEG.iter().find(|(_, n, _)| *n == name) {
            classes[usize::from(number)] = *class;
        }
    }
    if numbered.is_empty() {
        LIDARSEG.iter().for_each(|(number, _, class)| classes[usize::from(*number)] = *class);
    }
    classes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_category_has_one_kind_and_other_names_have_none() {
        let mut names: Vec<_> = CATEGORIES.iter().map(|(name, _)| *name).collect();
        names.dedup();
        assert_eq!(names.len(), 23);
        assert!(names.is_sorted());
        assert_eq!(kind_of_category("vehicle.bus.bendy"), Some(Kind::ArticulatedBus));
        assert_eq!(kind_of_category("vehicle.hovercraft"), None);
        assert_eq!(kind_of_category("vehicle.bicycle").and_then(with_rider), Some(Kind::BicycleWithRider));
    }

    #[test]
    fn a_datasets_own_lidar_numbers_stand_before_the_published_ones() {
        assert_eq!(lidar_classes(&[])[30], LidarClass::Vegetation);
        let own = lidar_classes(&[(3, "static.vegetation")]);
        assert_eq!((own[3], own[30]), (LidarClass::Vegetation, LidarClass::Other));
    }
}
