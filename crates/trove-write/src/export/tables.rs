//! Files that sum frames up: rows that the steps have written, one step's in memory at once.

use std::io::{self, Write};

use serde_json::Value;
use serde_json::value::RawValue;

use super::dataset::Finished;
use super::json_file::JsonFile;
use super::unit::Unit;
use crate::WriteError;

/// Writes a split's JSON file: fields, then lists by the names of their tables.
pub(crate) fn write_tables(
    finished: &Finished<'_>,
    split: &str,
    path: &str,
    fields: &[(&str, Value)],
    tables: &[(&str, &str)],
    unit: &mut Unit<'_>,
) -> Result<(), WriteError> {
    let mut fault = None;
    let written = unit.stream(path, |file| {
        let mut json = JsonFile::begin(file)?;
        for (name, value) in fields {
            json.field(name, value)?;
        }
        for (name, table) in tables {
            json.begin_list(name)?;
            each_row(finished, Some(split), table, &mut fault, |row| json.row(row))?;
            json.end_list()?;
        }
        json.end()
    });
    written.map_err(|error| fault.unwrap_or(error))
}

/// Writes a JSON file that is one list: first rows that belong to no step, then those of all steps.
pub(crate) fn write_list(
    finished: &Finished<'_>,
    path: &str,
    first: &[Value],
    table: &str,
    unit: &mut Unit<'_>,
) -> Result<(), WriteError> {
    let mut fault = None;
    let written = unit.stream(path, |file| {
        let mut separator = "[\n";
        let mut row = |text: &str| {
            write!(file, "{separator}{text}")?;
            separator = ",\n";
            Ok(())
        };
        for value in first {
            row(&value.to_string())?;
        }
        each_row(finished, None, table, &mut fault, |text| row(text.get()))?;
        // A list without rows has not been begun.
        file.write_all(if separator == "[\n" { b"[]\n" } else { b"\n]\n" })
    });
    written.map_err(|error| fault.unwrap_or(error))
}

/// Hands out the rows of a table; what cannot be read goes to `fault`.
fn each_row(
    finished: &Finished<'_>,
    split: Option<&str>,
    table: &str,
    fault: &mut Option<WriteError>,
    mut row: impl FnMut(&RawValue) -> io::Result<()>,
) -> io::Result<()> {
    for rows in finished.rows(split) {
        match rows {
            Ok((_, rows)) => rows.get(table).into_iter().flatten().try_for_each(|text| row(text))?,
            Err(error) => {
                *fault = Some(error);
                return Err(io::ErrorKind::InvalidData.into());
            }
        }
    }
    Ok(())
}
