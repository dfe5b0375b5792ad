//! The JSON files of an output folder, as types.
//!
//! Everything that writes or reads `manifest.json`, `report.json`, `site.json`, `frame.json`, `curated.json` or the files
//! in `.trove/` does it through these types. The schemas in `docs/schema` are generated from them:
//! `TROVE_WRITE_SCHEMAS=1 cargo test -p trove-format schemas` writes them anew.
//!
//! Readers ignore fields that they do not know, and take `null` or an empty value where an optional field is missing.

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

pub use curated::Curated;
pub use error::FormatError;
pub use frame::{FrameTable, LensModel, Matrix4, ObjectRow, Projection};
pub use frame_file::FrameFile;
pub use journal::{FrameLine, Journal, RunIdentity, Versions, WrittenFile};
pub use manifest::{ClassEntry, Counterfactual, FORMAT, FrameRow, Manifest, ManifestDrive};
pub use report::{EntryRow, ReportTable, RunReport, SceneReport};
pub use site::{AssetFitRow, DriveProjection, DriveRow, Factors, FitRow, LightFactor, ProjectionKind, SiteFile, Source};
