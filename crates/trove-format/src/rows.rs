//! JSON with one line a field and one line an object of a list.

use std::io;

use serde::Serialize;
use serde_json::ser::Formatter;

/// A file's bytes, with a line break at the end.
pub(crate) fn bytes(value: &impl Serialize) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut serializer = serde_json::Serializer::with_formatter(&mut bytes, RowFormatter::default());
    value.serialize(&mut serializer).expect("types of this crate have keys that are strings");
    bytes.push(b'\n');
    bytes
}

/// One line a field and one line an object: files that are read by people, by `grep` and by `diff`.
#[derive(Default)]
struct RowFormatter {
    /// How many brackets are open.
    depth: usize,
}

impl RowFormatter {
    fn open<W: ?Sized + io::Write>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.depth += 1;
        writer.write_all(bracket)
    }

    fn close<W: ?Sized + io::Write>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.depth -= 1;
        writer.write_all(if self.depth == 0 { b"\n" } else { b"" })?;
        writer.write_all(bracket)
    }
}

impl Formatter for RowFormatter {
    fn begin_array<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.open(writer, b"[")
    }

    fn end_array<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, b"]")
    }

    fn begin_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        // An object in a list of the table's is a row.
        self.open(writer, if self.depth == 2 { b"\n{" } else { b"{" })
    }

    fn end_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, b"}")
    }

    fn begin_object_key<W: ?Sized + io::Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        writer.write_all(if first { b"" } else { b"," })?;
        writer.write_all(if self.depth == 1 { b"\n" } else { b"" })
    }
}
