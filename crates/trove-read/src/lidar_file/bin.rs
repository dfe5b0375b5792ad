//! Points as float32: x, y, z, intensity.

use glam::DVec3;

use super::bytes::array;

const POINT_BYTES: usize = 16;

pub(super) fn points(bytes: &[u8]) -> Result<Vec<DVec3>, String> {
    if bytes.is_empty() || !bytes.len().is_multiple_of(POINT_BYTES) {
        let length = bytes.len();
        return Err(format!(
            "expected points of {POINT_BYTES} bytes (x, y, z, intensity as float32), found {length} bytes"
        ));
    }
    let point = |point: &[u8]| {
        let value = |i: usize| array(point, 4 * i).map_or(f64::NAN, |b| f64::from(f32::from_le_bytes(b)));
        DVec3::new(value(0), value(1), value(2))
    };
    Ok(bytes.chunks_exact(POINT_BYTES).map(point).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_four_floats() {
        let bytes: Vec<u8> =
            [1.5f32, -2.0, 0.25, 9.0, f32::NAN, 0.0, 0.0, 0.0].into_iter().flat_map(f32::to_le_bytes).collect();
        let read = points(&bytes).unwrap();
        assert_eq!(read[0], DVec3::new(1.5, -2.0, 0.25));
        assert!(read.len() == 2 && read[1].x.is_nan());
        assert!(points(&bytes[..31]).unwrap_err().contains("found 31 bytes"));
        assert!(points(&[]).is_err());
    }
}
