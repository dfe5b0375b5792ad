//! Label sets as tables: a line a class, fields apart by tabs, the first line names the columns.

/// Every label set that has a table.
pub const LABEL_TABLES: [&str; 10] =
    ["trove20", "trove13", "cityscapes", "kitti-step", "coco", "camvid", "idd-lite", "waymo", "occ3d", "asprs"];
/// What stands under `train_id` for a class that does not count.
pub(crate) const IGNORED: u8 = 255;

/// The text of a label set's table; `None` for a name that is not in [`LABEL_TABLES`].
///
/// Columns that all have: `id`, `train_id` (255: does not count), `name`, `thing` (yes or no), `rgb` (sRGB,
/// apart by commas). Columns named after other label sets hold the name of the class there.
pub fn label_table(set: &str) -> Option<&'static str> {
    Some(match set {
        "trove20" => include_str!("trove20.tsv"),
        "trove13" => include_str!("trove13.tsv"),
        "cityscapes" => include_str!("cityscapes.tsv"),
        "kitti-step" => include_str!("kitti-step.tsv"),
        "coco" => include_str!("coco.tsv"),
        "camvid" => include_str!("camvid.tsv"),
        "idd-lite" => include_str!("idd-lite.tsv"),
        "waymo" => include_str!("waymo.tsv"),
        "occ3d" => include_str!("occ3d.tsv"),
        "asprs" => include_str!("asprs.tsv"),
        _ => return None,
    })
}

/// A table's fields; it is part of the program, so that a mistake in it is one in the program.
pub(crate) struct Table {
    columns: Vec<&'static str>,
    rows: Vec<Vec<&'static str>>,
}

impl Table {
    pub(crate) fn new(text: &'static str) -> Self {
        let mut lines = text.lines().map(|line| line.split('\t').collect::<Vec<_>>());
        let columns = lines.next().unwrap_or_default();
        Self { columns, rows: lines.collect() }
    }

    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    pub(crate) fn text(&self, row: usize, column: &str) -> &'static str {
        let place = self.columns.iter().position(|name| *name == column);
        let field = place.and_then(|place| self.rows.get(row)?.get(place));
        field.unwrap_or_else(|| panic!("table of {}: row {row} has no field {column}", self.columns.join(", ")))
    }

    pub(crate) fn number(&self, row: usize, column: &str) -> u8 {
        let text = self.text(row, column);
        text.parse().unwrap_or_else(|_| panic!("row {row}, {column}: expected 0 to 255, found {text}"))
    }

    pub(crate) fn has(&self, column: &str) -> bool {
        self.columns.contains(&column)
    }

    /// The colour under `rgb`.
    pub(crate) fn rgb(&self, row: usize) -> [u8; 3] {
        let mut channels = self.text(row, "rgb").split(',').map(|channel| channel.parse().expect("0 to 255"));
        [(); 3].map(|()| channels.next().expect("three channels"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_has_its_names_once_and_numbers_what_counts_in_the_order_of_its_ids() {
        for (set, rows, counted) in [
            ("trove20", 20, 19),
            ("trove13", 13, 12),
            ("cityscapes", 34, 19),
            ("kitti-step", 20, 19),
            ("coco", 134, 133),
            ("camvid", 12, 11),
            ("idd-lite", 8, 7),
            ("waymo", 29, 27),
            ("occ3d", 18, 17),
        ] {
            let table = Table::new(label_table(set).unwrap());
            assert_eq!(table.len(), rows, "{set}");
            assert!(table.rows.iter().all(|row| row.len() == table.columns.len()), "{set}");
            let all = 0..table.len();
            assert!(all.clone().all(|i| ["yes", "no"].contains(&table.text(i, "thing"))), "{set}");
            assert!(all.clone().all(|i| table.rgb(i).len() == 3), "{set}");
            assert!(all.clone().map(|i| table.number(i, "id")).is_sorted_by(|a, b| a < b), "{set}");
            let trained = all.clone().map(|i| table.number(i, "train_id")).filter(|id| *id != IGNORED);
            assert_eq!(trained.collect::<Vec<_>>(), (0..counted).collect::<Vec<_>>(), "{set}");
            let names: std::collections::BTreeSet<_> = all.map(|i| table.text(i, "name")).collect();
            assert_eq!(names.len(), rows, "{set}");
        }
        assert!(LABEL_TABLES.iter().all(|set| label_table(set).is_some()) && label_table("pascal").is_none());
    }

    #[test]
    fn columns_that_are_named_after_a_set_hold_names_of_its_classes() {
        for set in LABEL_TABLES {
            let table = Table::new(label_table(set).unwrap());
            for other in table.columns.iter().filter(|column| LABEL_TABLES.contains(column)) {
                let known = Table::new(label_table(other).unwrap());
                for i in 0..table.len() {
                    let name = table.text(i, other);
                    let is_known = (0..known.len()).any(|row| known.text(row, "name") == name);
                    assert!(is_known, "{set}, row {i}: {other} has no {name}");
                }
            }
        }
    }
}
