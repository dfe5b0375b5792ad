//! Cars, lorries, buses and machines.

mod body;
mod bus;
mod cabin;
mod car;
mod cars;
mod extras;
mod face;
mod faces;
mod fittings;
mod grid;
mod machine;
mod models;
mod palette;
mod plate;
mod tall_models;
mod truck;
mod trucks;
mod wheel;

use trove_model::Asset;

pub(crate) use wheel::upright;

/// Every model of this family.
pub(crate) fn assets() -> Vec<Asset> {
    let families: [fn() -> Vec<Asset>; 4] = [cars::assets, trucks::assets, bus::assets, machine::assets];
    families.iter().flat_map(|family| family()).collect()
}
