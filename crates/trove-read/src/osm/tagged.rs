//! Tags of one thing, read with a word about every value that cannot be used.

use std::fmt::Display;
use std::ops::RangeInclusive;

use trove_model::{Outcome, Report};

use super::raw::Tags;
use super::vocabulary::{Said, Vocabulary};

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

    /// What the first of some keys that says anything means; where none does, a word that is not known is noted.
    pub(super) fn word<T: Copy>(&self, keys: &[&str], vocabulary: &Vocabulary<T>) -> Option<T> {
        self.words(keys, vocabulary).first().copied()
    }

    /// What each of some keys means, of those that say anything.
    pub(super) fn words<T: Copy>(&self, keys: &[&str], vocabulary: &Vocabulary<T>) -> Vec<T> {
        let (mut meanings, mut unknown) = (Vec::new(), Vec::new());
        for &key in keys {
            match vocabulary.read(self.tags.get(key)) {
                Said::Meaning(meaning) => meanings.push(meaning),
                Said::Unknown => unknown.push(key),
                Said::Nothing => {}
            }
        }
        for key in unknown.into_iter().filter(|_| meanings.is_empty()) {
            self.refuse(&format!("unknown {key}"), self.tags.get(key));
        }
        meanings
    }

    /// Notes a value that is not used, and why.
    pub(super) fn refuse(&self, why: &str, value: &str) {
        self.report.note(Outcome::Dropped, &format!("osm: {why}"), format!("{}: {value}", self.owner));
    }
}
