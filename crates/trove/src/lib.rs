//! The pipeline (recipe, run, resume, manifest) and the command line: the only crate that knows more than one stage.
//!
//! What goes in: arguments and a recipe. What comes out: folders of pictures with labels, and an exit status.
//!
//! ```
//! use std::ffi::OsString;
//!
//! use trove::recipe::Recipe;
//!
//! let status = |args: &[&str]| trove::main(args.iter().map(OsString::from), &[]);
//! assert_eq!(status(&["trove", "--help"]), 0);
//! assert_eq!(status(&["trove", "generate"]), 2, "wrong usage");
//!
//! let error = Recipe::parse("[drive]\ndataset = \"nuscenes\"\nroot = \"data\"\n[render]\nssp = 16\n").unwrap_err();
//! assert!(error.to_string().contains("did you mean `spp`?"));
//! ```

mod answer;
mod assets;
mod build;
mod built_scene;
mod cache;
mod class_maps;
mod cli;
mod contents;
mod demo;
mod doctor;
mod drives;
mod export;
#[doc(hidden)]
pub mod fuzzing;
mod inspect;
mod interrupt;
mod judge;
mod libraries;
mod library;
mod map;
mod message;
mod overview;
mod photographs;
mod place;
mod progress;
mod ready_scene;
pub mod recipe;
mod rigs;
pub mod run;
mod sources;
mod status;
mod store;
mod street_map;
mod variation;
mod verify;
mod view;
mod virtual_scene;
mod watch;

pub use class_maps::mapped_labels;
pub use cli::{call, main};
pub use ready_scene::{FreeCamera, PictureRequest, ReadyScene};
pub use trove_format::{FrameFile, RunLengths};
pub use trove_model::{Occlusion, Raster, Role, label_table};
pub use trove_write::{StoredFrame, colors, encode_picture, mask_table, painted};
pub use watch::{Follower, Watch};

/// Name of the built-in asset library in recipes.
pub const PROCEDURAL: &str = "procedural";
