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

mod assets;
mod build;
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
mod place;
mod progress;
pub mod recipe;
mod rigs;
pub mod run;
mod sources;
mod street_map;
mod variation;
mod verify;
mod virtual_scene;

pub use cli::main;
pub use trove_model::label_table;

/// Name of the built-in asset library in recipes.
pub const PROCEDURAL: &str = "procedural";
