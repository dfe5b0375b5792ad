//! Cars, lorries, buses and machines.

mod body;
mod car;
mod cars;
mod extras;
mod palette;
mod wheel;

use trove_model::Asset;

pub(crate) use wheel::upright;

/// Every model of this family.
pub(crate) fn assets() -> Vec<Asset> {
    cars::assets()
}
