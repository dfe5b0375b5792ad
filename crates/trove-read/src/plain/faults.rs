//! What is wrong with a text, with its places.

use std::path::Path;

use serde::Deserialize;
use trove_model::Kind;

use crate::ReadError;

/// So many faults are told; of the others, how many there are.
const TOLD: usize = 20;
/// Longer messages are cut, characters.
const LONGEST: usize = 300;
/// Longer words are compared by their beginnings, characters.
const LONGEST_WORD: usize = 100;

/// A part of a text.
#[derive(Clone, Debug)]
pub(super) struct Part<'a> {
    pub(super) text: &'a str,
    /// Where it is in the whole (`keyframes[3].boxes[0]`); empty for the whole.
    pub(super) path: String,
}

/// A value with the part that says it.
#[derive(Clone, Debug)]
pub(super) struct Located<'a, T> {
    pub(super) part: Part<'a>,
    pub(super) value: T,
}

/// The faults of a text.
pub(super) struct Faults<'a> {
    whole: &'a str,
    told: Vec<String>,
    count: usize,
}

impl<'a> Faults<'a> {
    pub(super) fn of(whole: &'a str) -> Self {
        Self { whole, told: Vec::new(), count: 0 }
    }

    /// Tells of a fault in a part.
    pub(super) fn say(&mut self, part: &Part, what: &str) {
        self.say_at(part, 0, || what.to_owned());
    }

    /// Tells of a fault whose words take time to find, if there is room for it.
    pub(super) fn explain(&mut self, part: &Part, what: impl FnOnce() -> String) {
        self.say_at(part, 0, what);
    }

    /// What a part says; `None` where it does not say such a thing, which is a fault.
    pub(super) fn read<T: Deserialize<'a>>(&mut self, part: &Part<'a>) -> Option<T> {
        match serde_json::from_str(part.text) {
            Ok(value) => Some(value),
            Err(error) => {
                if self.told.len() >= TOLD {
                    self.count += 1;
                    return None;
                }
                let before = part.text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len);
                let offset = before.sum::<usize>() + error.column().saturating_sub(1);
                let message = error.to_string();
                let place = format!(" at line {} column {}", error.line(), error.column());
                let message = message.strip_suffix(&place).unwrap_or(&message);
                self.say_at(part, offset, || explained(message));
                None
            }
        }
    }

    /// A value that a check gives, or the fault that it tells.
    pub(super) fn take<T>(&mut self, part: &Part, checked: Result<T, String>) -> Option<T> {
        checked.inspect_err(|what| self.say(part, what)).ok()
    }

    /// So many bytes from the part's start.
    fn say_at(&mut self, part: &Part, offset: usize, what: impl FnOnce() -> String) {
        self.count += 1;
        if self.told.len() >= TOLD {
            return;
        }
        // Parts are slices of the whole, so where they begin tells their line.
        let start = (part.text.as_ptr() as usize).saturating_sub(self.whole.as_ptr() as usize);
        let before = self.whole.as_bytes().get(..start + offset).unwrap_or(self.whole.as_bytes());
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        let column = before.iter().rev().take_while(|&&b| b != b'\n').count() + 1;
        let cut = |text: &str| text.chars().take(LONGEST).collect::<String>();
        let path = if part.path.is_empty() { String::new() } else { format!("{}: ", cut(&part.path)) };
        self.told.push(format!("line {line}, column {column}: {path}{}", cut(&what())));
    }

    /// An error where anything was told.
    pub(super) fn into_result(self, path: &Path) -> Result<(), ReadError> {
        if self.count == 0 {
            return Ok(());
        }
        let more = self.count - self.told.len();
        Err(ReadError::Faults { path: path.to_owned(), faults: self.told, more })
    }
}

/// A message of the parser with the known word that is nearest to an unknown one.
fn explained(message: &str) -> String {
    if message.starts_with("expected a kind out of")
        && let Some((_, found)) = message.rsplit_once("found ")
    {
        let kind = nearest(found.trim_matches('"'), Kind::ALL.into_iter().map(Kind::name)).unwrap_or_default();
        return format!("expected a kind, found {found}; did you mean \"{kind}\"?");
    }
    let mut names = message.split('`').skip(1).step_by(2);
    let unknown = names.next().filter(|_| message.starts_with("unknown "));
    let nearest = unknown.and_then(|unknown| nearest(unknown, names));
    nearest.map_or_else(|| message.to_owned(), |name| format!("{message}; did you mean `{name}`?"))
}

/// The known word that is nearest to one from a file, of which only the beginning is looked at.
pub(super) fn nearest<'n>(found: &str, known: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let found: String = found.chars().take(LONGEST_WORD).collect();
    known.min_by_key(|name| strsim::damerau_levenshtein(name, &found))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_told_with_their_places_up_to_a_number() {
        let whole = "{\n \"a\": [1,\n 2.5]}";
        let mut faults = Faults::of(whole);
        let part = Part { text: &whole[8..whole.len() - 1], path: "a".into() };
        assert_eq!(part.text, "[1,\n 2.5]");
        assert_eq!(faults.read::<Vec<u32>>(&part), None);
        for _ in 0..TOLD {
            faults.say(&part, "wrong");
        }
        let error = faults.into_result(Path::new("drive.json")).unwrap_err().to_string();
        assert!(error.contains("21 faults") && error.contains("line 3, column 4: a: invalid type"), "{error}");
        assert!(error.contains("line 2, column 7: a: wrong") && error.contains("and 1 more"), "{error}");
    }

    #[test]
    fn an_unknown_word_is_answered_with_the_nearest() {
        assert_eq!(
            explained("unknown field `sise_m`, expected `track` or `size_m`"),
            "unknown field `sise_m`, expected `track` or `size_m`; did you mean `size_m`?"
        );
        let kind = explained("expected a kind out of adult, car, found \"caar\"");
        assert_eq!(kind, "expected a kind, found \"caar\"; did you mean \"car\"?");
        assert_eq!(explained("missing field `track`"), "missing field `track`");
    }
}
