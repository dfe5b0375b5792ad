//! `manifest.json`: what an output folder holds.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::iter::Peekable;
use std::path::Path;

use serde::ser::{Error, SerializeSeq};
use serde::{Deserialize, Serialize, Serializer};
use trove_files::OutputRoot;
use trove_model::{CLASSES, ClassRow, Role};

use crate::{DriveRow, Factors, FormatError, Source, Versions, file};

/// The whole of `manifest.json`, which a finished run writes last.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Manifest {
    /// Version of the format of all the folder's files: 2.
    pub format: u32,
    /// The recipe's seed.
    pub seed: u64,
    /// The recipe, with its defaults filled in.
    pub recipe: serde_json::Value,
    /// Everything besides the recipe that decides the bytes.
    pub versions: Versions,
    /// The class table, ordered by id.
    pub classes: Vec<ClassEntry>,
    /// The table of parts, ordered by id; missing in folders written by earlier versions.
    #[serde(default)]
    pub parts: Vec<PartEntry>,
    /// The drives that frames were made from.
    pub drives: Vec<ManifestDrive>,
    /// Every source of all drives, each once, in alphabetical order.
    pub licences: Vec<Source>,
    /// The finished frames, ordered by scene, variation and keyframe.
    pub frames: Vec<FrameRow>,
    /// The finished LiDAR sweeps, likewise; missing in folders written by earlier versions.
    #[serde(default)]
    pub sweeps: Vec<FrameRow>,
    /// The finished grids, likewise; missing where the recipe asks for none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub grids: Vec<FrameRow>,
    /// The radars' finished cycles, likewise; missing where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub radars: Vec<FrameRow>,
}

/// A class in every label set.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ClassEntry {
    /// Value in `class.png`.
    pub id: u8,
    /// Its name (`cycle_rider`).
    pub name: String,
    /// Whether it is countable, with ids in `instance.png`.
    pub thing: bool,
    /// Colour in label images, 8-bit sRGB.
    pub rgb: [u8; 3],
    /// Id among the paper's 13 classes.
    pub class13: u8,
    /// Cityscapes' `id`.
    pub cityscapes_id: u8,
    /// Cityscapes' `trainId`, which KITTI-STEP shares; 255 is ignored.
    pub train_id: u8,
    /// COCO panoptic's category; 0 where COCO has none.
    pub coco_id: u8,
    /// CamVid's id in its 12-class form; 11 is unlabelled.
    pub camvid_id: u8,
}

/// A part of objects that labels tell apart.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct PartEntry {
    /// Value in `part.png`, where 0 is none of them.
    pub id: u8,
    /// Its name (`cyclist`).
    pub name: String,
}

/// A drive, with the sources of what was built from it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ManifestDrive {
    /// The drive.
    #[serde(flatten)]
    pub drive: DriveRow,
    /// Where the parts of its scenes came from.
    pub sources: Vec<Source>,
}

/// A finished frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FrameRow {
    /// Its folder relative to the output folder, with `/` between the parts.
    pub path: String,
    /// The drive (`scene-0103`).
    pub scene: String,
    /// Number of the variation, from 0.
    pub variation: u32,
    /// Index of the keyframe in its drive, from 0.
    pub keyframe: u32,
    /// The camera (`ego.CAM_FRONT`, `v1.CAM_FRONT`), LiDAR (`ego.LIDAR_TOP`), radar (`ego.RADAR_FRONT`) or grid (`ego.OCC3D`).
    pub view: String,
    /// How its variation differs.
    pub factors: Factors,
    /// SHA-256 of each of its files, lower-case hexadecimal, by file name.
    pub files: BTreeMap<String, String>,
    /// What it is compared with; only frames of a counterfactual set other than v00's have it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub counterfactual: Option<Counterfactual>,
}

/// What a frame of a counterfactual set is compared with.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Counterfactual {
    /// The one factor that differs, as in the recipe's `variations.counterfactual`.
    pub factor: String,
    /// Path of v00's frame of the same view, as in `path`.
    pub base: String,
}

impl From<&ClassRow> for ClassEntry {
    fn from(row: &ClassRow) -> Self {
        Self {
            id: row.class.id(),
            name: row.name.to_owned(),
            thing: row.thing,
            rgb: row.rgb,
            class13: row.class13,
            cityscapes_id: row.cityscapes_id,
            train_id: row.train_id,
            coco_id: row.coco_id,
            camvid_id: row.camvid_id,
        }
    }
}

impl ClassEntry {
    /// The class table, ordered by id.
    pub fn all() -> Vec<Self> {
        CLASSES.iter().map(Self::from).collect()
    }
}

impl PartEntry {
    /// The table of parts, ordered by id.
    pub fn all() -> Vec<Self> {
        Role::ALL.iter().map(|(role, name)| Self { id: role.id(), name: (*name).to_owned() }).collect()
    }
}

impl Manifest {
    /// The file's name.
    pub const NAME: &str = "manifest.json";

    /// Reads it from an output folder; `None` where it is not there, since the run has not finished.
    ///
    /// # Errors
    /// A file that cannot be read, is damaged, or is of another version of the format.
    pub fn read(folder: &Path) -> Result<Option<Self>, FormatError> {
        let path = folder.join(Self::NAME);
        let bytes = file::bytes_if_there(&path)?;
        let Some(bytes) = bytes else { return Ok(None) };
        let manifest: Self = file::of_this_format(&path, &bytes, "a manifest of trove generate")?;
        // Whoever sends a folder does not choose which files are read elsewhere.
        let root = OutputRoot::new(folder);
        match manifest
            .frames
            .iter()
            .chain(&manifest.sweeps)
            .chain(&manifest.radars)
            .find_map(|frame| root.at(&frame.path).err())
        {
            Some(source) => Err(FormatError::Outside { path, source }),
            None => Ok(Some(manifest)),
        }
    }

    /// Writes the file with other rows than its own, which are made while they are written.
    ///
    /// # Errors
    /// What the system says, or a row that cannot be made.
    pub fn write(&self, rows: ManifestRows<'_>, mut to: impl Write) -> io::Result<()> {
        let Self { format, seed, recipe, versions, classes, parts, drives, licences, .. } = self;
        let ManifestRows { frames, sweeps, radars, grids } = rows;
        let [frames, sweeps, radars, grids] = [frames, sweeps, radars, grids].map(Rows::new);
        let (format, seed) = (*format, *seed);
        let written =
            Written { format, seed, recipe, versions, classes, parts, drives, licences, frames, sweeps, radars, grids };
        serde_json::to_writer_pretty(&mut to, &written)?;
        to.write_all(b"\n")
    }

    /// The file's bytes.
    #[allow(clippy::missing_panics_doc)] // nothing fails but rows that are made and files that are full
    pub fn to_json(&self) -> Vec<u8> {
        fn own(rows: &[FrameRow]) -> MadeRows<'_> {
            Box::new(rows.iter().map(|row| Ok(row.clone())))
        }
        let mut bytes = Vec::new();
        let rows = ManifestRows {
            frames: own(&self.frames),
            sweeps: own(&self.sweeps),
            radars: own(&self.radars),
            grids: own(&self.grids),
        };
        self.write(rows, &mut bytes).expect("rows that are there, written to memory");
        bytes
    }
}

/// Rows as they are made; why one cannot be.
pub type MadeRows<'a> = Box<dyn Iterator<Item = Result<FrameRow, String>> + 'a>;

/// A manifest's rows, of which few are in memory at once.
pub struct ManifestRows<'a> {
    /// See [`Manifest::frames`].
    pub frames: MadeRows<'a>,
    /// See [`Manifest::sweeps`].
    pub sweeps: MadeRows<'a>,
    /// See [`Manifest::radars`].
    pub radars: MadeRows<'a>,
    /// See [`Manifest::grids`].
    pub grids: MadeRows<'a>,
}

/// [`Manifest`] as it is written.
#[derive(Serialize)]
struct Written<'a> {
    format: u32,
    seed: u64,
    recipe: &'a serde_json::Value,
    versions: &'a Versions,
    classes: &'a [ClassEntry],
    parts: &'a [PartEntry],
    drives: &'a [ManifestDrive],
    licences: &'a [Source],
    frames: Rows<'a>,
    sweeps: Rows<'a>,
    #[serde(skip_serializing_if = "Rows::are_none")]
    grids: Rows<'a>,
    #[serde(skip_serializing_if = "Rows::are_none")]
    radars: Rows<'a>,
}

/// Rows that are made once, when they are written.
struct Rows<'a>(RefCell<Peekable<MadeRows<'a>>>);

impl<'a> Rows<'a> {
    fn new(rows: MadeRows<'a>) -> Self {
        Self(RefCell::new(rows.peekable()))
    }

    fn are_none(&self) -> bool {
        self.0.borrow_mut().peek().is_none()
    }
}

impl Serialize for Rows<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(None)?;
        for row in &mut *self.0.borrow_mut() {
            list.serialize_element(&row.map_err(S::Error::custom)?)?;
        }
        list.end()
    }
}
