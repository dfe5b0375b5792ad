//! Cars, lorries, buses and machines.

mod body;
mod car;
mod cars;
mod extras;
mod palette;
mod truck;
mod trucks;
mod wheel;

use trove_model::Asset;

pub(crate) use wheel::upright;

/// Every model of this family.
pub(crate) fn assets() -> Vec<Asset> {
    let families: [fn() -> Vec<Asset>; 2] = [cars::assets, trucks::assets];
    families.iter().flat_map(|family| family()).collect()
}
