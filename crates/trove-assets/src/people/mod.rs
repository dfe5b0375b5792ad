//! People on foot, with what they push, ride or sit in, and a dog.

use trove_model::Asset;

/// Every model of this family.
pub(crate) fn assets() -> Vec<Asset> {
    Vec::new()
}
