//! Files → `Drive`, `StreetMap`, `EnvironmentMap`, `AssetLibrary`, `HumanBody`, `Locale`.
//!
//! What goes in: paths. What comes out: the model's nouns. A dataset's peculiarities (axis order, quaternion order,
//! class names, time units) end here; this crate must not know how scenes are built, rendered or written.

pub mod asset_files;
mod datasets;
pub mod drive_source;
pub mod environment;
mod error;
mod geo_extent;
pub mod human_body;
pub mod locale;
pub mod nuscenes;
pub mod osm;

pub use datasets::DATASETS;
pub use error::ReadError;
