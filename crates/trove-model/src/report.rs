//! What was dropped, guessed or substituted on the way.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;
use std::sync::Mutex;

/// How many examples of a kind are kept.
const EXAMPLES: usize = 5;

/// Longer examples are cut, characters.
const LONGEST_EXAMPLE: usize = 1000;

/// What happened to something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    /// It could not be used.
    Dropped,
    /// Something else stands in for it.
    Substituted,
    /// It was not given and was made up.
    Guessed,
    /// It was used, and may not be what is wanted.
    Warned,
}

impl Outcome {
    /// Every outcome.
    pub const ALL: [Self; 4] = [Self::Dropped, Self::Substituted, Self::Guessed, Self::Warned];

    /// Its name in reports (`dropped`).
    pub fn name(self) -> &'static str {
        match self {
            Self::Dropped => "dropped",
            Self::Substituted => "substituted",
            Self::Guessed => "guessed",
            Self::Warned => "warned",
        }
    }
}

/// All that happened of one kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// What happened.
    pub outcome: Outcome,
    /// To what and why (`box of zero size`).
    pub what: String,
    /// How often.
    pub count: u64,
    /// The first few by name, in alphabetical order.
    pub examples: Vec<String>,
}

/// Something measured on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// What (`map.lane_to_road_median_m`).
    pub name: String,
    /// The value.
    pub value: f64,
}

/// Collects what was dropped, guessed or substituted; the same happenings give the same report in any order and
/// from any thread.
#[derive(Debug, Default)]
pub struct Report {
    inner: Mutex<Inner>,
}

impl Clone for Report {
    fn clone(&self) -> Self {
        Self { inner: Mutex::new(self.lock().clone()) }
    }
}

#[derive(Clone, Debug, Default)]
struct Inner {
    entries: BTreeMap<(Outcome, String), (u64, BTreeSet<String>)>,
    measurements: BTreeMap<String, f64>,
}

impl Report {
    /// Notes that `what` happened to `example` (which names the thing and its place). Examples quote files, so control
    /// characters in them are escaped and long ones are cut.
    pub fn note(&self, outcome: Outcome, what: &str, example: impl Display) {
        let mut inner = self.lock();
        let (count, examples) = inner.entries.entry((outcome, what.to_owned())).or_default();
        *count += 1;
        examples.insert(quoted(&example.to_string()));
        if examples.len() > EXAMPLES {
            examples.pop_last();
        }
    }

    /// Notes a measured value; a later one of the same name replaces it.
    pub fn measure(&self, name: &str, value: f64) {
        self.lock().measurements.insert(name.to_owned(), value);
    }

    /// Everything noted, in the order of outcome and name.
    pub fn entries(&self) -> Vec<Entry> {
        let entry = |((outcome, what), (count, examples)): (&(Outcome, String), &(u64, BTreeSet<String>))| Entry {
            outcome: *outcome,
            what: what.clone(),
            count: *count,
            examples: examples.iter().cloned().collect(),
        };
        self.lock().entries.iter().map(entry).collect()
    }

    /// Everything measured, in the order of names.
    pub fn measurements(&self) -> Vec<Measurement> {
        let measurement = |(name, &value): (&String, &f64)| Measurement { name: name.clone(), value };
        self.lock().measurements.iter().map(measurement).collect()
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}

fn quoted(text: &str) -> String {
    let mut quoted = String::new();
    for (i, c) in text.chars().enumerate() {
        match c {
            _ if i == LONGEST_EXAMPLE => {
                quoted.push('…');
                break;
            }
            '\n' | '\t' => quoted.push(' '),
            c if c.is_control() => quoted.extend(c.escape_unicode()),
            c => quoted.push(c),
        }
    }
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn examples_are_short_and_do_not_reach_the_terminal_as_commands() {
        let report = Report::default();
        report.note(Outcome::Dropped, "name", format!("\u{1b}]0;x\u{7}{}", "é".repeat(2000)));
        let example = &report.entries()[0].examples[0];
        assert!(
            example.starts_with("\\u{1b}]0;x\\u{7}é") && example.ends_with('…') && !example.contains(char::is_control)
        );
        assert!(example.chars().count() < 1050);
    }

    #[test]
    fn the_order_of_happenings_does_not_matter() {
        let (a, b) = (Report::default(), Report::default());
        for i in 0..20 {
            a.note(Outcome::Dropped, "way", i);
            b.note(Outcome::Dropped, "way", 19 - i);
        }
        assert_eq!(a.entries(), b.entries());
        assert_eq!(a.entries()[0].count, 20);
        assert_eq!(a.entries()[0].examples.len(), EXAMPLES);
        // What happens to a copy does not happen to the other.
        a.clone().note(Outcome::Dropped, "way", 20);
        assert_eq!(a.entries(), b.entries());
    }
}
