//! Scenes and frames, inside the page or, where they are too many for it, beside it.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde::Serialize;
use serde_json::json;
use trove_files::write_atomically;

/// What the page loads when it is looked at, by name.
pub(super) struct Chunks {
    most: usize,
    bytes: usize,
    held: Vec<(String, String)>,
    folder: PathBuf,
}

impl Chunks {
    /// Inside the page up to so many bytes, else in a folder.
    pub(super) fn new(most: usize, folder: PathBuf) -> Self {
        Self { most, bytes: 0, held: Vec::new(), folder }
    }

    pub(super) fn add(&mut self, name: &str, content: &impl Serialize) -> Result<()> {
        // What ends a script inside a text would end it there too.
        let content = serde_json::to_string(content)?.replace("</", "<\\/");
        self.bytes += content.len();
        self.held.push((name.to_owned(), content));
        if self.are_beside() {
            for (name, content) in self.held.drain(..) {
                put_beside(&self.folder, &name, &content)?;
            }
        }
        Ok(())
    }

    pub(super) fn are_beside(&self) -> bool {
        self.bytes > self.most
    }

    /// Those inside the page.
    pub(super) fn held(&self) -> &[(String, String)] {
        &self.held
    }

    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }
}

/// A script, since that is the only kind of file that a page opened by a double click may read.
fn put_beside(folder: &Path, name: &str, content: &str) -> Result<()> {
    let file = folder.join(format!("{name}.js"));
    let parent = file.parent().unwrap_or(folder);
    std::fs::create_dir_all(parent).with_context(|| format!("{}: cannot make the folder", parent.display()))?;
    let script = format!("chunk({},{content})\n", json!(name));
    write_atomically(&file, script.as_bytes()).with_context(|| format!("{}", file.display()))
}
