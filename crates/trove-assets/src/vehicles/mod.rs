//! Cars, auto-rickshaws, lorries, buses and machines.
//!
//! All are put together in a [`workshop::Workshop`], which knows the [`slots::Slots`] that vehicles are made of, from
//! parts that are shared: wheels, hulls, plates, what is written on them. Cars are told by plans in data files.

mod buses;
mod cars;
mod coverings;
mod decal;
mod hull;
mod machines;
mod plate;
mod rickshaw;
mod slots;
mod trucks;
mod wheel;
mod workshop;

use trove_model::Asset;

pub(crate) use cars::{CarPlan, assets as cars};
pub(crate) use decal::on_back;
pub(crate) use plate::{PLATE_M, any as number_plate};

/// Every model of this family; cars as these plans tell.
pub(crate) fn assets(cars: &[CarPlan]) -> Vec<Asset> {
    [cars::assets(cars), rickshaw::assets(), trucks::assets(), buses::assets(), machines::assets()].concat()
}
