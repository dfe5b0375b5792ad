//! What a pixel can be: the 20 classes, and the same in other datasets' numbers.
//!
//! The numbers stand in the tables beside this file, a label set each, which Python and the documentation read too.

mod table;

use std::sync::LazyLock;

pub(crate) use table::{IGNORED, Table};
pub use table::{LABEL_TABLES, label_table};

/// The paper's 20 classes; the discriminant is the id in `class.png`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
    /// Id among the paper's 13 classes; 0 is void.
    pub class13: u8,
    /// Cityscapes `id`.
    pub cityscapes_id: u8,
    /// Cityscapes `trainId`, which KITTI-STEP shares; 255 is ignored.
    pub train_id: u8,
    /// COCO panoptic category; 0 where COCO has none.
    pub coco_id: u8,
    /// CamVid in its 12-class form; 11 is unlabelled.
    pub camvid_id: u8,
}

/// All classes, in the order of their ids.
pub static CLASSES: LazyLock<[ClassRow; 20]> = LazyLock::new(|| {
    let table = |set| Table::new(label_table(set).expect("a known set"));
    let ours = table("trove20");
    // The number in another set of the class that a column names.
    let number = |i: usize, set, number| {
        let known = table(set);
        let row = (0..known.len()).find(|row| known.text(*row, "name") == ours.text(i, set));
        known.number(row.expect("a name that the other set knows"), number)
    };
    std::array::from_fn(|i| ClassRow {
        class: Class::ALL[i],
        name: ours.text(i, "name"),
        thing: ours.text(i, "thing") == "yes",
        rgb: ours.rgb(i),
        class13: number(i, "trove13", "id"),
        cityscapes_id: number(i, "cityscapes", "id"),
        train_id: number(i, "cityscapes", "train_id"),
        coco_id: number(i, "coco", "id"),
        camvid_id: number(i, "camvid", "id"),
    })
});

impl Class {
    /// All classes, in the order of their ids.
    pub const ALL: [Self; 20] = [
        Self::Void,
        Self::Sky,
        Self::Car,
        Self::Bus,
        Self::Jeep,
        Self::Truck,
        Self::Van,
        Self::Human,
        Self::Building,
        Self::Road,
        Self::Barrier,
        Self::Ground,
        Self::CycleRider,
        Self::Construction,
        Self::Bush,
        Self::Tree,
        Self::MotorcycleRider,
        Self::TrafficCone,
        Self::TrafficSign,
        Self::Sidewalk,
    ];

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
        Self::ALL.get(usize::from(id)).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_class_stands_in_the_row_of_its_id_under_its_name() {
        for (i, row) in CLASSES.iter().enumerate() {
            assert_eq!(usize::from(row.class.id()), i);
            assert_eq!(Class::from_id(row.class.id()), Some(row.class));
            assert_eq!(row.name.replace('_', ""), format!("{:?}", row.class).to_lowercase());
        }
        assert_eq!(Class::from_id(20), None);
    }

    #[test]
    fn the_thirteen_classes_are_those_of_the_contract() {
        // Written down from the paper's list, not from the table.
        let thirteen: [&[Class]; 13] = [
            &[Class::Void, Class::Barrier],
            &[Class::Car, Class::Jeep, Class::Van],
            &[Class::Bus],
            &[Class::Truck, Class::Construction],
            &[Class::Human],
            &[Class::CycleRider, Class::MotorcycleRider],
            &[Class::Road],
            &[Class::Sidewalk],
            &[Class::Building],
            &[Class::TrafficCone, Class::TrafficSign],
            &[Class::Bush, Class::Tree],
            &[Class::Ground],
            &[Class::Sky],
        ];
        assert_eq!(thirteen.iter().map(|of| of.len()).sum::<usize>(), 20);
        for (id, of) in thirteen.iter().enumerate() {
            for class in *of {
                assert_eq!(usize::from(class.row().class13), id, "{class:?}");
            }
        }
    }

    #[test]
    fn classes_have_their_numbers_in_other_sets() {
        let numbers = |class: Class| {
            let row = class.row();
            [row.class13, row.cityscapes_id, row.train_id, row.coco_id, row.camvid_id]
        };
        for (class, expected) in [
            (Class::Void, [0, 0, 255, 0, 11]),
            (Class::Jeep, [1, 26, 13, 3, 8]),
            (Class::Barrier, [0, 14, 255, 185, 7]),
            (Class::MotorcycleRider, [5, 25, 12, 4, 11]),
            (Class::Sidewalk, [7, 8, 1, 191, 4]),
        ] {
            assert_eq!(numbers(class), expected, "{class:?}");
        }
    }
}
