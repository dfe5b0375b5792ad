//! Whole buildings, for footprints that are rectangles. Their fronts look towards −y.

mod blocks;
mod houses;
mod site;

use rayon::prelude::*;
use trove_model::{Asset, Surface};

/// Every model of this family, made with these surfaces.
pub(crate) fn assets(surfaces: &[Surface]) -> Vec<Asset> {
    let builders: [fn(&[Surface]) -> Asset; 10] = [
        houses::row,
        houses::detached,
        houses::apartments,
        houses::shops,
        blocks::slab,
        blocks::tower,
        blocks::warehouse,
        blocks::corner,
        blocks::ribbon,
        blocks::hotel,
    ];
    builders.par_iter().map(|build| build(surfaces)).collect()
}
