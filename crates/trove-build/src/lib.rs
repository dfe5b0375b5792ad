//! `Drive` + `StreetMap` + `AssetLibrary` → `Scene` and its `Shot`s.
//!
//! What goes in: the model's nouns. What comes out: the virtual scene of every keyframe and the cameras in it. This
//! crate must not know files, datasets' formats or the renderer.
//!
//! ```
//! use glam::DVec2;
//! use trove_build::{BuildSettings, LightChoice, OnDisagreement, PlacePlan, Traffic, ViewPlan, ViewSettings, Weather};
//! use trove_model::{AssetLibrary, Class, DrivingSide, MapProjection, Report, Road, RoadKind, Seed, StreetMap};
//!
//! // One street in London, without models to furnish it.
//! let ends = vec![DVec2::new(-100.0, 0.0), DVec2::new(100.0, 0.0)];
//! let map = StreetMap { roads: vec![Road::new(1, RoadKind::Residential, ends)], ..StreetMap::default() };
//! let plan = PlacePlan {
//!     name: "a street",
//!     projection: MapProjection::spherical(51.501, -0.141, DVec2::ZERO),
//!     size_m: 120.0,
//!     driving_side: DrivingSide::Left,
//!     time_ns: 1_718_452_800_000_000_000, // noon in June
//! };
//! let (seed, report) = (Seed(7), Report::default());
//! let drive = trove_build::place_drive(&map, &plan, seed, &report)?;
//!
//! let settings = BuildSettings {
//!     seeds: seed.into(),
//!     top_k: 1,
//!     traffic: Traffic::default(),
//!     light: LightChoice::default(),
//!     weather: Weather::default(),
//!     on_disagreement: OnDisagreement::default(),
//!     invent: false,
//!     locale: trove_read::locale::Locales::built_in().country("GB").expect("a country of the table").clone(),
//!     borders: None,
//! };
//! let site = trove_build::build(&drive, Some(&map), &AssetLibrary::default(), &settings, &report)?;
//!
//! let scene = site.scene(&drive, 0);
//! assert!(scene.instances.iter().any(|instance| instance.class == Class::Road));
//! let views = ViewSettings { spp: 16, ..ViewSettings::default() };
//! let shots = ViewPlan::new(&drive, &site, views, seed.into(), &report).shots(&drive, &site, 0, &report);
//! assert_eq!(shots.len(), 6, "cameras around the roof");
//! # Ok::<(), trove_build::BuildError>(())
//! ```

mod agreement;
mod assembly;
mod between;
mod buildings;
mod error;
mod furniture;
mod geometry;
mod grids;
mod ground;
mod light;
mod pieces;
mod place;
mod placement;
mod radars;
mod roads;
mod scanners;
mod site;
mod skyline;
mod snow;
mod spray;
mod standing;
mod surroundings;
#[cfg(test)]
mod testing;
mod traffic;
mod vegetation;
mod views;

pub use agreement::{OnDisagreement, agreed};
pub use assembly::Weather;
pub use between::{Moments, Timeline, between};
pub use error::BuildError;
pub use grids::grid_shots;
pub use light::{LightChoice, Moment, SkyChoice};
pub use place::{PlacePlan, Seeds, place_drive};
pub use placement::{AssetFit, ObjectFit};
pub use radars::{MountedRadar, radar_shots};
pub use roads::{HORIZON_M, with_bends};
pub use scanners::{MountedLidar, lidar_shots};
pub use site::{BuildSettings, Site, area, build, build_at};
pub use standing::on_relief;
pub use traffic::Traffic;
pub use views::{ALL_CAMERAS, LensChange, PictureSize, ViewPlan, ViewSettings};
