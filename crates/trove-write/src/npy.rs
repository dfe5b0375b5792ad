//! NumPy's arrays as files (format 1.0), in C order.

use std::path::PathBuf;

use trove_files::{LARGEST_FILE, read_regular};

use crate::WriteError;

const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";
/// NumPy aligns what follows the header to it.
const ALIGNED: usize = 64;

/// A file of elements of NumPy's type `descr`, such as `'<u2'`, which `elements` holds, little-endian.
pub(crate) fn encode(descr: &str, shape: &[usize], elements: &[u8]) -> Vec<u8> {
    let shape = shape.iter().map(|side| format!("{side},")).collect::<Vec<_>>().join(" ");
    // A list of several sides ends without a comma.
    let shape = if shape.matches(',').count() > 1 { shape.trim_end_matches(',') } else { &shape };
    let header = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': ({shape}), }}");
    let length = (MAGIC.len() + 2 + header.len() + 1).next_multiple_of(ALIGNED) - MAGIC.len() - 2;
    let mut bytes = Vec::with_capacity(MAGIC.len() + 2 + length + elements.len());
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&(length as u16).to_le_bytes());
    bytes.extend_from_slice(format!("{header:<width$}\n", width = length - 1).as_bytes());
    bytes.extend_from_slice(elements);
    bytes
}

/// The header and the elements of a file; `None` where it is none.
pub(crate) fn split(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let length = bytes.get(8..10).map(|length| usize::from(u16::from_le_bytes([length[0], length[1]])) + 10)?;
    let (header, elements) = bytes.split_at_checked(length)?;
    Some((header.strip_prefix(MAGIC)?.get(2..)?, elements))
}

/// Names and NumPy's types of a record's fields, in their order; little-endian, packed.
pub(crate) type Fields = [(&'static str, &'static str)];

/// A structured array with so many records, which `bytes` holds.
pub(crate) fn encode_records(fields: &Fields, count: usize, bytes: &[u8]) -> Vec<u8> {
    encode(&record(fields), &[count], bytes)
}

/// A record's type.
fn record(fields: &Fields) -> String {
    format!("[{}]", fields.iter().map(|(name, kind)| format!("('{name}', '{kind}'), ")).collect::<String>())
}

/// The records of a structured array; what is wrong with others.
pub(crate) fn records<'b, const BYTES: usize>(fields: &Fields, bytes: &'b [u8]) -> Result<&'b [[u8; BYTES]], String> {
    let (header, records) = split(bytes).ok_or("no header")?;
    if !header.starts_with(format!("{{'descr': {}, 'fortran_order': False, ", record(fields)).as_bytes()) {
        return Err("an array of other records".into());
    }
    if records.len() % BYTES != 0 {
        return Err(format!("{} bytes, not a multiple of {BYTES}", records.len()));
    }
    Ok(records.as_chunks::<BYTES>().0)
}

/// What `decode` makes of a file; an error that names the file where it cannot be read or is damaged.
pub(crate) fn read<T>(path: PathBuf, decode: impl FnOnce(&[u8]) -> Result<T, String>) -> Result<T, WriteError> {
    let bytes = read_regular(&path, LARGEST_FILE).map_err(WriteError::storage(&path, "read the file"))?;
    decode(&bytes).map_err(|found| WriteError::Damaged { path, found })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_is_numpys() {
        // What numpy.save writes.
        for (descr, shape, expected) in [
            ("'|u1'", &[3][..], "{'descr': '|u1', 'fortran_order': False, 'shape': (3,), }"),
            ("'<u2'", &[200, 200, 16], "{'descr': '<u2', 'fortran_order': False, 'shape': (200, 200, 16), }"),
        ] {
            let bytes = encode(descr, shape, &[7]);
            let (header, elements) = split(&bytes).unwrap();
            let header = std::str::from_utf8(header).unwrap();
            assert_eq!((header.trim_end(), elements), (expected, &[7][..]));
            assert!((bytes.len() - 1).is_multiple_of(64) && header.ends_with('\n'));
        }
        assert_eq!(split(b"\x93NUMPY"), None);
    }
}
