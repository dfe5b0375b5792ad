//! What made-up things are placed by.

mod clearance;
mod kerbs;

use crate::place::Place;
use crate::placement::Stand;

pub(crate) use clearance::{Clearance, Room, recorded};
pub(crate) use kerbs::{KERB_STEP_M, KerbPoint, Kerbs};

/// The place as far as it is built when plants and furniture come.
pub(crate) struct Surroundings<'a> {
    /// What it is built from.
    pub place: &'a Place<'a>,
    /// Edges of the carriageway.
    pub kerbs: &'a Kerbs,
    /// The ground.
    pub stand: Stand<'a>,
}
