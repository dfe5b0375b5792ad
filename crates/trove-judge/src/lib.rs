//! Datasets → verdicts.
//!
//! What goes in: folders of pictures and labels, ours or others'. What comes out: numbers, choices, and pictures in
//! other colours. This crate must not know how any of them were made.

pub mod curate;
mod error;
pub mod evaluate;
mod label_set;
mod pictures;
pub mod recolor;

pub use error::JudgeError;
pub use label_set::{LabelSet, NamedId};
pub use pictures::{OnProgress, thumbnail};
