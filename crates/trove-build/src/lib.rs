//! `Drive` + `StreetMap` + `AssetLibrary` → `Scene` and its `Shot`s.
//!
//! What goes in: the model's nouns. What comes out: the virtual scene of every keyframe and the cameras in it. This
//! crate must not know files, datasets' formats or the renderer.

mod agreement;
mod assembly;
mod buildings;
mod error;
mod furniture;
mod geometry;
mod ground;
mod light;
mod pieces;
mod place;
mod placement;
mod roads;
mod site;
mod surroundings;
#[cfg(test)]
mod testing;
mod traffic;
mod vegetation;
mod views;

pub use agreement::{OnDisagreement, agreed};
pub use assembly::Weather;
pub use error::BuildError;
pub use light::{LightChoice, Moment, SkyChoice};
pub use place::{PlacePlan, Seeds, place_drive};
pub use placement::{AssetFit, ObjectFit};
pub use site::{BuildSettings, Site, area, build};
pub use traffic::Traffic;
pub use views::{ALL_CAMERAS, LensChange, PictureSize, ViewSettings, shots};
