//! What stands along and on streets.

mod animals;
mod barriers;
mod bins;
mod carts;
mod cattle;
mod cones;
mod fences;
mod finish;
mod fittings;
mod furniture;
mod lamps;
mod plan;
mod posters;
mod seats;
mod signals;
mod signs;
mod trade;
mod wheeled;
mod works;

use trove_model::Asset;

pub(crate) use cones::ConePlan;
pub(crate) use fences::WallPlan;
pub(crate) use plan::FurniturePlan;
pub(crate) use signals::SignalPlan;

/// Plans of what stands along streets.
#[derive(Clone, Debug, Default)]
pub(crate) struct StreetPlans {
    pub(crate) cones: Vec<ConePlan>,
    pub(crate) furniture: Vec<FurniturePlan>,
    pub(crate) signals: Vec<SignalPlan>,
    pub(crate) walls: Vec<WallPlan>,
}

/// What plans tell.
pub(crate) fn planned(plans: &StreetPlans) -> Vec<Asset> {
    [
        plans.cones.iter().map(cones::cone).collect(),
        plans.furniture.iter().map(FurniturePlan::asset).collect(),
        signals::assets(&plans.signals),
        plans.walls.iter().map(fences::wall).collect(),
    ]
    .concat()
}

/// Every model of this family.
pub(crate) fn assets(plans: &StreetPlans) -> Vec<Asset> {
    [
        planned(plans),
        animals::assets(),
        barriers::assets(),
        bins::assets(),
        carts::assets(),
        vec![cattle::cow()],
        cones::others(),
        fences::assets(),
        fittings::assets(),
        furniture::assets(),
        lamps::assets(),
        seats::assets(),
        signs::assets(),
        trade::assets(),
        wheeled::assets(),
        works::assets(),
    ]
    .concat()
}
