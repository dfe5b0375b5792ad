//! nuScenes' names for things, in ours.

use trove_model::{Kind, LidarClass};

/// Attribute of a cycle that somebody rides.
pub(super) const WITH_RIDER: &str = "cycle.with_rider";
/// Attribute of a cycle that stands or is pushed.
pub(super) const WITHOUT_RIDER: &str = "cycle.without_rider";

/// How attributes of vehicles other than cycles begin, all of which tell whether they are parked.
pub(super) const VEHICLE: &str = "vehicle.";
/// The one of those that are.
pub(super) const PARKED: &str = "vehicle.parked";

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
    fn a_datasets_own_lidar_numbers_stand_before_the_published_ones() {
        assert_eq!(lidar_classes(&[])[30], LidarClass::Vegetation);
        let own = lidar_classes(&[(3, "static.vegetation")]);
        assert_eq!((own[3], own[30]), (LidarClass::Vegetation, LidarClass::Other));
    }
}
