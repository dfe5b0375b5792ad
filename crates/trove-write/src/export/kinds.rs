//! What datasets call the kinds of road users: `kinds.tsv`, a line a kind; what is not in it has no name anywhere.

use std::collections::{BTreeSet, HashMap};
use std::sync::LazyLock;

use trove_format::ObjectRow;
use trove_model::{Class, Kind};

const TABLE: &str = include_str!("kinds.tsv");

/// Names by kind.
static KINDS: LazyLock<HashMap<Kind, [&str; 2]>> = LazyLock::new(|| {
    let row = |line: &'static str| {
        let mut fields = line.split('\t');
        let kind = fields.next().and_then(Kind::from_name).unwrap_or_else(|| panic!("kinds.tsv: no kind in {line:?}"));
        (kind, [(); 2].map(|()| fields.next().unwrap_or_default()))
    };
    TABLE.lines().skip(1).map(row).collect()
});

/// KITTI's type of an object; `None` for what KITTI does not label.
pub(crate) fn kitti(object: &ObjectRow) -> Option<&'static str> {
    // A van and a minibus are cars elsewhere.
    match (object.kind, object.class) {
        (Kind::Car, Class::Van) => Some("Van"),
        (kind, _) => named(kind, 0),
    }
}

/// nuScenes' category of a kind; `None` for what nuScenes does not annotate.
pub(crate) fn nuscenes(kind: Kind) -> Option<&'static str> {
    named(kind, 1)
}

/// nuScenes' categories, each once.
pub(crate) fn nuscenes_categories() -> BTreeSet<&'static str> {
    KINDS.values().map(|names| names[1]).filter(|name| !name.is_empty()).collect()
}

fn named(kind: Kind, column: usize) -> Option<&'static str> {
    KINDS.get(&kind).map(|names| names[column]).filter(|name| !name.is_empty())
}
