//! Numbers of plans that nothing can be built from, refused before it is tried.

use std::fmt::Debug;
use std::ops::RangeInclusive;

/// A key, what was expected there, what was found.
pub(crate) type Wrong = (&'static str, &'static str, String);

/// Refuses numbers outside a range, which `expected` tells of; what is not a number is in none.
pub(crate) fn within<'a>(
    key: &'static str,
    expected: &'static str,
    range: RangeInclusive<f32>,
    numbers: impl IntoIterator<Item = &'a f32>,
) -> Result<(), Wrong> {
    match numbers.into_iter().find(|n| !range.contains(n)) {
        Some(found) => wrong(key, expected, found),
        None => Ok(()),
    }
}

/// Says what was found in place of what was expected.
pub(crate) fn wrong(key: &'static str, expected: &'static str, found: &dyn Debug) -> Result<(), Wrong> {
    Err((key, expected, format!("{found:?}")))
}

/// The commonness of what does not say it: as common as most.
pub(crate) fn ordinary() -> f32 {
    1.0
}
