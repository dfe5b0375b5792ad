//! The annotated objects and the recording vehicle as assets on the ground.

mod cast;
mod fit;
mod rows;
mod stand;

pub(crate) use cast::{Role, cast};
pub(crate) use stand::{Placement, Stand};
