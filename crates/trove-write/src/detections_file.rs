//! `detections.npy`: what a radar tells as a structured array of NumPy, a record a detection.

use trove_model::{Class, InstanceId, RadarDetection};

use crate::npy;

const FIELDS: [(&str, &str); 13] = [
    ("x", "<f4"),
    ("y", "<f4"),
    ("range_m", "<f4"),
    ("azimuth_rad", "<f4"),
    ("radial_mps", "<f4"),
    ("ground_mps", "<f4"),
    ("rcs_dbsm", "<f4"),
    ("range_error_m", "<f4"),
    ("azimuth_error_rad", "<f4"),
    ("speed_error_mps", "<f4"),
    ("instance", "<u4"),
    ("class", "|u1"),
    ("surfaces", "|u1"),
];
const RECORD_BYTES: usize = 46;

/// The file's bytes.
pub(crate) fn encode(detections: &[RadarDetection]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(detections.len() * RECORD_BYTES);
    for told in detections {
        let (left, ahead) = told.azimuth_rad.sin_cos();
        let numbers = [
            told.range_m * ahead,
            told.range_m * left,
            told.range_m,
            told.azimuth_rad,
            told.radial_mps,
            told.ground_mps,
            told.rcs_dbsm,
            told.range_error_m,
            told.azimuth_error_rad,
            told.speed_error_mps,
        ];
        numbers.iter().for_each(|number| bytes.extend_from_slice(&(*number as f32).to_le_bytes()));
        bytes.extend_from_slice(&told.instance.0.to_le_bytes());
        bytes.extend_from_slice(&[told.class.id(), told.surfaces]);
    }
    npy::encode_records(&FIELDS, detections.len(), &bytes)
}

/// The detections of bytes that [`encode`] wrote; what is wrong with others.
pub(crate) fn decode(bytes: &[u8]) -> Result<Vec<RadarDetection>, String> {
    npy::records::<RECORD_BYTES>(&FIELDS, bytes)?.iter().map(detection).collect()
}

fn detection(record: &[u8; RECORD_BYTES]) -> Result<RadarDetection, String> {
    let four = |i: usize| [record[4 * i], record[4 * i + 1], record[4 * i + 2], record[4 * i + 3]];
    let number = |i: usize| f64::from(f32::from_le_bytes(four(i)));
    Ok(RadarDetection {
        range_m: number(2),
        azimuth_rad: number(3),
        radial_mps: number(4),
        ground_mps: number(5),
        rcs_dbsm: number(6),
        range_error_m: number(7),
        azimuth_error_rad: number(8),
        speed_error_mps: number(9),
        instance: InstanceId(u32::from_le_bytes(four(10))),
        class: Class::from_id(record[44]).ok_or_else(|| format!("class {}, which there is not", record[44]))?,
        surfaces: record[45],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_comes_back() {
        let told = RadarDetection {
            range_m: 20.5,
            azimuth_rad: -0.25,
            radial_mps: -7.5,
            ground_mps: 0.125,
            rcs_dbsm: 10.5,
            range_error_m: 0.25,
            azimuth_error_rad: 0.0625,
            speed_error_mps: 0.5,
            class: Class::Car,
            instance: InstanceId(70_001),
            surfaces: 2,
        };
        let bytes = encode(&[told; 3]);
        assert_eq!(decode(&bytes).unwrap(), [told; 3]);
        assert!(decode(&bytes[..bytes.len() - 1]).is_err());
        assert_eq!(decode(&encode(&[])).unwrap(), []);
    }
}
