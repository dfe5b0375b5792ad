//! Where the randomness of a place comes from, factor by factor.

use trove_model::Seed;

/// The seeds of what may differ between variations of a place: each can change while all that the others decide stays
/// as it was, but for what physically follows (plants make way for street furniture).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seeds {
    /// What no variation changes: the plan of buildings that only the LiDAR saw.
    pub place: Seed,
    /// Which models stand for recorded objects, but for people.
    pub assets: Seed,
    /// Colours, wear and extras of vehicles.
    pub paint: Seed,
    /// Who the people on foot are, and how they are dressed.
    pub people: Seed,
    /// Styles and colours of buildings, and heights that nobody knows.
    pub facades: Seed,
    /// Surfaces of roads, sidewalks and land, markings that nobody knows, damage.
    pub materials: Seed,
    /// Street furniture.
    pub furniture: Seed,
    /// Species and individuals of plants, lawns and undergrowth.
    pub vegetation: Seed,
    /// Which recorded road users are left out, and who comes besides.
    pub traffic: Seed,
    /// What is not known of the sky.
    pub light: Seed,
    /// Which vehicles carry the rig.
    pub rigs: Seed,
    /// The samples of pictures.
    pub noise: Seed,
}

impl From<Seed> for Seeds {
    /// One seed for all: the parts of a place draw independently of each other all the same.
    fn from(seed: Seed) -> Self {
        Self {
            place: seed,
            assets: seed,
            paint: seed,
            people: seed,
            facades: seed,
            materials: seed,
            furniture: seed,
            vegetation: seed,
            traffic: seed,
            light: seed,
            rigs: seed,
            noise: seed,
        }
    }
}
