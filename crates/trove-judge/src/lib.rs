//! Datasets → verdicts.
//!
//! What goes in: folders of pictures and labels, ours or others'. What comes out: numbers, choices, and pictures in
//! other colours. This crate must not know how any of them were made.
//!
//! ```
//! use image::GrayImage;
//! use trove_judge::evaluate;
//! use trove_model::{ClassMap, Seed};
//!
//! // Ids of Cityscapes: 7 is the road, 26 a car. The prediction takes one of the car's two pixels for road.
//! let folder = tempfile::tempdir()?;
//! let [predicted, truth] = ["predicted.png", "truth.png"].map(|name| folder.path().join(name));
//! GrayImage::from_raw(4, 1, vec![7, 7, 7, 26]).expect("four pixels").save(&predicted)?;
//! GrayImage::from_raw(4, 1, vec![7, 7, 26, 26]).expect("four pixels").save(&truth)?;
//!
//! let classes = ClassMap::named("cityscapes");
//! let settings = evaluate::Settings {
//!     classes,
//!     predicted: None,
//!     truth: None,
//!     boundary: false,
//!     panoptic: false,
//!     seed: Seed(0),
//! };
//! let result = evaluate::evaluate(&predicted, &truth, &settings, &|_, _| true)?;
//! let miou = result.miou.expect("classes that are there").value;
//! assert!((miou - (2.0 / 3.0 + 1.0 / 2.0) / 2.0).abs() < 1e-12);
//! assert_eq!(result.accuracy.map(|share| share.value), Some(0.75));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod audit;
pub mod curate;
mod error;
pub mod evaluate;
pub mod looks;
mod numbering;
pub mod page;
mod pictures;
pub mod recolor;

pub use error::JudgeError;
pub use numbering::Numbering;
pub use pictures::{OnProgress, thumbnail};
