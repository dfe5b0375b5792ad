//! The index on disk: a key that says what it was made from, numbers of variable length, and a checksum.
//!
//! A file that is stale, cut or damaged reads as `None` and is made anew; it is written beside its place and then
//! renamed, so that nobody sees half of one.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use trove_files::{LARGEST_FILE, read_regular};
use trove_model::{Entry, Outcome};

use super::index::{Index, SceneSpans, Span};

const MAGIC: &[u8] = b"TROVE nuScenes index 2\n";

/// An index's place and what it must have been made from.
pub(super) struct IndexFile {
    path: PathBuf,
    key: String,
}

impl IndexFile {
    /// For the tables in a version's folder: their sizes and times of change are the key.
    pub(super) fn new(cache_dir: &Path, folder: &Path, tables: &[&str]) -> Self {
        let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
        let mut key = format!("{}\n", folder.display());
        for table in tables {
            let metadata = folder.join(format!("{table}.json")).metadata().ok();
            let size = metadata.as_ref().map_or(0, std::fs::Metadata::len);
            let changed = metadata.and_then(|m| m.modified().ok()).and_then(|t| t.duration_since(UNIX_EPOCH).ok());
            let _ = writeln!(key, "{table} {size} {}", changed.map_or(0, |t| t.as_nanos()));
        }
        let name = format!("nuscenes-{:016x}.index", fnv1a(folder.as_os_str().as_encoded_bytes()));
        Self { path: cache_dir.join(name), key }
    }

    /// The index, where there is one that was made from these tables as they are.
    pub(super) fn read(&self) -> Option<Index> {
        let bytes = read_regular(&self.path, LARGEST_FILE).ok()?;
        let (body, checksum) = bytes.split_last_chunk::<8>()?;
        if fnv1a(body) != u64::from_le_bytes(*checksum) {
            return None;
        }
        let mut reader = Reader { rest: body.strip_prefix(MAGIC)? };
        (reader.text()? == self.key).then(|| reader.index()).flatten()
    }

    /// Keeps an index for the next time.
    pub(super) fn write(&self, index: &Index) -> std::io::Result<()> {
        let mut bytes = MAGIC.to_vec();
        put_text(&mut bytes, &self.key);
        put_index(&mut bytes, index);
        bytes.extend(fnv1a(&bytes).to_le_bytes());
        let folder = self.path.parent().unwrap_or(Path::new("."));
        std::fs::create_dir_all(folder)?;
        trove_files::write_atomically(&self.path, &bytes)
    }

    /// Where it lies.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }
}

fn put_index(out: &mut Vec<u8>, index: &Index) {
    put_number(out, index.scenes.len() as u64);
    for scene in &index.scenes {
        for spans in [&scene.sample_data, &scene.ego_poses, &scene.annotations] {
            put_number(out, spans.len() as u64);
            let mut end = 0;
            for span in spans {
                put_number(out, span.offset - end);
                put_number(out, span.length);
                end = span.offset + span.length;
            }
        }
    }
    put_number(out, index.entries.len() as u64);
    for entry in &index.entries {
        put_number(out, OUTCOMES.iter().position(|o| *o == entry.outcome).unwrap_or(0) as u64);
        put_number(out, entry.count);
        put_text(out, &entry.what);
        put_number(out, entry.examples.len() as u64);
        entry.examples.iter().for_each(|example| put_text(out, example));
    }
}

const OUTCOMES: [Outcome; 4] = [Outcome::Dropped, Outcome::Substituted, Outcome::Guessed, Outcome::Warned];

/// LEB128: seven bits a byte, low ones first.
fn put_number(out: &mut Vec<u8>, mut number: u64) {
    while number >= 0x80 {
        out.push(number as u8 | 0x80);
        number >>= 7;
    }
    out.push(number as u8);
}

fn put_text(out: &mut Vec<u8>, text: &str) {
    put_number(out, text.len() as u64);
    out.extend(text.as_bytes());
}

struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    fn index(&mut self) -> Option<Index> {
        let scenes = self
            .many(|r| Some(SceneSpans { sample_data: r.spans()?, ego_poses: r.spans()?, annotations: r.spans()? }))?;
        let entries = self.many(|r| {
            let outcome = *OUTCOMES.get(r.number()? as usize)?;
            let (count, what) = (r.number()?, r.text()?.to_owned());
            Some(Entry { outcome, what, count, examples: r.many(|r| r.text().map(str::to_owned))? })
        })?;
        self.rest.is_empty().then_some(Index { scenes, entries })
    }

    fn spans(&mut self) -> Option<Vec<Span>> {
        let mut end = 0u64;
        self.many(|r| {
            let span = Span { offset: end.checked_add(r.number()?)?, length: r.number()? };
            end = span.offset.checked_add(span.length)?;
            Some(span)
        })
    }

    fn many<T>(&mut self, mut one: impl FnMut(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        (0..self.number()?).map(|_| one(self)).collect()
    }

    fn number(&mut self) -> Option<u64> {
        let mut number = 0u64;
        for shift in (0..64).step_by(7) {
            let (&byte, rest) = self.rest.split_first()?;
            self.rest = rest;
            number |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(number);
            }
        }
        None
    }

    fn text(&mut self) -> Option<&'a str> {
        let length = usize::try_from(self.number()?).ok()?;
        let (text, rest) = self.rest.split_at_checked(length)?;
        self.rest = rest;
        std::str::from_utf8(text).ok()
    }
}

/// FNV-1a: the file is our own, the sum tells accidents.
fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn index() -> Index {
        let spans = |n: u64| (0..n).map(|i| Span { offset: i * 1_000_000_000, length: 300 + i }).collect();
        let entry = Entry { outcome: Outcome::Warned, what: "é".into(), count: 9, examples: vec!["a".into()] };
        Index {
            scenes: (0..3)
                .map(|n| SceneSpans { sample_data: spans(n), ego_poses: spans(2), annotations: spans(1) })
                .collect(),
            entries: vec![entry],
        }
    }

    #[test]
    fn an_index_that_was_kept_is_the_same_until_its_tables_change() {
        let (cache, tables) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        std::fs::write(tables.path().join("a.json"), "[]").unwrap();
        let file = || IndexFile::new(cache.path(), tables.path(), &["a"]);
        assert_eq!(file().read(), None);
        file().write(&index()).unwrap();
        assert_eq!(file().read(), Some(index()));
        std::fs::write(tables.path().join("a.json"), "[] ").unwrap();
        assert_eq!(file().read(), None);
    }

    proptest! {
        #[test]
        fn a_damaged_index_is_not_read(at in 0usize..200, bit in 0u8..8, keep in 0usize..200) {
            let cache = tempfile::tempdir().unwrap();
            let file = IndexFile::new(cache.path(), cache.path(), &[]);
            file.write(&index()).unwrap();
            let mut bytes = std::fs::read(file.path()).unwrap();
            let at = at % bytes.len();
            bytes[at] ^= 1 << bit;
            std::fs::write(file.path(), &bytes).unwrap();
            prop_assert_eq!(file.read(), None);
            bytes[at] ^= 1 << bit;
            std::fs::write(file.path(), &bytes[..keep.min(bytes.len() - 1)]).unwrap();
            prop_assert_eq!(file.read(), None);
        }

        #[test]
        fn any_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..100)) {
            let _ = Reader { rest: &bytes }.index();
        }
    }
}
