//! How a library's lamps shine: a table of luminous intensity from an IES file, lumens and colour.

use std::path::Path;

use trove_model::Luminaire;

use super::fault::Fault;
use super::library_file::LightEntry;
use super::picture::Pictures;
use crate::ReadError;

/// Reads what an entry's light names.
pub(super) fn luminaire(folder: &Path, entry: &LightEntry, pictures: &Pictures) -> Result<Luminaire, ReadError> {
    let ordinary = match &entry.table {
        Some(table) => {
            let path = folder.join(table);
            let bytes = pictures.folder.read(folder, table).map_err(|source| ReadError::io(&path, source))?;
            // Names of makers are often in Latin-1.
            Luminaire::from_ies(&String::from_utf8_lossy(&bytes)).map_err(|fault| {
                Fault::new(format!("line {}", fault.line), fault.expected, fault.found, fault.remedy).at(&path)
            })?
        }
        None => Luminaire::default(),
    };
    let (lumens, kelvin) = (entry.lumens.unwrap_or(ordinary.lumens), entry.kelvin.unwrap_or(ordinary.kelvin));
    Ok(Luminaire { lumens, kelvin, ..ordinary })
}
