//! People on foot, with what they push, ride or sit in, and a dog.

mod adults;
mod figure;
mod wardrobe;

use trove_model::Asset;

pub(crate) use figure::{Figure, Physique, Pose};
pub(crate) use wardrobe::{Hair, Leg, Outfit, Sleeve, Wardrobe};

/// Every model of this family.
pub(crate) fn assets() -> Vec<Asset> {
    adults::assets()
}
