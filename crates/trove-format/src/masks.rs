//! `masks.json`: the pixels of each object, as run lengths.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{FormatError, file, rows};

/// The whole of `masks.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MaskTable {
    /// The objects of `frame.json`, in the same order.
    pub objects: Vec<MaskRow>,
}

/// The masks of an object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MaskRow {
    /// Its id in `frame.json`.
    pub id: u32,
    /// The pixels that show it.
    pub visible: RunLengths,
    /// The pixels that would if nothing else were there.
    pub amodal: RunLengths,
}

/// A mask of the whole image in COCO's compressed form, as `pycocotools.mask.decode` takes it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct RunLengths {
    /// Rows and columns.
    pub size: [u32; 2],
    /// Lengths of runs down the columns, the first of pixels outside, as a string.
    pub counts: String,
}

impl MaskTable {
    /// The file's name.
    pub const NAME: &str = "masks.json";

    /// Reads it from a frame's folder.
    ///
    /// # Errors
    /// A file that cannot be read or is damaged.
    pub fn read(folder: &Path) -> Result<Self, FormatError> {
        let path = folder.join(Self::NAME);
        file::parsed(&path, &file::bytes(&path)?, "masks of trove generate")
    }

    /// The file's bytes: one line an object.
    pub fn to_json(&self) -> Vec<u8> {
        rows::bytes(self)
    }
}
