//! Buildings as plans tell them.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::finish::{self, FinishPlan};
use super::parts::PartPlan;
use crate::measure::{Wrong, ordinary, within, wrong};

/// A building: a `[[building]]` of a file of plans. Metres, its front towards −y; colours linear RGB.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BuildingPlan {
    /// Unique in its library.
    pub(crate) id: String,
    /// Words that say what it is.
    #[serde(default)]
    pub(super) tags: Vec<String>,
    /// How often it is drawn among those that fit as well; 1 is ordinary.
    #[serde(default = "ordinary")]
    pub(super) commonness: f32,
    /// ISO 3166-1 codes of the countries in which it stands; without any: everywhere.
    #[serde(default)]
    pub(super) countries: Vec<String>,
    /// After how many metres it looks the same again, along x and along y; 0: never.
    pub(super) module_m: [f32; 2],
    #[serde(default)]
    pub(super) finishes: BTreeMap<String, FinishPlan>,
    pub(super) masses: Vec<MassPlan>,
    #[serde(default)]
    pub(super) parts: Vec<PartPlan>,
    /// Slabs that may be repeated, where the modules do not imply them.
    #[serde(default)]
    pub(super) repeat: RepeatPlan,
}

/// From and to along each axis.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RepeatPlan {
    pub(super) x: Option<[f64; 2]>,
    pub(super) y: Option<[f64; 2]>,
    pub(super) z: Option<[f64; 2]>,
}

/// A box of storeys on one another.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MassPlan {
    pub(super) size_m: [f32; 2],
    /// Its middle.
    #[serde(default)]
    pub(super) at_m: [f32; 2],
    /// Where it begins.
    #[serde(default)]
    pub(super) base_m: f32,
    /// Finish of its underside, where that can be seen.
    pub(super) soffit: Option<String>,
    pub(super) levels: Vec<LevelPlan>,
    pub(super) roof: Option<RoofPlan>,
}

/// Storeys that are alike.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LevelPlan {
    pub(super) storey_m: f32,
    #[serde(default = "one")]
    pub(super) count: u32,
    /// Finishes of front, right, back and left, in turn; none: it is open.
    #[serde(default)]
    pub(super) walls: Vec<String>,
    /// Mouldings around every storey.
    #[serde(default)]
    pub(super) bands: Vec<BandPlan>,
    pub(super) arcade: Option<ArcadePlan>,
    pub(super) deck: Option<DeckPlan>,
}

/// A moulding around a storey.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BandPlan {
    pub(super) finish: String,
    /// From and to above the storey's foot.
    pub(super) between_m: [f32; 2],
    pub(super) out_m: f32,
    /// Only around the topmost of the level's storeys.
    #[serde(default)]
    pub(super) top: bool,
}

/// A walk behind piers along the front.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArcadePlan {
    pub(super) finish: String,
    pub(super) deep_m: f32,
    /// Width and depth of a pier.
    pub(super) pier_m: [f32; 2],
    /// Between the middles of two piers.
    pub(super) every_m: f32,
    /// Height of the beam over the piers.
    pub(super) beam_m: f32,
}

/// Open storeys between slabs.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DeckPlan {
    pub(super) finish: String,
    pub(super) parapet: String,
    pub(super) parapet_m: f32,
    pub(super) slab_m: f32,
    /// Between columns, along x and y.
    pub(super) columns_m: [f32; 2],
}

/// What closes a mass.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum RoofPlan {
    Flat {
        covering: String,
        coping: String,
        parapet_m: f32,
    },
    /// With its ridge along x, or across; `hip_m` pulls the ridge's ends in.
    Pitched {
        tiles: String,
        gable: String,
        rise_m: f32,
        #[serde(default)]
        hip_m: f32,
        #[serde(default)]
        across: bool,
    },
    Mansard {
        tiles: String,
        covering: String,
        trim: String,
        rise_m: f32,
        in_m: f32,
    },
}

fn one() -> u32 {
    1
}

impl LevelPlan {
    pub(super) fn height_m(&self) -> f32 {
        self.storey_m * self.count as f32
    }
}

impl MassPlan {
    /// Its levels, each with the height of its foot.
    pub(super) fn levels(&self) -> impl Iterator<Item = (f32, &LevelPlan)> {
        self.levels.iter().scan(self.base_m, |z, level| {
            let foot = *z;
            *z += level.height_m();
            Some((foot, level))
        })
    }

    pub(super) fn top_m(&self) -> f32 {
        self.base_m + self.levels.iter().map(LevelPlan::height_m).sum::<f32>()
    }

    fn finishes(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.soffit.as_deref().into_iter().collect();
        for level in &self.levels {
            names.extend(level.walls.iter().map(String::as_str));
            names.extend(level.bands.iter().map(|band| &*band.finish));
            names.extend(level.arcade.iter().map(|arcade| &*arcade.finish));
            names.extend(level.deck.iter().flat_map(|deck| [&*deck.finish, &*deck.parapet]));
        }
        match &self.roof {
            Some(RoofPlan::Flat { covering, coping, .. }) => names.extend([&**covering, coping]),
            Some(RoofPlan::Pitched { tiles, gable, .. }) => names.extend([&**tiles, gable]),
            Some(RoofPlan::Mansard { tiles, covering, trim, .. }) => names.extend([&**tiles, covering, trim]),
            None => {}
        }
        names
    }

    fn check(&self) -> Result<(), Wrong> {
        within("masses.size_m", "metres from 1 to 200", 1.0..=200.0, &self.size_m)?;
        within("masses.at_m", "metres from -100 to 100", -100.0..=100.0, &self.at_m)?;
        within("masses.base_m", "metres from 0 to 300", 0.0..=300.0, [&self.base_m])?;
        for level in &self.levels {
            within("masses.levels.storey_m", "metres from 0.1 to 100", 0.1..=100.0, [&level.storey_m])?;
            if !(1..=100).contains(&level.count) || level.walls.len() > 4 {
                return wrong("masses.levels", "1 to 100 storeys with at most 4 walls", &(level.count, &level.walls));
            }
            if let Some(arcade) = &level.arcade {
                let numbers = [arcade.deep_m, arcade.every_m, arcade.beam_m, arcade.pier_m[0], arcade.pier_m[1]];
                within("masses.levels.arcade", "metres from 0.1 to 20", 0.1..=20.0, &numbers)?;
            }
            if let Some(deck) = &level.deck {
                within("masses.levels.deck.columns_m", "metres from 2 to 50", 2.0..=50.0, &deck.columns_m)?;
            }
        }
        Ok(())
    }
}

impl BuildingPlan {
    /// The key of a value that nothing can be built from, with what was expected and what it is.
    pub(crate) fn check(&self) -> Result<(), Wrong> {
        within("commonness", "a number from 0 to 1000", 0.0..=1000.0, [&self.commonness])?;
        let is_code = |code: &&String| code.len() == 2 && code.chars().all(|c| c.is_ascii_uppercase());
        if let Some(wrong_code) = self.countries.iter().find(|code| !is_code(code)) {
            return wrong("countries", "ISO 3166-1 codes of countries, such as GB", wrong_code);
        }
        within("module_m", "metres from 0 to 100", 0.0..=100.0, &self.module_m)?;
        if !(1..=20).contains(&self.masses.len()) || self.parts.len() > 100 {
            return wrong("masses", "1 to 20 masses and at most 100 parts", &(self.masses.len(), self.parts.len()));
        }
        self.masses.iter().try_for_each(MassPlan::check)?;
        self.parts.iter().try_for_each(|part| part.check(self.masses.len()))?;
        for slab in [self.repeat.x, self.repeat.y, self.repeat.z].into_iter().flatten() {
            if !(slab[0] < slab[1] && slab.iter().all(|m| (-200.0..=400.0).contains(m))) {
                return wrong("repeat", "metres, from below upwards", &slab);
            }
        }
        let colors = self.finishes.values().flat_map(|finish| finish.colors.iter().flatten());
        within("finishes.colors", "linear RGB from 0 to 2", 0.0..=2.0, colors)?;
        let mut named =
            self.masses.iter().flat_map(MassPlan::finishes).chain(self.parts.iter().flat_map(PartPlan::finishes));
        match named.find(|name| !self.finishes.contains_key(*name) && !finish::is_known(name)) {
            Some(unknown) => wrong("finish", "one of its finishes, a common one or a surface's id", &unknown),
            None => Ok(()),
        }
    }
}
