//! KITTI's files of numbers.

use std::path::Path;

use trove_files::read_text;

use crate::ReadError;

/// Several times a long sequence's labels: more lines, each of them a mistake to report, would take minutes.
const LARGEST: u64 = 8 << 20;

/// A text file.
pub(super) fn read(path: &Path) -> Result<String, ReadError> {
    read_text(path, LARGEST).map_err(|error| ReadError::io(path, error))
}

/// A file's content is not what it should be.
pub(super) fn damaged(path: &Path, place: &str, expected: &str, found: impl Into<String>) -> ReadError {
    ReadError::Format {
        path: path.to_owned(),
        place: place.to_owned(),
        expected: expected.to_owned(),
        found: found.into(),
        remedy: "unpack the dataset's file again".to_owned(),
    }
}

/// The number that a word is; `None` for NaN, infinity and what is no number.
pub(super) fn number(word: &str) -> Option<f64> {
    word.parse().ok().filter(|number: &f64| number.is_finite())
}

/// A line of numbers; `None` where one of its words is none.
pub(super) fn numbers(line: &str) -> Option<Vec<f64>> {
    line.split_whitespace().map(number).collect()
}

/// The start of a text that is quoted in a message.
pub(super) fn quoted(text: &str) -> String {
    let start: String = text.trim().chars().take(60).collect();
    if start.is_empty() { "nothing".to_owned() } else { format!("\"{start}\"") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_numbers_or_nothing() {
        assert_eq!(numbers(" 1 -2.5e-1\t3 "), Some(vec![1.0, -0.25, 3.0]));
        assert_eq!(numbers(""), Some(Vec::new()));
        for line in ["1 nan", "inf", "1,5", "1 x"] {
            assert_eq!(numbers(line), None, "{line}");
        }
        assert_eq!((quoted("  "), quoted(" a ")), ("nothing".to_owned(), "\"a\"".to_owned()));
    }
}
