//! JSON files that are one list: rows of all steps, one step in memory at once.

use std::io::Write;

use serde_json::Value;

use super::dataset::Finished;
use super::unit::Unit;
use crate::WriteError;

/// Writes a list: first rows that belong to no step, then those that the steps have written for a table.
pub(crate) fn write_list(
    finished: &Finished<'_>,
    path: &str,
    first: &[Value],
    table: &str,
    unit: &mut Unit<'_>,
) -> Result<(), WriteError> {
    let mut fault = None;
    unit.stream(path, |file| {
        let mut separator = "[\n";
        let mut row = |file: &mut dyn Write, text: &str| {
            write!(file, "{separator}{text}")?;
            separator = ",\n";
            Ok::<(), std::io::Error>(())
        };
        for value in first {
            row(file, &value.to_string())?;
        }
        for rows in finished.rows(None) {
            match rows {
                Ok((_, rows)) => rows.get(table).into_iter().flatten().try_for_each(|text| row(file, text.get()))?,
                Err(error) => {
                    fault = Some(error);
                    return Err(std::io::ErrorKind::InvalidData.into());
                }
            }
        }
        // A list without rows has not been begun.
        file.write_all(if separator == "[\n" { b"[]\n" } else { b"\n]\n" })
    })
    .map_err(|error| fault.take().unwrap_or(error))
}
