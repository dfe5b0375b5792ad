//! The values of a page.

use std::rc::Rc;

use super::fault::Fault;
use super::runs::Runs;
use trove_files::Budget;

/// How values are written, by the number in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Physical {
    Bool,
    Int32,
    Int64,
    Float,
    Double,
    Bytes,
}

impl Physical {
    pub(super) fn of(number: i64) -> Option<Self> {
        Some(match number {
            0 => Self::Bool,
            1 => Self::Int32,
            2 => Self::Int64,
            4 => Self::Float,
            5 => Self::Double,
            6 => Self::Bytes,
            _ => return None,
        })
    }

    /// Bytes of a value; `None` for texts and bools.
    fn size(self) -> Option<usize> {
        match self {
            Self::Bool | Self::Bytes => None,
            Self::Int32 | Self::Float => Some(4),
            Self::Int64 | Self::Double => Some(8),
        }
    }
}

/// Where values go.
pub(crate) enum Sink<'a> {
    Nowhere,
    Integers(&'a mut Vec<i64>),
    /// Of either precision.
    Numbers(&'a mut Vec<f64>),
    Texts(&'a mut Vec<Vec<u8>>),
}

impl Sink<'_> {
    /// Whether values of a kind can go there.
    pub(super) fn takes(&self, kind: Physical) -> bool {
        match self {
            Self::Nowhere => true,
            Self::Integers(_) => matches!(kind, Physical::Bool | Physical::Int32 | Physical::Int64),
            Self::Numbers(_) => matches!(kind, Physical::Float | Physical::Double),
            Self::Texts(_) => kind == Physical::Bytes,
        }
    }

    pub(super) fn wants(&self) -> &'static str {
        match self {
            Self::Nowhere => "anything",
            Self::Integers(_) => "integers",
            Self::Numbers(_) => "floating-point numbers",
            Self::Texts(_) => "texts",
        }
    }

    fn put(&mut self, kind: Physical, value: &[u8], times: usize) {
        let double = || match *value {
            [a, b, c, d] => f64::from(f32::from_le_bytes([a, b, c, d])),
            [a, b, c, d, e, f, g, h] => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
            _ => f64::NAN,
        };
        let integer = || match *value {
            [a] => i64::from(a),
            [a, b, c, d] => i64::from(i32::from_le_bytes([a, b, c, d])),
            [a, b, c, d, e, f, g, h] => i64::from_le_bytes([a, b, c, d, e, f, g, h]),
            _ => 0,
        };
        match self {
            Self::Nowhere => {}
            Self::Integers(sink) => sink.extend(std::iter::repeat_n(integer(), times)),
            Self::Numbers(sink) => sink.extend(std::iter::repeat_n(double(), times)),
            Self::Texts(sink) => sink.extend(std::iter::repeat_n(value.to_vec(), times)),
        }
        debug_assert!(self.takes(kind));
    }

    /// Bytes that a value takes there.
    fn size(&self, value: &[u8]) -> usize {
        match self {
            Self::Nowhere => 0,
            Self::Integers(_) | Self::Numbers(_) => 8,
            Self::Texts(_) => size_of::<Vec<u8>>() + value.len(),
        }
    }
}

/// Distinct values of a column, to which its pages refer.
pub(super) struct Dictionary {
    kind: Physical,
    bytes: Vec<u8>,
    /// Where each value begins and ends.
    spans: Vec<(u32, u32)>,
}

impl Dictionary {
    pub(super) fn new(kind: Physical, bytes: Vec<u8>, count: usize, budget: &Budget) -> Result<Self, Fault> {
        budget.take(count, size_of::<(u32, u32)>())?;
        let (mut spans, mut at) = (Vec::new(), 0);
        for _ in 0..count {
            let span = next_span(kind, &bytes, &mut at)?;
            spans.push((span.0 as u32, span.1 as u32));
        }
        Ok(Self { kind, bytes, spans })
    }

    fn get(&self, index: u32) -> Result<&[u8], Fault> {
        let span = self.spans.get(index as usize).map(|&(from, to)| &self.bytes[from as usize..to as usize]);
        span.ok_or_else(|| {
            Fault::new(format!("an index into a dictionary of {} values", self.spans.len()), index.to_string())
        })
    }
}

/// Values of a page that are still to be read.
pub(super) enum Values {
    Plain {
        kind: Physical,
        bytes: Vec<u8>,
        at: usize,
    },
    /// Bools, a bit each.
    Bits {
        bytes: Vec<u8>,
        at: usize,
    },
    /// Bools, as runs.
    Bools(Runs),
    Indexed {
        dictionary: Rc<Dictionary>,
        indices: Runs,
    },
}

impl Values {
    /// Puts the next values somewhere.
    pub(super) fn take(&mut self, mut count: usize, sink: &mut Sink, budget: &Budget) -> Result<(), Fault> {
        match self {
            Self::Plain { kind, bytes, at } => {
                if let Some(size) = kind.size() {
                    let end = count.checked_mul(size).and_then(|length| at.checked_add(length));
                    let values = end.and_then(|end| bytes.get(*at..end)).ok_or_else(ended)?;
                    budget.take(count, sink.size(&[]))?;
                    values.chunks_exact(size).for_each(|value| sink.put(*kind, value, 1));
                    *at += values.len();
                    return Ok(());
                }
                for _ in 0..count {
                    let (from, to) = next_span(*kind, bytes, at)?;
                    let value = &bytes[from..to];
                    budget.take(1, sink.size(value))?;
                    sink.put(*kind, value, 1);
                }
            }
            Self::Bits { bytes, at } => {
                budget.take(count, sink.size(&[]))?;
                for _ in 0..count {
                    let byte = bytes.get(*at / 8).ok_or_else(ended)?;
                    sink.put(Physical::Bool, &[byte >> (*at % 8) & 1], 1);
                    *at += 1;
                }
            }
            Self::Bools(runs) => {
                while count > 0 {
                    let (value, times) = runs.peek(count)?;
                    budget.take(times, sink.size(&[]))?;
                    sink.put(Physical::Bool, &[(value & 1) as u8], times);
                    runs.pass(times);
                    count -= times;
                }
            }
            Self::Indexed { dictionary, indices } => {
                while count > 0 {
                    let (index, times) = indices.peek(count)?;
                    let value = dictionary.get(index)?;
                    budget.take(times, sink.size(value))?;
                    sink.put(dictionary.kind, value, times);
                    indices.pass(times);
                    count -= times;
                }
            }
        }
        Ok(())
    }
}

/// The next value in plain bytes; texts begin with their length.
fn next_span(kind: Physical, bytes: &[u8], at: &mut usize) -> Result<(usize, usize), Fault> {
    let size = match kind.size() {
        Some(size) => size,
        None => {
            let length = bytes.get(*at..).and_then(|rest| rest.first_chunk()).ok_or_else(ended)?;
            *at += 4;
            u32::from_le_bytes(*length) as usize
        }
    };
    let from = *at;
    let to = from.checked_add(size).filter(|to| *to <= bytes.len()).ok_or_else(ended)?;
    *at = to;
    Ok((from, to))
}

fn ended() -> Fault {
    Fault::new("more values", "the end of a page")
}
