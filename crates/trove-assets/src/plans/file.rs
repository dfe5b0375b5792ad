//! A file of plans as it stands: entries, pieces that entries share by name, and who takes what from whom.

use std::collections::BTreeMap;

use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::error::PlanError;

/// Keys whose value may be the name of a table of the same key (`paint = "fleet"` is `[paint.fleet]`), or a list of such.
const PIECES: [&str; 10] = ["paint", "plate", "face", "back", "skin", "hair", "dye", "top", "bottom", "shoes"];
/// Lists of entries.
const ENTRIES: [&str; 12] =
    ["building", "car", "facade", "person", "cone", "furniture", "signal", "wall", "tree", "shrub", "hedge", "bed"];
/// Tables of which an entry may change single keys, taking the others from the entry that it is like.
const MERGED: [&str; 2] = ["profile", "build"];

/// A file of plans; what it does not hold is looked for in another.
#[derive(Clone, Debug, Default)]
pub(super) struct PlanFile<'a> {
    /// Licence and author of what is made from it.
    pub(super) licence: Option<String>,
    /// Entries and pieces by the key that they stand under, in the order of the file, each with its id or name.
    tables: BTreeMap<&'static str, Vec<(String, Table)>>,
    base: Option<&'a PlanFile<'a>>,
}

impl<'a> PlanFile<'a> {
    pub(super) fn parse(text: &str, base: Option<&'a PlanFile<'a>>) -> Result<Self, PlanError> {
        let whole: Table = toml::from_str(text).map_err(|error| {
            let line = error.span().map_or(1, |at| 1 + text[..at.start.min(text.len())].matches('\n').count());
            PlanError::new(format!("line {line}"), "TOML", error.message())
        })?;
        let mut file = Self { base, ..Self::default() };
        for (key, value) in whole {
            let named = |known: &[&'static str]| known.iter().copied().find(|name| *name == key);
            if let Some(name) = named(&ENTRIES) {
                file.tables.insert(name, entries(name, value)?);
            } else if let Some(name) = named(&PIECES) {
                file.tables.insert(name, pieces(name, value)?);
            } else if let ("licence", Value::String(licence)) = (key.as_str(), &value) {
                file.licence = Some(licence.clone());
            } else {
                let known = ENTRIES.into_iter().chain(PIECES).chain(["licence"]);
                return Err(PlanError::new(format!("`{key}`"), "a known key", value.type_str()).or_near(&key, known));
            }
        }
        Ok(file)
    }

    /// The entries under a key with all that they take from others.
    pub(super) fn read<T: DeserializeOwned>(&self, key: &'static str) -> Result<Vec<(String, T)>, PlanError> {
        let entries = self.tables.get(key).map_or(&[][..], Vec::as_slice);
        let read = |(id, table): &(String, Table)| {
            let place = format!("{key} {id:?}");
            let mut whole = self.completed(key, table, &place, &mut Vec::new())?;
            whole.insert("id".into(), Value::String(id.clone()));
            let plan = Value::Table(whole).try_into().map_err(|error| PlanError::of_entry(&place, &error))?;
            Ok((place, plan))
        };
        entries.iter().map(read).collect()
    }

    /// A table with what it takes from the one that it is like, and with pieces in place of their names.
    fn completed(
        &self,
        key: &'static str,
        table: &Table,
        place: &str,
        trail: &mut Vec<String>,
    ) -> Result<Table, PlanError> {
        let mut whole = match table.get("like") {
            None => Table::new(),
            Some(Value::String(name)) => self.named(key, name, &format!("{place}: like"), trail)?,
            Some(other) => return Err(PlanError::new(format!("{place}: like"), "a name", other.type_str())),
        };
        let is_own = |name: &str| name != "like" && !(name == "id" && ENTRIES.contains(&key));
        for (name, value) in table.iter().filter(|(name, _)| is_own(name)) {
            let value = match PIECES.into_iter().find(|piece| piece == name) {
                Some(piece) => self.piece(piece, value, &format!("{place}: {name}"))?,
                None => value.clone(),
            };
            match (whole.get_mut(name), value) {
                (Some(Value::Table(old)), Value::Table(new)) if MERGED.contains(&name.as_str()) => old.extend(new),
                (_, value) => drop(whole.insert(name.clone(), value)),
            }
        }
        Ok(whole)
    }

    /// What is named or written out under the key of a piece, completed.
    fn piece(&self, key: &'static str, value: &Value, place: &str) -> Result<Value, PlanError> {
        Ok(match value {
            Value::String(name) => Value::Table(self.named(key, name, place, &mut Vec::new())?),
            Value::Table(table) => Value::Table(self.completed(key, table, place, &mut Vec::new())?),
            Value::Array(list) => {
                Value::Array(list.iter().map(|value| self.piece(key, value, place)).collect::<Result<_, _>>()?)
            }
            other => other.clone(),
        })
    }

    /// An entry or a piece of this file or else of the one behind it, completed.
    fn named(&self, key: &'static str, name: &str, place: &str, trail: &mut Vec<String>) -> Result<Table, PlanError> {
        let own = self.tables.get(key).into_iter().flatten().find(|(own, _)| own == name);
        if let Some((_, table)) = own {
            if trail.iter().any(|passed| passed == name) {
                return Err(PlanError::new(place, "one that does not come from this one", format!("{name:?}")));
            }
            trail.push(name.to_owned());
            return self.completed(key, table, &format!("{key} {name:?}"), trail);
        }
        match self.base {
            Some(base) if base.knows(key, name) => base.named(key, name, place, &mut Vec::new()),
            _ => {
                let files = std::iter::successors(Some(self), |file| file.base);
                let known = files.flat_map(|file| file.tables.get(key).into_iter().flatten());
                let found = format!("{name:?}");
                Err(PlanError::new(place, format!("the name of a {key}"), found)
                    .or_near(name, known.map(|(n, _)| &**n)))
            }
        }
    }

    fn knows(&self, key: &str, name: &str) -> bool {
        let own = self.tables.get(key).into_iter().flatten().any(|(own, _)| own == name);
        own || self.base.is_some_and(|base| base.knows(key, name))
    }
}

fn entries(key: &str, value: Value) -> Result<Vec<(String, Table)>, PlanError> {
    let wrong = |found: &Value| PlanError::new(format!("`{key}`"), format!("[[{key}]]"), found.type_str());
    let Value::Array(list) = value else { return Err(wrong(&value)) };
    let mut entries: Vec<(String, Table)> = Vec::new();
    for (i, entry) in list.into_iter().enumerate() {
        let Value::Table(table) = entry else { return Err(wrong(&entry)) };
        let place = || format!("{key} number {}: id", i + 1);
        let id = match table.get("id") {
            Some(Value::String(id)) if !id.is_empty() => id.clone(),
            Some(other) => return Err(PlanError::new(place(), "a name", other.to_string())),
            None => return Err(PlanError::new(place(), "a name", "none").do_this("write `id = \"…\"`")),
        };
        if entries.iter().any(|(known, _)| *known == id) {
            return Err(PlanError::new(place(), "a name of its own", format!("{id:?} twice")));
        }
        entries.push((id, table));
    }
    Ok(entries)
}

fn pieces(key: &str, value: Value) -> Result<Vec<(String, Table)>, PlanError> {
    let Value::Table(named) = value else {
        return Err(PlanError::new(format!("`{key}`"), format!("[{key}.NAME]"), value.type_str()));
    };
    let piece = |(name, value): (String, Value)| match value {
        Value::Table(table) => Ok((name, table)),
        other => Err(PlanError::new(format!("{key}.{name}"), format!("[{key}.NAME]"), other.type_str())),
    };
    named.into_iter().map(piece).collect()
}
