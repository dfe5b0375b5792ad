//! Plans of what is generated, as data: the built-in ones, and those of users' libraries in the same form.
//!
//! A file of plans is TOML. `[[car]]`, `[[facade]]`, `[[person]]`, `[[tree]]` and the like are entries, which become assets
//! or surfaces; `[paint.NAME]`, `[face.NAME]`, `[top.NAME]` and other such tables are pieces that entries name. An entry
//! or a piece takes from the one that it is `like` what it does not say itself; users' files take from the built-in
//! ones too.

mod error;
mod file;
#[cfg(test)]
mod tests;

use std::sync::LazyLock;

use serde::de::DeserializeOwned;
use trove_model::{Asset, AssetLibrary, HumanBody, Surface};

pub use error::PlanError;

use crate::buildings::{self, BuildingPlan};
use crate::measure::Wrong;
use crate::people::{self, PersonPlan};
use crate::plants::{self, PlantPlans, RowPlan, ShrubPlan, TreePlan};
use crate::street::{self, ConePlan, FurniturePlan, SignalPlan, StreetPlans, WallPlan};
use crate::surfaces::{self, FacadePlan};
use crate::vehicles::{self, CarPlan};
use file::PlanFile;

/// The name of the file in a user's library.
pub const FILE_NAME: &str = "plans.toml";

const BUILT_IN: &str = concat!(
    include_str!("../../plans/buildings.toml"),
    "\n",
    include_str!("../../plans/cars.toml"),
    "\n",
    include_str!("../../plans/facades.toml"),
    "\n",
    include_str!("../../plans/furniture.toml"),
    "\n",
    include_str!("../../plans/plants.toml"),
    "\n",
    include_str!("../../plans/people.toml"),
);

static BUILT_IN_FILE: LazyLock<PlanFile<'static>> =
    LazyLock::new(|| PlanFile::parse(BUILT_IN, None).expect("a test reads the built-in plans"));

/// What a file of plans asks for.
#[derive(Clone, Debug)]
pub struct Plans {
    pub(crate) buildings: Vec<BuildingPlan>,
    pub(crate) cars: Vec<CarPlan>,
    pub(crate) facades: Vec<FacadePlan>,
    pub(crate) persons: Vec<PersonPlan>,
    pub(crate) plants: PlantPlans,
    pub(crate) street: StreetPlans,
    licence: Option<String>,
}

impl Plans {
    /// Reads a user's file of plans, which may take from the built-in ones.
    ///
    /// # Errors
    /// The text is not TOML, a key is unknown, missing or of another type, or a measure is one that cannot be built.
    pub fn parse(text: &str) -> Result<Self, PlanError> {
        Self::of(&PlanFile::parse(text, Some(&BUILT_IN_FILE))?)
    }

    /// The plans of the built-in library.
    pub(crate) fn built_in() -> &'static Self {
        static PLANS: LazyLock<Plans> =
            LazyLock::new(|| Plans::of(&BUILT_IN_FILE).expect("a test reads the built-in plans"));
        &PLANS
    }

    fn of(file: &PlanFile<'_>) -> Result<Self, PlanError> {
        Ok(Self {
            buildings: checked(file, "building", BuildingPlan::check)?,
            cars: checked(file, "car", CarPlan::check)?,
            facades: checked(file, "facade", FacadePlan::check)?,
            persons: checked(file, "person", PersonPlan::check)?,
            street: StreetPlans {
                cones: checked(file, "cone", ConePlan::check)?,
                furniture: checked(file, "furniture", FurniturePlan::check)?,
                signals: checked(file, "signal", SignalPlan::check)?,
                walls: checked(file, "wall", WallPlan::check)?,
            },
            plants: PlantPlans {
                trees: checked(file, "tree", TreePlan::check)?,
                shrubs: checked(file, "shrub", ShrubPlan::check)?,
                hedges: checked(file, "hedge", RowPlan::check_hedge)?,
                beds: checked(file, "bed", RowPlan::check_bed)?,
            },
            licence: file.licence.clone(),
        })
    }

    /// The ids of those whom only [`HumanBody`] makes, in the order of the file.
    pub fn persons(&self) -> impl Iterator<Item = &str> {
        self.persons.iter().map(|person| person.id.as_str())
    }

    /// The library of a user's plans, with ids that begin with the library's name; sorted by id. Without a body it has
    /// no persons.
    pub fn library(&self, name: &str, body: Option<&HumanBody>) -> AssetLibrary {
        let facades = surfaces::facades(&self.facades);
        let families = [
            self.houses(&facades),
            vehicles::cars(&self.cars),
            street::planned(&self.street),
            plants::planned(&self.plants),
        ];
        let mut library = AssetLibrary { assets: families.concat(), surfaces: facades, ..AssetLibrary::default() };
        for asset in &mut library.assets {
            asset.id = format!("{name}/{}", asset.id);
            asset.licence = self.licence.clone().unwrap_or_else(|| asset.licence.clone());
        }
        for surface in &mut library.surfaces {
            surface.id = format!("{name}/{}", surface.id);
        }
        library.assets.extend(body.map(|body| self.people(name, body)).unwrap_or_default());
        library.assets.sort_by(|a, b| a.id.cmp(&b.id));
        library.surfaces.sort_by(|a, b| a.id.cmp(&b.id));
        library
    }

    /// The buildings, in the built-in surfaces and these facades.
    fn houses(&self, facades: &[Surface]) -> Vec<Asset> {
        if self.buildings.is_empty() {
            return Vec::new();
        }
        let built_in = surfaces::surfaces(&Self::built_in().facades, 1);
        buildings::planned(&self.buildings, &[facades, &built_in].concat())
    }

    /// The persons, whose ids begin with the library's name from the start: textures are named after them.
    fn people(&self, name: &str, body: &HumanBody) -> Vec<Asset> {
        let mut plans = self.persons.clone();
        plans.iter_mut().for_each(|plan| plan.id = format!("{name}/{}", plan.id));
        let assets = people::persons(&plans, body).into_iter();
        assets.map(|a| Asset { licence: self.licence.clone().unwrap_or(a.licence), ..a }).collect()
    }
}

/// The entries under a key, none of which holds a number that cannot be built from.
fn checked<T: DeserializeOwned>(
    file: &PlanFile<'_>,
    key: &'static str,
    check: impl Fn(&T) -> Result<(), Wrong>,
) -> Result<Vec<T>, PlanError> {
    let checked = |(place, plan): (String, T)| match check(&plan) {
        Ok(()) => Ok(plan),
        Err((key, expected, found)) => Err(PlanError::new(format!("{place}: {key}"), expected, found)),
    };
    file.read(key)?.into_iter().map(checked).collect()
}
