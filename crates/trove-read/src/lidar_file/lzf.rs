//! LZF, by which PCD files are packed (Marc Lehmann's LibLZF).
//!
//! A control byte below 32 says how many bytes follow as they are, less one; else its upper three bits say how many are
//! repeated, less two (7: a byte follows that is added), and its lower five with the next byte how far back they are, less one.

/// What so many bytes were packed from; `None` where they are not that.
pub(super) fn unpacked(packed: &[u8], length: usize) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(length);
    let mut rest = packed.iter();
    while let Some(&control) = rest.next() {
        let control = usize::from(control);
        if control < 32 {
            let literal = rest.as_slice().get(..=control)?;
            out.extend_from_slice(literal);
            rest = rest.as_slice().get(control + 1..)?.iter();
        } else {
            let more = if control >> 5 == 7 { usize::from(*rest.next()?) } else { 0 };
            let back = ((control & 31) << 8) + usize::from(*rest.next()?) + 1;
            let start = out.len().checked_sub(back)?;
            // What is repeated may reach into what it makes.
            for i in 0..(control >> 5) + more + 2 {
                out.push(out[start + i]);
            }
        }
        if out.len() > length {
            return None;
        }
    }
    (out.len() == length).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repetitions_reach_into_what_they_make() {
        // "ab", then five bytes from two back; then twelve from one back.
        assert_eq!(unpacked(&[1, b'a', b'b', 3 << 5, 1], 7).unwrap(), b"abababa");
        assert_eq!(unpacked(&[0, b'x', 7 << 5, 3, 0], 13).unwrap(), [b'x'; 13]);
    }

    #[test]
    fn what_is_cut_short_or_points_before_the_start_is_refused() {
        for packed in [&[5, b'a'][..], &[1, b'a', b'b', 7 << 5], &[0, b'a', 1 << 5, 9], &[1 << 5, 0]] {
            assert_eq!(unpacked(packed, 7), None, "{packed:?}");
        }
        assert_eq!(unpacked(&[1, b'a', b'b'], 3), None);
        assert_eq!(unpacked(&[1, b'a', b'b'], 1), None);
    }
}
