//! What stands along and on streets.

mod barriers;
mod carts;
mod cones;
mod finish;
mod furniture;
mod lamps;
mod letters;
mod signals;
mod signs;

use trove_model::Asset;

/// Every model of this family.
pub(crate) fn assets() -> Vec<Asset> {
    [
        barriers::assets(),
        carts::assets(),
        cones::assets(),
        furniture::assets(),
        lamps::assets(),
        signals::assets(),
        signs::assets(),
    ]
    .concat()
}
