//! A folder a frame, with a manifest, a report and a contact sheet above them.

use std::collections::BTreeSet;
use std::path::Path;
use std::{fs, io};

use trove_files::{OutputRoot, write_piecewise};
use trove_format::{FrameFile, FrameTable, Manifest, ManifestRows, RunReport, WrittenFile};
use trove_model::{Class, InstanceId, Labels, Occlusion, Raster, Role};

use crate::files::{FolderInTheMaking, Maker, sha256_file};
use crate::{Frame, Grid, RadarCycle, Sweep, WriteError, contact_sheet, exr_file, masks, png_file, write_atomically};

const CONTACT_SHEET: &str = "contact_sheet.png";

/// Writes the frames of a run as docs/output.md tells; several threads may write frames at once, in any order.
pub struct FrameFolders {
    root: OutputRoot,
    maker: Maker,
}

impl FrameFolders {
    /// The folder below the output folder that holds the datasets of `output.formats`.
    pub const EXPORTS: &str = "exports";

    /// Names below the output folder that no scene can have, because what sums the run up has them.
    pub const RESERVED: [&str; 4] = [CONTACT_SHEET, RunReport::NAME, Manifest::NAME, Self::EXPORTS];

    /// Writes below `root`, alone.
    pub fn new(root: &Path) -> Self {
        Self::made_by(root, Maker::Alone)
    }

    /// Writes below `root`, where others may write the same frames meanwhile.
    pub fn made_by(root: &Path, maker: Maker) -> Self {
        Self { root: OutputRoot::new(root), maker }
    }

    /// Names of the files in a finished frame's folder that holds these pictures.
    pub fn files(pictures: &BTreeSet<FrameFile>) -> Vec<&'static str> {
        pictures.iter().map(|file| file.name()).chain([FrameTable::NAME]).collect()
    }

    /// Writes a frame and says which files it has now. `pictures` are those that are wanted; a frame without light has none
    /// that show it, and one that was compared with none shows no change.
    ///
    /// Writes the folder under a hidden name beside it first, then renames it, so that it is never there in part. What an
    /// interrupted run left under the hidden name, and a folder without all its files, is replaced; a finished frame is
    /// not: it has the same bytes where another process made it.
    ///
    /// # Errors
    /// A file system that refuses, or a frame that does not fit the form or is there already with other bytes.
    pub fn frame(&self, frame: &Frame, pictures: &BTreeSet<FrameFile>) -> Result<Vec<WrittenFile>, WriteError> {
        let dir = self.root.at(&frame.path)?;
        narrowed(&frame.labels)?;
        let there = |file: &FrameFile| match file {
            FrameFile::Change => frame.change.is_some(),
            _ => frame.color.is_some() || !file.shows_light(),
        };
        let pictures: BTreeSet<FrameFile> = pictures.iter().copied().filter(there).collect();
        let known: Vec<&str> = FrameFile::ALL.map(FrameFile::name).into_iter().chain([FrameTable::NAME]).collect();
        let encoded = pictures.iter().map(|file| encode(*file, frame));
        self.put(&dir, &Self::files(&pictures), &known, encoded.chain([Ok(frame.table.to_json())]))
    }

    /// Writes a LiDAR's sweep, as [`FrameFolders::frame`] writes a frame.
    ///
    /// # Errors
    /// A file system that refuses, or a sweep that is there already with other bytes.
    pub fn sweep(&self, sweep: &Sweep) -> Result<Vec<WrittenFile>, WriteError> {
        self.folder(&sweep.path, &Sweep::FILES, sweep.encoded())
    }

    /// Writes a grid, as [`FrameFolders::frame`] writes a frame.
    ///
    /// # Errors
    /// A file system that refuses, or a grid that is there already with other bytes.
    pub fn grid(&self, grid: &Grid) -> Result<Vec<WrittenFile>, WriteError> {
        self.folder(&grid.path, Grid::files(grid.form), grid.encoded())
    }

    /// Writes a radar's cycle, as [`FrameFolders::frame`] writes a frame.
    ///
    /// # Errors
    /// A file system that refuses, or a cycle that is there already with other bytes.
    pub fn radar(&self, cycle: &RadarCycle) -> Result<Vec<WrittenFile>, WriteError> {
        self.folder(&cycle.path, &RadarCycle::FILES, cycle.encoded())
    }

    /// Takes a finished frame of another output folder over; false where one of its files is not as it was written.
    ///
    /// # Errors
    /// A file system that refuses, or a frame that is there already with other bytes.
    pub fn adopt(&self, path: &str, from: &Path, files: &[WrittenFile]) -> Result<bool, WriteError> {
        let mut folder = FolderInTheMaking::start(&self.root.at(path)?, &self.maker)?;
        for file in files {
            let source = from.join(&file.name);
            if sha256_file(&source).is_ok_and(|sha256| sha256 == file.sha256) {
                folder.take(&source, file)?;
            } else {
                return Ok(false);
            }
        }
        let names: Vec<&str> = files.iter().map(|file| file.name.as_str()).collect();
        self.place(folder, &self.root.at(path)?, &names, &names)?;
        Ok(true)
    }

    fn folder(
        &self,
        path: &str,
        names: &[&str],
        files: impl IntoIterator<Item = Vec<u8>>,
    ) -> Result<Vec<WrittenFile>, WriteError> {
        self.put(&self.root.at(path)?, names, names, files.into_iter().map(Ok))
    }

    /// Writes a folder of these files, which are `names`; `known` may lie there instead.
    fn put(
        &self,
        dir: &Path,
        names: &[&str],
        known: &[&str],
        files: impl Iterator<Item = Result<Vec<u8>, WriteError>>,
    ) -> Result<Vec<WrittenFile>, WriteError> {
        what_lies(dir, names, known)?; // before anything is written
        let mut folder = FolderInTheMaking::start(dir, &self.maker)?;
        for (name, bytes) in names.iter().zip(files) {
            folder.add(name, &bytes?)?;
        }
        self.place(folder, dir, names, known)
    }

    fn place(
        &self,
        folder: FolderInTheMaking,
        dir: &Path,
        names: &[&str],
        known: &[&str],
    ) -> Result<Vec<WrittenFile>, WriteError> {
        match what_lies(dir, names, known)? {
            Lies::Nothing => {}
            Lies::Unfinished => {
                fs::remove_dir_all(dir).map_err(WriteError::storage(dir, "remove an unfinished folder"))?;
            }
            Lies::Finished if folder.lies_there() => return Ok(folder.give_up()),
            Lies::Finished => {
                return Err(WriteError::Occupied { path: dir.to_owned(), found: "one with other bytes".into() });
            }
        }
        folder.finish()
    }

    /// The frames that the contact sheet shows of those with these paths.
    pub fn in_sheet(paths: &[String]) -> Vec<&String> {
        contact_sheet::chosen(paths)
    }

    /// Whether [`FrameFolders::finish`] reads a file of those frames.
    pub fn is_in_sheet(name: &str) -> bool {
        contact_sheet::is_read(name)
    }

    /// Writes what sums all frames up, those of earlier runs too: the contact sheet of the frames with these paths, the
    /// report, and the manifest, whose rows are made meanwhile.
    ///
    /// # Errors
    /// A file system that refuses, a finished frame that cannot be read back, or a row that cannot be made.
    pub fn finish(
        &self,
        manifest: &Manifest,
        rows: ManifestRows<'_>,
        sheet: &[&String],
        report: &RunReport,
    ) -> Result<(), WriteError> {
        let frame = |path: &&String| -> Result<_, WriteError> {
            Ok(contact_sheet::Frame { name: (*path).clone(), dir: self.root.at(path)? })
        };
        let sheet: Vec<contact_sheet::Frame> = sheet.iter().map(frame).collect::<Result<_, _>>()?;
        let [sheet_file, report_file, manifest_file] =
            [CONTACT_SHEET, RunReport::NAME, Manifest::NAME].map(|name| self.root.path().join(name));
        contact_sheet::write(&sheet_file, &sheet)?;
        write_atomically(&report_file, &report.to_json())?;
        write_piecewise(&manifest_file, |file| manifest.write(rows, file))
            .map_err(WriteError::storage(&manifest_file, "write the file"))
    }
}

/// A picture's bytes.
fn encode(file: FrameFile, frame: &Frame) -> Result<Vec<u8>, WriteError> {
    let (name, width, height) = (file.name(), frame.table.width_px, frame.table.height_px);
    let labels = &frame.labels;
    let color = || frame.color.as_ref().ok_or_else(|| WriteError::Mismatch(format!("{name} without light")));
    match file {
        FrameFile::Radiance => exr_file::encode(name, &color()?.radiance, ["R", "G", "B"]),
        FrameFile::Rgb => png_file::rgb(name, width, height, &color()?.srgb.data),
        FrameFile::Class => png_file::grey(name, width, height, &labels.class.map(|class| class.id()).data),
        FrameFile::Instance => png_file::grey16(name, width, height, &narrowed(labels)?),
        FrameFile::Depth => exr_file::encode_scalar(name, &labels.depth_m),
        FrameFile::Normal => exr_file::encode(name, &labels.normal, ["R", "G", "B"]),
        FrameFile::FlowForward => exr_file::encode(name, &labels.flow_forward, ["R", "G"]),
        FrameFile::FlowBackward => exr_file::encode(name, &labels.flow_backward, ["R", "G"]),
        FrameFile::OccludedForward => png_file::grey(name, width, height, &values(&labels.occluded_forward)),
        FrameFile::OccludedBackward => png_file::grey(name, width, height, &values(&labels.occluded_backward)),
        FrameFile::Panoptic => {
            let ids = narrowed(labels)?;
            // Of an id's 24 bits, COCO's pictures have the lowest in red.
            let segment = |(id, class): (&u16, &Class)| [(id & 0xff) as u8, (id >> 8) as u8, class.id()];
            let segments: Vec<[u8; 3]> = ids.iter().zip(&labels.class.data).map(segment).collect();
            png_file::labels_rgb(name, width, height, &segments)
        }
        FrameFile::Range => exr_file::encode_scalar(name, made(name, &labels.extra.range_m)?),
        FrameFile::NormalWorld => exr_file::encode(name, made(name, &labels.extra.normal_world)?, ["R", "G", "B"]),
        FrameFile::Albedo => exr_file::encode(name, made(name, &labels.extra.albedo)?, ["R", "G", "B"]),
        FrameFile::Roughness => exr_file::encode_scalar(name, made(name, &labels.extra.roughness)?),
        FrameFile::SceneFlowForward => {
            exr_file::encode(name, made(name, &labels.extra.scene_flow_forward)?, ["R", "G", "B"])
        }
        FrameFile::SceneFlowBackward => {
            exr_file::encode(name, made(name, &labels.extra.scene_flow_backward)?, ["R", "G", "B"])
        }
        FrameFile::ObjectCoordinates => {
            exr_file::encode(name, made(name, &labels.extra.object_coordinates)?, ["R", "G", "B"])
        }
        FrameFile::Coverage => png_file::grey(name, width, height, &made(name, &labels.extra.coverage)?.data),
        FrameFile::Part => {
            let parts = made(name, &labels.extra.part)?.map(|part| part.map_or(0, Role::id));
            png_file::grey(name, width, height, &parts.data)
        }
        FrameFile::Masks => Ok(masks::mask_table(labels).ok_or_else(|| not_asked(name))?.to_json()),
        FrameFile::Change => {
            let change = frame.change.as_ref();
            let change =
                change.ok_or_else(|| WriteError::Mismatch(format!("{name} without a scene to compare with")))?;
            png_file::grey(name, width, height, &change.map(|&differs| if differs { u8::MAX } else { 0 }).data)
        }
    }
}

/// A label that the shot asked for.
fn made<'a, T>(name: &str, raster: &'a Option<Raster<T>>) -> Result<&'a Raster<T>, WriteError> {
    raster.as_ref().ok_or_else(|| not_asked(name))
}

fn not_asked(name: &str) -> WriteError {
    WriteError::Mismatch(format!("{name} without the shot asking for it"))
}

fn values(occlusion: &Raster<Occlusion>) -> Vec<u8> {
    occlusion.data.iter().map(|occlusion| occlusion.value()).collect()
}

fn narrowed(labels: &Labels) -> Result<Vec<u16>, WriteError> {
    let narrow = |&id: &u32| u16::try_from(id).map_err(|_| WriteError::TooManyObjects(InstanceId(id)));
    labels.instance.data.iter().map(narrow).collect()
}

/// What lies where a folder is to be put.
enum Lies {
    Nothing,
    /// Some of the files.
    Unfinished,
    /// All of them.
    Finished,
}

/// What lies at `dir`; an error where anything else does than some of the `known` files.
fn what_lies(dir: &Path, expected: &[&str], known: &[&str]) -> Result<Lies, WriteError> {
    let entries = match fs::read_dir(dir) {
        Ok(entries) => entries,
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(Lies::Nothing),
        Err(e) => return Err(WriteError::storage(dir, "read the folder")(e)),
    };
    let mut present = Vec::new();
    for entry in entries {
        let name = entry.map_err(WriteError::storage(dir, "read the folder"))?.file_name();
        match known.iter().find(|file| name == **file) {
            Some(file) => present.push(*file),
            None => {
                let found = format!("{}, which does not belong to a frame", name.to_string_lossy());
                return Err(WriteError::Occupied { path: dir.to_owned(), found });
            }
        }
    }
    Ok(if expected.iter().all(|file| present.contains(file)) { Lies::Finished } else { Lies::Unfinished })
}
