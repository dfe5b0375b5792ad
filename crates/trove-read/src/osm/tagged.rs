//! Tags of one thing, read with a word about every value that cannot be used.

use std::fmt::Display;
use std::ops::RangeInclusive;

use trove_model::{Outcome, Report};

use super::raw::Tags;

/// The tags of a thing that `owner` names.
pub(super) struct Tagged<'a> {
    pub(super) tags: &'a Tags,
    pub(super) owner: &'a dyn Display,
    pub(super) report: &'a Report,
}

impl Tagged<'_> {
    /// The value of the first key that is tagged, where it can be read and lies in the range.
    pub(super) fn number(
        &self,
        keys: &[&str],
        read: fn(&str) -> Option<f64>,
        range: RangeInclusive<f64>,
    ) -> Option<f64> {
        self.parsed(keys, |text| read(text).filter(|value| range.contains(value)))
    }

    /// The value of the first key that is tagged, where it can be read.
    pub(super) fn parsed<T>(&self, keys: &[&str], read: impl Fn(&str) -> Option<T>) -> Option<T> {
        let text = self.tags.first(keys);
        if text.is_empty() {
            return None;
        }
        let value = read(text);
        if value.is_none() {
            self.refuse(&format!("{} that cannot be used", keys[0]), text);
        }
        value
    }

    /// Notes a value that is not used, and why.
    pub(super) fn refuse(&self, why: &str, value: &str) {
        self.report.note(Outcome::Dropped, &format!("osm: {why}"), format!("{}: {value}", self.owner));
    }
}
