//! Label sets as tables: a line a class, fields apart by tabs, the first line names the columns.

/// Every label set that has a table.
pub const LABEL_TABLES: [&str; 4] = ["trove20", "trove13", "cityscapes", "camvid"];
/// What stands under `train_id` for a class that does not count.
pub(super) const IGNORED: u8 = 255;

/// A class of a label set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LabelRow {
    /// The number in pictures.
    pub id: u8,
    /// The number among the classes that count; `None` for one that does not.
    pub train_id: Option<u8>,
    /// The class's name in its set.
    pub name: &'static str,
    /// Whether it is countable.
    pub thing: bool,
}

/// The text of a label set's table; `None` for a name that is not in [`LABEL_TABLES`].
///
/// Columns that all have: `id`, `train_id` (255: does not count), `name`, `thing` (yes or no). Columns named after other
/// label sets hold the name of the class there.
pub fn label_table(set: &str) -> Option<&'static str> {
    Some(match set {
        "trove20" => include_str!("trove20.tsv"),
        "trove13" => include_str!("trove13.tsv"),
        "cityscapes" => include_str!("cityscapes.tsv"),
        "camvid" => include_str!("camvid.tsv"),
        _ => return None,
    })
}

/// The classes of a label set in the order of their ids; `None` for a name that is not in [`LABEL_TABLES`].
pub fn label_rows(set: &str) -> Option<Vec<LabelRow>> {
    label_table(set).map(|text| Table::new(text).label_rows())
}

/// A table's fields; it is part of the program, so that a mistake in it is one in the program.
pub(super) struct Table {
    columns: Vec<&'static str>,
    rows: Vec<Vec<&'static str>>,
}

impl Table {
    pub(super) fn new(text: &'static str) -> Self {
        let mut lines = text.lines().map(|line| line.split('\t').collect::<Vec<_>>());
        let columns = lines.next().unwrap_or_default();
        Self { columns, rows: lines.collect() }
    }

    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    pub(super) fn text(&self, row: usize, column: &str) -> &'static str {
        let place = self.columns.iter().position(|name| *name == column);
        let field = place.and_then(|place| self.rows.get(row)?.get(place));
        field.unwrap_or_else(|| panic!("table of {}: row {row} has no field {column}", self.columns.join(", ")))
    }

    pub(super) fn number(&self, row: usize, column: &str) -> u8 {
        let text = self.text(row, column);
        text.parse().unwrap_or_else(|_| panic!("row {row}, {column}: expected 0 to 255, found {text}"))
    }

    pub(super) fn label_rows(&self) -> Vec<LabelRow> {
        let row = |i| LabelRow {
            id: self.number(i, "id"),
            train_id: Some(self.number(i, "train_id")).filter(|id| *id != IGNORED),
            name: self.text(i, "name"),
            thing: self.text(i, "thing") == "yes",
        };
        (0..self.len()).map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_has_its_ids_and_names_once_and_trains_on_all_that_count() {
        for (set, rows, counted) in
            [("trove20", 20, 19), ("trove13", 13, 12), ("cityscapes", 34, 19), ("camvid", 12, 11)]
        {
            let table = Table::new(label_table(set).unwrap());
            assert!(table.rows.iter().all(|row| row.len() == table.columns.len()), "{set}");
            for i in 0..table.len() {
                assert!(["yes", "no"].contains(&table.text(i, "thing")), "{set} {i}");
            }
            let labels = table.label_rows();
            assert_eq!(labels.iter().map(|l| l.id).collect::<Vec<_>>(), (0..rows).collect::<Vec<_>>(), "{set}");
            let mut trained: Vec<u8> = labels.iter().filter_map(|l| l.train_id).collect();
            trained.sort_unstable();
            assert_eq!(trained, (0..counted).collect::<Vec<_>>(), "{set}");
            let mut names: Vec<&str> = labels.iter().map(|l| l.name).collect();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), labels.len(), "{set}");
        }
        assert!(LABEL_TABLES.iter().all(|set| label_rows(set).is_some()) && label_rows("pascal").is_none());
    }

    #[test]
    fn columns_that_are_named_after_a_set_hold_names_of_its_classes() {
        for set in LABEL_TABLES {
            let table = Table::new(label_table(set).unwrap());
            for other in table.columns.iter().filter(|column| LABEL_TABLES.contains(column)) {
                let known = label_rows(other).unwrap();
                for i in 0..table.len() {
                    let name = table.text(i, other);
                    assert!(known.iter().any(|label| label.name == name), "{set}, row {i}: {other} has no {name}");
                }
            }
        }
    }
}
