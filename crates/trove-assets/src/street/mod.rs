//! Street furniture.

use trove_model::Asset;

/// Every model of this family.
pub(crate) fn assets() -> Vec<Asset> {
    Vec::new()
}
