//! What made-up things are placed by.

use trove_model::{Bounds, Drive, StreetMap};

use crate::kerbs::Kerbs;
use crate::placement::Stand;

/// The place as far as it is built when plants and furniture come.
pub(crate) struct Surroundings<'a> {
    /// The recording.
    pub drive: &'a Drive,
    /// The map.
    pub map: Option<&'a StreetMap>,
    /// The area that is built.
    pub bounds: Bounds,
    /// Edges of the carriageway.
    pub kerbs: &'a Kerbs,
    /// The ground.
    pub stand: Stand<'a>,
}
