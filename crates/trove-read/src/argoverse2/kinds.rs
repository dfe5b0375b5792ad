//! Argoverse 2's names for things, in ours.

use trove_model::Kind;

/// Category and kind, a line each.
const CATEGORIES: &str = include_str!("categories.tsv");

/// The fields of each line of one of this module's tables.
pub(super) fn rows(table: &str) -> impl Iterator<Item = Vec<&str>> {
    table.lines().filter(|line| !line.starts_with('#')).map(|line| line.split('\t').collect())
}

/// What a category is; `None` for a name that is not Argoverse 2's.
pub(super) fn kind_of_category(category: &str) -> Option<Kind> {
    rows(CATEGORIES).find(|row| row[0] == category).and_then(|row| Kind::from_name(row[1]))
}

/// What a rider's category rides; `None` for what is no rider.
pub(super) fn mount_of_rider(category: &str) -> Option<&'static str> {
    match category {
        "BICYCLIST" => Some("BICYCLE"),
        "MOTORCYCLIST" => Some("MOTORCYCLE"),
        "WHEELED_RIDER" => Some("WHEELED_DEVICE"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_category_has_a_kind_and_other_names_have_none() {
        let names: Vec<_> = rows(CATEGORIES).map(|row| row[0]).collect();
        // Thirty, one of which the guide and the constants spell differently.
        assert!(names.len() == 31 && names.is_sorted());
        assert!(names.iter().all(|name| kind_of_category(name).is_some()));
        assert_eq!(kind_of_category("BOX_TRUCK"), Some(Kind::Truck));
        assert_eq!(kind_of_category("HOVERCRAFT"), None);
        assert!(names.iter().filter_map(|name| mount_of_rider(name)).all(|mount| names.contains(&mount)));
    }
}
