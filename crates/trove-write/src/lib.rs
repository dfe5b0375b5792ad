//! `Capture` → files.
//!
//! What goes in: pictures, labels and the scene they show. What comes out: files that other tools open, each whole or
//! not there. This crate must not know how any of it was made.

pub mod contact_sheet;
mod error;
mod export_format;
mod exporter;
mod exr_file;
mod files;
mod frame;
mod frame_folders;
mod frame_table;
pub mod gltf;
mod jpeg;
mod picture;
mod png_file;
mod sheet;

pub use error::WriteError;
pub use export_format::ExportFormat;
pub use exporter::Exporter;
pub use files::{sha256_file, write_atomically};
pub use frame::Frame;
pub use frame_table::FrameMeta;
pub use picture::write_picture;
pub use sheet::write_sheet;
