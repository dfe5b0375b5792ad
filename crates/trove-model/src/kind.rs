//! What a thing is, finer than its class.

use crate::Class;

/// What an object or an asset is; readers turn a dataset's categories into it, and assets are chosen by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[allow(missing_docs)] // the names are the definition
pub enum Kind {
    Adult,
    Child,
    ConstructionWorker,
    PoliceOfficer,
    /// Person on a scooter, skateboard or segway.
    PersonalMobility,
    /// Pram with the person pushing it.
    Stroller,
    Wheelchair,
    Animal,
    Bicycle,
    BicycleWithRider,
    Motorcycle,
    MotorcycleWithRider,
    /// Passenger car of any body: its assets are of class car, jeep or van.
    Car,
    PoliceCar,
    Ambulance,
    Truck,
    Trailer,
    ConstructionVehicle,
    Bus,
    ArticulatedBus,
    Barrier,
    TrafficCone,
    /// Something pushed or pulled: bin on wheels, cart, suitcase.
    PushablePullable,
    /// Something lying about: bag, box, branch.
    Debris,
    BicycleRack,
    Building,
    Tree,
    Bush,
    TrafficSign,
    TrafficSignal,
    StreetLamp,
    UtilityPole,
    Bollard,
    Hydrant,
    Bin,
    Bench,
    Shelter,
    /// What else stands on a sidewalk: mailbox, cabinet, parking meter, planter, table.
    StreetFurniture,
    Fence,
    Wall,
    GuardRail,
}

impl Kind {
    /// Every kind.
    #[rustfmt::skip]
    pub const ALL: [Self; 41] = [
        Self::Adult, Self::Child, Self::ConstructionWorker, Self::PoliceOfficer, Self::PersonalMobility, Self::Stroller,
        Self::Wheelchair, Self::Animal, Self::Bicycle, Self::BicycleWithRider, Self::Motorcycle, Self::MotorcycleWithRider,
        Self::Car, Self::PoliceCar, Self::Ambulance, Self::Truck, Self::Trailer, Self::ConstructionVehicle, Self::Bus,
        Self::ArticulatedBus, Self::Barrier, Self::TrafficCone, Self::PushablePullable, Self::Debris, Self::BicycleRack,
        Self::Building, Self::Tree, Self::Bush, Self::TrafficSign, Self::TrafficSignal, Self::StreetLamp, Self::UtilityPole,
        Self::Bollard, Self::Hydrant, Self::Bin, Self::Bench, Self::Shelter,
        Self::StreetFurniture, Self::Fence, Self::Wall, Self::GuardRail,
    ];

    /// Its name in every file that is written or read (`bicycle_with_rider`), unique among the kinds.
    pub fn name(self) -> &'static str {
        match self {
            Self::Adult => "adult",
            Self::Child => "child",
            Self::ConstructionWorker => "construction_worker",
            Self::PoliceOfficer => "police_officer",
            Self::PersonalMobility => "personal_mobility",
            Self::Stroller => "stroller",
            Self::Wheelchair => "wheelchair",
            Self::Animal => "animal",
            Self::Bicycle => "bicycle",
            Self::BicycleWithRider => "bicycle_with_rider",
            Self::Motorcycle => "motorcycle",
            Self::MotorcycleWithRider => "motorcycle_with_rider",
            Self::Car => "car",
            Self::PoliceCar => "police_car",
            Self::Ambulance => "ambulance",
            Self::Truck => "truck",
            Self::Trailer => "trailer",
            Self::ConstructionVehicle => "construction_vehicle",
            Self::Bus => "bus",
            Self::ArticulatedBus => "articulated_bus",
            Self::Barrier => "barrier",
            Self::TrafficCone => "traffic_cone",
            Self::PushablePullable => "pushable_pullable",
            Self::Debris => "debris",
            Self::BicycleRack => "bicycle_rack",
            Self::Building => "building",
            Self::Tree => "tree",
            Self::Bush => "bush",
            Self::TrafficSign => "traffic_sign",
            Self::TrafficSignal => "traffic_signal",
            Self::StreetLamp => "street_lamp",
            Self::UtilityPole => "utility_pole",
            Self::Bollard => "bollard",
            Self::Hydrant => "hydrant",
            Self::Bin => "bin",
            Self::Bench => "bench",
            Self::Shelter => "shelter",
            Self::StreetFurniture => "street_furniture",
            Self::Fence => "fence",
            Self::Wall => "wall",
            Self::GuardRail => "guard_rail",
        }
    }

    /// The kind of a name; `None` where no kind is called that.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// The class where an asset does not say otherwise.
    pub fn class(self) -> Class {
        match self {
            Self::Adult
            | Self::Child
            | Self::ConstructionWorker
            | Self::PoliceOfficer
            | Self::PersonalMobility
            | Self::Stroller
            | Self::Wheelchair => Class::Human,
            Self::Bicycle | Self::BicycleWithRider => Class::CycleRider,
            Self::Motorcycle | Self::MotorcycleWithRider => Class::MotorcycleRider,
            Self::Car | Self::PoliceCar => Class::Car,
            Self::Ambulance => Class::Van,
            Self::Truck | Self::Trailer => Class::Truck,
            Self::ConstructionVehicle => Class::Construction,
            Self::Bus | Self::ArticulatedBus => Class::Bus,
            Self::Barrier | Self::Fence | Self::Wall | Self::GuardRail => Class::Barrier,
            Self::TrafficCone => Class::TrafficCone,
            Self::Building => Class::Building,
            Self::Tree => Class::Tree,
            Self::Bush => Class::Bush,
            Self::TrafficSign
            | Self::TrafficSignal
            | Self::StreetLamp
            | Self::UtilityPole
            | Self::Bollard
            | Self::Hydrant => Class::TrafficSign,
            Self::Animal
            | Self::PushablePullable
            | Self::Debris
            | Self::BicycleRack
            | Self::Bin
            | Self::Bench
            | Self::Shelter
            | Self::StreetFurniture => Class::Void,
        }
    }

    /// The everyday word for it, which is among the tags of its assets: `lamp`, `bicycle-rack`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Adult => "adult",
            Self::Child => "child",
            Self::ConstructionWorker => "worker",
            Self::PoliceOfficer => "police-officer",
            Self::PersonalMobility => "personal-mobility",
            Self::Stroller => "stroller",
            Self::Wheelchair => "wheelchair",
            Self::Animal => "animal",
            Self::Bicycle | Self::BicycleWithRider => "bicycle",
            Self::Motorcycle | Self::MotorcycleWithRider => "motorcycle",
            Self::Car => "car",
            Self::PoliceCar => "police-car",
            Self::Ambulance => "ambulance",
            Self::Truck => "truck",
            Self::Trailer => "trailer",
            Self::ConstructionVehicle => "machine",
            Self::Bus | Self::ArticulatedBus => "bus",
            Self::Barrier => "barrier",
            Self::TrafficCone => "cone",
            Self::PushablePullable => "cart",
            Self::Debris => "debris",
            Self::BicycleRack => "bicycle-rack",
            Self::Building => "building",
            Self::Tree => "tree",
            Self::Bush => "bush",
            Self::TrafficSign => "sign",
            Self::TrafficSignal => "signal",
            Self::StreetLamp => "lamp",
            Self::UtilityPole => "utility-pole",
            Self::Bollard => "bollard",
            Self::Hydrant => "hydrant",
            Self::Bin => "bin",
            Self::Bench => "bench",
            Self::Shelter => "shelter",
            Self::StreetFurniture => "street-furniture",
            Self::Fence => "fence",
            Self::Wall => "wall",
            Self::GuardRail => "guard-rail",
        }
    }

    /// Whether it stands on a pole or trunk that is not under the middle of it: its asset's origin is the pole's foot.
    pub fn is_on_pole(self) -> bool {
        matches!(self, Self::Tree | Self::TrafficSign | Self::TrafficSignal | Self::StreetLamp | Self::UtilityPole)
    }

    /// Whether it drives on four wheels or more.
    pub fn is_car(self) -> bool {
        self.is_vehicle() && !matches!(self.class(), Class::CycleRider | Class::MotorcycleRider)
    }

    /// Whether it drives, with a body that follows the ground's slope.
    pub fn is_vehicle(self) -> bool {
        matches!(
            self.class(),
            Class::Car
                | Class::Bus
                | Class::Jeep
                | Class::Truck
                | Class::Van
                | Class::Construction
                | Class::CycleRider
                | Class::MotorcycleRider
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_found_by_its_name() {
        for kind in Kind::ALL {
            assert_eq!(Kind::from_name(kind.name()), Some(kind));
        }
        assert_eq!(Kind::BicycleWithRider.name(), "bicycle_with_rider");
        assert_eq!(Kind::from_name("BicycleWithRider"), None);
    }
}
