//! COCO's packed runs: LEB128-like groups of five bits from '0', every number but the first two as the difference to the
//! one two before (the form of `cocoapi`'s masks).

/// The runs of a text; `None` for what is none.
pub(super) fn unpack(text: &str) -> Option<Vec<u32>> {
    let mut counts = Vec::<i64>::new();
    let mut bytes = text.bytes();
    while let Some(first) = bytes.next() {
        let (mut value, mut shift, mut byte) = (0i64, 0u32, first);
        loop {
            let group = byte.checked_sub(48).filter(|group| *group < 64)?;
            value |= i64::from(group & 31) << shift;
            shift += 5;
            if group & 32 == 0 {
                if group & 16 != 0 {
                    value |= -1 << shift;
                }
                break;
            }
            byte = bytes.next().filter(|_| shift < 40)?;
        }
        let before = counts.len().checked_sub(2).filter(|before| *before > 0).map_or(0, |before| counts[before]);
        counts.push(value.checked_add(before)?);
    }
    counts.into_iter().map(|count| u32::try_from(count).ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_those_that_pycocotools_packs() {
        // pycocotools.mask.encode: 4 × 5 pixels of which rows 1 and 2 of columns 1 to 3 are set; none of them; and
        // 300 × 400 with columns 100 to 109 and rows 5 to 8 of column 200.
        assert_eq!(unpack("5220003"), Some(vec![5, 2, 2, 2, 2, 2, 5]));
        assert_eq!(unpack("d0"), Some(vec![20]));
        assert_eq!(unpack("`Ym0hm2m[j0\\RMjVP1"), Some(vec![30_000, 3_000, 27_005, 4, 59_991]));
        assert_eq!(unpack("5220"), Some(vec![5, 2, 2, 2]));
        assert_eq!(unpack("\u{1}"), None);
    }
}
