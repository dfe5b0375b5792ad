//! The Waymo reader, on made-up and on real segments.

#![allow(clippy::unwrap_used)] // the lint knows test functions, not the functions that they share

mod bad_input;
mod forms;
mod panoptic;
mod parquet_writer;
mod real;
#[path = "writer.rs"]
mod waymo_writer;
