//! Files that sum a split up: fixed fields, then lists of the rows that its frames have written.

use serde_json::Value;

use super::dataset::Finished;
use super::json_file::JsonFile;
use super::unit::Unit;
use crate::WriteError;

/// Writes a split's JSON file: fields, then lists by the names of their tables; one step's rows are in memory at once.
pub(crate) fn write_tables(
    finished: &Finished<'_>,
    split: &str,
    path: &str,
    fields: &[(&str, Value)],
    tables: &[(&str, &str)],
    unit: &mut Unit<'_>,
) -> Result<(), WriteError> {
    let mut fault = None;
    unit.stream(path, |file| {
        let mut json = JsonFile::begin(file)?;
        for (name, value) in fields {
            json.field(name, value)?;
        }
        for (name, table) in tables {
            json.begin_list(name)?;
            for rows in finished.rows(Some(split)) {
                match rows {
                    Ok((_, rows)) => rows.get(*table).into_iter().flatten().try_for_each(|row| json.row(row))?,
                    Err(error) => {
                        fault = Some(error);
                        return Err(std::io::ErrorKind::InvalidData.into());
                    }
                }
            }
            json.end_list()?;
        }
        json.end()
    })
    .map_err(|error| fault.take().unwrap_or(error))
}
