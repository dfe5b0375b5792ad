//! The JSON files of an output folder, and of drives in the plain form, as types.
//!
//! Everything that writes or reads `manifest.json`, `report.json`, `site.json`, `frame.json`, `sweep.json`, `radar.json`, `grid.json`, `trajectory.json`, `lanes.json`, `curated.json` or the files
//! in `.trove/`, and the `drive.json` of a recording in the plain form, does it through these types. The schemas in `docs/schema` are generated from them:
//! `TROVE_WRITE_SCHEMAS=1 cargo test -p trove-format schemas` writes them anew.
//!
//! Readers ignore fields that they do not know, and take `null` or an empty value where an optional field is missing.
//!
//! ```
//! use trove_format::{Curated, FormatError, FrameTable, Manifest};
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
//!
//! let folder = tempfile::tempdir()?;
//! assert_eq!(cars(folder.path())?, 0, "nothing is finished yet");
//! std::fs::write(folder.path().join("manifest.json"), r#"{"format": 1, "frames": []}"#)?;
//! assert!(matches!(cars(folder.path()), Err(FormatError::Version { found: Some(1), .. })), "an older trove's folder");
//!
//! let chosen = Curated { train: vec!["demo-0001/v00/k002/ego.CAM_FRONT".into()], ..Curated::default() };
//! let path = folder.path().join(Curated::NAME);
//! std::fs::write(&path, chosen.to_json())?;
//! assert_eq!(Curated::read(&path)?, chosen);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod class_map_file;
mod curated;
mod error;
mod file;
mod frame;
mod frame_file;
mod grid;
mod journal;
mod lanes;
mod manifest;
mod masks;
mod names;
mod plain_drive;
mod radar;
mod report;
mod rows;
#[cfg(test)]
mod schemas;
mod site;
mod sweep;
#[cfg(test)]
mod tests;
mod trajectory;

pub use class_map_file::ClassMapFile;
pub use curated::Curated;
pub use error::FormatError;
pub use file::FORMAT;
pub use frame::{FrameTable, GlassPolicy, LensModel, Matrix4, ObjectOrigin, ObjectRow, Projection};
pub use frame_file::FrameFile;
pub use grid::{GridClass, GridObject, GridTable};
pub use journal::{FrameLine, Inputs, Journal, JournalLine, PlanLine, RunIdentity, Versions, WrittenFile};
pub use lanes::{KerbRow, LaneRow, LanesFile, LineRow};
pub use manifest::{ClassEntry, Counterfactual, FrameRow, MadeRows, Manifest, ManifestDrive, ManifestRows, PartEntry};
pub use masks::{MaskRow, MaskTable, RunLengths};
pub use plain_drive::{
    PlainBox, PlainCamera, PlainDrive, PlainEgoBody, PlainGeoPose, PlainGeoreference, PlainKeyframe, PlainLane,
    PlainLaneMap, PlainLaneMark, PlainLidar, PlainMoment, PlainPicture, PlainPolygon, PlainPose, PlainSweep,
};
pub use radar::RadarTable;
pub use report::{EntryRow, ReportTable, RunReport, SceneReport};
pub use site::{
    AssetFitRow, DriveProjection, DriveRow, Factors, FitRow, LightFactor, LocaleRow, ProjectionKind, SiteFile, Source,
};
pub use sweep::{SweepTable, SweptObject};
pub use trajectory::{EgoMoment, EgoPose, TrajectoryFile};
