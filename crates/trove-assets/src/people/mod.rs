//! People on foot, with what they push, ride or sit in, and a dog.

mod adults;
mod dog;
mod figure;
mod mobility;
mod wardrobe;

use trove_model::Asset;

pub(crate) use figure::{Figure, Physique, Pose};
pub(crate) use wardrobe::{Hair, Leg, Outfit, Sleeve, Wardrobe};

/// Every model of this family.
pub(crate) fn assets() -> Vec<Asset> {
    let families: [fn() -> Vec<Asset>; 3] = [adults::assets, mobility::assets, dog::assets];
    families.iter().flat_map(|family| family()).collect()
}
