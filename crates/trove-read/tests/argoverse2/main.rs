//! The Argoverse 2 reader, on small logs that the tests write and on the real one.

#![allow(clippy::unwrap_used)] // the lint knows test functions, not the functions that they share

mod bad_input;
mod fixture;
mod real;
mod small;
mod utm;
