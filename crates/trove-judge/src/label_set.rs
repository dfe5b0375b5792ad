//! Which numbers a dataset's label pictures hold, and which of them count.

use trove_model::{CLASSES, ClassRow, LabelRow, label_rows};

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

/// What many write where there is no label.
const NOTHING: u8 = 255;

impl LabelSet {
    /// Every name that [`LabelSet::named`] knows.
    pub const NAMES: [&str; 5] = ["trove13", "trove20", "cityscapes", "cityscapes-train", "camvid"];

    /// The set of a name; `None` for one that is not in [`LabelSet::NAMES`].
    pub fn named(name: &str) -> Option<Self> {
        let name = Self::NAMES.into_iter().find(|known| *known == name)?;
        let (table, by_train_id) = name.strip_suffix("-train").map_or((name, false), |table| (table, true));
        let rows = label_rows(table)?;
        let id = |row: &LabelRow| if by_train_id { row.train_id } else { Some(row.id) };
        let counted = rows.iter().filter(|row| row.train_id.is_some());
        let classes = counted.filter_map(|row| Some(NamedId { id: id(row)?, name: row.name, thing: row.thing }));
        let others = rows.iter().filter(|row| row.train_id.is_none()).filter_map(id);
        Some(Self { name, classes: classes.collect(), ignored: others.chain([NOTHING]).collect() })
    }

    /// The number that one of our classes has in this set.
    pub(crate) fn number(&self, row: &ClassRow) -> u8 {
        match self.name {
            "trove13" => row.class13,
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
