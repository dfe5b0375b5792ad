//! The nuScenes reader on a small made-up dataset, whole and damaged, and on real scenes.

#![allow(clippy::unwrap_used)] // the lint knows test functions, not the functions that they share

mod bad_input;
mod between;
mod fixture;
mod join;
mod kept_index;
mod real;
mod relatives;
