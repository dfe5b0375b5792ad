//! Class maps: the classes of a dataset's label pictures, and where our 20 belong among them.

use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZero;

use crate::{Class, Kind, Role};

/// The map of `class.png`.
pub(super) const OURS: &str = "trove20";
/// The map of the paper's 13 classes.
pub(super) const PAPER: &str = "paper13";

/// The number that most datasets write where nothing is labelled.
const NOTHING: u8 = 255;

/// A numbering of label pictures: its classes, and the number there of each of our 20.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClassMap {
    /// What it is asked for by (`cityscapes`).
    pub name: String,
    /// Every class, ascending by id, also those that do not count.
    pub classes: Vec<MappedClass>,
    /// The number where none of the classes is; it does not count.
    pub unlabelled: u8,
    /// How pictures tell the objects of a class apart.
    pub instances: InstanceCoding,
    /// Number of each of our classes.
    of_ours: [u8; 20],
    /// Number of each kind that goes elsewhere than its class does.
    of_kinds: BTreeMap<Kind, u8>,
    /// Number of each part of objects that goes elsewhere than they do.
    of_parts: BTreeMap<Role, u8>,
}

/// A class of a [`ClassMap`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MappedClass {
    /// The number in pictures.
    pub id: u8,
    /// Its place among the classes that count, from 0; `None` for one that does not count.
    pub train_id: Option<u8>,
    /// The class's name.
    pub name: String,
    /// Whether it is countable; segments of others are one a picture.
    pub thing: bool,
    /// Colour in pictures of labels, sRGB.
    pub rgb: [u8; 3],
    /// The id of the paper's 13 classes that all of it belongs to (0 void); `None` where it is of several, or not known.
    pub paper13: Option<u8>,
}

/// How a picture of labels tells the objects of a class apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum InstanceCoding {
    /// It does not: their numbers are in a picture beside it.
    #[default]
    Beside,
    /// A pixel of 16 bits is the class's number times this, plus the object's.
    Divisor(NonZero<u16>),
    /// Red is the class, green (high byte) and blue are the object.
    GreenBlue,
}

/// A class with what belongs to it, of which a [`ClassMap`] is made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClassMapEntry {
    /// The number in pictures.
    pub id: u8,
    /// The class's name.
    pub name: String,
    /// Whether it is countable.
    pub thing: bool,
    /// Whether it does not count.
    pub ignored: bool,
    /// Colour in pictures of labels, sRGB.
    pub rgb: [u8; 3],
    /// Which of our classes belong to it.
    pub ours: Vec<Class>,
    /// Kinds that belong to it although their class does not.
    pub kinds: Vec<Kind>,
    /// Parts of objects that belong to it, whatever they are part of.
    pub parts: Vec<Role>,
    /// The id of the paper's 13 classes that it belongs to; without it, that of `ours` where they agree.
    pub paper13: Option<u8>,
}

/// Why entries are no class map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClassMapFault {
    /// The name of the class.
    pub class: String,
    /// What should be there.
    pub expected: String,
    /// What is there.
    pub found: String,
}

impl ClassMap {
    /// A map of some classes in any order. Our classes that none of them lists are unlabelled.
    ///
    /// # Errors
    /// Ids or names that are there twice, the number for `unlabelled` among the classes that count, and classes, kinds
    /// and parts of ours that two classes list.
    pub fn new(
        name: &str,
        unlabelled: u8,
        instances: InstanceCoding,
        mut entries: Vec<ClassMapEntry>,
    ) -> Result<Self, ClassMapFault> {
        entries.sort_by_key(|entry| entry.id);
        let (mut ids, mut names) = (BTreeMap::new(), BTreeSet::new());
        let (mut ours, mut of_kinds, mut of_parts) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
        let mut counted = 0..NOTHING;
        let mut classes = Vec::with_capacity(entries.len());
        for entry in &entries {
            let fault = |expected: &str, found: String| {
                Err(ClassMapFault { class: entry.name.clone(), expected: expected.into(), found })
            };
            if let Some(other) = ids.insert(entry.id, &entry.name) {
                return fault("an id of its own", format!("{}, which is that of \"{other}\"", entry.id));
            }
            if !names.insert(&entry.name) {
                return fault("a name of its own", "another class of that name".into());
            }
            if !entry.ignored && entry.id == unlabelled {
                return fault("an id other than that of unlabelled pixels", unlabelled.to_string());
            }
            for class in &entry.ours {
                if ours.insert(*class, entry.id).is_some_and(|other| other != entry.id) {
                    return fault("classes of ours that no other class lists", class.row().name.into());
                }
            }
            for kind in &entry.kinds {
                if of_kinds.insert(*kind, entry.id).is_some_and(|other| other != entry.id) {
                    return fault("kinds that no other class lists", kind.name().into());
                }
            }
            for part in &entry.parts {
                if of_parts.insert(*part, entry.id).is_some_and(|other| other != entry.id) {
                    return fault("parts that no other class lists", part.name().into());
                }
            }
            let of_13: BTreeSet<u8> = entry.ours.iter().map(|class| class.row().class13).collect();
            classes.push(MappedClass {
                id: entry.id,
                train_id: if entry.ignored { None } else { counted.next() },
                name: entry.name.clone(),
                thing: entry.thing,
                rgb: entry.rgb,
                paper13: entry.paper13.or(of_13.first().copied().filter(|_| of_13.len() == 1)),
            });
        }
        let of_ours = Class::ALL.map(|class| ours.get(&class).copied().unwrap_or(unlabelled));
        Ok(Self { name: name.to_owned(), classes, unlabelled, instances, of_ours, of_kinds, of_parts })
    }

    /// The number of one of our classes.
    pub fn id(&self, class: Class) -> u8 {
        self.of_ours[usize::from(class.id())]
    }

    /// The number of an object, whose kind may say more than its class.
    pub fn object_id(&self, class: Class, kind: Kind) -> u8 {
        self.of_kinds.get(&kind).copied().unwrap_or(self.id(class))
    }

    /// The number of a part of something, which may be an object of some kind. What somebody rides is numbered as what
    /// nobody rides where riders have a number of their own.
    pub fn part_id(&self, class: Class, kind: Option<Kind>, part: Option<Role>) -> u8 {
        if let Some(id) = part.and_then(|part| self.of_parts.get(&part)) {
            return *id;
        }
        let ridden = match kind {
            Some(Kind::BicycleWithRider) => Some((Role::Cyclist, Kind::Bicycle)),
            Some(Kind::MotorcycleWithRider) => Some((Role::Motorcyclist, Kind::Motorcycle)),
            _ => None,
        };
        let parted = ridden.filter(|(rider, _)| part.is_some() && self.of_parts.contains_key(rider));
        let kind = parted.map(|(_, cycle)| cycle).or(kind);
        kind.map_or(self.id(class), |kind| self.object_id(class, kind))
    }

    /// Whether a part of some object has a number of its own.
    pub fn knows_parts(&self) -> bool {
        !self.of_parts.is_empty()
    }

    /// The class of a number; `None` for one that has none.
    pub fn class(&self, id: u8) -> Option<&MappedClass> {
        self.classes.binary_search_by_key(&id, |class| class.id).ok().map(|i| &self.classes[i])
    }

    /// The classes that count, in the order of their ids and training ids.
    pub fn counted(&self) -> impl Iterator<Item = &MappedClass> {
        self.classes.iter().filter(|class| class.train_id.is_some())
    }

    /// Numbers that may be in pictures and do not count, ascending.
    pub fn ignored(&self) -> Vec<u8> {
        let classes = self.classes.iter().filter(|class| class.train_id.is_none()).map(|class| class.id);
        let nothing = if self.class(NOTHING).is_some() { self.unlabelled } else { NOTHING };
        let all: BTreeSet<u8> = classes.chain([self.unlabelled, nothing]).collect();
        all.into_iter().collect()
    }

    /// The training id of each number; `None` for those that do not count.
    pub fn train_ids(&self) -> [Option<u8>; 256] {
        let mut found = [None; 256];
        self.classes.iter().for_each(|class| found[usize::from(class.id)] = class.train_id);
        found
    }

    /// The training id of each of our 20 classes; `None` for those that do not count.
    pub fn train_ids_of_ours(&self) -> [Option<u8>; 20] {
        let train_ids = self.train_ids();
        self.of_ours.map(|id| train_ids[usize::from(id)])
    }

    /// What each number of this map is in another; numbers that do not count here are unlabelled there. `None` where that
    /// is not known: it is for a map of the same names, from `trove20` to all, and to `paper13` from those that know
    /// where each of their classes belongs.
    pub fn in_map(&self, other: &Self) -> Option<[u8; 256]> {
        let mut numbers = [other.unlabelled; 256];
        let is_ours = self.name == OURS;
        let same_names = self.counted().map(|class| &class.name).collect::<BTreeSet<_>>()
            == other.counted().map(|class| &class.name).collect();
        for class in self.counted() {
            numbers[usize::from(class.id)] = if is_ours {
                other.id(Class::from_id(class.id)?)
            } else if same_names {
                other.counted().find(|known| known.name == class.name)?.id
            } else if other.name == PAPER {
                class.paper13?
            } else {
                return None;
            };
        }
        Some(numbers)
    }
}
