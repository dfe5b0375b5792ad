//! Whether labels agree with themselves, with the image, and over views and times.
//!
//! Frames of `trove generate` are handed over by whoever can read them; datasets in other forms are read here.

mod camvid;
mod cityscapes;
mod coco;
mod extra;
mod finding;
mod flow;
mod form;
mod frame;
mod image;
mod kitti;
mod label_image;
mod moments;
mod nuscenes;
mod polygons;
mod report;
mod rle;
mod single;
#[cfg(test)]
mod tests;
mod tracks;
mod views;
mod worst;

pub use finding::{Audit, Check, Finding, Tally};
pub use form::{LabelForm, audit};
pub use frame::{LabelledFrame, LabelledSweep, patches};
pub use moments::FrameReader;
pub use report::report;
pub use worst::{picture, worst_in_turn};
