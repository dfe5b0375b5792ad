//! What made-up things are placed by.

mod clearance;
mod kerbs;

use trove_model::{Bounds, Drive, Locale, StreetMap};

use crate::placement::Stand;

pub(crate) use clearance::{Clearance, Room, recorded};
pub(crate) use kerbs::{KERB_STEP_M, KerbPoint, Kerbs};

/// The place as far as it is built when plants and furniture come.
pub(crate) struct Surroundings<'a> {
    /// The recording.
    pub drive: &'a Drive,
    /// The map.
    pub map: Option<&'a StreetMap>,
    /// Whose customs it follows.
    pub locale: &'a Locale,
    /// The area that is built.
    pub bounds: Bounds,
    /// Edges of the carriageway.
    pub kerbs: &'a Kerbs,
    /// The ground.
    pub stand: Stand<'a>,
}
