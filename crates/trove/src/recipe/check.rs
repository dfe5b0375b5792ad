//! What a value of a recipe has to be, and what may have been meant.

use std::fmt::Display;

use anyhow::{Result, ensure};

pub(super) fn check(key: &str, value: impl Display, holds: bool, expected: &str) -> Result<()> {
    ensure!(holds, "{key}: expected {expected}, found {value}");
    Ok(())
}

/// Whether a value is left out of what a recipe is written as.
pub(super) fn is_zero(n: &f64) -> bool {
    *n == 0.0
}

/// The known name that is nearest to an unknown one, as the end of a message.
pub(crate) fn nearest(unknown: &str, known: &[&str]) -> String {
    let nearest = known.iter().min_by_key(|name| strsim::damerau_levenshtein(unknown, name));
    nearest.map(|name| format!("; did you mean `{name}`?")).unwrap_or_default()
}
