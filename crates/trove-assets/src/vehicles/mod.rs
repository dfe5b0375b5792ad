//! Cars, lorries, buses and machines.

mod body;
mod buses;
mod cabin;
mod car;
mod cars;
mod decal;
mod extras;
mod face;
mod faces;
mod finish;
mod fittings;
mod grid;
mod hull;
mod machines;
mod models;
mod palette;
mod plate;
mod tall_models;
mod trucks;
mod wheel;
mod workshop;

use trove_model::Asset;

pub(crate) use decal::{PLATE_M, number_plate, on_back};
pub(crate) use hull::rect;
pub(crate) use wheel::upright;

/// Every model of this family.
pub(crate) fn assets() -> Vec<Asset> {
    let families: [fn() -> Vec<Asset>; 4] = [cars::assets, trucks::assets, buses::assets, machines::assets];
    families.iter().flat_map(|family| family()).collect()
}
