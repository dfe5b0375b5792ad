//! What one step of an export writes: files, rows of tables, and what had to be clipped.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use trove_files::{OutputRoot, hidden_beside};

use crate::WriteError;

/// A finished step, as a line of the journal tells it.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Written {
    /// Lengths of its files in bytes, by their paths below the dataset's folder.
    pub files: BTreeMap<String, u64>,
    /// Rows of the tables that sum the dataset up.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub rows: BTreeMap<String, Vec<Box<RawValue>>>,
    /// Values that the form cannot hold, counted by what happened to them.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub clipped: BTreeMap<String, u64>,
}

/// A step under way: frames that are written together.
pub(crate) struct Unit<'a> {
    root: &'a OutputRoot,
    written: Written,
}

impl<'a> Unit<'a> {
    /// A step that writes below `root`.
    pub(crate) fn new(root: &'a OutputRoot) -> Self {
        Self { root, written: Written::default() }
    }

    /// Writes a file whole.
    pub(crate) fn write(&mut self, path: &str, bytes: &[u8]) -> Result<(), WriteError> {
        self.stream(path, |file| file.write_all(bytes))
    }

    /// Writes a file bit by bit; it appears once all is written.
    pub(crate) fn stream(
        &mut self,
        path: &str,
        fill: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
    ) -> Result<(), WriteError> {
        self.external(path, |partial| {
            let mut file = BufWriter::new(File::create(partial)?);
            fill(&mut file)?;
            file.flush()
        })
    }

    /// Lets something else write a file, under a hidden name; it appears once that is done.
    pub(crate) fn external(
        &mut self,
        path: &str,
        fill: impl FnOnce(&Path) -> std::io::Result<()>,
    ) -> Result<(), WriteError> {
        let place = self.place(path)?;
        let partial = hidden_beside(&place, "partial");
        // What a killed run left may be a link to a file of the source's, which must not be written to.
        let _ = fs::remove_file(&partial);
        let written = fill(&partial).and_then(|()| {
            fs::rename(&partial, &place)?;
            Ok(fs::metadata(&place)?.len())
        });
        if written.is_err() {
            // The first error is the one to tell of.
            let _ = fs::remove_file(&partial);
        }
        let bytes = written.map_err(WriteError::storage(&place, "write the file"))?;
        self.written.files.insert(path.to_owned(), bytes);
        Ok(())
    }

    /// Puts a file of the source's at `path` without its bytes being copied where the file system can do that.
    pub(crate) fn link(&mut self, path: &str, from: &Path) -> Result<(), WriteError> {
        let place = self.place(path)?;
        let partial = hidden_beside(&place, "partial");
        let _ = fs::remove_file(&partial); // what a killed run left
        let linked = fs::hard_link(from, &partial).or_else(|_| fs::copy(from, &partial).map(drop));
        let bytes = linked
            .and_then(|()| fs::rename(&partial, &place))
            .and_then(|()| {
                // Renaming a link over another of the same file does nothing and leaves both.
                let _ = fs::remove_file(&partial);
                Ok(fs::metadata(&place)?.len())
            })
            .map_err(WriteError::storage(from, "link or copy the file"))?;
        self.written.files.insert(path.to_owned(), bytes);
        Ok(())
    }

    /// Puts a file that was just written at a second path.
    pub(crate) fn link_own(&mut self, path: &str, own: &str) -> Result<(), WriteError> {
        let from = self.place(own)?;
        self.link(path, &from)
    }

    /// Adds a row to a table.
    pub(crate) fn row(&mut self, table: &str, row: &impl Serialize) -> Result<(), WriteError> {
        let row = serde_json::value::to_raw_value(row).map_err(|e| WriteError::Mismatch(format!("a row: {e}")))?;
        self.written.rows.entry(table.to_owned()).or_default().push(row);
        Ok(())
    }

    /// Notes values that the form cannot hold.
    pub(crate) fn clip(&mut self, what: &str, values: u64) {
        if values > 0 {
            *self.written.clipped.entry(what.to_owned()).or_default() += values;
        }
    }

    /// What was written.
    pub(crate) fn finish(self) -> Written {
        self.written
    }

    fn place(&self, path: &str) -> Result<PathBuf, WriteError> {
        let place = self.root.at(path)?;
        if let Some(folder) = place.parent() {
            fs::create_dir_all(folder).map_err(WriteError::storage(folder, "make the folder"))?;
        }
        Ok(place)
    }
}
