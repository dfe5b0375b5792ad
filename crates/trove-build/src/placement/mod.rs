//! The annotated objects and the recording vehicle as assets on the ground.

mod cast;
mod choice;
mod cycle;
mod fit;
mod gait;
mod rows;
mod shown;
mod stand;

pub(crate) use cast::{Cast, Casting, Role, ego_cuboid};
pub use choice::{AssetFit, ObjectFit};
pub(crate) use shown::Shown;
pub(crate) use stand::Stand;
