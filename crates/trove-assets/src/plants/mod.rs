//! Trees and bushes.

mod bushes;
mod growth;
mod leaves;
mod stems;
mod trees;

use rayon::prelude::*;
use trove_model::Asset;

/// Every model of this family.
pub(crate) fn assets() -> Vec<Asset> {
    let groups: [fn() -> Vec<Asset>; 3] = [trees::assets, stems::assets, bushes::assets];
    groups.par_iter().flat_map_iter(|group| group()).collect()
}
