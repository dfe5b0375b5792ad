//! A column's pages, one after the other.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::rc::Rc;

use super::fault::Fault;
use super::metadata::{Chunk, ColumnInfo};
use super::runs::Runs;
use super::thrift::Thrift;
use super::values::{Dictionary, Physical, Values};
use trove_files::Budget;

/// Longer heads of pages are damaged: their statistics quote the least and the largest value, bytes.
const LONGEST_HEAD: u64 = 1 << 20;
/// What is read of a page before its head's length is known, bytes.
const FIRST_HEAD: u64 = 512;
/// Larger pages are damaged; a megabyte is usual, bytes.
const LARGEST_PAGE: u64 = 256 << 20;

/// A page of values with their levels.
pub(super) struct Page {
    /// Values and what stands in for those that are not there.
    pub(super) left: usize,
    pub(super) repeated: Runs,
    pub(super) defined: Runs,
    pub(super) values: Values,
}

/// A column's pages, in order.
pub(super) struct Pages<'a> {
    file: &'a File,
    budget: &'a Budget,
    column: &'a ColumnInfo,
    /// Chunks that are not begun.
    rest: &'a [Chunk],
    chunk: Option<Chunk>,
    dictionary: Option<Rc<Dictionary>>,
}

/// A page as it stands in the file.
struct Raw {
    kind: i64,
    size: usize,
    bytes: Vec<u8>,
}

impl<'a> Pages<'a> {
    pub(super) fn new(file: &'a File, budget: &'a Budget, column: &'a ColumnInfo) -> Self {
        Self { file, budget, column, rest: &column.chunks, chunk: None, dictionary: None }
    }

    /// The next page; `None` behind the last one.
    pub(super) fn next(&mut self) -> Result<Option<Page>, Fault> {
        loop {
            let Some(chunk) = self.chunk.filter(|chunk| chunk.values > 0 && chunk.from < chunk.to) else {
                let Some((first, rest)) = self.rest.split_first() else { return Ok(None) };
                (self.chunk, self.rest, self.dictionary) = (Some(*first), rest, None);
                continue;
            };
            if let Some(page) = self.read(chunk)? {
                return Ok(Some(page));
            }
        }
    }

    /// Reads a page and moves on; `None` for one that has no values of its own.
    fn read(&mut self, chunk: Chunk) -> Result<Option<Page>, Fault> {
        let mut bytes = self.bytes(chunk.from, FIRST_HEAD.min(chunk.to - chunk.from))?;
        if Thrift::read(&mut bytes.as_slice(), self.budget).is_err() {
            bytes = self.bytes(chunk.from, LONGEST_HEAD.min(chunk.to - chunk.from))?;
        }
        let mut rest = bytes.as_slice();
        let head = Thrift::read(&mut rest, self.budget)?;
        let body = chunk.from + (bytes.len() - rest.len()) as u64;
        let size = |field: i16| {
            let size = head.integer(field).and_then(|size| u64::try_from(size).ok()).filter(|s| *s <= LARGEST_PAGE);
            size.ok_or_else(|| Fault::new("a page of at most 256 MiB", format!("{:?} bytes", head.integer(field))))
        };
        let (unpacked, packed) = (size(2)?, size(3)?);
        if packed > chunk.to - body {
            return Err(Fault::new("a page within its column", format!("{packed} bytes from byte {body} on")));
        }
        let raw =
            Raw { kind: head.integer(1).unwrap_or(-1), size: unpacked as usize, bytes: self.bytes(body, packed)? };
        self.budget.take(raw.size, 1)?;
        let page = match raw.kind {
            0 => Some(self.page_v1(raw, head.field(5).unwrap_or(&Thrift::Other), chunk)?),
            3 => Some(self.page_v2(raw, head.field(8).unwrap_or(&Thrift::Other), chunk)?),
            2 => {
                let about = head.field(7).unwrap_or(&Thrift::Other);
                let count = number(about, 1)?;
                let bytes = chunk.codec.unpack(raw.bytes, raw.size)?;
                self.dictionary = Some(Rc::new(Dictionary::new(self.column.kind, bytes, count, self.budget)?));
                None
            }
            // Indices are not needed.
            _ => None,
        };
        let read = page.as_ref().map_or(0, |page| page.left as u64);
        self.chunk = Some(Chunk { from: body + packed, values: chunk.values.saturating_sub(read), ..chunk });
        Ok(page)
    }

    /// Levels and values are packed together, the levels after their lengths.
    fn page_v1(&self, raw: Raw, head: &Thrift, chunk: Chunk) -> Result<Page, Fault> {
        let left = self.count(head)?;
        let bytes = chunk.codec.unpack(raw.bytes, raw.size)?;
        let mut rest = bytes.as_slice();
        let mut levels = |most: u32| {
            if most == 0 {
                return Ok(Runs::constant(0));
            }
            let length = take(&mut rest, 4)?.iter().rev().fold(0, |length, byte| length << 8 | usize::from(*byte));
            Runs::new(take(&mut rest, length)?.to_vec(), bits(most))
        };
        let (repeated, defined) = (levels(self.column.most_repeated)?, levels(self.column.most_defined)?);
        Ok(Page { left, repeated, defined, values: self.values(rest.to_vec(), number(head, 2)?)? })
    }

    /// Levels come first, not packed, with their lengths in the head.
    fn page_v2(&self, raw: Raw, head: &Thrift, chunk: Chunk) -> Result<Page, Fault> {
        let left = self.count(head)?;
        let mut rest = raw.bytes.as_slice();
        let (defined, repeated) = (number(head, 5)?, number(head, 6)?);
        let repeated = (take(&mut rest, repeated)?.to_vec(), self.column.most_repeated);
        let defined = (take(&mut rest, defined)?.to_vec(), self.column.most_defined);
        let levels = |(bytes, most): (Vec<u8>, u32)| match most {
            0 => Ok(Runs::constant(0)),
            _ => Runs::new(bytes, bits(most)),
        };
        let is_packed = head.integer(7) != Some(0) && !rest.is_empty();
        let size = raw.size.checked_sub(raw.bytes.len() - rest.len());
        let size = size.ok_or_else(|| Fault::new("a page that is longer than its levels", "a shorter one"))?;
        let bytes = if is_packed { chunk.codec.unpack(rest.to_vec(), size)? } else { rest.to_vec() };
        let values = self.values(bytes, number(head, 4)?)?;
        Ok(Page { left, repeated: levels(repeated)?, defined: levels(defined)?, values })
    }

    fn count(&self, head: &Thrift) -> Result<usize, Fault> {
        let count = number(head, 1)?;
        // What is a run in the file is still read one by one.
        self.budget.take(count, 1)?;
        Ok(count)
    }

    fn values(&self, bytes: Vec<u8>, encoding: usize) -> Result<Values, Fault> {
        let kind = self.column.kind;
        Ok(match (encoding, &self.dictionary) {
            (0, _) if kind == Physical::Bool => Values::Bits { bytes, at: 0 },
            (0, _) => Values::Plain { kind, bytes, at: 0 },
            (3, _) if kind == Physical::Bool => Values::Bools(Runs::new(bytes.get(4..).unwrap_or(&[]).to_vec(), 1)?),
            (2 | 8, Some(dictionary)) => {
                // Without values there is no width either.
                let width = bytes.first().copied().unwrap_or(0);
                let indices = Runs::new(bytes.get(1..).unwrap_or(&[]).to_vec(), u32::from(width))?;
                Values::Indexed { dictionary: dictionary.clone(), indices }
            }
            (2 | 8, None) => return Err(Fault::new("a dictionary before the pages that refer to it", "none")),
            (other, _) => {
                return Err(Fault::new("values that are plain or in a dictionary", format!("encoding {other}")));
            }
        })
    }

    fn bytes(&self, from: u64, length: u64) -> Result<Vec<u8>, Fault> {
        let mut file = self.file;
        file.seek(SeekFrom::Start(from))?;
        let mut bytes = Vec::new();
        file.take(length).read_to_end(&mut bytes)?;
        if bytes.len() as u64 == length { Ok(bytes) } else { Err(Fault::new("a whole page", "the end of the file")) }
    }
}

/// Bits of the largest level.
fn bits(most: u32) -> u32 {
    u32::BITS - most.leading_zeros()
}

fn number(head: &Thrift, field: i16) -> Result<usize, Fault> {
    let number = head.integer(field).and_then(|n| usize::try_from(n).ok());
    number.ok_or_else(|| Fault::new("a page's head", format!("{:?} in its field {field}", head.integer(field))))
}

fn take<'a>(input: &mut &'a [u8], count: usize) -> Result<&'a [u8], Fault> {
    let (head, tail) =
        input.split_at_checked(count).ok_or_else(|| Fault::new("a page's levels", "the end of the page"))?;
    *input = tail;
    Ok(head)
}
