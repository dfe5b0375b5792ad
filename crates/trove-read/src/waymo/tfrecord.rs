//! TFRecord: records with their lengths and checksums.
//!
//! Length (u64), masked CRC-32C of it (u32), bytes, masked CRC-32C of them (u32), all little-endian
//! (<https://www.tensorflow.org/tutorials/load_data/tfrecord>).

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use trove_files::open_regular;

/// Length and checksum before a record, and the checksum after it, bytes.
const HEAD: u64 = 12;
const TAIL: u64 = 4;
/// Larger records are damaged: a frame with all its pictures and range images has 6 MB, bytes.
const LARGEST_RECORD: u64 = 128 << 20;

/// A file's records, one after the other.
pub(super) struct Records {
    input: BufReader<File>,
    length: u64,
    /// Where the next record begins.
    at: u64,
    /// Of the records so far the number.
    count: usize,
    buffer: Vec<u8>,
}

/// What comes next in a file.
pub(super) enum Next<'a> {
    Record(&'a [u8]),
    /// A record that is damaged, with what is wrong; the next one can be read.
    Damaged(&'static str),
    /// The file is damaged from here on, with what is wrong.
    Lost(&'static str),
    End,
}

impl Records {
    pub(super) fn open(path: &Path) -> io::Result<Self> {
        let file = open_regular(path)?;
        let length = file.metadata()?.len();
        Ok(Self { input: BufReader::with_capacity(1 << 16, file), length, at: 0, count: 0, buffer: Vec::new() })
    }

    /// Bytes in the file.
    pub(super) fn length(&self) -> u64 {
        self.length
    }

    /// Where the next record begins, for messages.
    pub(super) fn place(&self) -> String {
        format!("record {} at byte {}", self.count, self.at)
    }

    /// Reads the next record.
    pub(super) fn read(&mut self) -> io::Result<Next<'_>> {
        let size = match self.head()? {
            Ok(Some(size)) => size,
            Ok(None) => return Ok(Next::End),
            Err(why) => return Ok(Next::Lost(why)),
        };
        self.buffer.clear();
        self.input.by_ref().take(size + TAIL).read_to_end(&mut self.buffer)?;
        self.advance(size);
        let Some((record, sum)) = self.buffer.split_last_chunk() else { return Ok(Next::Lost("the end of the file")) };
        if record.len() as u64 != size {
            return Ok(Next::Lost("the end of the file"));
        }
        Ok(if masked_crc32c(record) == u32::from_le_bytes(*sum) {
            Next::Record(record)
        } else {
            Next::Damaged("another checksum")
        })
    }

    /// Passes the next record without reading it; false at the end and where the file is damaged.
    pub(super) fn skip(&mut self) -> io::Result<bool> {
        let Ok(Some(size)) = self.head()? else { return Ok(false) };
        self.advance(size);
        self.input.seek(SeekFrom::Start(self.at))?;
        Ok(true)
    }

    fn advance(&mut self, size: u64) {
        self.at += HEAD + size + TAIL;
        self.count += 1;
    }

    /// The size of the next record; `None` at the end. The inner error says why there is none.
    fn head(&mut self) -> io::Result<Result<Option<u64>, &'static str>> {
        let left = self.length.saturating_sub(self.at);
        if left == 0 {
            return Ok(Ok(None));
        }
        if left < HEAD + TAIL {
            return Ok(Err("the end of the file"));
        }
        let (mut size, mut sum) = ([0; 8], [0; 4]);
        self.input.read_exact(&mut size)?;
        self.input.read_exact(&mut sum)?;
        if masked_crc32c(&size) != u32::from_le_bytes(sum) {
            return Ok(Err("another checksum of the record's length"));
        }
        let size = u64::from_le_bytes(size);
        Ok(match size {
            _ if size > LARGEST_RECORD => Err("a record of more than 128 MiB"),
            _ if size > left - HEAD - TAIL => Err("the end of the file"),
            _ => Ok(Some(size)),
        })
    }
}

/// The checksum that stands in files: rotated by 15 bits and added to a constant.
pub(super) fn masked_crc32c(bytes: &[u8]) -> u32 {
    crc32c(bytes).rotate_right(15).wrapping_add(0xa282_ead8)
}

/// CRC-32C (Castagnoli), eight bytes at a time (Kounavis and Berry 2005).
fn crc32c(bytes: &[u8]) -> u32 {
    let (words, rest) = bytes.as_chunks::<8>();
    let table = |k: usize, index: u32| TABLES[k][(index & 0xff) as usize];
    let mut crc = u32::MAX;
    for word in words {
        let (low, high) = ([word[0], word[1], word[2], word[3]], [word[4], word[5], word[6], word[7]]);
        let (low, high) = (crc ^ u32::from_le_bytes(low), u32::from_le_bytes(high));
        crc = table(7, low) ^ table(6, low >> 8) ^ table(5, low >> 16) ^ table(4, low >> 24);
        crc ^= table(3, high) ^ table(2, high >> 8) ^ table(1, high >> 16) ^ table(0, high >> 24);
    }
    for &byte in rest {
        crc = table(0, crc ^ u32::from(byte)) ^ (crc >> 8);
    }
    !crc
}

static TABLES: [[u32; 256]; 8] = tables();

const fn tables() -> [[u32; 256]; 8] {
    let mut tables = [[0; 256]; 8];
    let mut i = 0;
    while i < 256 {
        let (mut crc, mut bit) = (i as u32, 0);
        while bit < 8 {
            crc = if crc & 1 == 1 { (crc >> 1) ^ 0x82f6_3b78 } else { crc >> 1 };
            bit += 1;
        }
        tables[0][i] = crc;
        i += 1;
    }
    i = 0;
    while i < 256 {
        let mut k = 1;
        while k < 8 {
            let before: u32 = tables[k - 1][i];
            tables[k][i] = (before >> 8) ^ tables[0][(before & 0xff) as usize];
            k += 1;
        }
        i += 1;
    }
    tables
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_are_those_of_the_specification() {
        // RFC 3720, B.4.
        assert_eq!(crc32c(&[0; 32]), 0x8a91_36aa);
        assert_eq!(crc32c(&[0xff; 32]), 0x62a8_ab43);
        let ascending: Vec<u8> = (0..32).collect();
        assert_eq!(crc32c(&ascending), 0x46dd_794e);
        assert_eq!(crc32c(b"123456789"), 0xe306_9283);
    }
}
