//! WebDataset: the files of many frames in one tar file.

use std::fs;

use tar::{Builder, EntryType, Header};
use trove_files::{LARGEST_FILE, read_regular};
use trove_format::{FrameFile, FrameTable};

use super::dataset::Dataset;
use super::plan::Plan;
use super::unit::Unit;
use crate::WriteError;

/// `<split>-<shard>.tar` with `<frame>.rgb.png`, `<frame>.class.png`, … and `<frame>.json`.
pub(super) struct WebDataset;

/// A shard ends with the frame that passes one of these.
const SHARD_FRAMES: usize = 1000;
const SHARD_BYTES: u64 = 1_000_000_000;

impl Dataset for WebDataset {
    fn units(&self, plan: &Plan) -> Vec<Vec<usize>> {
        let mut shards: Vec<Vec<usize>> = Vec::new();
        let mut bytes = 0;
        for (number, frame) in plan.frames.iter().enumerate() {
            let is_full = |shard: &Vec<usize>| {
                bytes >= SHARD_BYTES || shard.len() >= SHARD_FRAMES || plan.frames[shard[0]].split != frame.split
            };
            match shards.last_mut().filter(|shard| !is_full(shard)) {
                Some(shard) => shard.push(number),
                None => {
                    shards.push(vec![number]);
                    bytes = 0;
                }
            }
            // What cannot be read is told when it is written.
            let folder = plan.source.join(&frame.path);
            let size = |file: FrameFile| fs::metadata(folder.join(file.name())).map_or(0, |file| file.len());
            bytes += FrameFile::ALL.into_iter().map(size).sum::<u64>();
        }
        shards
    }

    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let split = &plan.frames[frames[0]].split;
        let mut fault = None;
        unit.stream(&format!("{split}-{:08}.tar", frames[0]), |file| {
            let mut shard = Builder::new(file);
            for &number in frames {
                let folder = plan.source.join(&plan.frames[number].path);
                let pictures = FrameFile::ALL.into_iter().map(|file| (file.name(), file.name()));
                for (name, ending) in pictures.chain([(FrameTable::NAME, "json")]) {
                    let path = folder.join(name);
                    if !path.is_file() {
                        continue;
                    }
                    let bytes = read_regular(&path, LARGEST_FILE).inspect_err(|_| fault = Some(path.clone()))?;
                    let mut header = Header::new_ustar();
                    header.set_entry_type(EntryType::Regular);
                    header.set_mode(0o644);
                    header.set_size(bytes.len() as u64);
                    shard.append_data(&mut header, format!("{number:08}.{ending}"), bytes.as_slice())?;
                }
            }
            shard.finish()
        })
        .map_err(|error| match (error, fault) {
            (WriteError::Storage { source, .. }, Some(path)) => WriteError::storage(&path, "read the file")(source),
            (error, _) => error,
        })
    }
}
