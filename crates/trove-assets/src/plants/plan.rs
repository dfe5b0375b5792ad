//! What stands in the plans of trees, shrubs, hedges and beds. Lengths are metres, colours linear RGB.

use glam::Vec3;
use serde::Deserialize;
use trove_model::{Asset, Climate, LeafType};

use super::bark::Bark;
use super::leaves::Sprig;
use super::tones::{Tones, Year};
use crate::measure::ordinary;

/// The plants to grow.
#[derive(Clone, Debug, Default)]
pub(crate) struct PlantPlans {
    pub(crate) trees: Vec<TreePlan>,
    pub(crate) shrubs: Vec<ShrubPlan>,
    pub(crate) hedges: Vec<RowPlan>,
    pub(crate) beds: Vec<RowPlan>,
}

/// Climates and how common a plant is there.
type Habitat = Vec<(ClimatePlan, f32)>;

/// A kind of tree: a `[[tree]]` of a file of plans; measures are those of a grown one in a street.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TreePlan {
    /// Unique in its library; its last part is the species.
    pub(super) id: String,
    /// Words that say what it is, besides its name.
    #[serde(default)]
    pub(super) tags: Vec<String>,
    /// How often it is drawn among those that fit as well; 1 is ordinary.
    #[serde(default = "ordinary")]
    pub(super) commonness: f32,
    #[serde(default)]
    pub(super) leaves: LeavesPlan,
    /// Words of its names on maps.
    #[serde(default)]
    pub(super) genera: Vec<String>,
    #[serde(default)]
    pub(super) habitat: Habitat,
    pub(super) height_m: f32,
    /// Largest radius of the crown.
    pub(super) radius_m: f32,
    /// Height at which branches begin, as a share of the whole.
    pub(super) clear: f32,
    /// Height in the crown (0 to 1), and the crown's radius there as a share of the largest.
    pub(super) crown: Vec<(f32, f32)>,
    /// Clumps that the crown consists of, and their radius as a share of the crown's.
    pub(super) lobes: usize,
    pub(super) lobe: f32,
    /// Height of a clump as a share of its width.
    pub(super) flat: f32,
    /// How far up the crown the trunk goes on before it divides; negative: below the crown.
    pub(super) leader: f32,
    /// Points that branches grow to.
    pub(super) points: usize,
    /// Pull upwards in every step of growth.
    pub(super) lift: f32,
    pub(super) trunk_m: f32,
    /// How much the trunk's foot spreads.
    pub(super) roots: f32,
    pub(super) sprig: Sprig,
    pub(super) card_m: f32,
    /// Sprigs of a grown crown.
    pub(super) cards: usize,
    /// Upward pull on sprigs; negative where they hang.
    pub(super) hang: f32,
    pub(super) green: [f32; 3],
    #[serde(default)]
    pub(super) year: Year,
    pub(super) bark: Bark,
    pub(super) bark_color: [f32; 3],
}

/// A kind of shrub: a `[[shrub]]` of a file of plans.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ShrubPlan {
    /// Unique in its library; its last part is the species.
    pub(super) id: String,
    /// Words that say what it is, besides its name.
    #[serde(default)]
    pub(super) tags: Vec<String>,
    /// How often it is drawn among those that fit as well; 1 is ordinary.
    #[serde(default = "ordinary")]
    pub(super) commonness: f32,
    #[serde(default)]
    pub(super) habitat: Habitat,
    /// Half axes; the foot is in the middle of the underside.
    pub(super) half_m: [f32; 3],
    /// Round clumps that it consists of, and their radius as a share of the whole's.
    pub(super) clumps: usize,
    pub(super) clump: f32,
    /// Leaves come out of the ground on long stalks instead of sitting on a surface.
    #[serde(default)]
    pub(super) from_ground: bool,
    pub(super) sprig: Sprig,
    pub(super) card_m: f32,
    pub(super) cards: usize,
    pub(super) green: [f32; 3],
    #[serde(default)]
    pub(super) year: Year,
}

/// What grows in rows: a `[[hedge]]` or a `[[bed]]` of a file of plans.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RowPlan {
    /// Unique in its library; its last part is the species.
    pub(super) id: String,
    /// Words that say what it is, besides its name.
    #[serde(default)]
    pub(super) tags: Vec<String>,
    /// How often it is drawn among those that fit as well; 1 is ordinary.
    #[serde(default = "ordinary")]
    pub(super) commonness: f32,
    #[serde(default)]
    pub(super) habitat: Habitat,
    pub(super) sprig: Sprig,
    pub(super) card_m: f32,
    /// Sprigs of a piece.
    pub(super) cards: usize,
    pub(super) green: [f32; 3],
    #[serde(default)]
    pub(super) year: Year,
    /// Heads above the leaves of a bed, one colour a sort.
    #[serde(default)]
    pub(super) flowers: Vec<[f32; 3]>,
}

/// What leaves are.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum LeavesPlan {
    #[default]
    Broad,
    Needle,
    Frond,
}

impl From<LeavesPlan> for LeafType {
    fn from(leaves: LeavesPlan) -> Self {
        match leaves {
            LeavesPlan::Broad => Self::Broad,
            LeavesPlan::Needle => Self::Needle,
            LeavesPlan::Frond => Self::Frond,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum ClimatePlan {
    Tropical,
    Subtropical,
    Mediterranean,
    Arid,
    Temperate,
    Cold,
}

impl From<ClimatePlan> for Climate {
    fn from(climate: ClimatePlan) -> Self {
        match climate {
            ClimatePlan::Tropical => Self::Tropical,
            ClimatePlan::Subtropical => Self::Subtropical,
            ClimatePlan::Mediterranean => Self::Mediterranean,
            ClimatePlan::Arid => Self::Arid,
            ClimatePlan::Temperate => Self::Temperate,
            ClimatePlan::Cold => Self::Cold,
        }
    }
}

impl TreePlan {
    pub(super) fn tones(&self) -> Tones<'_> {
        Tones { green: Vec3::from_array(self.green), year: &self.year }
    }
}

impl ShrubPlan {
    pub(super) fn tones(&self) -> Tones<'_> {
        Tones { green: Vec3::from_array(self.green), year: &self.year }
    }
}

impl RowPlan {
    pub(super) fn tones(&self) -> Tones<'_> {
        Tones { green: Vec3::from_array(self.green), year: &self.year }
    }
}

/// The species of an id: what follows its folder.
pub(super) fn species(id: &str) -> &str {
    id.rsplit('/').next().unwrap_or(id)
}

pub(super) fn climates(habitat: &[(ClimatePlan, f32)]) -> Vec<(Climate, f32)> {
    habitat.iter().map(|&(climate, share)| (climate.into(), share)).collect()
}

/// A grown plant with what its plan says of how it is chosen.
pub(super) fn offered(asset: Asset, tags: &[String], commonness: f32) -> Asset {
    Asset { commonness, ..asset }.tagged(tags)
}
