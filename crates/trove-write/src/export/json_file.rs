//! JSON files that are larger than memory: one list after another, row by row.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::value::RawValue;

/// An object whose fields are written one after another.
pub(crate) struct JsonFile<'w, W: Write> {
    writer: &'w mut W,
    is_first_field: bool,
    is_first_row: bool,
}

impl<'w, W: Write> JsonFile<'w, W> {
    /// Begins the file.
    pub(crate) fn begin(writer: &'w mut W) -> io::Result<Self> {
        writer.write_all(b"{")?;
        Ok(Self { writer, is_first_field: true, is_first_row: true })
    }

    /// A field with its value.
    pub(crate) fn field(&mut self, name: &str, value: &impl Serialize) -> io::Result<()> {
        self.name(name)?;
        Ok(serde_json::to_writer(&mut *self.writer, value)?)
    }

    /// Begins a field that is a list; its rows follow, then [`JsonFile::end_list`].
    pub(crate) fn begin_list(&mut self, name: &str) -> io::Result<()> {
        self.name(name)?;
        self.is_first_row = true;
        self.writer.write_all(b"[")
    }

    /// A row of the list.
    pub(crate) fn row(&mut self, row: &RawValue) -> io::Result<()> {
        let separator: &[u8] = if self.is_first_row { b"\n" } else { b",\n" };
        self.is_first_row = false;
        self.writer.write_all(separator)?;
        self.writer.write_all(row.get().as_bytes())
    }

    /// Ends the list.
    pub(crate) fn end_list(&mut self) -> io::Result<()> {
        self.writer.write_all(b"]")
    }

    /// Ends the file.
    pub(crate) fn end(self) -> io::Result<()> {
        self.writer.write_all(b"}\n")
    }

    fn name(&mut self, name: &str) -> io::Result<()> {
        let separator: &[u8] = if self.is_first_field { b"\n" } else { b",\n" };
        self.is_first_field = false;
        self.writer.write_all(separator)?;
        serde_json::to_writer(&mut *self.writer, name)?;
        self.writer.write_all(b": ")
    }
}
