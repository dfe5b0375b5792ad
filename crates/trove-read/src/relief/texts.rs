//! How long the texts of a TIFF say they are, looked at before its decoder meets them: that one prints a line for its
//! developers where a text is longer than its limit.

use std::io::{Read, Result, Seek, SeekFrom};

/// The type of a text (TIFF 6.0, section 2).
const ASCII: u64 = 2;

/// The longest text in the first directory, bytes as it claims.
pub(super) fn longest(mut file: impl Read + Seek) -> Result<u64> {
    let mut head = [0; 4];
    file.read_exact(&mut head)?;
    let is_big_endian = head[0] == b'M';
    // BigTIFF's offsets and counts are of 64 bits, and its header says so once more.
    let wide = if head.contains(&43) { 8 } else { 4 };
    let number = |file: &mut dyn Read, bytes: usize| -> Result<u64> {
        let mut raw = [0; 8];
        file.read_exact(&mut raw[..bytes])?;
        if is_big_endian {
            raw[..bytes].reverse();
        }
        Ok(u64::from_le_bytes(raw))
    };
    if wide == 8 {
        number(&mut file, 4)?;
    }
    let directory = number(&mut file, wide)?;
    file.seek(SeekFrom::Start(directory))?;
    let entries = number(&mut file, if wide == 8 { 8 } else { 2 })?;
    let mut longest = 0;
    for _ in 0..entries {
        let (_tag, kind) = (number(&mut file, 2)?, number(&mut file, 2)?);
        let (count, _value) = (number(&mut file, wide)?, number(&mut file, wide)?);
        if kind == ASCII {
            longest = longest.max(count);
        }
    }
    Ok(longest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    #[test]
    fn the_longest_text_is_found_in_all_four_kinds_of_file() {
        let numbers = |big_endian: bool, numbers: &[(u64, usize)]| -> Vec<u8> {
            let bytes = |&(number, bytes): &(u64, usize)| {
                let all = number.to_be_bytes();
                let mut bytes = all[8 - bytes..].to_vec();
                if !big_endian {
                    bytes.reverse();
                }
                bytes
            };
            numbers.iter().flat_map(bytes).collect()
        };
        for big_endian in [false, true] {
            let order = if big_endian { b"MM" } else { b"II" };
            // A number of 32 bits, a text of 7 and one of 5 bytes.
            let entries =
                |wide| [(4, 90), (ASCII, 7), (ASCII, 5)].map(|(kind, n)| [(9, 2), (kind, 2), (n, wide), (0, wide)]);
            let plain = [&[(42, 2), (8, 4), (3, 2)][..], entries(4).as_flattened()].concat();
            let wide = [&[(43, 2), (8, 2), (0, 2), (16, 8), (3, 8)][..], entries(8).as_flattened()].concat();
            for file in [plain, wide] {
                let bytes = [&order[..], &numbers(big_endian, &file)].concat();
                assert_eq!(longest(Cursor::new(&bytes)).unwrap(), 7);
                assert!(longest(Cursor::new(&bytes[..bytes.len() - 1])).is_err());
            }
        }
    }
}
