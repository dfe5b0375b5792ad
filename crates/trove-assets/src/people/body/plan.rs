//! What stands in the plan of a person on foot: body, face, hair, clothes, and what they do.

use serde::Deserialize;
use trove_model::{Kind, Outdoors};

use super::build::Build;
use super::head::HairCut;
use super::outfit::{Bottom, Top};
use super::posture::Act;
use crate::measure::ordinary;

/// Someone on foot: a `[[person]]` of a file of plans. Heights of clothes are those of the body's own shape, in
/// metres from its hips; colours linear RGB.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PersonPlan {
    /// Unique in its library.
    pub(crate) id: String,
    #[serde(default)]
    pub(super) kind: PersonKind,
    /// Words that say what they are.
    #[serde(default)]
    pub(super) tags: Vec<String>,
    /// How often they are drawn; 1 is ordinary.
    #[serde(default = "ordinary")]
    pub(super) commonness: f32,
    /// When their clothes are worn; empty: always.
    #[serde(default)]
    pub(super) worn_in: Vec<WornIn>,
    pub(super) build: Build,
    pub(super) skin: Dye,
    pub(super) hair: Dye,
    pub(super) hair_cut: HairCut,
    /// 0 shaven, 1 a full beard.
    #[serde(default)]
    pub(super) beard: f32,
    /// Garments for the trunk, from the innermost.
    pub(super) top: Vec<Layer>,
    /// How far down the outermost goes on as a coat.
    pub(super) tail_m: Option<f32>,
    pub(super) bottom: Legwear,
    pub(super) shoes: Shoes,
    #[serde(default)]
    pub(super) has_tie: bool,
    #[serde(default)]
    pub(super) is_hi_vis: bool,
    #[serde(default)]
    pub(super) headgear: Headgear,
    #[serde(default)]
    pub(super) bag: Bag,
    /// What they do besides walking and running.
    pub(super) acts: Vec<Act>,
}

/// What a person counts as.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum PersonKind {
    #[default]
    Adult,
    Child,
    ConstructionWorker,
    PoliceOfficer,
}

impl From<PersonKind> for Kind {
    fn from(kind: PersonKind) -> Self {
        match kind {
            PersonKind::Adult => Self::Adult,
            PersonKind::Child => Self::Child,
            PersonKind::ConstructionWorker => Self::ConstructionWorker,
            PersonKind::PoliceOfficer => Self::PoliceOfficer,
        }
    }
}

/// What clothes are worn in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum WornIn {
    Warm,
    Mild,
    Wet,
    Cold,
}

impl From<WornIn> for Outdoors {
    fn from(worn_in: WornIn) -> Self {
        match worn_in {
            WornIn::Warm => Self::Warm,
            WornIn::Mild => Self::Mild,
            WornIn::Wet => Self::Wet,
            WornIn::Cold => Self::Cold,
        }
    }
}

/// Colours to draw from, repeated according to how common they are.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Dye {
    pub(super) colors: Vec<[f32; 3]>,
}

/// A garment for the trunk.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Layer {
    /// These four as in [`Top`].
    pub(super) sleeve: f32,
    pub(super) neck_m: f32,
    pub(super) hem_m: f32,
    pub(super) wide: f32,
    pub(super) fabric: Fabric,
    pub(super) dye: Dye,
    /// Open over the chest.
    #[serde(default)]
    pub(super) has_lapels: bool,
    /// With a collar that stands up.
    #[serde(default)]
    pub(super) has_collar: bool,
}

impl Layer {
    pub(super) fn cut(&self) -> Top {
        Top { sleeve: self.sleeve, neck_m: self.neck_m, hem_m: self.hem_m, wide: self.wide }
    }
}

/// A garment for the legs.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Legwear {
    pub(super) cut: Bottom,
    pub(super) fabric: Fabric,
    pub(super) dye: Dye,
}

/// What is on the feet.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Shoes {
    /// How high they reach.
    pub(super) to_m: f32,
    pub(super) colors: Vec<[f32; 3]>,
}

/// Cloth, as [`super::fabric::Fabrics`] has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Fabric {
    Woven,
    Denim,
    Knit,
    Striped,
    Checked,
    Printed,
    /// Waterproof.
    Coated,
}

/// What is worn on the head.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Headgear {
    #[default]
    None,
    Cap,
    Helmet,
    PoliceCap,
    Scarf,
    Hood,
    Beanie,
}

impl Headgear {
    /// Whether it lies about the head so closely that hair would show through.
    pub(super) fn hides_hair(self) -> bool {
        matches!(self, Self::Scarf | Self::Hood)
    }
}

/// What is carried on the body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Bag {
    #[default]
    None,
    Backpack,
    Satchel,
    Shopping,
    Briefcase,
    Umbrella,
}
