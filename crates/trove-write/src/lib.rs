//! `Capture` → files.
//!
//! What goes in: pictures, labels and the scene they show. What comes out: files that other tools open, each whole or
//! not there. This crate must not know how any of it was made.
//!
//! ```
//! use trove_model::Raster;
//! use trove_write::{sha256_file, write_picture};
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("gradient.png");
//! let gradient = Raster::from_fn(16, 9, |x, y| [16 * x as u8, 28 * y as u8, 128]);
//! write_picture(&path, &gradient)?;
//!
//! let back = image::open(&path)?.into_rgb8();
//! assert_eq!((back.dimensions(), back.get_pixel(15, 8).0), ((16, 9), [240, 224, 128]));
//! assert_eq!(sha256_file(&path)?.len(), 64);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod colors;
pub mod contact_sheet;
mod counted;
mod detections_file;
mod error;
mod export;
mod exr_file;
mod exr_parts;
mod files;
mod frame;
mod frame_folders;
mod frame_table;
pub mod gltf;
mod grid;
mod jpeg;
mod label_pictures;
mod masks;
mod npy;
mod npz;
mod picture;
mod plain_drive;
mod png_file;
mod points_file;
mod radar_cycle;
mod sheet;
mod stored_frame;
mod sweep;

pub use error::WriteError;
pub use export::{Choice, DatasetFormat, Exported, Watch, export};
pub use files::{Maker, sha256, sha256_file, write_atomically};
pub use frame::Frame;
pub use frame_folders::FrameFolders;
pub use frame_table::FrameMeta;
pub use grid::Grid;
pub use jpeg::packed as encode_jpeg;
pub use label_pictures::LabelPictures;
pub use masks::{mask_table, painted};
pub use picture::{encode_picture, write_picture};
pub use plain_drive::{PlainFiles, write_plain_drive};
pub use radar_cycle::{RadarCycle, StoredRadarCycle};
pub use sheet::write_sheet;
pub use stored_frame::StoredFrame;
pub use sweep::{StoredSweep, Sweep};
