//! Which model a plant becomes, and how large.

use glam::DVec3;
use trove_model::{Asset, AssetLibrary, Kind, Seed};

use super::climate::Climate;
use super::crowns::Crown;
use super::{Form, Wish};
use crate::scenery::Scenery;

/// A model is scaled at most by this, and at least by one over it.
const MAX_SCALE: f64 = 1.6;
/// Individuals differ from their species by so much in each direction.
const VARIATION: f64 = 0.1;
/// Crowns are cut back to this share of their width at most; a tree that has less room is another tree or none.
const LEAST_WIDTH: f64 = 0.5;
/// What is driven on is clear up to this height: the clearance that road authorities keep over carriageways, metres.
pub(super) const LANE_CLEARANCE_M: f64 = 4.5;
/// Up to this height plants would stand in furniture and in people, metres.
const BODY_M: f64 = 2.0;

/// A model and how it grows here.
#[derive(Clone, Debug)]
struct Model<'a> {
    asset: &'a Asset,
    crown: Crown,
    /// Lots in the draw of species.
    lots: usize,
}

/// The plants of a library that live in a place.
pub(super) struct Species<'a> {
    trees: Vec<Model<'a>>,
    bushes: Vec<Model<'a>>,
    hedges: Vec<Model<'a>>,
}

/// Distances from a plant's foot to what it must not touch, metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Space {
    /// To what is driven on: only what hangs below [`LANE_CLEARANCE_M`] counts.
    pub lane_m: f64,
    /// To walls.
    pub wall_m: f64,
}

/// A plant that has a model and a size, and no place yet.
pub(super) struct Grown<'a> {
    asset: &'a Asset,
    scale: DVec3,
    yaw_rad: f64,
    seed: Seed,
    /// Half its width, metres.
    pub(super) radius_m: f64,
    /// Half the width of what hangs below [`LANE_CLEARANCE_M`], metres.
    pub(super) low_radius_m: f64,
    /// Half the width of what is at the height of people and furniture, metres.
    pub(super) body_radius_m: f64,
}

impl<'a> Species<'a> {
    /// The plants that live in a climate.
    pub(super) fn new(library: &'a AssetLibrary, climate: Climate) -> Self {
        let lives = |asset: &&Asset| !asset.frost_tender || climate.is_frost_free();
        let models = |kind| -> Vec<Model<'a>> {
            let model = |asset| Model { asset, crown: Crown::new(asset), lots: commonness(asset, climate) };
            library.of_kind(kind).filter(lives).map(model).collect()
        };
        let (hedges, bushes) = models(Kind::Bush).into_iter().partition(|m| m.asset.id.contains("hedge"));
        Self { trees: models(Kind::Tree), bushes, hedges }
    }

    /// Whether there is none of a kind.
    pub(super) fn lacks(&self, kind: Kind) -> bool {
        if kind == Kind::Tree { self.trees.is_empty() } else { self.bushes.is_empty() }
    }

    /// The plant for a wish and the space that it has; `None` where no model of the kind fits.
    pub(super) fn grow(&self, wish: &Wish, space: Space, seed: Seed) -> Option<Grown<'a>> {
        if let Form::Hedge { yaw_rad, length_m, width_m } = wish.form {
            return self.hedge(wish, [length_m, width_m], yaw_rad, seed);
        }
        let models = if wish.kind == Kind::Tree { &self.trees } else { &self.bushes };
        let scale_of = |m: &Model| wish.height_m / m.asset.size_m.z.max(0.1);
        // How much of its width it keeps.
        let width = |m: &Model| {
            let scale = scale_of(m).clamp(1.0 / MAX_SCALE, MAX_SCALE);
            let low_m = m.crown.reach_below_m(LANE_CLEARANCE_M / scale) * scale;
            let share = (space.lane_m / low_m.max(1e-3)).min(space.wall_m / (m.crown.reach_m() * scale).max(1e-3));
            if wish.kind == Kind::Tree { share } else { 1.0 }
        };
        let named = |m: &&Model| wish.genus.is_none_or(|genus| genus.suits(&m.asset.id));
        let fits = |m: &&Model| width(m) >= LEAST_WIDTH;
        let suits = |m: &&Model| (1.0 / MAX_SCALE..=MAX_SCALE).contains(&scale_of(m));

        // One species a group, of those that grow to the height and have room; else the one that comes nearest.
        let of_genus: Vec<&Model> = models.iter().filter(fits).filter(named).collect();
        let candidates = if of_genus.is_empty() { models.iter().filter(fits).collect() } else { of_genus };
        let strangeness = |m: &Model| scale_of(m).ln().abs();
        let nearest = || candidates.iter().min_by(|a, b| strangeness(a).total_cmp(&strangeness(b)));
        // A weighted order of species (Efraimidis and Spirakis, 2006) that all of the group share: where one plant has no
        // room for the first its neighbours keep it.
        let group = Seed(wish.group).child("species");
        let rank = |m: &Model| -(1.0 - group.child(&m.asset.id).random().unit()).ln() / m.lots as f64;
        let suitable = candidates.iter().filter(|m| m.lots > 0 && suits(m));
        let model = *suitable.min_by(|a, b| rank(a).total_cmp(&rank(b))).or_else(nearest)?;

        let mut random = seed.random();
        let mut vary = || 1.0 + random.range(-VARIATION, VARIATION);
        let (wide, high) = (vary().min(width(model)), vary());
        let size = scale_of(model).clamp(1.0 / MAX_SCALE, MAX_SCALE);
        let scale = DVec3::new(size * wide, size * wide, size * high);
        Some(Grown {
            asset: model.asset,
            scale,
            yaw_rad: random.range(0.0, std::f64::consts::TAU),
            seed,
            radius_m: model.crown.reach_m() * scale.x,
            low_radius_m: model.crown.reach_below_m(LANE_CLEARANCE_M / scale.z) * scale.x,
            body_radius_m: model.crown.reach_below_m(BODY_M / scale.z) * scale.x,
        })
    }

    /// A piece of a hedge that joins its neighbours.
    fn hedge(&self, wish: &Wish, size_m: [f64; 2], yaw_rad: f64, seed: Seed) -> Option<Grown<'a>> {
        let models = if self.hedges.is_empty() { &self.bushes } else { &self.hedges };
        let asset = Seed(wish.group).child("hedge").random().pick(models)?.asset;
        let scale = DVec3::new(size_m[0], size_m[1], wish.height_m) / asset.size_m.max(DVec3::splat(0.05));
        // Turned round every other time, lest its pieces look the same.
        let turn = if seed.random().chance(0.5) { std::f64::consts::PI } else { 0.0 };
        let radius_m = size_m[1] / 2.0;
        // All of a hedge is of one green.
        let seed = Seed(wish.group);
        Some(Grown {
            asset,
            scale,
            yaw_rad: yaw_rad + turn,
            seed,
            radius_m,
            low_radius_m: radius_m,
            body_radius_m: radius_m,
        })
    }
}

/// Lots of a species in the draw: what towns plant in a climate, as far as the built-in models go.
fn commonness(asset: &Asset, climate: Climate) -> usize {
    use Climate::{Arid, Cold, Mediterranean, Subtropical, Temperate, Tropical};
    match (asset.id.as_str(), climate) {
        ("tree/palm" | "tree/palm-low", Mediterranean | Arid) => 9,
        ("tree/palm" | "tree/palm-low", _) => 4,
        ("tree/rain-tree", Tropical) => 20,
        ("tree/rain-tree", _) => 5,
        ("tree/spruce", Cold) => 8,
        ("tree/spruce", Temperate) => 3,
        ("tree/pine", Mediterranean) => 7,
        ("tree/pine", Temperate | Cold) => 4,
        ("tree/spruce" | "tree/pine", _) => 1,
        ("tree/cypress", Mediterranean) => 6,
        ("tree/cypress", Subtropical | Arid) => 2,
        ("tree/cypress", _) => 0,
        ("tree/birch", Cold) => 12,
        ("tree/birch", Temperate) => 4,
        ("tree/birch", _) => 0,
        ("tree/linden", Temperate | Cold) => 16,
        ("tree/linden", _) => 3,
        ("tree/plane", Mediterranean | Temperate) => 14,
        ("tree/oak", Tropical | Arid) => 4,
        ("bush/tropical", Tropical | Subtropical) => 16,
        _ => 10,
    }
}

/// What a map says of a tree's kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Genus {
    Palm,
    Conifer,
    Slender,
    Birch,
    Plane,
    Oak,
    Linden,
    Broadleaved,
}

impl Genus {
    /// From OpenStreetMap's genus, species or leaf type.
    pub(super) fn parse(detail: &str) -> Option<Self> {
        let detail = detail.to_lowercase();
        let has = |words: &[&str]| words.iter().any(|w| detail.contains(w));
        Some(match () {
            _ if has(&["palm", "phoenix", "washingtonia", "arecaceae", "trachycarpus", "cocos", "roystonea"]) => {
                Self::Palm
            }
            _ if has(&["cupressus", "cypress", "italica", "juniperus", "thuja"]) => Self::Slender,
            _ if has(&["needleleaved", "pinus", "picea", "abies", "larix", "cedrus", "taxus", "araucaria"]) => {
                Self::Conifer
            }
            _ if has(&["betula", "birch"]) => Self::Birch,
            _ if has(&["platanus"]) => Self::Plane,
            _ if has(&["quercus", "fagus", "castanea", "aesculus"]) => Self::Oak,
            _ if has(&["tilia", "acer", "carpinus", "ulmus", "fraxinus"]) => Self::Linden,
            _ if detail.trim().is_empty() => return None,
            _ => Self::Broadleaved,
        })
    }

    /// Whether a model can stand for it.
    fn suits(self, asset: &str) -> bool {
        let has = |words: &[&str]| words.iter().any(|w| asset.contains(w));
        match self {
            Self::Palm => has(&["palm"]),
            Self::Conifer => has(&["spruce", "pine"]),
            Self::Slender => has(&["cypress"]),
            Self::Birch => has(&["birch"]),
            Self::Plane => has(&["plane"]),
            Self::Oak => has(&["oak"]),
            Self::Linden => has(&["linden", "street"]),
            Self::Broadleaved => !has(&["palm", "spruce", "pine", "cypress"]),
        }
    }
}

impl<'a> Grown<'a> {
    /// The plant at a place.
    pub(super) fn scenery(self, foot_world: DVec3) -> Scenery<'a> {
        Scenery { asset: self.asset, foot_world, yaw_rad: self.yaw_rad, scale: self.scale, seed: self.seed }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_map_calls_a_tree_is_understood() {
        for (detail, genus) in [
            ("", None),
            ("Tilia cordata", Some(Genus::Linden)),
            ("Platanus × hispanica", Some(Genus::Plane)),
            ("Populus nigra 'Italica'", Some(Genus::Slender)),
            ("needleleaved", Some(Genus::Conifer)),
            ("broadleaved", Some(Genus::Broadleaved)),
            ("Washingtonia robusta", Some(Genus::Palm)),
        ] {
            assert_eq!(Genus::parse(detail), genus, "{detail}");
        }
    }
}
