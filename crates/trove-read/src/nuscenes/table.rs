//! One JSON table as a stream of records, however large the file is.
//!
//! A table is an array of flat objects. The scanner finds where each begins and ends by its braces and strings, holds
//! one buffer, and leaves reading the record to the caller: a record that is no valid JSON is the caller's to drop,
//! a file whose brackets do not match is an error.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use trove_files::open_regular;

use crate::ReadError;

const CHUNK_BYTES: usize = 1 << 20;
/// The longest official record (a map's list of logs) has 3 kB; more than this is a quote or brace gone astray.
const LONGEST_RECORD_BYTES: usize = 1 << 20;

/// A record's bytes and where they begin in the file.
pub(super) struct RawRecord<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) offset: u64,
}

/// What may stand at the scanner's place.
#[derive(Clone, Copy, PartialEq)]
enum Expect {
    Array,
    FirstRecord,
    Record,
    Separator,
    End,
}

impl Expect {
    fn words(self) -> &'static str {
        match self {
            Self::Array => "'[' that begins the table",
            Self::FirstRecord => "'{' of a record or ']'",
            Self::Record => "'{' of a record",
            Self::Separator => "',' or ']' after a record",
            Self::End => "nothing after the table's ']'",
        }
    }
}

/// Reads a table's records one after the other.
pub(super) struct Table<R> {
    path: PathBuf,
    source: R,
    buffer: Vec<u8>,
    /// Where in `buffer` the unread bytes begin.
    at: usize,
    /// Offset in the file of `buffer`'s first byte.
    base: u64,
    exhausted: bool,
    expect: Expect,
}

impl Table<File> {
    /// Opens a table of the dataset.
    pub(super) fn open(path: &Path) -> Result<Self, ReadError> {
        match open_regular(path) {
            Ok(file) => Ok(Self::new(path, file)),
            Err(e) if e.kind() == ErrorKind::NotFound => Err(ReadError::Missing {
                path: path.to_owned(),
                expected: "a table of the nuScenes schema".to_owned(),
                found: "no file".to_owned(),
                remedy: "unpack the dataset's metadata archive into this folder again".to_owned(),
            }),
            Err(e) => Err(ReadError::io(path, e)),
        }
    }
}

impl<R: Read> Table<R> {
    /// Over bytes that are said to be of a path.
    pub(super) fn new(path: &Path, source: R) -> Self {
        let (buffer, path) = (Vec::new(), path.to_owned());
        Self { path, source, buffer, at: 0, base: 0, exhausted: false, expect: Expect::Array }
    }

    /// The next record; `None` after the table's end.
    pub(super) fn next_record(&mut self) -> Result<Option<RawRecord<'_>>, ReadError> {
        loop {
            let Some(byte) = self.peek()? else {
                return if self.expect == Expect::End { Ok(None) } else { Err(self.truncated(self.at)) };
            };
            match (self.expect, byte) {
                (Expect::Array, b'[') => self.expect = Expect::FirstRecord,
                (Expect::FirstRecord, b']') | (Expect::Separator, b']') => self.expect = Expect::End,
                (Expect::Separator, b',') => self.expect = Expect::Record,
                (Expect::FirstRecord | Expect::Record, b'{') => {
                    let length = self.record_length()?;
                    let (from, offset) = (self.at, self.base + self.at as u64);
                    self.at += length;
                    self.expect = Expect::Separator;
                    return Ok(Some(RawRecord { bytes: &self.buffer[from..from + length], offset }));
                }
                _ => return Err(self.unexpected(byte)),
            }
            self.at += 1;
        }
    }

    /// The next byte that is not white space.
    fn peek(&mut self) -> Result<Option<u8>, ReadError> {
        loop {
            match self.buffer[self.at..].iter().position(|b| !b.is_ascii_whitespace()) {
                Some(skip) => {
                    self.at += skip;
                    return Ok(Some(self.buffer[self.at]));
                }
                None => {
                    self.at = self.buffer.len();
                    if !self.refill()? {
                        return Ok(None);
                    }
                }
            }
        }
    }

    /// Length of the record that begins at `at`, read into the buffer as a whole.
    fn record_length(&mut self) -> Result<usize, ReadError> {
        loop {
            let unread = &self.buffer[self.at..];
            if let Some(length) = object_length(unread) {
                return Ok(length);
            }
            let place = self.at;
            if unread.len() > LONGEST_RECORD_BYTES {
                return Err(self.format(
                    place,
                    "a record shorter than 1 MiB".to_owned(),
                    "no end of the record that begins here".to_owned(),
                    "a quote or brace is damaged from here on: copy the file again",
                ));
            }
            if !self.refill()? {
                return Err(self.truncated(self.at));
            }
        }
    }

    /// Reads on, giving up what was consumed; false at the end of the file.
    fn refill(&mut self) -> Result<bool, ReadError> {
        if self.exhausted {
            return Ok(false);
        }
        self.base += self.at as u64;
        self.buffer.drain(..self.at);
        self.at = 0;
        let before = self.buffer.len();
        let mut chunk = self.source.by_ref().take(CHUNK_BYTES as u64);
        chunk.read_to_end(&mut self.buffer).map_err(|e| ReadError::io(&self.path, e))?;
        self.exhausted = self.buffer.len() == before;
        Ok(!self.exhausted)
    }

    fn truncated(&self, at: usize) -> ReadError {
        let expected = match self.expect {
            Expect::FirstRecord | Expect::Record => "the end of the record that begins here",
            other => other.words(),
        };
        let remedy = "the file is cut short: copy or unpack it again";
        self.format(at, expected.to_owned(), "the end of the file".to_owned(), remedy)
    }

    fn unexpected(&self, byte: u8) -> ReadError {
        let found = format!("'{}'", byte.escape_ascii());
        self.format(self.at, self.expect.words().to_owned(), found, "the file is damaged: copy or unpack it again")
    }

    fn format(&self, at: usize, expected: String, found: String, remedy: &str) -> ReadError {
        let byte = self.base + at as u64;
        let place = match line_of(&self.path, byte) {
            Some(line) => format!("line {line} (byte {byte})"),
            None => format!("byte {byte}"),
        };
        ReadError::Format { path: self.path.clone(), place, expected, found, remedy: remedy.to_owned() }
    }
}

/// Splits bytes that hold whole records with commas between them; `offset` is where they begin in the file.
pub(super) fn records(bytes: &[u8], offset: u64) -> impl Iterator<Item = RawRecord<'_>> {
    let mut at = 0;
    std::iter::from_fn(move || {
        at += bytes[at..].iter().position(|&b| b == b'{')?;
        let length = object_length(&bytes[at..])?;
        let record = RawRecord { bytes: &bytes[at..at + length], offset: offset + at as u64 };
        at += length;
        Some(record)
    })
}

/// Length of the object that `bytes` begin with; `None` where it does not end in them.
fn object_length(bytes: &[u8]) -> Option<usize> {
    let (mut depth, mut i) = (0u32, 0);
    while i < bytes.len() {
        match bytes[i] {
            b'{' => depth += 1,
            b'}' => {
                depth -= 1;
                if depth == 0 {
                    return Some(i + 1);
                }
            }
            b'"' => i = string_end(bytes, i + 1)?,
            _ => {}
        }
        i += 1;
    }
    None
}

/// Where the string ends whose first character is at `i`.
fn string_end(bytes: &[u8], mut i: usize) -> Option<usize> {
    loop {
        match bytes.get(i)? {
            b'"' => return Some(i),
            b'\\' => i += 2,
            _ => i += 1,
        }
    }
}

/// The line, counted from 1, of a byte in a file.
fn line_of(path: &Path, byte: u64) -> Option<u64> {
    let mut source = open_regular(path).ok()?.take(byte);
    let (mut buffer, mut lines) = (vec![0; CHUNK_BYTES], 1);
    loop {
        match source.read(&mut buffer).ok()? {
            0 => return Some(lines),
            n => lines += buffer[..n].iter().filter(|&&b| b == b'\n').count() as u64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Gives a byte at a time, so that every boundary of the buffer is met.
    struct Trickle<'a>(&'a [u8]);

    impl Read for Trickle<'_> {
        fn read(&mut self, out: &mut [u8]) -> std::io::Result<usize> {
            let n = self.0.len().min(out.len()).min(1);
            out[..n].copy_from_slice(&self.0[..n]);
            self.0 = &self.0[n..];
            Ok(n)
        }
    }

    fn scan(text: &[u8]) -> Result<Vec<(u64, Vec<u8>)>, ReadError> {
        let mut table = Table::new(Path::new("t.json"), Trickle(text));
        let mut found = Vec::new();
        while let Some(record) = table.next_record()? {
            found.push((record.offset, record.bytes.to_vec()));
        }
        Ok(found)
    }

    #[test]
    fn records_are_found_with_their_offsets_whatever_their_strings_hold() {
        let text = br#"[ {"a": "}\"{"} ,{"b": {"c": [1, "]"]}}]"#;
        let found = scan(text).unwrap();
        assert_eq!(found.len(), 2);
        for (offset, bytes) in found {
            assert_eq!(&text[offset as usize..][..bytes.len()], &bytes[..]);
            assert!(serde_json::from_slice::<serde_json::Value>(&bytes).is_ok());
        }
        assert_eq!(scan(b" [ ] ").unwrap().len(), 0);
    }

    #[test]
    fn a_table_that_is_cut_or_mended_wrongly_names_the_byte() {
        let cases: [(&[u8], &str); 6] = [
            (b"", "byte 0"),
            (b"{}", "byte 0"),
            (b"[{\"a\": 1}, {\"b\"", "byte 11"),
            (b"[{} {}]", "byte 4"),
            (b"[{}, ]", "byte 5"),
            (b"[{}] x", "byte 5"),
        ];
        for (text, place) in cases {
            let message = scan(text).unwrap_err().to_string();
            assert!(message.contains(place), "{message}");
        }
    }

    proptest! {
        #[test]
        fn any_bytes_never_panic(bytes in prop::collection::vec(prop::sample::select(&b"[]{},\"\\ax1 \n\xff"[..]), 0..60)) {
            let _ = scan(&bytes);
            let _ = records(&bytes, 0).count();
        }
    }
}
