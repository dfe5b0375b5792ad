//! The JSON files of an output folder, as types.
//!
//! Everything that writes or reads `manifest.json`, `report.json`, `site.json`, `frame.json`, `curated.json` or the files
//! in `.trove/` does it through these types. The schemas in `docs/schema` are generated from them:
//! `TROVE_WRITE_SCHEMAS=1 cargo test -p trove-format schemas` writes them anew.
//!
//! Readers ignore fields that they do not know, and take `null` or an empty value where an optional field is missing.
//!
//! ```
//! use trove_format::{FormatError, FrameTable, Manifest};
//!
//! /// How many cars a finished folder's frames show.
//! fn cars(folder: &std::path::Path) -> Result<usize, FormatError> {
//!     let manifest = Manifest::read(folder)?;
//!     let mut cars = 0;
//!     for frame in manifest.iter().flat_map(|manifest| &manifest.frames) {
//!         let table = FrameTable::read(&folder.join(&frame.path))?;
//!         cars += table.objects.iter().filter(|o| o.class == trove_model::Class::Car && o.visible_px > 0).count();
//!     }
//!     Ok(cars)
//! }
//! assert_eq!(cars(std::path::Path::new("a folder that is not there"))?, 0);
//! # Ok::<(), FormatError>(())
//! ```

mod curated;
mod error;
mod file;
mod frame;
mod frame_file;
mod journal;
mod manifest;
mod names;
mod report;
#[cfg(test)]
mod schemas;
mod site;
#[cfg(test)]
mod tests;

pub use curated::Curated;
pub use error::FormatError;
pub use file::FORMAT;
pub use frame::{FrameTable, LensModel, Matrix4, ObjectRow, Projection};
pub use frame_file::FrameFile;
pub use journal::{FrameLine, Journal, RunIdentity, Versions, WrittenFile};
pub use manifest::{ClassEntry, Counterfactual, FrameRow, Manifest, ManifestDrive};
pub use report::{EntryRow, ReportTable, RunReport, SceneReport};
pub use site::{
    AssetFitRow, DriveProjection, DriveRow, Factors, FitRow, LightFactor, LocaleRow, ProjectionKind, SiteFile, Source,
};
