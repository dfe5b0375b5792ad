//! What a pixel can be: the 20 classes, and the same in other datasets' numbers.

/// The paper's 20 classes; the discriminant is the id in `class.png`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Class {
    /// Nothing of the below; ignored in training.
    Void = 0,
    /// Where a ray hits nothing.
    Sky = 1,
    /// Passenger car.
    Car = 2,
    /// Bus of any kind.
    Bus = 3,
    /// Off-road vehicle, SUV.
    Jeep = 4,
    /// Lorry with or without its trailer.
    Truck = 5,
    /// Van, minibus, ambulance.
    Van = 6,
    /// Person on foot, and what is pushed or sat in.
    Human = 7,
    /// Building.
    Building = 8,
    /// Carriageway with its markings.
    Road = 9,
    /// Movable or fixed barrier.
    Barrier = 10,
    /// Ground that is neither road nor sidewalk.
    Ground = 11,
    /// Bicycle and its rider.
    CycleRider = 12,
    /// Construction vehicle.
    Construction = 13,
    /// Bush or hedge.
    Bush = 14,
    /// Tree.
    Tree = 15,
    /// Motorcycle and its rider.
    MotorcycleRider = 16,
    /// Traffic cone.
    TrafficCone = 17,
    /// Traffic sign, pole, lamp, signal.
    TrafficSign = 18,
    /// Sidewalk.
    Sidewalk = 19,
}

/// The paper's 13 classes; the discriminant is the id.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
#[allow(missing_docs)] // the names are the definition
pub enum Class13 {
    Void = 0,
    Car = 1,
    Bus = 2,
    Truck = 3,
    Person = 4,
    Rider = 5,
    Road = 6,
    Sidewalk = 7,
    Building = 8,
    TrafficPole = 9,
    Vegetation = 10,
    Terrain = 11,
    Sky = 12,
}

/// One class in every numbering that is written or read.
#[derive(Clone, Copy, Debug)]
pub struct ClassRow {
    /// The class.
    pub class: Class,
    /// Name in manifests and tables.
    pub name: &'static str,
    /// Countable, with an instance id.
    pub thing: bool,
    /// Colour in pictures of labels, sRGB.
    pub rgb: [u8; 3],
    /// In the paper's 13 classes.
    pub class13: Class13,
    /// Cityscapes `id`.
    pub cityscapes_id: u8,
    /// Cityscapes `trainId`, which KITTI-STEP shares; 255 is ignored.
    pub train_id: u8,
    /// COCO panoptic category; 0 where COCO has none.
    pub coco_id: u8,
    /// CamVid in its 12-class form; 11 is unlabelled.
    pub camvid_id: u8,
}

#[rustfmt::skip]
/// All classes, in the order of their ids.
pub const CLASSES: [ClassRow; 20] = [
    row(Class::Void,            "void",             false, [0, 0, 0],       Class13::Void,        0,  255, 0,   11),
    row(Class::Sky,             "sky",              false, [70, 130, 180],  Class13::Sky,         23, 10,  187, 0),
    row(Class::Car,             "car",              true,  [0, 0, 142],     Class13::Car,         26, 13,  3,   8),
    row(Class::Bus,             "bus",              true,  [0, 60, 100],    Class13::Bus,         28, 15,  6,   8),
    row(Class::Jeep,            "jeep",             true,  [40, 40, 200],   Class13::Car,         26, 13,  3,   8),
    row(Class::Truck,           "truck",            true,  [0, 0, 70],      Class13::Truck,       27, 14,  8,   8),
    row(Class::Van,             "van",              true,  [60, 90, 230],   Class13::Car,         26, 13,  3,   8),
    row(Class::Human,           "human",            true,  [220, 20, 60],   Class13::Person,      24, 11,  1,   9),
    row(Class::Building,        "building",         true,  [70, 70, 70],    Class13::Building,    11, 2,   197, 1),
    row(Class::Road,            "road",             false, [128, 64, 128],  Class13::Road,        7,  0,   149, 3),
    row(Class::Barrier,         "barrier",          true,  [190, 153, 153], Class13::Void,        14, 255, 185, 7),
    row(Class::Ground,          "ground",           false, [152, 251, 152], Class13::Terrain,     22, 9,   193, 5),
    row(Class::CycleRider,      "cycle_rider",      true,  [255, 0, 0],     Class13::Rider,       25, 12,  2,   10),
    row(Class::Construction,    "construction",     true,  [230, 150, 0],   Class13::Truck,       27, 14,  8,   8),
    row(Class::Bush,            "bush",             true,  [107, 142, 35],  Class13::Vegetation,  21, 8,   184, 5),
    row(Class::Tree,            "tree",             true,  [50, 105, 30],   Class13::Vegetation,  21, 8,   184, 5),
    row(Class::MotorcycleRider, "motorcycle_rider", true,  [200, 40, 110],  Class13::Rider,       25, 12,  4,   11),
    row(Class::TrafficCone,     "traffic_cone",     true,  [250, 110, 20],  Class13::TrafficPole, 17, 5,   0,   11),
    row(Class::TrafficSign,     "traffic_sign",     true,  [220, 220, 0],   Class13::TrafficPole, 20, 7,   13,  6),
    row(Class::Sidewalk,        "sidewalk",         false, [244, 35, 232],  Class13::Sidewalk,    8,  1,   191, 4),
];

#[allow(clippy::too_many_arguments)] // one row of the table above
const fn row(
    class: Class,
    name: &'static str,
    thing: bool,
    rgb: [u8; 3],
    class13: Class13,
    cityscapes_id: u8,
    train_id: u8,
    coco_id: u8,
    camvid_id: u8,
) -> ClassRow {
    ClassRow { class, name, thing, rgb, class13, cityscapes_id, train_id, coco_id, camvid_id }
}

impl Class {
    /// The class's line in the table.
    pub fn row(self) -> &'static ClassRow {
        &CLASSES[self as usize]
    }

    /// The id in `class.png`.
    pub fn id(self) -> u8 {
        self as u8
    }

    /// The class of an id; `None` from 20 on.
    pub fn from_id(id: u8) -> Option<Self> {
        CLASSES.get(usize::from(id)).map(|row| row.class)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_class_stands_in_the_row_of_its_id() {
        for (i, row) in CLASSES.iter().enumerate() {
            assert_eq!(usize::from(row.class.id()), i);
            assert_eq!(Class::from_id(row.class.id()), Some(row.class));
        }
        assert_eq!(Class::from_id(20), None);
    }
}
