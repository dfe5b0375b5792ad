//! NumPy's array files, as far as the dataset uses them: two dimensions, small floats.

use trove_model::Raster;

const MAGIC: &[u8] = b"\x93NUMPY";

/// A two-dimensional array of little-endian float16, float32 or float64 in C's order, row by row; the error says what is
/// expected and what is found.
pub(super) fn read(bytes: &[u8]) -> Result<Raster<f32>, (String, String)> {
    let wrong = |expected: &str, found: &str| Err((expected.to_owned(), found.to_owned()));
    let Some(rest) = bytes.strip_prefix(MAGIC) else { return wrong("a NumPy array", "something else") };
    let split = match rest {
        [1, _, a, b, rest @ ..] => rest.split_at_checked(usize::from(u16::from_le_bytes([*a, *b]))),
        [2 | 3, _, a, b, c, d, rest @ ..] => rest.split_at_checked(u32::from_le_bytes([*a, *b, *c, *d]) as usize),
        _ => return wrong("a NumPy array of version 1, 2 or 3", "another"),
    };
    let Some((header, data)) = split else { return wrong("a whole header", "the end of the file") };
    let header = String::from_utf8_lossy(header);
    let Some(kind) = ["<f2", "<f4", "<f8"].into_iter().position(|kind| header.contains(&format!("'{kind}'"))) else {
        return wrong("little-endian floats of 2, 4 or 8 bytes", &header);
    };
    if !header.contains("'fortran_order': False") {
        return wrong("an array in C's order", &header);
    }
    let Some([height, width]) = shape(&header) else { return wrong("a shape of two numbers", &header) };
    let bytes_each = 2usize << kind;
    let expected = u128::from(width) * u128::from(height) * bytes_each as u128;
    if expected != data.len() as u128 || width == 0 || height == 0 {
        return wrong(&format!("{height} × {width} values of {bytes_each} bytes"), &format!("{} bytes", data.len()));
    }
    let value = |bytes: &[u8]| match *bytes {
        [a, b] => from_half(u16::from_le_bytes([a, b])),
        [a, b, c, d] => f32::from_le_bytes([a, b, c, d]),
        [a, b, c, d, e, f, g, h] => f64::from_le_bytes([a, b, c, d, e, f, g, h]) as f32,
        _ => f32::NAN,
    };
    Ok(Raster { width, height, data: data.chunks_exact(bytes_each).map(value).collect() })
}

/// The two numbers in the brackets after `'shape':`.
fn shape(header: &str) -> Option<[u32; 2]> {
    let (_, rest) = header.split_once("'shape':")?;
    let (inside, _) = rest.trim_start().strip_prefix('(')?.split_once(')')?;
    let numbers: Vec<u32> =
        inside.split(',').map(str::trim).filter(|n| !n.is_empty()).map(|n| n.parse().ok()).collect::<Option<_>>()?;
    numbers.try_into().ok()
}

/// IEEE 754's half precision.
fn from_half(bits: u16) -> f32 {
    let (exponent, fraction) = (i32::from(bits >> 10 & 0x1f), f32::from(bits & 0x3ff));
    let size = match exponent {
        0 => fraction * 2f32.powi(-24),
        0x1f if fraction == 0.0 => f32::INFINITY,
        0x1f => f32::NAN,
        _ => (1.0 + fraction / 1024.0) * 2f32.powi(exponent - 15),
    };
    if bits >> 15 == 1 { -size } else { size }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn array(header: &str, data: &[u8]) -> Vec<u8> {
        let length = (header.len() as u16).to_le_bytes();
        [MAGIC, &[1, 0], &length, header.as_bytes(), data].concat()
    }

    #[test]
    fn halves_are_what_the_standard_says() {
        let halves =
            [(0x3c00, 1.0), (0xc000, -2.0), (0x7bff, 65504.0), (0x0001, 5.960_464_5e-8), (0x3555, 0.333_251_95)];
        for (bits, value) in halves {
            assert_eq!(from_half(bits), value);
        }
        assert!(from_half(0x7e00).is_nan() && from_half(0xfc00) == f32::NEG_INFINITY);
    }

    #[test]
    fn an_array_is_read_row_by_row_and_a_wrong_one_says_what_is_wrong() {
        let header = "{'descr': '<f2', 'fortran_order': False, 'shape': (1, 2), }   \n";
        let raster = read(&array(header, &[0, 0x3c, 0, 0xc0])).unwrap();
        assert_eq!((raster.width, raster.height, raster.data), (2, 1, vec![1.0, -2.0]));
        let wrong = |header: &str, data: &[u8]| read(&array(header, data)).unwrap_err().0;
        assert!(wrong(header, &[0; 3]).contains("1 × 2 values of 2 bytes"));
        assert!(wrong(&header.replace("<f2", ">f2"), &[0; 4]).contains("little-endian"));
        assert!(wrong(&header.replace("False", "True"), &[0; 4]).contains("C's order"));
        assert!(wrong(&header.replace("(1, 2)", "(2,)"), &[0; 4]).contains("two numbers"));
        assert!(wrong(&header.replace("(1, 2)", "(4294967295, 4294967295)"), &[0; 4]).contains("values"));
        assert!(read(&array(header, &[])[..20]).unwrap_err().0.contains("whole header"));
    }

    proptest! {
        #[test]
        fn any_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..80)) {
            let _ = read(&[MAGIC, &bytes[..]].concat());
        }
    }
}
