//! Packed pages.

use std::io::Read;

use flate2::read::MultiGzDecoder;

use super::fault::Fault;

/// How pages are packed, by the number in the file.
#[derive(Clone, Copy, Debug)]
pub(super) enum Codec {
    None,
    Snappy,
    Gzip,
    Zstd,
}

impl Codec {
    pub(super) fn of(number: i64) -> Result<Self, Fault> {
        const NAMES: [&str; 8] = ["none", "Snappy", "gzip", "LZO", "Brotli", "LZ4", "Zstandard", "raw LZ4"];
        Ok(match number {
            0 => Self::None,
            1 => Self::Snappy,
            2 => Self::Gzip,
            6 => Self::Zstd,
            _ => {
                let name = usize::try_from(number).ok().and_then(|n| NAMES.get(n)).copied().unwrap_or("an unknown one");
                return Err(Fault::new("a packing of none, Snappy, gzip or Zstandard", name));
            }
        })
    }

    /// The unpacked bytes, of which there must be `size`.
    pub(super) fn unpack(self, packed: Vec<u8>, size: usize) -> Result<Vec<u8>, Fault> {
        let unpacked = match self {
            Self::None => Some(packed),
            Self::Snappy => snappy(&packed, size),
            Self::Gzip => {
                let mut bytes = Vec::new();
                let read = MultiGzDecoder::new(packed.as_slice()).take(size as u64 + 1).read_to_end(&mut bytes);
                read.is_ok().then_some(bytes)
            }
            Self::Zstd => zstd::bulk::decompress(&packed, size).ok(),
        };
        unpacked
            .filter(|bytes| bytes.len() == size)
            .ok_or_else(|| Fault::new(format!("a page of {size} bytes packed with {self:?}"), "bytes that are none"))
    }
}

/// Snappy's block format (<https://github.com/google/snappy/blob/main/format_description.txt>).
fn snappy(mut packed: &[u8], size: usize) -> Option<Vec<u8>> {
    let mut length = 0u64;
    for shift in (0..35).step_by(7) {
        let byte = take(&mut packed, 1)?[0];
        length |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            break;
        }
    }
    if length != size as u64 {
        return None;
    }
    let mut bytes = Vec::with_capacity(size);
    while let Some((&tag, rest)) = packed.split_first() {
        packed = rest;
        let high = usize::from(tag >> 2);
        let (count, back) = match tag & 3 {
            0 => {
                let count = if high < 60 { high } else { little(take(&mut packed, high - 59)?) };
                let literal = take(&mut packed, count.checked_add(1)?)?;
                if bytes.len() + literal.len() > size {
                    return None;
                }
                bytes.extend_from_slice(literal);
                continue;
            }
            1 => (4 + (high & 7), (high >> 3) << 8 | little(take(&mut packed, 1)?)),
            2 => (1 + high, little(take(&mut packed, 2)?)),
            _ => (1 + high, little(take(&mut packed, 4)?)),
        };
        let start = bytes.len().checked_sub(back)?;
        if back == 0 || bytes.len() + count > size {
            return None;
        }
        // A copy may reach into what it writes.
        for i in start..start + count {
            bytes.push(bytes[i]);
        }
    }
    Some(bytes)
}

fn take<'a>(input: &mut &'a [u8], count: usize) -> Option<&'a [u8]> {
    let (head, tail) = input.split_at_checked(count)?;
    *input = tail;
    Some(head)
}

fn little(bytes: &[u8]) -> usize {
    bytes.iter().rev().fold(0, |value, byte| value << 8 | usize::from(*byte))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn snappy_copies_may_overlap_and_lead_nowhere() {
        // "ab", then eight more bytes from two back.
        assert_eq!(snappy(&[10, 1 << 2, b'a', b'b', 1 | 4 << 2, 2], 10).unwrap(), b"ababababab");
        for bad in [&[10, 1 << 2, b'a', b'b', 1 | 4 << 2, 3][..], &[10, 1 << 2, b'a'], &[9, 0], &[], &[10, 0xfc, 255]] {
            assert_eq!(snappy(bad, 10), None, "{bad:?}");
        }
    }
}
