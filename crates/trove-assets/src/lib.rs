//! The built-in, generated `AssetLibrary`.
//!
//! What goes in: [`Ingredients`]. What comes out: models and surfaces, the same for the same ingredients. This crate
//! must not know files, datasets or how scenes are built and rendered.
//!
//! A library of its own from a plan, as users' libraries bring them:
//!
//! ```
//! use trove_assets::Plans;
//!
//! let text = "[[car]]\nid = \"long\"\nlike = \"car/estate\"\n[car.profile]\nlength_m = 4.9\n";
//! let library = Plans::parse(text)?.library("mine", None);
//! assert_eq!(library.assets[0].id, "mine/long");
//! assert!((library.assets[0].size_m.x - 4.9).abs() < 0.1);
//!
//! let mistake = Plans::parse(&text.replace("estate", "estat")).unwrap_err();
//! assert!(mistake.to_string().contains("car/estate"));
//! # Ok::<(), trove_assets::PlanError>(())
//! ```

mod buildings;
mod countries;
mod cycles;
mod licence;
mod measure;
mod people;
mod plans;
mod plants;
mod shape;
mod street;
mod surfaces;
#[cfg(test)]
mod tests;
mod vehicles;

use rayon::prelude::*;
use trove_model::{Asset, AssetLibrary, HumanBody, Surface};

pub use plans::{FILE_NAME as PLANS_FILE, PlanError, Plans};

/// Changes whenever the sources do from which a library is generated.
pub const SOURCES: &str = env!("TROVE_ASSETS_SOURCES");

/// What the library is made from and how finely.
#[derive(Clone, Copy, Debug)]
pub struct Ingredients<'a> {
    /// What people are made from; `None`: plainer figures.
    pub human_body: Option<&'a HumanBody>,
    /// Resolution of the textures as a multiple of the ordinary one: 1 (at most 1024 texels a side), 2 or 4 (4096).
    pub texture_scale: u32,
}

impl Default for Ingredients<'_> {
    fn default() -> Self {
        Self { human_body: None, texture_scale: 1 }
    }
}

/// Every built-in model and surface, sorted by id.
pub fn library(ingredients: &Ingredients<'_>) -> AssetLibrary {
    let mut surfaces = surfaces::surfaces(&Plans::built_in().facades, ingredients.texture_scale);
    surfaces.sort_by(|a, b| a.id.cmp(&b.id));
    let mut assets = assets(ingredients, &surfaces);
    if ingredients.texture_scale > 1 {
        surfaces::refine(&mut assets, &surfaces);
    }
    AssetLibrary { assets, surfaces, covers: plants::covers() }
}

/// Every model, sorted by id; buildings wear these surfaces, or plain colours where one is not there.
fn assets(ingredients: &Ingredients<'_>, surfaces: &[Surface]) -> Vec<Asset> {
    let cars = || vehicles::assets(&Plans::built_in().cars);
    let plants = || plants::assets(&Plans::built_in().plants);
    let street = || street::assets(&Plans::built_in().street);
    let families: [fn() -> Vec<Asset>; 4] = [cars, cycles::assets, plants, street];
    let (mut assets, people): (Vec<Asset>, Vec<Asset>) = rayon::join(
        || families.par_iter().flat_map_iter(|family| family()).collect(),
        || people::assets(&Plans::built_in().persons, ingredients.human_body),
    );
    assets.extend(people);
    assets.extend(buildings::assets(&Plans::built_in().buildings, surfaces));
    assets.sort_by(|a, b| a.id.cmp(&b.id));
    assets
}
