//! `Drive` + `StreetMap` + `AssetLibrary` → `Scene` and its `Shot`s.
//!
//! What goes in: the model's nouns. What comes out: the virtual scene of every keyframe and the cameras in it. This
//! crate must not know files, datasets' formats or the renderer.

mod agreement;
mod assembly;
mod buildings;
mod clearance;
mod distance_field;
mod error;
mod furniture;
mod ground;
mod kerbs;
mod light;
mod moments;
mod palette;
mod piece;
mod placement;
mod plane;
mod plane_raster;
mod roads;
mod scenery;
mod seeds;
mod segments;
mod site;
mod stock;
mod surroundings;
#[cfg(test)]
mod testing;
mod traffic;
mod vegetation;
mod views;
mod weather;

pub use agreement::{OnDisagreement, agreed};
pub use error::BuildError;
pub use light::{LightChoice, Moment, SkyChoice};
pub use placement::{AssetFit, ObjectFit};
pub use seeds::Seeds;
pub use site::{BuildSettings, Site, area, build};
pub use traffic::Traffic;
pub use views::{ALL_CAMERAS, LensChange, PictureSize, ViewSettings, place_drive, shots};
pub use weather::Weather;
