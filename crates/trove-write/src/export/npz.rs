//! NumPy's archives: a ZIP file whose members are arrays, stored as they are.

/// An archive of one array of 16-bit numbers, called `data`.
pub(crate) fn of_u16(values: &[u16]) -> Vec<u8> {
    let mut array = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    let header = format!("{{'descr': '<u2', 'fortran_order': False, 'shape': ({},), }}", values.len());
    array.extend_from_slice(format!("{header:<117}\n").as_bytes());
    values.iter().for_each(|value| array.extend_from_slice(&value.to_le_bytes()));
    stored("data.npy", &array)
}

/// A ZIP file of one member without compression (APPNOTE 6.3).
fn stored(name: &str, bytes: &[u8]) -> Vec<u8> {
    let (length, crc) = (bytes.len() as u32, crc32fast::hash(bytes));
    // Version 2.0, no flags, stored, 1980-01-01.
    let mut common = vec![20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0];
    for number in [crc, length, length] {
        common.extend_from_slice(&number.to_le_bytes());
    }
    common.extend_from_slice(&(name.len() as u16).to_le_bytes());
    common.extend_from_slice(&[0; 2]);
    let mut zip = [&b"PK\x03\x04"[..], &common, name.as_bytes(), bytes].concat();
    let directory_at = zip.len() as u32;
    // No comment, disk 0, no attributes, the member at the beginning.
    zip.extend([&b"PK\x01\x02"[..], &[20, 0], &common, &[0; 14], name.as_bytes()].concat());
    let directory_length = zip.len() as u32 - directory_at;
    zip.extend([&b"PK\x05\x06"[..], &[0, 0, 0, 0, 1, 0, 1, 0]].concat());
    zip.extend_from_slice(&directory_length.to_le_bytes());
    zip.extend_from_slice(&directory_at.to_le_bytes());
    zip.extend_from_slice(&[0; 2]);
    zip
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_archive_is_laid_out_as_zip_readers_expect() {
        let bytes = of_u16(&[1, 17_003]);
        assert_eq!(&bytes[..4], b"PK\x03\x04");
        let end = bytes.len() - 22;
        assert_eq!(&bytes[end..end + 4], b"PK\x05\x06");
        let directory = u32::from_le_bytes(bytes[end + 16..end + 20].try_into().unwrap()) as usize;
        assert_eq!(&bytes[directory..directory + 4], b"PK\x01\x02");
        assert_eq!(&bytes[directory + 46..end], b"data.npy");
        let array = &bytes[30 + 8..directory];
        assert_eq!((array.len(), &array[array.len() - 4..]), (128 + 4, &[1, 0, 0x6b, 0x42][..]));
        assert_eq!(u32::from_le_bytes(bytes[14..18].try_into().unwrap()), crc32fast::hash(array));
    }
}
