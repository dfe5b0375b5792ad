//! What labels tell.

use serde::{Deserialize, Serialize};
use trove_format::GlassPolicy;

/// `[labels]`
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct LabelsSection {
    /// What they tell of panes of glass.
    pub glass: GlassPolicy,
}
