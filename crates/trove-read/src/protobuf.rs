//! Protocol Buffers' wire format: fields of a message, without a schema.
//!
//! <https://protobuf.dev/programming-guides/encoding>. OpenStreetMap's PBF and Waymo's frames are made of it. The `osmpbf`
//! crate panics on damaged files (sums that overflow, member types that do not exist), so the few lines that are needed
//! stand here.

/// What stands in a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value<'a> {
    Varint(u64),
    Bytes(&'a [u8]),
    Fixed32([u8; 4]),
    Fixed64([u8; 8]),
}

/// A message's fields as (number, value); an error where the bytes are none, after which it ends.
pub(crate) struct Fields<'a> {
    rest: &'a [u8],
}

/// The bytes are no message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Malformed;

impl<'a> Fields<'a> {
    pub(crate) fn new(message: &'a [u8]) -> Self {
        Self { rest: message }
    }

    fn field(&mut self) -> Result<(u32, Value<'a>), Malformed> {
        let key = take_varint(&mut self.rest)?;
        let number = u32::try_from(key >> 3).map_err(|_| Malformed)?;
        let value = match key & 7 {
            0 => Value::Varint(take_varint(&mut self.rest)?),
            1 => Value::Fixed64(take_array(&mut self.rest)?),
            2 => {
                let len = take_varint(&mut self.rest)?;
                Value::Bytes(take_bytes(&mut self.rest, usize::try_from(len).map_err(|_| Malformed)?)?)
            }
            5 => Value::Fixed32(take_array(&mut self.rest)?),
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
    pub(crate) fn bytes(self) -> Result<&'a [u8], Malformed> {
        if let Self::Bytes(bytes) = self { Ok(bytes) } else { Err(Malformed) }
    }

    /// A plain number.
    pub(crate) fn varint(self) -> Result<u64, Malformed> {
        if let Self::Varint(value) = self { Ok(value) } else { Err(Malformed) }
    }

    /// Text, of which bytes that are not UTF-8 are replaced.
    pub(crate) fn text(self) -> Result<String, Malformed> {
        Ok(String::from_utf8_lossy(self.bytes()?).into_owned())
    }

    /// A number of type `double`, or `float`.
    pub(crate) fn double(self) -> Result<f64, Malformed> {
        match self {
            Self::Fixed64(bytes) => Ok(f64::from_le_bytes(bytes)),
            Self::Fixed32(bytes) => Ok(f64::from(f32::from_le_bytes(bytes))),
            _ => Err(Malformed),
        }
    }

    /// Appends the numbers of a repeated `double`, packed or one by one, as far as `most` in all.
    pub(crate) fn append_doubles_to(self, numbers: &mut Vec<f64>, most: usize) -> Result<(), Malformed> {
        match self {
            Self::Bytes(packed) => {
                let (doubles, rest) = packed.as_chunks();
                numbers.extend(
                    doubles.iter().map(|bytes| f64::from_le_bytes(*bytes)).take(most - numbers.len().min(most)),
                );
                if rest.is_empty() { Ok(()) } else { Err(Malformed) }
            }
            one => {
                let number = one.double()?;
                if numbers.len() < most {
                    numbers.push(number);
                }
                Ok(())
            }
        }
    }

    /// Appends the numbers of a repeated field, packed or one by one.
    pub(crate) fn append_to(self, numbers: &mut Vec<u64>) -> Result<(), Malformed> {
        match self {
            Self::Varint(value) => numbers.push(value),
            Self::Fixed32(_) | Self::Fixed64(_) => return Err(Malformed),
            Self::Bytes(mut packed) => {
                while !packed.is_empty() {
                    numbers.push(take_varint(&mut packed)?);
                }
            }
        }
        Ok(())
    }
}

/// The numbers that stand in some fields of a message.
pub(crate) fn doubles<const N: usize>(message: &[u8], fields: [u32; N]) -> Result<[Option<f64>; N], Malformed> {
    let mut numbers = [None; N];
    for field in Fields::new(message) {
        let (number, value) = field?;
        if let Some(i) = fields.iter().position(|field| *field == number) {
            numbers[i] = Some(value.double()?);
        }
    }
    Ok(numbers)
}

/// A number of type `sint64`.
pub(crate) fn zigzag(value: u64) -> i64 {
    (value >> 1) as i64 ^ -((value & 1) as i64)
}

/// Running sums of `sint64` differences; where they overflow they wrap, which damaged files alone do.
pub(crate) fn running_sums(deltas: &[u64]) -> impl Iterator<Item = i64> + '_ {
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

fn take_array<const N: usize>(rest: &mut &[u8]) -> Result<[u8; N], Malformed> {
    let (head, tail) = rest.split_first_chunk().ok_or(Malformed)?;
    *rest = tail;
    Ok(*head)
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
        let one = [&[0x09][..], &1.5f64.to_le_bytes(), &[0x0a, 0x08], &2.5f64.to_le_bytes()].concat();
        let mut doubles = Vec::new();
        Fields::new(&one).for_each(|field| field.unwrap().1.append_doubles_to(&mut doubles, 9).unwrap());
        assert_eq!(doubles, [1.5, 2.5]);
        assert_eq!(Fields::new(&[0x0d, 0, 0]).next(), Some(Err(Malformed)));
    }
}
