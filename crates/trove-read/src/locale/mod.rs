//! Borders and a table of customs → [`Locale`].
//!
//! Which country a point lies in comes from real borders (`country-boundaries`, whose data are OpenStreetMap's); what its
//! customs are comes from `locales.toml`, which a user's own table may extend.

mod borders;
mod table;

use std::collections::BTreeMap;
use std::path::Path;

use trove_files::{LARGEST_TEXT, read_text};
use trove_model::{Locale, Outcome, Provenance, Report};

use crate::ReadError;
use borders::Finding;
use table::Table;

/// The customs of all countries.
#[derive(Clone, Debug)]
pub struct Locales {
    by_code: BTreeMap<String, Locale>,
    /// Where no country is known.
    nowhere: Locale,
}

impl Locales {
    /// The built-in table.
    #[allow(clippy::missing_panics_doc)] // a test reads that table
    pub fn built_in() -> Self {
        Self::of(&Table::built_in()).expect("a test reads the built-in table")
    }

    /// The built-in table with a user's own rows over it.
    ///
    /// # Errors
    /// A file that cannot be read, is no TOML, or has rows, keys or values that mean nothing; each names the nearest
    /// one that does.
    pub fn with_file(path: &Path) -> Result<Self, ReadError> {
        let text = read_text(path, LARGEST_TEXT).map_err(|source| ReadError::io(path, source))?;
        let read = || Self::of(&Table::built_in().extended_by(&text)?);
        read().map_err(|fault| fault.at(path))
    }

    fn of(table: &Table) -> Result<Self, table::Fault> {
        let codes = table.codes();
        let by_code = codes.iter().map(|code| Ok((code.clone(), table.locale(code)?))).collect::<Result<_, _>>()?;
        Ok(Self { by_code, nowhere: table.default_locale()? })
    }

    /// The customs of a country by its ISO 3166 code (`GB`); `None` for a code that the table does not have.
    pub fn country(&self, code: &str) -> Option<&Locale> {
        self.by_code.get(code)
    }

    /// The codes that the table has, ascending.
    pub fn codes(&self) -> impl Iterator<Item = &str> {
        self.by_code.keys().map(String::as_str)
    }

    /// The customs of the country that a place on earth lies in, by latitude and longitude in degrees.
    ///
    /// At sea they are those of the nearest coast within 200 km, and elsewhere the table's default; what is guessed is
    /// reported.
    pub fn at(&self, lat_deg: f64, lon_deg: f64, report: &Report) -> Locale {
        let here = format!("{lat_deg:.3}, {lon_deg:.3}");
        let (found, guessed) = match borders::country(lat_deg, lon_deg, |code| self.by_code.contains_key(code)) {
            Finding::Inside(code) => (self.country(code), None),
            Finding::Near(code) => (self.country(code), Some("customs of a place at sea, from the nearest country")),
            Finding::Nowhere => (None, Some("customs of a place far from any country, from the table's default")),
        };
        if let Some(what) = guessed {
            report.note(Outcome::Guessed, what, here);
        }
        found.unwrap_or(&self.nowhere).clone()
    }
}

/// Where borders come from.
pub fn provenance() -> Provenance {
    Provenance {
        source: "borders of countries (country-boundaries)".into(),
        licence: "© OpenStreetMap contributors, ODbL 1.0".into(),
    }
}

#[cfg(test)]
mod tests;
