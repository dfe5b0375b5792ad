//! The class maps that come with the program, out of its tables.

use std::num::NonZero;

use super::map::{ClassMap, ClassMapEntry, InstanceCoding, OURS, PAPER};
use crate::class::{IGNORED, Table};
use crate::{Class, Kind, Role, label_table};

/// Waymo's own tools write this.
const WAYMO_DIVISOR: NonZero<u16> = NonZero::new(1000).unwrap();
/// Which kinds go elsewhere than their class does, by map.
const KINDS: &str = include_str!("kinds.tsv");
/// Which parts of objects go elsewhere than the objects do, by map.
const PARTS: &str = include_str!("parts.tsv");

/// Where a map stands.
struct Source {
    /// The table of its classes.
    table: &'static str,
    /// The column of `trove20.tsv`, `kinds.tsv` and `parts.tsv` with the names of its classes, or of a finer map's that it is part of.
    column: &'static str,
    /// Pictures hold training ids.
    by_train_id: bool,
    /// The number where nothing is labelled.
    unlabelled: u8,
    instances: InstanceCoding,
}

impl ClassMap {
    /// Every name that [`ClassMap::named`] knows.
    pub const NAMES: [&str; 11] = [
        PAPER,
        OURS,
        "cityscapes",
        "cityscapes-train",
        "kitti-step",
        "coco",
        "camvid",
        "idd-lite",
        "waymo",
        "occ3d",
        "asprs",
    ];

    /// A built-in map: `paper13` (also `trove13`), the paper's 13 classes; `trove20`, those of `class.png`; or a
    /// dataset's. `None` for a name that is not in [`ClassMap::NAMES`].
    #[allow(clippy::missing_panics_doc)] // a test makes every built-in map
    pub fn named(name: &str) -> Option<Self> {
        let name = if name == "trove13" { PAPER } else { name };
        let source = source(name)?;
        let map = Self::new(name, source.unlabelled, source.instances, entries(&source));
        Some(map.expect("a test makes every built-in map"))
    }
}

fn source(name: &str) -> Option<Source> {
    let of =
        |table| Source { table, column: table, by_train_id: false, unlabelled: 0, instances: InstanceCoding::Beside };
    Some(match name {
        OURS => Source { column: "name", ..of("trove20") },
        PAPER => of("trove13"),
        "cityscapes" => of("cityscapes"),
        "cityscapes-train" => Source { by_train_id: true, unlabelled: IGNORED, ..of("cityscapes") },
        "kitti-step" => Source {
            column: "cityscapes",
            unlabelled: IGNORED,
            instances: InstanceCoding::GreenBlue,
            ..of("kitti-step")
        },
        "coco" => of("coco"),
        "camvid" => Source { unlabelled: 11, ..of("camvid") },
        "idd-lite" => Source { unlabelled: IGNORED, ..of("idd-lite") },
        "occ3d" => Source { unlabelled: 17, ..of("occ3d") },
        "asprs" => of("asprs"),
        "waymo" => Source { instances: InstanceCoding::Divisor(WAYMO_DIVISOR), ..of("waymo") },
        _ => return None,
    })
}

fn entries(source: &Source) -> Vec<ClassMapEntry> {
    let table = |set| Table::new(label_table(set).expect("a set that has a table"));
    let (classes, ours, paper, kinds) = (table(source.table), table("trove20"), table("trove13"), Table::new(KINDS));
    let row = |table: &Table, name: &str| (0..table.len()).find(|row| table.text(*row, "name") == name);
    let id = |row| classes.number(row, if source.by_train_id { "train_id" } else { "id" });
    // A class that only a finer map has is unlabelled here.
    let belongs =
        |table: &Table, i, to| row(&classes, table.text(i, source.column)).map_or(source.unlabelled, id) == to;
    let rows = |table: &Table| if table.has(source.column) { 0..table.len() } else { 0..0 };
    let (parts, of_kinds) = (Table::new(PARTS), rows(&kinds));
    // A part without a name there has no number of its own.
    let of_parts = rows(&parts).filter(|row| !parts.text(*row, source.column).is_empty());
    let entry = |i: usize| ClassMapEntry {
        id: id(i),
        name: classes.text(i, "name").to_owned(),
        thing: classes.text(i, "thing") == "yes",
        ignored: classes.number(i, "train_id") == IGNORED,
        rgb: classes.rgb(i),
        ours: Class::ALL.into_iter().filter(|class| belongs(&ours, usize::from(class.id()), id(i))).collect(),
        kinds: (of_kinds.clone().filter(|row| belongs(&kinds, *row, id(i))))
            .map(|row| Kind::from_name(kinds.text(row, "kind")).expect("a known kind"))
            .collect(),
        parts: (of_parts.clone().filter(|row| belongs(&parts, *row, id(i))))
            .map(|row| Role::from_name(parts.text(row, "part")).expect("a known part"))
            .collect(),
        paper13: match source.table {
            "trove13" => Some(id(i)),
            _ if classes.has("trove13") => row(&paper, classes.text(i, "trove13")).map(|row| paper.number(row, "id")),
            _ => None,
        },
    };
    let mut entries: Vec<ClassMapEntry> = (0..classes.len()).map(entry).collect();
    // By training ids, all that does not count is one.
    entries.sort_by_key(|entry| entry.id);
    entries.dedup_by_key(|entry| entry.id);
    entries
}
