//! nuScenes' radars: PCD files of eighteen fields, as its devkit's `RadarPointCloud` reads them.

use trove_model::{Class, RadarDetection};

use super::pcd::{self, Field};
use crate::{StoredRadarCycle, WriteError};

/// Names, bytes and types of a record's fields.
const FIELDS: [Field; 18] = [
    ("x", 4, 'F'),
    ("y", 4, 'F'),
    ("z", 4, 'F'),
    ("dyn_prop", 1, 'I'),
    ("id", 2, 'I'),
    ("rcs", 4, 'F'),
    ("vx", 4, 'F'),
    ("vy", 4, 'F'),
    ("vx_comp", 4, 'F'),
    ("vy_comp", 4, 'F'),
    ("is_quality_valid", 1, 'I'),
    ("ambig_state", 1, 'I'),
    ("x_rms", 1, 'I'),
    ("y_rms", 1, 'I'),
    ("invalid_state", 1, 'I'),
    ("pdh0", 1, 'I'),
    ("vx_rms", 1, 'I'),
    ("vy_rms", 1, 'I'),
];
/// The ARS 408's steps of standard deviations: a number stands for less than its value, metres or metres a second.
const RMS: [f64; 31] = [
    0.005, 0.006, 0.008, 0.011, 0.014, 0.018, 0.023, 0.029, 0.038, 0.049, 0.063, 0.081, 0.105, 0.135, 0.174, 0.224,
    0.288, 0.371, 0.478, 0.616, 0.794, 1.023, 1.317, 1.697, 2.187, 2.817, 3.630, 4.676, 6.025, 7.762, 10.0,
];
/// Dynamic properties.
const MOVING: u8 = 0;
const STATIONARY: u8 = 1;
const ONCOMING: u8 = 2;
/// The speed is no alias of another.
const UNAMBIGUOUS: u8 = 3;
/// Probabilities of an artefact: below 25 %, and below 75 % for what two or more surfaces have sent on.
const SURELY: u8 = 1;
const PERHAPS: u8 = 3;

/// A cycle's file; without detections it has one record that is not a number, as nuScenes marks that.
pub(super) fn file(cycle: &StoredRadarCycle) -> Result<Vec<u8>, WriteError> {
    let detections = cycle.detections()?;
    let mut bytes = pcd::header(&FIELDS, detections.len().max(1), pcd::UNMOVED);
    for (id, told) in (0..).zip(&detections) {
        bytes.extend(record(id, told, cycle.table.stands_mps));
    }
    if detections.is_empty() {
        let nothing = RadarDetection {
            range_m: f64::NAN,
            azimuth_rad: f64::NAN,
            radial_mps: f64::NAN,
            ground_mps: f64::NAN,
            rcs_dbsm: f64::NAN,
            range_error_m: 0.0,
            azimuth_error_rad: 0.0,
            speed_error_mps: 0.0,
            class: Class::Void,
            instance: trove_model::InstanceId(0),
            surfaces: 0,
        };
        bytes.extend(record(0, &nothing, 0.0));
    }
    // The devkit asks that something follows the last record.
    bytes.push(b'\n');
    Ok(bytes)
}

fn record(id: u16, told: &RadarDetection, stands_mps: f64) -> Vec<u8> {
    let (left, ahead) = told.azimuth_rad.sin_cos();
    let dynamic = match told.ground_mps {
        mps if mps.abs() < stands_mps => STATIONARY,
        mps if mps < 0.0 => ONCOMING,
        _ => MOVING,
    };
    // Along the line of sight and across it, in the sensor's axes.
    let across_m = told.range_m * told.azimuth_error_rad;
    let [x_m, y_m] = [(ahead, left), (left, ahead)].map(|(a, b)| (told.range_error_m * a).hypot(across_m * b));
    let [vx_mps, vy_mps] = [ahead, left].map(|share| (told.speed_error_mps * share).abs());
    let artefact = if told.surfaces > 1 { PERHAPS } else { SURELY };
    let mut bytes = Vec::with_capacity(43);
    let floats = |bytes: &mut Vec<u8>, values: &[f64]| {
        values.iter().for_each(|value| bytes.extend_from_slice(&(*value as f32).to_le_bytes()));
    };
    floats(&mut bytes, &[told.range_m * ahead, told.range_m * left, 0.0]);
    bytes.push(dynamic);
    bytes.extend_from_slice(&id.to_le_bytes());
    let (v, ground) = (told.radial_mps, told.ground_mps);
    floats(&mut bytes, &[told.rcs_dbsm, v * ahead, v * left, ground * ahead, ground * left]);
    bytes.extend_from_slice(&[1, UNAMBIGUOUS, rms(x_m), rms(y_m), 0, artefact, rms(vx_mps), rms(vy_mps)]);
    bytes
}

/// The number of a standard deviation's step.
fn rms(deviation: f64) -> u8 {
    RMS.iter().position(|step| deviation < *step).unwrap_or(RMS.len() - 1) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::InstanceId;

    #[test]
    fn a_record_is_as_the_devkit_unpacks_it() {
        let told = RadarDetection {
            range_m: 20.0,
            azimuth_rad: std::f64::consts::FRAC_PI_6,
            radial_mps: -8.0,
            ground_mps: -2.0,
            rcs_dbsm: 11.5,
            range_error_m: 0.1,
            azimuth_error_rad: 0.005,
            speed_error_mps: 0.0139,
            class: Class::Car,
            instance: InstanceId(7),
            surfaces: 2,
        };
        let bytes = record(258, &told, 0.4);
        assert_eq!(bytes.len(), FIELDS.iter().map(|field| usize::from(field.1)).sum::<usize>());
        let float = |at: usize| f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
        assert!((float(0) - 17.320_508).abs() < 1e-5 && (float(4) - 10.0).abs() < 1e-5 && float(8) == 0.0);
        assert_eq!((bytes[12], &bytes[13..15]), (ONCOMING, &[2, 1][..]));
        assert!((float(19) + 6.928_203).abs() < 1e-5 && (float(31) + 1.0).abs() < 1e-5);
        // 0.1 m along the line of sight and across it.
        assert_eq!(bytes[35..], [1, 3, 12, 12, 0, PERHAPS, 4, 2]);
        assert_eq!((rms(0.0049), rms(0.005), rms(99.0)), (0, 1, 30));
    }
}
