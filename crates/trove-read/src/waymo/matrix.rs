//! Range images of v1: a zlib stream of a `MatrixFloat`.

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::fault::Unusable;
use super::range_image::Grid;
use crate::protobuf::{Fields, Malformed, Value};
use trove_files::Budget;

/// Four times the largest there is, 64 beams × 2650 columns × 6 numbers, bytes.
const LARGEST_GRID: u64 = 16 << 20;

/// Unpacks a range image.
pub(super) fn grid(packed: &[u8], budget: &Budget) -> Result<Grid, Unusable> {
    let mut message = Vec::new();
    let unpacked = ZlibDecoder::new(packed).take(LARGEST_GRID + 1).read_to_end(&mut message);
    budget.take(message.len(), 1)?;
    if unpacked.is_err() || message.len() as u64 > LARGEST_GRID {
        return Err(Unusable::Malformed);
    }
    let (mut values, mut shape) = (Vec::new(), Vec::new());
    for field in Fields::new(&message) {
        match field? {
            (1, Value::Bytes(packed)) => {
                let (floats, rest) = packed.as_chunks();
                if !rest.is_empty() {
                    return Err(Unusable::Malformed);
                }
                values.extend(floats.iter().map(|bytes| f32::from_le_bytes(*bytes)));
            }
            (1, Value::Fixed32(bytes)) => values.push(f32::from_le_bytes(bytes)),
            (2, value) => shape = dimensions(value.bytes()?)?,
            _ => {}
        }
    }
    Ok(Grid::new(&shape, values).ok_or(Malformed)?)
}

fn dimensions(message: &[u8]) -> Result<Vec<i64>, Malformed> {
    let mut dimensions = Vec::new();
    for field in Fields::new(message) {
        if let (1, value) = field? {
            value.append_to(&mut dimensions)?;
        }
    }
    Ok(dimensions.into_iter().map(|n| n as i64).collect())
}
