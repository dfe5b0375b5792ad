//! What is known of a place before anything is built: its seeds, its time and climate, and the drive of one that nobody
//! drove through.

mod conditions;
mod made_up;
mod moments;
mod seeds;

pub(crate) use conditions::Conditions;
pub use made_up::{PlacePlan, place_drive};
pub(crate) use moments::{apart_s, next, previous};
pub use seeds::Seeds;
