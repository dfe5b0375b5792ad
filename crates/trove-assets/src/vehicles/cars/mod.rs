//! Passenger cars and vans, each made as a plan in a data file tells.
//!
//! Boxes of data sets are as wide as bodies, without mirrors; so are these models' measures, and the mirrors are an
//! extra that every one of them has.

mod build;
mod cabin;
mod check;
mod ends;
mod extras;
mod finish;
mod fittings;
mod grid;
mod plan;
mod shell;

pub(crate) use finish::assets;
pub(crate) use plan::CarPlan;
