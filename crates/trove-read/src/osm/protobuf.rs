//! Protocol Buffers' wire format: fields of a message, without a schema.
//!
//! <https://protobuf.dev/programming-guides/encoding>. The `osmpbf` crate panics on damaged files (sums that
//! overflow, member types that do not exist), so the forty lines that are needed stand here.

/// What stands in a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value<'a> {
    Varint(u64),
    Bytes(&'a [u8]),
    /// Of four or eight bytes: no field that is read is one.
    Fixed,
}

/// A message's fields as (number, value); an error where the bytes are none, after which it ends.
pub(super) struct Fields<'a> {
    rest: &'a [u8],
}

/// The bytes are no message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Malformed;

impl<'a> Fields<'a> {
    pub(super) fn new(message: &'a [u8]) -> Self {
        Self { rest: message }
    }

    fn field(&mut self) -> Result<(u32, Value<'a>), Malformed> {
        let key = take_varint(&mut self.rest)?;
        let number = u32::try_from(key >> 3).map_err(|_| Malformed)?;
        let value = match key & 7 {
            0 => Value::Varint(take_varint(&mut self.rest)?),
            1 => take_bytes(&mut self.rest, 8).map(|_| Value::Fixed)?,
            2 => {
                let len = take_varint(&mut self.rest)?;
                Value::Bytes(take_bytes(&mut self.rest, usize::try_from(len).map_err(|_| Malformed)?)?)
            }
            5 => take_bytes(&mut self.rest, 4).map(|_| Value::Fixed)?,
            _ => return Err(Malformed),
        };
        Ok((number, value))
    }
}

impl<'a> Iterator for Fields<'a> {
    type Item = Result<(u32, Value<'a>), Malformed>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let field = self.field();
        if field.is_err() {
            self.rest = &[];
        }
        Some(field)
    }
}

impl<'a> Value<'a> {
    /// A nested message, a string.
    pub(super) fn bytes(self) -> Result<&'a [u8], Malformed> {
        if let Self::Bytes(bytes) = self { Ok(bytes) } else { Err(Malformed) }
    }

    /// A plain number.
    pub(super) fn varint(self) -> Result<u64, Malformed> {
        if let Self::Varint(value) = self { Ok(value) } else { Err(Malformed) }
    }

    /// Appends the numbers of a repeated field, packed or one by one.
    pub(super) fn append_to(self, numbers: &mut Vec<u64>) -> Result<(), Malformed> {
        match self {
            Self::Varint(value) => numbers.push(value),
            Self::Fixed => return Err(Malformed),
            Self::Bytes(mut packed) => {
                while !packed.is_empty() {
                    numbers.push(take_varint(&mut packed)?);
                }
            }
        }
        Ok(())
    }
}

/// A number of type `sint64`.
pub(super) fn zigzag(value: u64) -> i64 {
    (value >> 1) as i64 ^ -((value & 1) as i64)
}

/// Running sums of `sint64` differences; where they overflow they wrap, which damaged files alone do.
pub(super) fn running_sums(deltas: &[u64]) -> impl Iterator<Item = i64> + '_ {
    deltas.iter().scan(0i64, |sum, &delta| {
        *sum = sum.wrapping_add(zigzag(delta));
        Some(*sum)
    })
}

fn take_varint(rest: &mut &[u8]) -> Result<u64, Malformed> {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let (&byte, tail) = rest.split_first().ok_or(Malformed)?;
        *rest = tail;
        value |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            return Ok(value);
        }
    }
    Err(Malformed)
}

fn take_bytes<'a>(rest: &mut &'a [u8], len: usize) -> Result<&'a [u8], Malformed> {
    let (head, tail) = rest.split_at_checked(len).ok_or(Malformed)?;
    *rest = tail;
    Ok(head)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_specifications_examples_are_read() {
        let fields: Vec<_> = Fields::new(&[0x08, 0x96, 0x01]).collect();
        assert_eq!(fields, [Ok((1, Value::Varint(150)))]);
        let fields: Vec<_> = Fields::new(b"\x12\x07testing").collect();
        assert_eq!(fields, [Ok((2, Value::Bytes(b"testing")))]);
        assert_eq!([0, 1, 2, 0xffff_ffff].map(zigzag), [0, -1, 1, -0x8000_0000]);
        assert_eq!(Fields::new(&[0x12, 0x07, b't']).next(), Some(Err(Malformed)));
    }
}
