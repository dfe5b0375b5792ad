//! NumPy's archives: a ZIP file whose members are arrays, packed as `numpy.savez_compressed` does.

use std::io::Write;

use flate2::Compression;
use flate2::write::DeflateEncoder;

/// An archive of arrays by their names; each is a whole `.npy` file.
pub(crate) fn archive(arrays: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let (mut zip, mut directory) = (Vec::new(), Vec::new());
    for (name, array) in arrays {
        let (name, packed) = (format!("{name}.npy"), deflated(array));
        // Version 2.0, no flags, deflated, 1980-01-01 (APPNOTE 6.3).
        let mut common = vec![20, 0, 0, 0, 8, 0, 0, 0, 0x21, 0];
        for number in [crc32fast::hash(array), packed.len() as u32, array.len() as u32] {
            common.extend_from_slice(&number.to_le_bytes());
        }
        common.extend_from_slice(&(name.len() as u16).to_le_bytes());
        common.extend_from_slice(&[0; 2]);
        // No comment, disk 0, no attributes.
        directory.extend([&b"PK\x01\x02"[..], &[20, 0], &common, &[0; 10]].concat());
        directory.extend_from_slice(&(zip.len() as u32).to_le_bytes());
        directory.extend_from_slice(name.as_bytes());
        zip.extend([&b"PK\x03\x04"[..], &common, name.as_bytes(), &packed].concat());
    }
    let (at, count) = (zip.len() as u32, (arrays.len() as u16).to_le_bytes());
    zip.extend_from_slice(&directory);
    zip.extend([&b"PK\x05\x06"[..], &[0; 4], &count, &count].concat());
    zip.extend_from_slice(&(directory.len() as u32).to_le_bytes());
    zip.extend_from_slice(&at.to_le_bytes());
    zip.extend_from_slice(&[0; 2]);
    zip
}

fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    written.expect("a vector takes all that is written to it")
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::*;

    #[test]
    fn the_archive_is_laid_out_as_zip_readers_expect() {
        let bytes = archive(&[("a", vec![1; 1000]), ("data", vec![2, 3])]);
        let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let end = bytes.len() - 22;
        assert_eq!((&bytes[end..end + 4], bytes[end + 10]), (&b"PK\x05\x06"[..], 2));
        let (mut entry, mut found) = (number(end + 16), Vec::new());
        while entry < end {
            assert_eq!(&bytes[entry..entry + 4], b"PK\x01\x02");
            let (packed, length, at) = (number(entry + 20), number(entry + 24), number(entry + 42));
            let name_length = usize::from(bytes[entry + 28]);
            let name = &bytes[entry + 46..entry + 46 + name_length];
            assert_eq!((&bytes[at..at + 4], &bytes[at + 30..at + 30 + name_length]), (&b"PK\x03\x04"[..], name));
            let from = at + 30 + name_length;
            let mut unpacked = Vec::new();
            flate2::read::DeflateDecoder::new(&bytes[from..from + packed]).read_to_end(&mut unpacked).unwrap();
            assert_eq!((unpacked.len(), number(entry + 16) as u32), (length, crc32fast::hash(&unpacked)));
            found.push((String::from_utf8(name.to_vec()).unwrap(), unpacked));
            entry += 46 + name_length;
        }
        assert_eq!(found, [("a.npy".into(), vec![1; 1000]), ("data.npy".into(), vec![2, 3])]);
    }
}
