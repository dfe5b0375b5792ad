//! What is known of a place before anything is built on its ground, and the drive of one that nobody drove through.

mod conditions;
mod made_up;
mod moments;
mod seeds;

use trove_model::{AssetLibrary, Bounds, Drive, HeightField, Locale, Report, StreetMap};

pub(crate) use conditions::Conditions;
pub use made_up::{PlacePlan, place_drive};
pub(crate) use moments::{apart_s, moment_s, next, previous};
pub use seeds::Seeds;

/// What a place is built from, and what its builders draw from and report to.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    /// The recording.
    pub drive: &'a Drive,
    /// The street map, laid on the recording; `None` where there is none.
    pub map: Option<&'a StreetMap>,
    /// Whether that map is none but made up from the recording, streets without houses.
    pub is_assumed: bool,
    /// Whether buildings are made up where that map may lack them.
    pub invents: bool,
    /// The area that is built, World, metres.
    pub bounds: Bounds,
    /// Height of the carriageway.
    pub ground: &'a HeightField,
    /// Models and surfaces, as they look in the season.
    pub library: &'a AssetLibrary,
    /// Whose customs it follows.
    pub locale: &'a Locale,
    /// What plants grow under.
    pub conditions: Conditions,
    /// The sources of all randomness in it.
    pub seeds: &'a Seeds,
    /// Takes what is dropped, guessed or substituted.
    pub report: &'a Report,
}
