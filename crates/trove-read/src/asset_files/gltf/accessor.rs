//! Numbers in buffers.

use super::container::{Container, none};
use super::json::Accessor;
use crate::asset_files::fault::Fault;
use crate::asset_files::model::too_large;

impl Container {
    /// An accessor's numbers, `components` a value; integers that are normalized become −1 to 1 or 0 to 1.
    pub(super) fn floats(&self, accessor: usize, components: usize, place: &str) -> Result<Vec<f32>, Fault> {
        let (a, place) = self.accessor(accessor, components, place)?;
        let size = component_size(a.component_type, &place)?;
        let number = |bytes: &[u8]| decode(bytes, a.component_type, a.normalized);
        let total = a.count.saturating_mul(components);
        self.budget.take(total, size_of::<f32>()).map_err(|e| too_large(&place, e))?;
        let mut values = match a.buffer_view {
            Some(view) => {
                let (bytes, stride) = self.view(view, &place)?;
                let elements = elements(bytes, a.byte_offset, stride, size * components, a.count, &place)?;
                elements.flat_map(|e| e.chunks_exact(size).map(number)).collect()
            }
            None => vec![0.0; total],
        };
        if let Some(sparse) = &a.sparse {
            let (bytes, stride) = self.view(sparse.indices.buffer_view, &place)?;
            let width = component_size(sparse.indices.component_type, &place)?;
            let indices = elements(bytes, sparse.indices.byte_offset, stride, width, sparse.count, &place)?;
            let (bytes, stride) = self.view(sparse.values.buffer_view, &place)?;
            let news = elements(bytes, sparse.values.byte_offset, stride, size * components, sparse.count, &place)?;
            for (index, new) in indices.zip(news) {
                let at = integer(index, sparse.indices.component_type) as usize;
                let slot = at.checked_mul(components).and_then(|i| values.get_mut(i..i + components));
                let slot = slot.ok_or_else(|| none(&place, "sparse index", at, a.count))?;
                slot.iter_mut().zip(new.chunks_exact(size)).for_each(|(s, b)| *s = number(b));
            }
        }
        Ok(values)
    }

    /// An accessor's whole numbers, `components` a value.
    pub(super) fn integers(&self, accessor: usize, components: usize, place: &str) -> Result<Vec<u32>, Fault> {
        let (a, place) = self.accessor(accessor, components, place)?;
        let size = component_size(a.component_type, &place)?;
        let view = a.buffer_view.ok_or_else(|| Fault::damaged(&place, "a bufferView", "none"))?;
        self.budget.take(a.count.saturating_mul(components), size_of::<u32>()).map_err(|e| too_large(&place, e))?;
        let (bytes, stride) = self.view(view, &place)?;
        let elements = elements(bytes, a.byte_offset, stride, size * components, a.count, &place)?;
        Ok(elements.flat_map(|e| e.chunks_exact(size).map(|b| integer(b, a.component_type))).collect())
    }

    /// How many numbers an accessor's values have (a colour's 3 or 4).
    pub(super) fn components(&self, accessor: usize) -> usize {
        self.root.accessors.get(accessor).map_or(0, |a| width(&a.shape))
    }

    fn accessor(&self, accessor: usize, components: usize, place: &str) -> Result<(&Accessor, String), Fault> {
        let place = format!("{place}: accessors[{accessor}]");
        let count = self.root.accessors.len();
        let a = self.root.accessors.get(accessor).ok_or_else(|| none(&place, "accessor", accessor, count))?;
        if width(&a.shape) != components {
            return Err(Fault::damaged(place, format!("{components} numbers per value"), format!("{:?}", a.shape)));
        }
        Ok((a, place))
    }
}

fn width(shape: &str) -> usize {
    match shape {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        "MAT4" => 16,
        _ => 0,
    }
}

fn component_size(component_type: u32, place: &str) -> Result<usize, Fault> {
    match component_type {
        5120 | 5121 => Ok(1),
        5122 | 5123 => Ok(2),
        5125 | 5126 => Ok(4),
        other => Err(Fault::damaged(place, "a componentType of glTF", other.to_string())),
    }
}

/// `count` slices of `size` bytes, `stride` apart.
fn elements<'a>(
    bytes: &'a [u8],
    offset: usize,
    stride: Option<usize>,
    size: usize,
    count: usize,
    place: &str,
) -> Result<impl Iterator<Item = &'a [u8]>, Fault> {
    let stride = stride.unwrap_or(size).max(1);
    let length = if count == 0 {
        Some(0)
    } else {
        stride.checked_mul(count - 1).and_then(|n| n.checked_add(size)).and_then(|n| n.checked_add(offset))
    };
    if length.is_none_or(|n| n > bytes.len()) {
        let expected = format!("{count} values of {size} bytes, {stride} apart, from byte {offset}");
        return Err(Fault::damaged(place, expected, format!("{} bytes", bytes.len())));
    }
    Ok((0..count).map(move |i| &bytes[offset + i * stride..offset + i * stride + size]))
}

fn integer(bytes: &[u8], component_type: u32) -> u32 {
    match (component_type, bytes) {
        (5120, [a]) => (*a as i8).max(0) as u32,
        (5121, [a]) => u32::from(*a),
        (5122, [a, b]) => i16::from_le_bytes([*a, *b]).max(0) as u32,
        (5123, [a, b]) => u32::from(u16::from_le_bytes([*a, *b])),
        (5126, [a, b, c, d]) => f32::from_le_bytes([*a, *b, *c, *d]) as u32,
        (_, [a, b, c, d]) => u32::from_le_bytes([*a, *b, *c, *d]),
        _ => 0,
    }
}

fn decode(bytes: &[u8], component_type: u32, normalized: bool) -> f32 {
    let (value, scale) = match (component_type, bytes) {
        (5120, [a]) => (f32::from(*a as i8), 127.0),
        (5121, [a]) => (f32::from(*a), 255.0),
        (5122, [a, b]) => (f32::from(i16::from_le_bytes([*a, *b])), 32767.0),
        (5123, [a, b]) => (f32::from(u16::from_le_bytes([*a, *b])), 65535.0),
        (5126, [a, b, c, d]) => return f32::from_le_bytes([*a, *b, *c, *d]),
        (_, [a, b, c, d]) => return u32::from_le_bytes([*a, *b, *c, *d]) as f32,
        _ => (0.0, 1.0),
    };
    if normalized { (value / scale).max(-1.0) } else { value }
}
