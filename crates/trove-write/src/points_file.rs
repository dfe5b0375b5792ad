//! `points.npy`: a LiDAR's points as a structured array of NumPy (format 1.0), a record a point.

use glam::DVec3;
use trove_model::{Class, InstanceId, LidarPoint};

use crate::npy;

/// Names and NumPy's types of a record's fields, in their order.
const FIELDS: [(&str, &str); 9] = [
    ("x", "<f4"),
    ("y", "<f4"),
    ("z", "<f4"),
    ("time_s", "<f4"),
    ("instance", "<u4"),
    ("ring", "<u2"),
    ("intensity", "|u1"),
    ("class", "|u1"),
    ("return", "|u1"),
];
const RECORD_BYTES: usize = 25;

/// The file's bytes.
pub(crate) fn encode(points: &[LidarPoint]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(points.len() * RECORD_BYTES);
    for point in points {
        let numbers = [point.position_m.x, point.position_m.y, point.position_m.z, point.time_s];
        numbers.iter().for_each(|number| bytes.extend_from_slice(&(*number as f32).to_le_bytes()));
        bytes.extend_from_slice(&point.instance.0.to_le_bytes());
        bytes.extend_from_slice(&point.ring.to_le_bytes());
        bytes.extend_from_slice(&[point.intensity, point.class.id(), point.number]);
    }
    npy::encode_records(&FIELDS, points.len(), &bytes)
}

/// The points of bytes that [`encode`] wrote; what is wrong with others.
pub(crate) fn decode(bytes: &[u8]) -> Result<Vec<LidarPoint>, String> {
    npy::records::<RECORD_BYTES>(&FIELDS, bytes)?.iter().map(point).collect()
}

fn point(record: &[u8; RECORD_BYTES]) -> Result<LidarPoint, String> {
    let four = |at: usize| [record[at], record[at + 1], record[at + 2], record[at + 3]];
    let number = |at: usize| f64::from(f32::from_le_bytes(four(at)));
    Ok(LidarPoint {
        position_m: DVec3::new(number(0), number(4), number(8)),
        time_s: number(12),
        instance: InstanceId(u32::from_le_bytes(four(16))),
        ring: u16::from_le_bytes([record[20], record[21]]),
        intensity: record[22],
        class: Class::from_id(record[23]).ok_or_else(|| format!("class {}, which there is not", record[23]))?,
        number: record[24],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(count: usize) -> Vec<LidarPoint> {
        let point = |i: usize| LidarPoint {
            position_m: DVec3::new(1.5, -2.25, 0.125) * i as f64,
            intensity: 7,
            ring: 31,
            number: 1,
            time_s: -0.046_875,
            class: Class::Tree,
            instance: InstanceId(70_000 + i as u32),
        };
        (0..count).map(point).collect()
    }

    #[test]
    fn what_is_written_comes_back_and_the_header_is_numpys() {
        for count in [0, 1, 123_456] {
            let bytes = encode(&points(count));
            assert_eq!(decode(&bytes).unwrap(), points(count));
            let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
            assert!((length + 10).is_multiple_of(64) && bytes[length + 9] == b'\n');
            assert_eq!(bytes.len(), 10 + length + count * 25);
            let header = std::str::from_utf8(&bytes[10..10 + length]).unwrap();
            assert!(header.contains(&format!("'shape': ({count},)")), "{header}");
        }
    }

    #[test]
    fn other_bytes_are_refused() {
        let good = encode(&points(2));
        let mut no_class = good.clone();
        *no_class.iter_mut().rev().nth(1).unwrap() = 99;
        let other = String::from_utf8_lossy(&encode(&[])).replace("ring", "rung").into_bytes();
        for bytes in [&good[..good.len() - 1], &good[..5], &no_class, &other, b"", &[0; 200]] {
            assert!(decode(bytes).is_err());
        }
    }
}
