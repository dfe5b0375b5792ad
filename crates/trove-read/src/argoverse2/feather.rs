//! Tables in Arrow's file format (Feather, version 2), by column.
//!
//! What the file says of itself is checked before arrow-ipc decodes it: only flat columns of numbers, text and truth values,
//! every block and buffer inside the file, and what they unpack to within the budget.

use std::io::{Cursor, ErrorKind};
use std::path::{Path, PathBuf};

use arrow_array::cast::AsArray;
use arrow_array::types::{
    ArrowPrimitiveType, Float16Type, Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, UInt8Type,
    UInt16Type, UInt32Type, UInt64Type,
};
use arrow_array::{Array, ArrayRef, PrimitiveArray};
use arrow_ipc::reader::FileReaderBuilder;
use arrow_ipc::{Block, Endianness, Footer, MetadataVersion, Type, root_as_footer, root_as_message};
use arrow_schema::DataType;
use trove_files::{LARGEST_FILE, read_regular};

use crate::ReadError;
use trove_files::Budget;

const MAGIC: &[u8] = b"ARROW1";
/// The footer's length and the magic, at the end.
const TRAILER_BYTES: usize = 10;
/// Before a message: a marker and its length.
const PREFIX_BYTES: usize = 8;
const CONTINUATION: [u8; 4] = [0xff; 4];

/// Some columns of a table.
pub(super) struct Table {
    path: PathBuf,
    names: Vec<String>,
    /// By batch, the columns that were asked for.
    batches: Vec<Vec<ArrayRef>>,
    rows: usize,
}

/// What is wrong in a file: place, what is expected there, what is found.
struct Damage(String, String, String);

fn damage(place: &str, expected: &str, found: impl ToString) -> Damage {
    Damage(place.to_owned(), expected.to_owned(), found.to_string())
}

impl Table {
    /// Reads some columns of a file.
    pub(super) fn read(path: &Path, columns: &[&str]) -> Result<Self, ReadError> {
        let bytes = read_regular(path, LARGEST_FILE).map_err(|source| match source.kind() {
            ErrorKind::NotFound => ReadError::Missing {
                path: path.to_owned(),
                expected: "a Feather file of Argoverse 2".to_owned(),
                found: "no file".to_owned(),
                remedy: "download the whole log".to_owned(),
            },
            _ => ReadError::io(path, source),
        })?;
        Self::decode(path, &bytes, columns).map_err(|Damage(place, expected, found)| ReadError::Format {
            path: path.to_owned(),
            place,
            expected,
            found,
            remedy: "the file is damaged or another dataset's: download it again".to_owned(),
        })
    }

    fn decode(path: &Path, bytes: &[u8], columns: &[&str]) -> Result<Self, Damage> {
        let budget = Budget::of_file(bytes.len() as u64);
        let footer = footer(bytes)?;
        let fields = fields(&footer)?;
        for block in footer.recordBatches().into_iter().flatten() {
            check_batch(bytes, block, &fields, &budget)?;
        }
        let position = |name: &&str| {
            let found = fields.iter().position(|(field, _)| field == name);
            found.ok_or_else(|| damage("schema", &format!("a column '{name}'"), list(&fields)))
        };
        let projection = columns.iter().map(position).collect::<Result<Vec<_>, _>>()?;
        let undecodable = |e: arrow_schema::ArrowError| damage("content", "columns that can be decoded", e);
        let reader = FileReaderBuilder::new().with_projection(projection).build(Cursor::new(bytes));
        let reader = reader.map_err(undecodable)?;
        // The reader gives columns in the file's order.
        let names: Vec<_> = reader.schema().fields().iter().map(|field| field.name().clone()).collect();
        let (mut batches, mut rows) = (Vec::new(), 0);
        for batch in reader {
            let batch = batch.map_err(undecodable)?;
            rows += batch.num_rows();
            batches.push(batch.columns().to_vec());
        }
        // As values of eight bytes or text, which is at most as long as the buffers.
        budget.take(rows, 32 * names.len()).map_err(|e| damage("content", &e.expected(), format!("{rows} rows")))?;
        Ok(Self { path: path.to_owned(), names, batches, rows })
    }

    /// How many rows there are.
    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// A column of decimal numbers of any width; NaN where it has none.
    pub(super) fn numbers(&self, name: &str) -> Result<Vec<f64>, ReadError> {
        self.column(name, "decimal numbers", |array, out: &mut Vec<f64>| match array.data_type() {
            DataType::Float16 => extend::<Float16Type, _>(array, out, |v| v.map_or(f64::NAN, f64::from)),
            DataType::Float32 => extend::<Float32Type, _>(array, out, |v| v.map_or(f64::NAN, f64::from)),
            DataType::Float64 => extend::<Float64Type, _>(array, out, |v| v.unwrap_or(f64::NAN)),
            _ => None,
        })
    }

    /// A column of whole numbers of any width; `None` where it has none, or one above an i64's.
    pub(super) fn integers(&self, name: &str) -> Result<Vec<Option<i64>>, ReadError> {
        self.column(name, "whole numbers", |array, out: &mut Vec<Option<i64>>| match array.data_type() {
            DataType::Int8 => extend::<Int8Type, _>(array, out, |v| v.map(i64::from)),
            DataType::Int16 => extend::<Int16Type, _>(array, out, |v| v.map(i64::from)),
            DataType::Int32 => extend::<Int32Type, _>(array, out, |v| v.map(i64::from)),
            DataType::Int64 => extend::<Int64Type, _>(array, out, |v| v),
            DataType::UInt8 => extend::<UInt8Type, _>(array, out, |v| v.map(i64::from)),
            DataType::UInt16 => extend::<UInt16Type, _>(array, out, |v| v.map(i64::from)),
            DataType::UInt32 => extend::<UInt32Type, _>(array, out, |v| v.map(i64::from)),
            DataType::UInt64 => extend::<UInt64Type, _>(array, out, |v| v.and_then(|v| v.try_into().ok())),
            _ => None,
        })
    }

    /// A column of text; `None` where it has none.
    pub(super) fn words(&self, name: &str) -> Result<Vec<Option<String>>, ReadError> {
        self.column(name, "text", |array, out: &mut Vec<Option<String>>| match array.data_type() {
            DataType::Utf8 => {
                out.extend(array.as_string_opt::<i32>()?.iter().map(|text| text.map(str::to_owned)));
                Some(())
            }
            DataType::LargeUtf8 => {
                out.extend(array.as_string_opt::<i64>()?.iter().map(|text| text.map(str::to_owned)));
                Some(())
            }
            _ => None,
        })
    }

    fn column<T>(
        &self,
        name: &str,
        of: &str,
        append: impl Fn(&ArrayRef, &mut Vec<T>) -> Option<()>,
    ) -> Result<Vec<T>, ReadError> {
        let place = format!("column '{name}'");
        let wrong = |found: String| ReadError::Format {
            path: self.path.clone(),
            place: place.clone(),
            expected: format!("a column of {of}"),
            found,
            remedy: "the file is another dataset's or was written anew: download it again".to_owned(),
        };
        let at = self.names.iter().position(|n| n == name).ok_or_else(|| wrong("none of that name".to_owned()))?;
        let mut values = Vec::with_capacity(self.rows);
        for batch in &self.batches {
            append(&batch[at], &mut values).ok_or_else(|| wrong(format!("one of {}", batch[at].data_type())))?;
        }
        Ok(values)
    }
}

fn extend<T: ArrowPrimitiveType, V>(
    array: &ArrayRef,
    out: &mut Vec<V>,
    value: impl Fn(Option<T::Native>) -> V,
) -> Option<()> {
    let array: &PrimitiveArray<T> = array.as_primitive_opt()?;
    out.extend(array.iter().map(value));
    Some(())
}

/// What stands at the file's end.
fn footer(bytes: &[u8]) -> Result<Footer<'_>, Damage> {
    let expected = "a Feather file (Arrow's file format, version 2)";
    let is_arrow = bytes.len() > MAGIC.len() + TRAILER_BYTES && bytes.starts_with(MAGIC) && bytes.ends_with(MAGIC);
    if !is_arrow {
        let found = if bytes.starts_with(MAGIC) { "its beginning alone" } else { "something else" };
        return Err(damage("beginning and end", expected, found));
    }
    let end = bytes.len() - TRAILER_BYTES;
    let length = bytes[end..].first_chunk().map_or(0, |length| i32::from_le_bytes(*length));
    let start = usize::try_from(length).ok().and_then(|length| end.checked_sub(length));
    let Some(start) = start else { return Err(damage("end", "a footer inside the file", format!("{length} bytes"))) };
    let footer = root_as_footer(&bytes[start..end]).map_err(|e| damage("footer", expected, e))?;
    if footer.dictionaries().is_some_and(|d| !d.is_empty()) {
        return Err(damage("footer", "plain columns", "dictionaries"));
    }
    if !(MetadataVersion::V4..=MetadataVersion::V5).contains(&footer.version()) {
        return Err(damage("footer", "version 4 or 5", format!("{:?}", footer.version())));
    }
    Ok(footer)
}

/// Names of the columns, with how many buffers each has.
fn fields(footer: &Footer<'_>) -> Result<Vec<(String, usize)>, Damage> {
    let schema = footer.schema().ok_or_else(|| damage("footer", "a schema", "none"))?;
    if schema.endianness() != Endianness::Little {
        return Err(damage("schema", "little-endian numbers", format!("{:?}", schema.endianness())));
    }
    let mut fields = Vec::new();
    for field in schema.fields().into_iter().flatten() {
        let name = field.name().unwrap_or_default();
        let is_flat = field.dictionary().is_none() && field.children().is_none_or(|c| c.is_empty());
        let buffers = match field.type_type() {
            Type::Int => field.type_as_int().filter(|int| matches!(int.bitWidth(), 8 | 16 | 32 | 64)).map(|_| 2),
            Type::FloatingPoint => {
                field.type_as_floating_point().filter(|f| (0..3).contains(&f.precision().0)).map(|_| 2)
            }
            Type::Bool => Some(2),
            Type::Utf8 | Type::LargeUtf8 => Some(3),
            _ => None,
        };
        let Some(buffers) = buffers.filter(|_| is_flat) else {
            let found = format!("{:?}", field.type_type());
            return Err(damage(&format!("column '{name}'"), "numbers, text or truth values", found));
        };
        fields.push((name.to_owned(), buffers));
    }
    Ok(fields)
}

fn list(fields: &[(String, usize)]) -> String {
    let names: Vec<_> = fields.iter().take(20).map(|(name, _)| name.as_str()).collect();
    names.join(", ")
}

/// Whether a batch lies in the file, fits the schema, and unpacks to what the budget has left.
fn check_batch(bytes: &[u8], block: &Block, fields: &[(String, usize)], budget: &Budget) -> Result<(), Damage> {
    let place = format!("batch at byte {}", block.offset());
    let expected = "a batch of the schema's columns inside the file";
    let wrong = |found: &str| damage(&place, expected, found);
    let inside = |offset: i64, length: i64, whole: &[u8]| {
        let start = usize::try_from(offset).ok()?;
        let end = start.checked_add(usize::try_from(length).ok()?)?;
        (end <= whole.len()).then_some((start, end))
    };
    let metadata = inside(block.offset(), block.metaDataLength().into(), bytes);
    let (start, body) = metadata.ok_or_else(|| wrong("one beyond its end"))?;
    // Without the marker arrow-ipc would look for the message elsewhere than here.
    if body - start < PREFIX_BYTES || !bytes[start..].starts_with(&CONTINUATION) {
        return Err(wrong("one without a head"));
    }
    let (_, end) = inside(body as i64, block.bodyLength(), bytes).ok_or_else(|| wrong("one beyond its end"))?;
    let message = root_as_message(&bytes[start + PREFIX_BYTES..body]).map_err(|e| damage(&place, expected, e))?;
    let Some(batch) = message.header_as_record_batch() else { return Err(wrong("another message")) };
    let rows = batch.length();
    let nodes = batch.nodes().into_iter().flatten();
    let are_nodes_right = batch.nodes().is_some_and(|nodes| nodes.len() == fields.len())
        && nodes.clone().all(|node| node.length() == rows && (0..=rows).contains(&node.null_count()));
    if rows < 0 || !are_nodes_right {
        return Err(wrong("columns of other lengths"));
    }
    let buffers = batch.buffers().into_iter().flatten();
    if buffers.clone().count() != fields.iter().map(|(_, buffers)| buffers).sum::<usize>() {
        return Err(wrong("more or fewer buffers"));
    }
    for buffer in buffers {
        let inside = inside(buffer.offset(), buffer.length(), &bytes[body..end]);
        let (from, to) = inside.ok_or_else(|| wrong("a buffer beyond its end"))?;
        let packed = &bytes[body + from..body + to];
        let unpacked = match batch.compression() {
            Some(_) if !packed.is_empty() => {
                let length = packed.first_chunk().map(|length| i64::from_le_bytes(*length));
                match length {
                    Some(-1) => Some(packed.len()),
                    Some(length) => usize::try_from(length).ok(),
                    None => None,
                }
            }
            _ => Some(packed.len()),
        };
        let unpacked = unpacked.ok_or_else(|| wrong("a buffer of no length"))?;
        budget.take(unpacked, 1).map_err(|e| damage(&place, &e.expected(), format!("a buffer of {unpacked} bytes")))?;
    }
    Ok(())
}
