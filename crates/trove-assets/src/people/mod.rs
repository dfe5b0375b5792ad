//! People on foot, with what they push, ride or sit in.

mod adults;
mod body;
mod figure;
mod mobility;
mod wardrobe;

use trove_model::{Asset, HumanBody};

pub(crate) use body::{PersonPlan, persons};
pub(crate) use figure::{Figure, Physique, Pose};
pub(crate) use wardrobe::{Hair, Leg, Outfit, Sleeve, Wardrobe};

/// Every model of this family; people on foot are plainer figures without a body to make these persons from.
pub(crate) fn assets(plans: &[PersonPlan], body: Option<&HumanBody>) -> Vec<Asset> {
    let on_foot = body.map(|body| persons(plans, body)).filter(|people| !people.is_empty());
    let on_foot = on_foot.unwrap_or_else(adults::assets);
    [on_foot, mobility::assets()].concat()
}
