//! People on foot, with what they push, ride or sit in.

mod adults;
mod body;
mod figure;
mod mobility;
mod wardrobe;

use trove_model::{Asset, HumanBody};

pub(crate) use figure::{Figure, Physique, Pose};
pub(crate) use wardrobe::{Hair, Leg, Outfit, Sleeve, Wardrobe};

/// Every model of this family; people on foot are plainer without a body to make them from.
pub(crate) fn assets(body: Option<&HumanBody>) -> Vec<Asset> {
    let on_foot = body.map(body::assets).filter(|people| !people.is_empty()).unwrap_or_else(adults::assets);
    [on_foot, mobility::assets()].concat()
}
