//! The one elevation tile of a zip file.

use std::io::Read;
use std::path::Path;

use flate2::read::DeflateDecoder;
use trove_files::read_regular;

use super::hgt;
use crate::ReadError;

/// Larger archives hold something else, bytes.
const LARGEST: u64 = 256 << 20;
/// Lengths of the fixed parts of a file's entry in the directory, of its own header, and of the directory's end.
const ENTRY: usize = 46;
const HEADER: usize = 30;
const END: usize = 22;
/// The comment behind the end may be this long.
const LONGEST_COMMENT: usize = 0xffff;

/// Name and bytes of the tile; folders before its name are left out, and it is never written anywhere.
pub(super) fn elevation(path: &Path) -> Result<(String, Vec<u8>), ReadError> {
    let bytes = read_regular(path, LARGEST).map_err(|source| ReadError::io(path, source))?;
    let fault = |place: &str, expected: &str, found: &str| ReadError::Format {
        path: path.to_owned(),
        place: place.to_owned(),
        expected: expected.into(),
        found: found.into(),
        remedy: "download it again, or unpack it and name the .hgt file".into(),
    };
    let Some(end) = end_of_directory(&bytes) else {
        return Err(fault("end of the file", "a zip file's directory", "none: the file is cut short or damaged"));
    };
    let mut at = number::<4>(&bytes, end + 16).unwrap_or(usize::MAX);
    while let Some(entry) = bytes.get(at..).filter(|entry| entry.starts_with(b"PK\x01\x02") && entry.len() > ENTRY) {
        let lengths = [28, 30, 32].map(|field| number::<2>(entry, field).unwrap_or(0));
        let name = String::from_utf8_lossy(entry.get(ENTRY..ENTRY + lengths[0]).unwrap_or_default()).into_owned();
        at += ENTRY + lengths.iter().sum::<usize>();
        let name = name.rsplit(['/', '\\']).next().unwrap_or_default().to_owned();
        if !name.to_ascii_lowercase().ends_with(".hgt") || name.starts_with('.') {
            continue;
        }
        let Some((method, packed)) = packed(&bytes, entry) else {
            return Err(fault(&name, "the file's packed bytes", "less: the zip file is damaged"));
        };
        let mut tile = Vec::new();
        // One byte more than the largest tile is seen as wrong by whoever looks at the length.
        let unpacked = match method {
            0 => packed.take(hgt::LARGEST + 1).read_to_end(&mut tile),
            8 => DeflateDecoder::new(packed).take(hgt::LARGEST + 1).read_to_end(&mut tile),
            _ => return Err(fault(&name, "a file that is stored or deflated", &format!("packing method {method}"))),
        };
        return match unpacked {
            Ok(_) => Ok((name, tile)),
            Err(error) => Err(fault(&name, "a file that unpacks", &error.to_string())),
        };
    }
    Err(fault("directory", "a zip file with an SRTM tile (.hgt)", "none"))
}

/// Where the record starts that tells where the directory is.
fn end_of_directory(bytes: &[u8]) -> Option<usize> {
    let last = bytes.len().checked_sub(END)?;
    (last.saturating_sub(LONGEST_COMMENT)..=last).rev().find(|&at| bytes[at..].starts_with(b"PK\x05\x06"))
}

/// How the file of a directory's entry is packed, and its bytes.
fn packed<'a>(bytes: &'a [u8], entry: &[u8]) -> Option<(usize, &'a [u8])> {
    let (method, length) = (number::<2>(entry, 10)?, number::<4>(entry, 20)?);
    let header = bytes.get(number::<4>(entry, 42)?..)?;
    let start = HEADER + number::<2>(header, 26)? + number::<2>(header, 28)?;
    Some((method, header.get(start..start.checked_add(length)?)?))
}

/// A little-endian number of so many bytes.
fn number<const BYTES: usize>(bytes: &[u8], at: usize) -> Option<usize> {
    let digits = bytes.get(at..at.checked_add(BYTES)?)?;
    Some(digits.iter().rev().fold(0, |number, &digit| number << 8 | usize::from(digit)))
}
