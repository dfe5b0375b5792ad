//! A Parquet column of lists, of which some rows are wanted.

use super::fault;
use crate::ReadError;
use crate::parquet::{Rows, Sink, Table};

/// Reads rows in any order; ascending ones are read in one go.
pub(super) struct ListColumn<'a> {
    table: &'a Table,
    name: String,
    rows: Rows<'a>,
    /// The row that comes next.
    next: usize,
}

impl<'a> ListColumn<'a> {
    pub(super) fn new(table: &'a Table, name: &str) -> Result<Self, ReadError> {
        Ok(Self { table, name: name.to_owned(), rows: table.column(name)?, next: 0 })
    }

    /// A row's list; empty where there is none.
    pub(super) fn numbers(&mut self, row: usize) -> Result<Vec<f64>, ReadError> {
        let mut numbers = Vec::new();
        self.read(row, &mut Sink::Numbers(&mut numbers))?;
        Ok(numbers)
    }

    /// A row's list; empty where there is none.
    pub(super) fn integers(&mut self, row: usize) -> Result<Vec<i64>, ReadError> {
        let mut integers = Vec::new();
        self.read(row, &mut Sink::Integers(&mut integers))?;
        Ok(integers)
    }

    /// The error of a row that is not what it should be.
    pub(super) fn damaged(&self, row: usize, expected: &str, found: String) -> ReadError {
        fault::damaged(self.table.path(), format!("column '{}', row {row}", self.name), expected, found)
    }

    fn read(&mut self, row: usize, sink: &mut Sink) -> Result<(), ReadError> {
        if row < self.next {
            (self.rows, self.next) = (self.table.column(&self.name)?, 0);
        }
        while self.next < row {
            self.rows.read(&mut Sink::Nowhere)?;
            self.next += 1;
        }
        self.next += 1;
        self.rows.read(sink).map(|_| ())
    }
}
