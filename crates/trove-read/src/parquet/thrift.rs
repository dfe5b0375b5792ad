//! Thrift's compact protocol, without a schema.
//!
//! <https://github.com/apache/thrift/blob/master/doc/specs/thrift-compact-protocol.md>

use super::fault::Fault;
use trove_files::Budget;

/// Structures of Parquet are five deep.
const DEEPEST: usize = 16;

/// What stands in a field.
#[derive(Debug)]
pub(super) enum Thrift<'a> {
    Integer(i64),
    Bytes(&'a [u8]),
    List(Vec<Thrift<'a>>),
    Struct(Vec<(i16, Thrift<'a>)>),
    /// A double, a map: no field that is read is one.
    Other,
}

impl<'a> Thrift<'a> {
    /// Reads a structure and moves `input` behind it.
    pub(super) fn read(input: &mut &'a [u8], budget: &Budget) -> Result<Self, Fault> {
        Reader { input, budget }.structure(0)
    }

    /// A field of a structure.
    pub(super) fn field(&self, number: i16) -> Option<&Self> {
        let Self::Struct(fields) = self else { return None };
        fields.iter().find(|(n, _)| *n == number).map(|(_, value)| value)
    }

    /// A number in a field of a structure.
    pub(super) fn integer(&self, number: i16) -> Option<i64> {
        if let Some(Self::Integer(value)) = self.field(number) { Some(*value) } else { None }
    }

    /// The elements of a list in a field of a structure; none where there is no list.
    pub(super) fn list(&self, number: i16) -> &[Self] {
        if let Some(Self::List(elements)) = self.field(number) { elements } else { &[] }
    }

    /// Text in a field of a structure.
    pub(super) fn text(&self, number: i16) -> Option<&'a str> {
        if let Some(Self::Bytes(bytes)) = self.field(number) { std::str::from_utf8(bytes).ok() } else { None }
    }
}

struct Reader<'i, 'a, 'b> {
    input: &'i mut &'a [u8],
    budget: &'b Budget,
}

impl<'a> Reader<'_, 'a, '_> {
    fn structure(&mut self, depth: usize) -> Result<Thrift<'a>, Fault> {
        let (mut fields, mut number) = (Vec::new(), 0i16);
        loop {
            let head = self.byte()?;
            if head == 0 {
                return Ok(Thrift::Struct(fields));
            }
            let step = i16::from(head >> 4);
            number = match step {
                0 => i16::try_from(self.zigzag()?).map_err(|_| broken())?,
                _ => number.checked_add(step).ok_or_else(broken)?,
            };
            // A bool is its own type.
            let value = match head & 0x0f {
                1 => Thrift::Integer(1),
                2 => Thrift::Integer(0),
                kind => self.value(kind, depth + 1)?,
            };
            self.budget.take(1, size_of::<(i16, Thrift)>())?;
            fields.push((number, value));
        }
    }

    fn value(&mut self, kind: u8, depth: usize) -> Result<Thrift<'a>, Fault> {
        if depth > DEEPEST {
            return Err(broken());
        }
        Ok(match kind {
            1 | 2 => Thrift::Integer(i64::from(self.byte()? == 1)),
            3 => Thrift::Integer(i64::from(self.byte()? as i8)),
            4..=6 => Thrift::Integer(self.zigzag()?),
            7 => self.take(8).map(|_| Thrift::Other)?,
            8 => {
                let length = usize::try_from(self.varint()?).map_err(|_| broken())?;
                Thrift::Bytes(self.take(length)?)
            }
            9 | 10 => {
                let head = self.byte()?;
                let count = if head >> 4 == 15 { self.varint()? } else { u64::from(head >> 4) };
                let mut elements = Vec::new();
                for _ in 0..count {
                    self.budget.take(1, size_of::<Thrift>())?;
                    elements.push(self.value(head & 0x0f, depth + 1)?);
                }
                Thrift::List(elements)
            }
            11 => {
                let count = self.varint()?;
                let kinds = if count > 0 { self.byte()? } else { 0 };
                for _ in 0..count {
                    self.budget.take(2, size_of::<Thrift>())?;
                    self.value(kinds >> 4, depth + 1)?;
                    self.value(kinds & 0x0f, depth + 1)?;
                }
                Thrift::Other
            }
            12 => self.structure(depth)?,
            _ => return Err(broken()),
        })
    }

    fn byte(&mut self) -> Result<u8, Fault> {
        Ok(self.take(1)?[0])
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], Fault> {
        let (head, tail) = self.input.split_at_checked(count).ok_or_else(broken)?;
        *self.input = tail;
        Ok(head)
    }

    fn varint(&mut self) -> Result<u64, Fault> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err(broken())
    }

    fn zigzag(&mut self) -> Result<i64, Fault> {
        let value = self.varint()?;
        Ok((value >> 1) as i64 ^ -((value & 1) as i64))
    }
}

fn broken() -> Fault {
    Fault::new("a Thrift structure", "bytes that are none")
}
