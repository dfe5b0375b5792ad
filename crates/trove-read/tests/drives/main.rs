//! One canonical drive, written in every dataset's form, comes back from every reader.

#![allow(clippy::unwrap_used)] // the lint knows test functions, not the functions that they share

mod canonical;
mod comparison;
mod nuscenes;
