//! Where models are met that are not met everywhere, as `plans/countries.toml` says it.

use std::collections::BTreeMap;
use std::sync::LazyLock;

static BY_TAG: LazyLock<BTreeMap<String, Vec<String>>> = LazyLock::new(|| {
    toml::from_str(include_str!("../plans/countries.toml")).expect("the library is built of it in every test")
});

/// Codes of the countries in which models with a tag are met.
pub(crate) fn met_in(tag: &str) -> Vec<String> {
    BY_TAG[tag].clone()
}
