//! Which model a plant becomes, and how large.

use glam::DVec3;
use trove_model::{Asset, AssetLibrary, Climate, Kind, LeafType, MappedPlant, PlantForm, Seed};

use super::crowns::Crown;
use super::wish::{Form, Wish};
use crate::pieces::Scenery;

/// A model is scaled at most by this, and at least by one over it.
const MAX_SCALE: f64 = 1.6;
/// Individuals differ from their species by so much in each direction.
const VARIATION: f64 = 0.1;
/// Of a species all models stand for a plant whose scale is within this of the best one's, as a difference of logarithms.
const INDIVIDUALS: f64 = 0.2;
/// Crowns are cut back to this share of their width at most, and by its root of their height, lest they become columns; a
/// tree that has less room is another tree or none.
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
    /// How common its species is.
    commonness: f64,
}

impl Model<'_> {
    /// What it shares with the other individuals of its species.
    fn species(&self) -> &str {
        let named = self.asset.plant.as_ref().and_then(|p| p.species.as_deref());
        named.unwrap_or(&self.asset.id)
    }

    /// Whether a map's name of a species or genus is its own.
    fn is_called(&self, species: &str) -> bool {
        self.asset.plant.as_ref().is_some_and(|p| p.is_called(species))
    }

    fn has_leaves(&self, leaves: LeafType) -> bool {
        self.asset.plant.as_ref().is_none_or(|p| p.leaves == leaves)
    }
}

/// The plants of a library that live in a place.
pub(super) struct Species<'a> {
    trees: Vec<Model<'a>>,
    bushes: Vec<Model<'a>>,
    rows: Vec<(PlantForm, Model<'a>)>,
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
        let models = |kind| -> Vec<(PlantForm, Model<'a>)> {
            let model = |asset: &'a Asset| {
                let (form, share) =
                    asset.plant.as_ref().map_or((PlantForm::Free, 1.0), |p| (p.form, p.commonness(climate)));
                let commonness = f64::from(share * asset.commonness);
                (commonness > 0.0).then(|| (form, Model { asset, crown: Crown::new(asset), commonness }))
            };
            library.of_kind(kind).filter_map(model).collect()
        };
        let free = |models: Vec<(PlantForm, Model<'a>)>| models.into_iter().map(|m| m.1).collect();
        let (bushes, rows) = models(Kind::Bush).into_iter().partition(|(form, _)| *form == PlantForm::Free);
        Self { trees: free(models(Kind::Tree)), bushes: free(bushes), rows }
    }

    /// Whether there is none of a kind.
    pub(super) fn lacks(&self, kind: Kind) -> bool {
        if kind == Kind::Tree { self.trees.is_empty() } else { self.bushes.is_empty() }
    }

    /// The plant for a wish and the space that it has; `None` where no model of the kind fits.
    pub(super) fn grow(&self, wish: &Wish, space: Space, seed: Seed) -> Option<Grown<'a>> {
        if let Form::Row { planted, yaw_rad, length_m, width_m } = wish.form {
            return self.row(planted, wish, [length_m, width_m], yaw_rad, seed);
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
        let fits = |m: &&Model| width(m) >= LEAST_WIDTH;
        let suits = |m: &&Model| (1.0 / MAX_SCALE..=MAX_SCALE).contains(&scale_of(m));

        // Of the genus that the map names; else with such leaves; else anything that has room.
        let fitting: Vec<&Model> = models.iter().filter(fits).collect();
        let only = |is: &dyn Fn(&Model) -> bool| -> Vec<&Model> { fitting.iter().copied().filter(|m| is(m)).collect() };
        let MappedPlant { species, leaves } = &wish.mapped;
        let mut candidates = only(&|m| species.as_ref().is_some_and(|species| m.is_called(species)));
        // Of the species that have names most have broad leaves.
        let leaves = leaves.or(species.as_ref().map(|_| LeafType::Broad));
        if let Some(leaves) = leaves.filter(|_| candidates.is_empty()) {
            candidates = only(&|m| m.has_leaves(leaves));
        }
        if candidates.is_empty() {
            candidates = fitting;
        }
        // One species a group, of those that grow to the height and have room: a weighted order of species (Efraimidis
        // and Spirakis, 2006) that all of the group share, so that where one plant has no room for the first its
        // neighbours keep it. Else the model that comes nearest.
        let strangeness = |m: &Model| scale_of(m).ln().abs();
        let group = Seed(wish.group).child("species");
        let rank = |m: &Model| -(1.0 - group.child(m.species()).random().unit()).ln() / m.commonness;
        let suitable = candidates.iter().filter(|m| suits(m));
        let chosen = suitable
            .min_by(|a, b| rank(a).total_cmp(&rank(b)))
            .or_else(|| candidates.iter().min_by(|a, b| strangeness(a).total_cmp(&strangeness(b))))?;
        // Any individual of it that is about as large.
        let alike: Vec<&Model> = candidates.iter().copied().filter(|m| m.species() == chosen.species()).collect();
        let most = alike.iter().map(|m| strangeness(m)).fold(f64::INFINITY, f64::min) + INDIVIDUALS;
        let alike: Vec<&Model> = alike.into_iter().filter(|m| strangeness(m) <= most).collect();
        let model = *seed.child("individual").random().pick(&alike)?;

        let mut random = seed.random();
        let mut vary = || 1.0 + random.range(-VARIATION, VARIATION);
        let room = width(model);
        let (wide, high) = (vary().min(room), vary() * room.min(1.0).sqrt());
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

    /// A piece of a row that joins its neighbours.
    fn row(&self, planted: PlantForm, wish: &Wish, size_m: [f64; 2], yaw_rad: f64, seed: Seed) -> Option<Grown<'a>> {
        let group = Seed(wish.group).child("row");
        let mut of_form: Vec<&Model> = self.rows.iter().filter(|r| r.0 == planted).map(|r| &r.1).collect();
        if of_form.is_empty() && planted == PlantForm::Hedge {
            of_form.extend(&self.bushes);
        }
        // All of a row is of one species; its pieces are individuals.
        let rank = |m: &Model| -(1.0 - group.child(m.species()).random().unit()).ln() / m.commonness;
        let chosen = of_form.iter().min_by(|a, b| rank(a).total_cmp(&rank(b)))?;
        let alike: Vec<&Model> = of_form.iter().copied().filter(|m| m.species() == chosen.species()).collect();
        let asset = seed.child("individual").random().pick(&alike)?.asset;
        let scale = DVec3::new(size_m[0], size_m[1], wish.height_m) / asset.size_m.max(DVec3::splat(0.05));
        // Turned round every other time, lest its pieces look the same.
        let turn = if seed.random().chance(0.5) { std::f64::consts::PI } else { 0.0 };
        let radius_m = size_m[1] / 2.0;
        // All of a row is of one green.
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

impl<'a> Grown<'a> {
    /// The plant at a place.
    pub(super) fn scenery(self, foot_world: DVec3) -> Scenery<'a> {
        Scenery { asset: self.asset, foot_world, yaw_rad: self.yaw_rad, scale: self.scale, seed: self.seed }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use trove_model::{LeafType, Plant};

    use super::*;

    fn plant(id: &str, plant: Plant, height_m: f64) -> Asset {
        let size = [0.4 * height_m, 0.4 * height_m, height_m];
        Asset { plant: Some(plant), ..crate::testing::asset(id, Kind::Tree, size) }
    }

    fn library() -> AssetLibrary {
        let lime = |id: &str, height_m| {
            let genera = vec!["tilia".into(), "lime".into()];
            plant(id, Plant { species: Some("lime".into()), genera, ..Plant::default() }, height_m)
        };
        let habitat = vec![(Climate::Temperate, 0.0)];
        let assets = vec![
            lime("tree/lime-1", 9.0),
            lime("tree/lime-2", 9.5),
            lime("tree/lime-young", 4.0),
            plant("tree/oak", Plant { genera: vec!["quercus".into()], ..Plant::default() }, 9.0),
            plant("tree/palm", Plant { habitat, leaves: LeafType::Frond, ..Plant::default() }, 9.0),
            plant("tree/pine", Plant { leaves: LeafType::Needle, ..Plant::default() }, 9.0),
        ];
        AssetLibrary { assets, ..AssetLibrary::default() }
    }

    fn grown(climate: Climate, species: Option<&str>, leaves: Option<LeafType>, height_m: f64) -> Vec<String> {
        let library = library();
        let mapped = MappedPlant { species: species.map(str::to_owned), leaves };
        let species = Species::new(&library, climate);
        let wish = Wish { mapped, ..Wish::new(Kind::Tree, DVec2::ZERO, height_m, 7) };
        let space = Space { lane_m: 50.0, wall_m: 50.0 };
        let mut ids: Vec<String> =
            (0..40).filter_map(|i| Some(species.grow(&wish, space, Seed(i))?.asset.id.clone())).collect();
        ids.sort();
        ids.dedup();
        ids
    }

    #[test]
    fn what_a_map_calls_a_tree_grows_there_in_several_individuals() {
        let (broad, needle) = (Some(LeafType::Broad), Some(LeafType::Needle));
        let temperate = |species, leaves, height_m| grown(Climate::Temperate, species, leaves, height_m);
        assert_eq!(temperate(Some("tilia cordata"), broad, 9.0), ["tree/lime-1", "tree/lime-2"]);
        assert_eq!(temperate(Some("tilia cordata"), None, 3.5), ["tree/lime-young"]);
        assert_eq!(temperate(Some("quercus robur"), None, 9.0), ["tree/oak"]);
        assert_eq!(temperate(None, needle, 9.0), ["tree/pine"]);
        assert_eq!(grown(Climate::Tropical, Some("roystonea regia"), Some(LeafType::Frond), 9.0), ["tree/palm"]);
    }

    #[test]
    fn a_plant_grows_where_it_lives_and_a_row_is_of_one_species() {
        for climate in [Climate::Temperate, Climate::Tropical] {
            let ids = grown(climate, None, None, 9.0);
            let species: Vec<&str> = ids.iter().filter_map(|id| id.split('-').next()).collect();
            assert!(species.windows(2).all(|pair| pair[0] == pair[1]), "{ids:?}");
            assert!(climate == Climate::Tropical || species[0] != "tree/palm");
        }
    }
}
