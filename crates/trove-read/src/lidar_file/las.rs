//! LAS 1.2 to 1.4 (ASPRS), point formats 0 to 10; LAZ is refused.

use glam::DVec3;

use super::bytes::{array, f64_at, u16_at, u32_at};
use trove_files::Budget;

/// Bytes of a point of each format, at the least.
const POINT_BYTES: [usize; 11] = [20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67];
/// Where the header has what is needed.
const MINOR_VERSION: usize = 25;
const POINTS_START: usize = 96;
const POINT_FORMAT: usize = 104;
const RECORD_BYTES: usize = 105;
const POINT_COUNT: usize = 107;
const SCALE: usize = 131;
const OFFSET: usize = 155;
const POINT_COUNT_1_4: usize = 247;
/// Bits of the format that say that the points are packed.
const PACKED: u8 = 0xc0;

pub(super) fn points(bytes: &[u8], budget: &Budget) -> Result<Vec<DVec3>, String> {
    if !bytes.starts_with(b"LASF") {
        return Err("expected a LAS file, which begins with LASF".to_owned());
    }
    let cut = || "expected a whole LAS header, found a file that is cut short".to_owned();
    let version = bytes.get(MINOR_VERSION - 1..=MINOR_VERSION).ok_or_else(cut)?;
    let (1, minor @ 2..=4) = (version[0], version[1]) else {
        return Err(format!("expected LAS 1.2 to 1.4, found {}.{}", version[0], version[1]));
    };
    let format = *bytes.get(POINT_FORMAT).ok_or_else(cut)?;
    if format & PACKED != 0 {
        return Err("expected plain LAS, found packed points (LAZ); unpack it with laszip or PDAL".to_owned());
    }
    let least = POINT_BYTES.get(usize::from(format));
    let least = *least.ok_or_else(|| format!("expected a point format of 0 to 10, found {format}"))?;
    let record = usize::from(u16_at(bytes, RECORD_BYTES).ok_or_else(cut)?);
    if record < least {
        return Err(format!("expected points of at least {least} bytes in format {format}, found {record}"));
    }
    let legacy = u64::from(u32_at(bytes, POINT_COUNT).ok_or_else(cut)?);
    let count = match minor {
        4 => array(bytes, POINT_COUNT_1_4).map(u64::from_le_bytes).ok_or_else(cut)?.max(legacy),
        _ => legacy,
    };
    let vector = |at: usize| -> Option<DVec3> {
        Some(DVec3::new(f64_at(bytes, at)?, f64_at(bytes, at + 8)?, f64_at(bytes, at + 16)?))
    };
    let (scale, offset) = (vector(SCALE).ok_or_else(cut)?, vector(OFFSET).ok_or_else(cut)?);
    let start = u32_at(bytes, POINTS_START).ok_or_else(cut)? as usize;
    let data = bytes.get(start..).ok_or_else(cut)?;
    let there = (data.len() / record) as u64;
    if count == 0 || count > there {
        return Err(format!("expected 1 to {there} points in a file of this size, found a header that says {count}"));
    }
    let count = count as usize;
    budget.take(count, size_of::<DVec3>()).map_err(|exceeded| format!("expected {}", exceeded.expected()))?;
    let point = |record: &[u8]| {
        let value = |i: usize| array(record, 4 * i).map_or(f64::NAN, |b| f64::from(i32::from_le_bytes(b)));
        DVec3::new(value(0), value(1), value(2)) * scale + offset
    };
    Ok(data.chunks_exact(record).take(count).map(point).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file with its points in whole scales.
    fn file(minor: u8, format: u8, record: u16, points: &[[i32; 3]]) -> Vec<u8> {
        let header = if minor == 4 { 375 } else { 227 };
        let mut bytes = vec![0; header];
        let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
        put(0, b"LASF");
        put(24, &[1, minor]);
        put(POINTS_START, &(header as u32).to_le_bytes());
        put(POINT_FORMAT, &[format]);
        put(RECORD_BYTES, &record.to_le_bytes());
        if minor == 4 {
            put(POINT_COUNT_1_4, &(points.len() as u64).to_le_bytes());
        } else {
            put(POINT_COUNT, &(points.len() as u32).to_le_bytes());
        }
        for (i, value) in [0.01, 0.01, 0.001, 500_000.0, 4_000_000.0, 100.0].iter().enumerate() {
            put(SCALE + 8 * i, &f64::to_le_bytes(*value));
        }
        for point in points {
            let start = bytes.len();
            bytes.extend(point.iter().flat_map(|v| v.to_le_bytes()));
            bytes.resize(start + usize::from(record), 7);
        }
        bytes
    }

    fn read(bytes: &[u8]) -> Result<Vec<DVec3>, String> {
        points(bytes, &Budget::of_file(bytes.len() as u64))
    }

    #[test]
    fn every_version_and_format_gives_scaled_points() {
        for minor in 2..=4 {
            for (format, &least) in (0u8..).zip(&POINT_BYTES) {
                let read = read(&file(minor, format, least as u16 + 3, &[[100, -200, 1500], [0, 0, 0]])).unwrap();
                assert!(read[0].distance(DVec3::new(500_001.0, 3_999_998.0, 101.5)) < 1e-6, "{read:?}");
                assert_eq!(read.len(), 2);
            }
        }
    }

    #[test]
    fn what_is_no_las_says_why() {
        let whole = file(2, 3, 34, &[[1, 2, 3]; 4]);
        let check = |bytes: &[u8], expect: &str| {
            let error = read(bytes).unwrap_err();
            assert!(error.contains(expect), "{error}");
        };
        check(b"", "begins with LASF");
        check(&whole[..100], "cut short");
        check(&whole[..whole.len() - 1], "1 to 3 points");
        check(&file(1, 3, 34, &[]), "1.2 to 1.4, found 1.1");
        check(&file(2, 3, 33, &[[1, 2, 3]]), "at least 34 bytes");
        check(&file(2, 11, 90, &[[1, 2, 3]]), "format of 0 to 10, found 11");
        check(&file(2, 3 | 0x80, 34, &[[1, 2, 3]]), "LAZ");
    }
}
