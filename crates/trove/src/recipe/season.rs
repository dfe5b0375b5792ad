//! Seasons as recipes name them.

use serde::{Deserialize, Serialize};
use trove_model::Season;

/// A season, or the recording's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs)] // the names are the definition
pub enum SeasonChoice {
    /// Of the recording, or of `light.time` where that is given.
    #[default]
    Recorded,
    Spring,
    Summer,
    Autumn,
    Winter,
}

impl From<SeasonChoice> for Option<Season> {
    fn from(chosen: SeasonChoice) -> Self {
        match chosen {
            SeasonChoice::Recorded => None,
            SeasonChoice::Spring => Some(Season::Spring),
            SeasonChoice::Summer => Some(Season::Summer),
            SeasonChoice::Autumn => Some(Season::Autumn),
            SeasonChoice::Winter => Some(Season::Winter),
        }
    }
}
