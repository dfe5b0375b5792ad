//! Where light comes from.

mod beam;
mod cdf;
mod cells;
mod emitters;
mod haze;
mod lights;
mod patches;
mod sky;
mod sun;
mod tree;

pub use beam::{Aim, BeamTable, Beams};
pub use cdf::Cdf;
pub use cells::{Cell, Cells, Within, direction_at, place_of, solid_angle_of_area};
pub use emitters::{Emitter, EmitterPoint, Emitters, Pattern, barycentric};
pub use haze::Haze;
pub use lights::{LightSample, Lights, Rest};
pub use patches::{ACROSS, BELOW, Patch, Patches};
pub use sky::{Picture, Sky};
pub use sun::{SUN_RADIUS_RAD, Sun};
pub use tree::{Cut, Group, GroupAim, LEAF, LEAST_SHARE, Tree};
