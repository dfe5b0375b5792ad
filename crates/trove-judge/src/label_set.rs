//! Which numbers a dataset's label pictures hold, and which of them count.

use trove_model::{CLASSES, Class13};

/// A number and its class.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedId {
    /// The number in pictures.
    pub id: u8,
    /// The class's name in the dataset.
    pub name: String,
}

/// The numbering of a dataset's classes; numbers that are not in it are ignored.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LabelSet {
    /// The name that it is asked for by (`cityscapes`).
    pub name: &'static str,
    /// Classes that count, in the order of their ids.
    pub classes: Vec<NamedId>,
}

/// Cityscapes' 19 evaluated classes as (id, trainId, name), from its labels table.
const CITYSCAPES: [(u8, u8, &str); 19] = [
    (7, 0, "road"),
    (8, 1, "sidewalk"),
    (11, 2, "building"),
    (12, 3, "wall"),
    (13, 4, "fence"),
    (17, 5, "pole"),
    (19, 6, "traffic light"),
    (20, 7, "traffic sign"),
    (21, 8, "vegetation"),
    (22, 9, "terrain"),
    (23, 10, "sky"),
    (24, 11, "person"),
    (25, 12, "rider"),
    (26, 13, "car"),
    (27, 14, "truck"),
    (28, 15, "bus"),
    (31, 16, "train"),
    (32, 17, "motorcycle"),
    (33, 18, "bicycle"),
];

/// CamVid in the 11 classes of SegNet (Badrinarayanan et al. 2017).
const CAMVID: [&str; 11] =
    ["sky", "building", "pole", "road", "pavement", "tree", "sign", "fence", "car", "pedestrian", "bicyclist"];

impl LabelSet {
    /// Every name that [`LabelSet::named`] knows.
    pub const NAMES: [&str; 5] = ["trove13", "trove20", "cityscapes", "cityscapes-train", "camvid"];

    /// The set of a name; `None` for one that is not in [`LabelSet::NAMES`].
    pub fn named(name: &str) -> Option<Self> {
        let class = |id: u8, name: &str| NamedId { id, name: name.into() };
        let name = Self::NAMES.into_iter().find(|known| *known == name)?;
        let classes = match name {
            "trove13" => CLASSES_13.iter().map(|(c, name)| class(*c as u8, name)).collect(),
            "trove20" => CLASSES.iter().skip(1).map(|row| class(row.class.id(), row.name)).collect(),
            "cityscapes" => CITYSCAPES.iter().map(|(id, _, name)| class(*id, name)).collect(),
            "cityscapes-train" => CITYSCAPES.iter().map(|(_, id, name)| class(*id, name)).collect(),
            _ => (0..).zip(CAMVID).map(|(id, name)| class(id, name)).collect(),
        };
        Some(Self { name, classes })
    }

    /// For every number its place among the classes; `None` for those that are ignored.
    pub(crate) fn index(&self) -> [Option<u8>; 256] {
        let mut index = [None; 256];
        for (i, class) in (0..).zip(&self.classes) {
            index[usize::from(class.id)] = Some(i);
        }
        index
    }
}

/// The paper's classes but void.
const CLASSES_13: [(Class13, &str); 12] = [
    (Class13::Car, "car"),
    (Class13::Bus, "bus"),
    (Class13::Truck, "truck"),
    (Class13::Person, "person"),
    (Class13::Rider, "rider"),
    (Class13::Road, "road"),
    (Class13::Sidewalk, "sidewalk"),
    (Class13::Building, "building"),
    (Class13::TrafficPole, "traffic_pole"),
    (Class13::Vegetation, "vegetation"),
    (Class13::Terrain, "terrain"),
    (Class13::Sky, "sky"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_set_has_its_classes_once_and_void_in_none() {
        for (name, count) in LabelSet::NAMES.into_iter().zip([12, 19, 19, 19, 11]) {
            let set = LabelSet::named(name).unwrap();
            assert_eq!((set.name, set.classes.len()), (name, count));
            assert_eq!(set.index().iter().flatten().count(), count);
            assert!(set.classes.is_sorted_by(|a, b| a.id < b.id));
        }
        assert!(LabelSet::named("trove13").unwrap().index()[0].is_none());
        assert_eq!(LabelSet::named("pascal"), None);
    }
}
