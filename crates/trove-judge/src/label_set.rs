//! Which numbers a dataset's label pictures hold, and which of them count.

use trove_model::{CLASSES, Class13, ClassRow};

/// A number and its class.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedId {
    /// The number in pictures.
    pub id: u8,
    /// The class's name in the dataset.
    pub name: &'static str,
    /// Whether it is countable; segments of others are one a picture.
    pub thing: bool,
}

/// The numbering of a dataset's classes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LabelSet {
    /// The name that it is asked for by (`cityscapes`).
    pub name: &'static str,
    /// Classes that count, in the order of their ids.
    pub classes: Vec<NamedId>,
    /// Numbers that may be in pictures and do not count.
    pub ignored: Vec<u8>,
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

/// Cityscapes' other classes: unlabeled to ground, parking, rail track, guard rail to tunnel, polegroup, caravan, trailer.
const CITYSCAPES_IGNORED: [u8; 15] = [0, 1, 2, 3, 4, 5, 6, 9, 10, 14, 15, 16, 18, 29, 30];
/// The first of Cityscapes' classes with instances (person).
const CITYSCAPES_THINGS_FROM: u8 = 24;
/// What many write where there is no label.
const NOTHING: u8 = 255;

/// CamVid in the 11 classes of SegNet (Badrinarayanan et al. 2017).
const CAMVID: [&str; 11] =
    ["sky", "building", "pole", "road", "pavement", "tree", "sign", "fence", "car", "pedestrian", "bicyclist"];

impl LabelSet {
    /// Every name that [`LabelSet::named`] knows.
    pub const NAMES: [&str; 5] = ["trove13", "trove20", "cityscapes", "cityscapes-train", "camvid"];

    /// The set of a name; `None` for one that is not in [`LabelSet::NAMES`].
    pub fn named(name: &str) -> Option<Self> {
        let class = |id: u8, name: &'static str, thing: bool| NamedId { id, name, thing };
        let cityscapes = |number: fn(&(u8, u8, &'static str)) -> u8| {
            CITYSCAPES.iter().map(|row| class(number(row), row.2, row.0 >= CITYSCAPES_THINGS_FROM)).collect()
        };
        let name = Self::NAMES.into_iter().find(|known| *known == name)?;
        let (classes, ignored): (Vec<NamedId>, Vec<u8>) = match name {
            "trove13" => (CLASSES_13.iter().map(|(c, name, thing)| class(*c as u8, name, *thing)).collect(), vec![0]),
            "trove20" => {
                (CLASSES.iter().skip(1).map(|row| class(row.class.id(), row.name, row.thing)).collect(), vec![0])
            }
            "cityscapes" => (cityscapes(|row| row.0), CITYSCAPES_IGNORED.to_vec()),
            "cityscapes-train" => (cityscapes(|row| row.1), Vec::new()),
            _ => ((0..).zip(CAMVID).map(|(id, name)| class(id, name, id >= 8)).collect(), vec![11]),
        };
        Some(Self { name, classes, ignored: ignored.into_iter().chain([NOTHING]).collect() })
    }

    /// The number that one of our classes has in this set.
    pub(crate) fn number(&self, row: &ClassRow) -> u8 {
        match self.name {
            "trove13" => row.class13 as u8,
            "trove20" => row.class.id(),
            "cityscapes" => row.cityscapes_id,
            "cityscapes-train" => row.train_id,
            _ => row.camvid_id,
        }
    }

    /// For each of our 20 classes its place among the set's; `None` for those that the set ignores.
    pub fn of_ours(&self) -> [Option<u8>; 20] {
        let index = self.index();
        std::array::from_fn(|i| index[usize::from(self.number(&CLASSES[i]))])
    }

    /// The place of the first number that is neither a class nor ignored.
    pub(crate) fn unknown(&self, ids: &[u8]) -> Option<usize> {
        let mut known = [false; 256];
        self.classes.iter().map(|class| class.id).chain(self.ignored.iter().copied()).for_each(|id| {
            known[usize::from(id)] = true;
        });
        ids.iter().position(|id| !known[usize::from(*id)])
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

/// The paper's classes but void, and which are countable.
const CLASSES_13: [(Class13, &str, bool); 12] = [
    (Class13::Car, "car", true),
    (Class13::Bus, "bus", true),
    (Class13::Truck, "truck", true),
    (Class13::Person, "person", true),
    (Class13::Rider, "rider", true),
    (Class13::Road, "road", false),
    (Class13::Sidewalk, "sidewalk", false),
    (Class13::Building, "building", false),
    (Class13::TrafficPole, "traffic_pole", false),
    (Class13::Vegetation, "vegetation", false),
    (Class13::Terrain, "terrain", false),
    (Class13::Sky, "sky", false),
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

    #[test]
    fn our_classes_have_known_numbers_everywhere() {
        for set in LabelSet::NAMES.map(|name| LabelSet::named(name).unwrap()) {
            let numbers: Vec<u8> = CLASSES.iter().map(|row| set.number(row)).collect();
            assert_eq!(set.unknown(&numbers), None, "{}", set.name);
            assert!(set.classes.iter().all(|class| !set.ignored.contains(&class.id)));
            assert_eq!(set.unknown(&[numbers[1], 200]), Some(1));
        }
    }
}
