//! The table of customs: rows that are like other rows.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde::Deserialize;
use toml::{Table as Keys, Value};
use trove_model::Locale;

use super::borders;
use crate::ReadError;
use crate::toml_fault::{self, nearest};

const BUILT_IN: &str = include_str!("locales.toml");
/// The key that names what a row or a section is like.
const LIKE: &str = "like";
const COUNTRIES: &str = "countries";
const COUNTRY: &str = "country";
/// Lists of which something is always taken.
const NEVER_EMPTY: [&str; 2] = ["models", "sidewalk"];
/// No length, share or colour is above this.
const LARGEST: f64 = 1000.0;
const REMEDY: &str = "correct it as docs/locales.md describes";

/// A mistake in a table.
#[derive(Debug)]
pub(super) struct Fault {
    place: String,
    expected: String,
    found: String,
}

impl Fault {
    fn new(place: impl Into<String>, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self { place: place.into(), expected: expected.into(), found: found.into() }
    }

    /// The error in the file that it is in.
    pub(super) fn at(self, path: &Path) -> ReadError {
        let Self { place, expected, found } = self;
        ReadError::Format { path: path.to_owned(), place, expected, found, remedy: REMEDY.into() }
    }
}

/// Finds numbers that are no length, share or colour, and lists that lack what is taken from them.
fn check(keys: &Keys, place: &str) -> Result<(), Fault> {
    keys.iter().try_for_each(|(key, value)| check_value(value, key, &format!("{place} {key}")))
}

fn check_value(value: &Value, key: &str, place: &str) -> Result<(), Fault> {
    let number = match value {
        Value::Table(keys) => return check(keys, place),
        Value::Array(values) if values.is_empty() && NEVER_EMPTY.contains(&key) => {
            return Err(Fault::new(place, "at least one", "none"));
        }
        Value::Array(values) => return values.iter().try_for_each(|value| check_value(value, key, place)),
        Value::Float(number) => *number,
        Value::Integer(number) => *number as f64,
        _ => return Ok(()),
    };
    if (0.0..=LARGEST).contains(&number) {
        return Ok(());
    }
    Err(Fault::new(place, format!("a number from 0 to {LARGEST}"), number.to_string()))
}

/// Rows by their names, and the groups of the countries that are listed.
#[derive(Clone, Debug, Default)]
pub(super) struct Table {
    rows: BTreeMap<String, Keys>,
    group_of: BTreeMap<String, String>,
}

impl Table {
    pub(super) fn built_in() -> Self {
        Self::default().with(BUILT_IN).expect("a test reads the built-in table")
    }

    /// With a user's rows: what they say counts before what stood there.
    pub(super) fn extended_by(self, text: &str) -> Result<Self, Fault> {
        let mut known = self.codes();
        known.extend(borders::codes().into_iter().map(str::to_owned));
        let extended = self.with(text)?;
        if let Some(code) = extended.codes().difference(&known).next() {
            let near = nearest(code, known.iter().map(String::as_str));
            return Err(Fault::new(format!("[{code}]"), "an ISO 3166 code", format!("{code:?}{near}")));
        }
        // Everything is read here, so that a mistake is found before it is needed.
        for row in extended.rows.keys() {
            extended.locale(row)?;
        }
        Ok(extended)
    }

    fn with(mut self, text: &str) -> Result<Self, Fault> {
        let read: Keys = toml::from_str(text).map_err(|error: toml::de::Error| {
            Fault::new(toml_fault::place(text, &error), "a table of locales (TOML)", error.message())
        })?;
        let mut rows = Vec::new();
        let mut listed = BTreeSet::new();
        for (name, row) in read {
            let Value::Table(mut row) = row else {
                return Err(Fault::new(name, "a row, such as [GB]", row.type_str()));
            };
            let place = format!("[{name}] {COUNTRIES}");
            for code in row.remove(COUNTRIES).map_or(Ok(Vec::new()), |codes| words(codes, &place))? {
                if is_code(&name) || !is_code(&code) {
                    return Err(Fault::new(place, "ISO 3166 codes, in the row of a group", format!("{code:?}")));
                }
                if !listed.insert(code.clone()) {
                    return Err(Fault::new(place, "countries that no other group lists", format!("{code:?}")));
                }
                // A country that a later table lists is like that group, whatever it was like before.
                self.rows.remove(&code);
                self.group_of.insert(code, name.clone());
            }
            check(&row, &format!("[{name}]"))?;
            rows.push((name, row));
        }
        for (name, row) in rows {
            merge(self.rows.entry(name).or_default(), row);
        }
        Ok(self)
    }

    /// The codes of all countries.
    pub(super) fn codes(&self) -> BTreeSet<String> {
        self.rows.keys().filter(|name| is_code(name)).chain(self.group_of.keys()).cloned().collect()
    }

    /// The customs of a country or a group.
    pub(super) fn locale(&self, name: &str) -> Result<Locale, Fault> {
        let mut keys = self.resolved(name, &mut Vec::new())?;
        if is_code(name) {
            keys.insert(COUNTRY.into(), name.into());
        }
        Locale::deserialize(Value::Table(keys)).map_err(|error| {
            let message = error.message();
            let hint = toml_fault::hint(message);
            Fault::new(format!("[{name}]"), "known customs", format!("{message}{hint}"))
        })
    }

    /// The customs of the row that is like no other, which stand for what is not listed.
    pub(super) fn default_locale(&self) -> Result<Locale, Fault> {
        let mut roots = self.rows.keys().filter(|name| self.like(name).is_none());
        match (roots.next(), roots.next()) {
            (Some(root), None) => self.locale(root),
            (_, second) => {
                let found = second.map_or("none".into(), |name| format!("[{name}] too"));
                Err(Fault::new("the table", "one row without `like`", found))
            }
        }
    }

    /// The row that a row is like: the one it names, else the group that lists it.
    fn like(&self, name: &str) -> Option<&str> {
        let own = self.rows.get(name).and_then(|row| row.get(LIKE)).and_then(Value::as_str);
        own.or_else(|| self.group_of.get(name).map(String::as_str))
    }

    /// A row with all that it has from others; `through` are the rows that lead to it.
    fn resolved(&self, name: &str, through: &mut Vec<String>) -> Result<Keys, Fault> {
        let place = || through.last().map_or_else(|| format!("[{name}]"), |from| format!("[{from}] {LIKE}"));
        if through.iter().any(|n| n == name) {
            return Err(Fault::new(place(), "a row that is not like itself", format!("{name:?}")));
        }
        if !self.rows.contains_key(name) && !self.group_of.contains_key(name) {
            let near = nearest(name, self.rows.keys().chain(self.group_of.keys()).map(String::as_str));
            return Err(Fault::new(place(), "the name of a row", format!("{name:?}{near}")));
        }
        through.push(name.to_owned());
        let mut keys = self.like(name).map_or(Ok(Keys::new()), |like| self.resolved(like, through))?;
        let mut own = self.rows.get(name).cloned().unwrap_or_default();
        own.remove(LIKE);
        if own.contains_key(COUNTRY) {
            return Err(Fault::new(format!("[{name}]"), "customs", format!("`{COUNTRY}`; the row's name is the code")));
        }
        for (section, value) in &mut own {
            let Some(like) = value.as_table_mut().and_then(|section| section.remove(LIKE)) else { continue };
            let place = format!("[{name}.{section}] {LIKE}");
            let like = like.as_str().ok_or_else(|| Fault::new(&place, "the name of a row", like.to_string()))?;
            let mut other = self.resolved(like, through)?;
            let other =
                other.remove(section).ok_or_else(|| Fault::new(place, "a section of a row", section.as_str()))?;
            keys.insert(section.clone(), other);
        }
        merge(&mut keys, own);
        through.pop();
        Ok(keys)
    }
}

/// Whether a row's name is a country's or a subdivision's code.
fn is_code(name: &str) -> bool {
    let (country, part) = name.split_once('-').map_or((name, None), |(country, part)| (country, Some(part)));
    let is_part = |part: &str| {
        (1..=3).contains(&part.len()) && part.bytes().all(|b| b.is_ascii_uppercase() || b.is_ascii_digit())
    };
    country.len() == 2 && country.bytes().all(|b| b.is_ascii_uppercase()) && part.is_none_or(is_part)
}

/// Puts keys over others; what is not a table replaces what stood there.
fn merge(keys: &mut Keys, over: Keys) {
    for (key, value) in over {
        match (keys.get_mut(&key), value) {
            (Some(Value::Table(below)), Value::Table(over)) => merge(below, over),
            (_, value) => {
                keys.insert(key, value);
            }
        }
    }
}

fn words(list: Value, place: &str) -> Result<Vec<String>, Fault> {
    let found = list.to_string();
    Vec::deserialize(list).map_err(|_| Fault::new(place, "a list of ISO 3166 codes", found))
}
