//! What a recipe names in object stores, as files in the cache.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use trove_files::{LARGEST_TEXT, OutputRoot, read_text, write_atomically};
use trove_write::sha256;

use super::{Object, Store, address};
use crate::cache;

/// Which version of each object lies in the cache, by its name.
const KNOWN: &str = ".known.json";

/// Fetches every text of a document that is an object store's address, and says where in the cache each lies.
///
/// # Errors
/// A store that refuses, an address of nothing, or a cache that cannot be written.
pub(crate) fn fetched(document: &toml::Table) -> Result<BTreeMap<PathBuf, PathBuf>> {
    let mut addresses = Vec::new();
    document.values().for_each(|value| collect(value, &mut addresses));
    let cache = || cache::folder().context("expected a folder for what is fetched, found none; set TROVE_CACHE");
    addresses.into_iter().map(|path| Ok((path.to_owned(), fetch(path, &cache()?.join("fetched"))?))).collect()
}

fn collect<'a>(value: &'a toml::Value, addresses: &mut Vec<&'a Path>) {
    match value {
        toml::Value::String(text) if address(Path::new(text)).is_some() => addresses.push(Path::new(text)),
        toml::Value::Array(values) => values.iter().for_each(|value| collect(value, addresses)),
        toml::Value::Table(table) => table.values().for_each(|value| collect(value, addresses)),
        _ => {}
    }
}

/// Fetches what is new of an object, or of all objects below a prefix, and says where it lies.
fn fetch(path: &Path, cache: &Path) -> Result<PathBuf> {
    let text = address(path).context("an address")?;
    let store = Store::open(text)?;
    let folder = cache.join(&sha256(text.as_bytes())[..16]);
    std::fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    let (root, known_file) = (OutputRoot::new(&folder), folder.join(KNOWN));
    // The object that the address names itself has the name "" below it.
    let single = store.look("")?.map(|object| Object { name: String::new(), ..object });
    let mut objects = single.clone().map_or_else(|| store.list(""), |object| Ok(vec![object]))?;
    // Folders are objects to some programs, and hidden files are nobody's data.
    objects.retain(|object| object.name.is_empty() || root.at(&object.name).is_ok());
    ensure!(!objects.is_empty(), "{text}: expected an object, or objects below it, found none");
    let place = |name: &str| -> Result<PathBuf> {
        // Formats are told by the ends of names.
        let own = text.rsplit_once('/').map_or(text, |(_, own)| own);
        Ok(root.at(if name.is_empty() { own } else { name })?)
    };
    let known: BTreeMap<String, String> =
        read_text(&known_file, LARGEST_TEXT).ok().and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default();
    let now: BTreeMap<String, String> = objects.iter().map(|object| (object.name.clone(), version(object))).collect();
    let (mut wanted, mut bytes) = (Vec::new(), 0);
    for object in &objects {
        let file = place(&object.name)?;
        if known.get(&object.name) != now.get(&object.name) || !file.is_file() {
            wanted.push((object.name.clone(), file));
            bytes += object.bytes;
        }
    }
    if !wanted.is_empty() {
        tracing::info!("{text}: fetching {} objects, {:.1} MB", wanted.len(), bytes as f64 / 1e6);
        // Until all are there, nothing is known of what lies there.
        let _ = std::fs::remove_file(&known_file);
        store.fetch(wanted).wait()?;
    }
    for gone in known.keys().filter(|name| !now.contains_key(*name)) {
        let _ = std::fs::remove_file(place(gone)?);
    }
    write_atomically(&known_file, &serde_json::to_vec(&now)?).with_context(|| known_file.display().to_string())?;
    if single.is_some() { place("") } else { Ok(folder) }
}

/// What changes whenever an object does.
fn version(object: &Object) -> String {
    object.version.clone().unwrap_or_else(|| format!("{} bytes of {:?}", object.bytes, object.modified))
}
