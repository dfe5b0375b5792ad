//! A dataset's own pictures of labels, in a folder that `trove evaluate` takes without options.

use std::fs;
use std::num::NonZero;
use std::path::{Path, PathBuf};

use trove_files::write_atomically;
use trove_format::ClassMapFile;

use crate::WriteError;

/// The folder of a drive's labels: `CAMERA/000003.png`, numbered by keyframe, and `class_map.toml`.
#[derive(Debug)]
pub struct LabelPictures {
    folder: PathBuf,
    /// Of the first picture, which those of all have to be.
    coding: Option<ClassMapFile>,
    written: usize,
}

impl LabelPictures {
    /// Nothing written yet.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), coding: None, written: 0 }
    }

    /// How many pictures are written.
    pub fn written(&self) -> usize {
        self.written
    }

    /// Writes a picture, a PNG in the numbers of a class map with some divisor; false where those are not the folder's.
    ///
    /// # Errors
    /// What cannot be written.
    pub fn write(
        &mut self,
        camera: &str,
        keyframe: usize,
        (classes, instance_divisor): (&'static str, NonZero<u16>),
        png: &[u8],
    ) -> Result<bool, WriteError> {
        let coding = ClassMapFile { like: classes, instance_divisor };
        if self.coding.as_ref().is_some_and(|first| *first != coding) {
            return Ok(false);
        }
        let folder = self.folder.join(camera);
        fs::create_dir_all(&folder).map_err(WriteError::storage(&folder, "make the folder"))?;
        let write = |path: &Path, bytes: &[u8]| {
            write_atomically(path, bytes).map_err(WriteError::storage(path, "write the file"))
        };
        if self.coding.is_none() {
            write(&self.folder.join(ClassMapFile::NAME), coding.to_toml().as_bytes())?;
            self.coding = Some(coding);
        }
        write(&folder.join(format!("{keyframe:06}.png")), png)?;
        self.written += 1;
        Ok(true)
    }
}
