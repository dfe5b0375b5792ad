//! A trace of positions alone (GPX, or CSV of WGS84 or ECEF) with a rig → a `Drive` without boxes.
//!
//! Fixes that cannot be are dropped and reported; the rest are smoothed by robust local regression (Cleveland 1979), and
//! keyframes stand along them at equal distances or times. World is x east, y north, with its origin at the first fix.

mod clean;
mod csv;
mod drive;
mod fix;
mod gpx;
mod smooth;
mod source;
mod times;

pub(crate) use source::DATASET;
