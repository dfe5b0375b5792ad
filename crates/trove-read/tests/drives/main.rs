//! One canonical drive, written in every dataset's form, comes back from every reader.

#![allow(clippy::unwrap_used)] // the lint knows test functions, not the functions that they share

mod argoverse2;
mod canonical;
mod comparison;
mod kitti;
mod nuscenes;
#[allow(dead_code)] // the reader's other tests use the rest
#[path = "../waymo/parquet_writer.rs"]
mod parquet_writer;
mod plain;
mod waymo;
#[allow(dead_code)] // the reader's other tests use the rest
#[path = "../waymo/writer.rs"]
mod waymo_writer;
