//! v1: a segment's TFRecord → records.

use std::collections::BTreeMap;
use std::path::Path;

use glam::Vec3;
use trove_model::{Outcome, Report};

use super::fault::{self, Unusable};
use super::frame_message::{self, Context, Frame};
use super::range_image::{self, Scan};
use super::records::{FrameRecord, GlobalFromEgo, LaserRecord, Returns, Segment};
use super::tfrecord::{Next, Records};
use super::{matrix, poses};
use crate::ReadError;
use trove_files::Budget;

/// `LaserName` of the LiDAR on the roof.
const TOP: i64 = 1;

/// A segment's name and how many frames its file has; the frames are not read.
pub(super) fn list(path: &Path) -> Result<(String, usize), ReadError> {
    let io = |source| ReadError::io(path, source);
    let mut records = Records::open(path).map_err(io)?;
    let (place, budget) = (records.place(), Budget::of_file(records.length()));
    let name = match records.read().map_err(io)? {
        Next::Record(record) => frame_message::frame(record, &budget).map(|frame| frame.context.name).map_err(Some),
        Next::Damaged(_) | Next::Lost(_) | Next::End => Err(None),
    };
    let name = name.map_err(|why| unusable(path, place.clone(), why))?;
    if name.is_empty() {
        return Err(fault::damaged(path, place, "a frame with the name of its segment", "none"));
    }
    let mut frames = 1;
    while records.skip().map_err(io)? {
        frames += 1;
    }
    Ok((name, frames))
}

/// Reads a segment, with the LiDAR of every so many frames.
pub(super) fn read(path: &Path, lidar_every: usize, report: &Report) -> Result<Segment, ReadError> {
    let io = |source| ReadError::io(path, source);
    let mut records = Records::open(path).map_err(io)?;
    let budget = Budget::of_file(records.length());
    let (mut segment, mut lasers) = (None::<Segment>, BTreeMap::new());
    loop {
        let place = records.place();
        let example = || format!("{}: {place}", path.display());
        let record = match records.read().map_err(io)? {
            Next::Record(record) => record,
            Next::Damaged(why) => {
                report.note(Outcome::Dropped, &format!("Waymo frame: {why}"), example());
                continue;
            }
            Next::Lost(why) if segment.is_none() => {
                return Err(fault::damaged(path, place, "a record of a TFRecord file", why));
            }
            Next::Lost(why) => {
                report.note(Outcome::Dropped, &format!("rest of a Waymo segment: {why}"), example());
                break;
            }
            Next::End => break,
        };
        let frame = match frame_message::frame(record, &budget) {
            Ok(frame) => frame,
            Err(Unusable::Malformed) => {
                report.note(Outcome::Dropped, "Waymo frame: bytes that are not a message", example());
                continue;
            }
            Err(why) => return Err(unusable(path, place, Some(why))),
        };
        let Frame { context, time_us, global_from_vehicle, pictures, lasers: scans, labels, map, map_from_global_m } =
            frame;
        let Context { name, location, cameras, lasers: of_context } = context;
        let segment = segment.get_or_insert_with(|| {
            lasers = of_context;
            Segment { name: name.clone(), location, cameras, ..Segment::default() }
        });
        if name != segment.name {
            report.note(Outcome::Dropped, "Waymo frame: of another segment", example());
            continue;
        }
        // Only a segment's first frame has a map.
        if segment.map.is_empty() && !map.is_empty() {
            (segment.map, segment.map_from_global_m) = (map, map_from_global_m);
        }
        let Some(global_from_ego) = poses::pose::<_, _>(&global_from_vehicle) else {
            report.note(Outcome::Dropped, "Waymo frame: no valid vehicle pose", example());
            continue;
        };
        let returns = if segment.frames.len().is_multiple_of(lidar_every) && scans.iter().any(has_image) {
            let sweep = Sweep { lasers: &lasers, global_from_ego: &global_from_ego, budget: &budget };
            let (returns, damage) = sweep.of(&scans).map_err(|why| unusable(path, place.clone(), Some(why)))?;
            damage
                .iter()
                .for_each(|why| report.note(Outcome::Dropped, &format!("Waymo range image: {why}"), example()));
            Some(returns)
        } else {
            None
        };
        segment.frames.push(FrameRecord { time_us, global_from_ego, pictures, labels, returns });
    }
    segment.ok_or_else(|| fault::damaged(path, "file", "at least one frame", "none that can be read"))
}

fn has_image(laser: &frame_message::Laser) -> bool {
    laser.returns.iter().any(|image| !image.is_empty())
}

struct Sweep<'a> {
    lasers: &'a BTreeMap<i64, LaserRecord>,
    global_from_ego: &'a GlobalFromEgo,
    budget: &'a Budget,
}

impl Sweep<'_> {
    /// The points of all LiDARs and both returns, and what was wrong with those that could not be used.
    fn of(&self, scans: &[frame_message::Laser]) -> Result<(Returns, Vec<&'static str>), Unusable> {
        let (mut returns, mut damage) = (Returns::default(), Vec::new());
        returns.origin_ego = self.lasers.get(&TOP).and_then(range_image::origin_ego).unwrap_or_default();
        for scan in scans {
            match self.append(scan, &mut returns) {
                Err(Unusable::Malformed) => damage.push("bytes that are none"),
                other => damage.extend(other?),
            }
        }
        self.budget.take(returns.points_ego.len(), size_of::<Vec3>())?;
        Ok((returns, damage))
    }

    fn append(&self, scan: &frame_message::Laser, returns: &mut Returns) -> Result<Option<&'static str>, Unusable> {
        let Some(laser) = self.lasers.get(&scan.number) else { return Ok(Some("LiDAR without calibration")) };
        let unpacked = |bytes: &[u8]| (!bytes.is_empty()).then(|| matrix::grid(bytes, self.budget)).transpose();
        let poses = unpacked(scan.poses)?;
        for image in scan.returns {
            let Some(image) = unpacked(image)? else { continue };
            let (poses, global_from_ego) = (poses.as_ref(), self.global_from_ego);
            let scan = Scan { laser, image: &image, poses, global_from_ego };
            if let Err(why) = scan.append_to(&mut returns.points_ego) {
                return Ok(Some(why));
            }
        }
        Ok(None)
    }
}

fn unusable(path: &Path, place: String, why: Option<Unusable>) -> ReadError {
    match why {
        Some(Unusable::TooMuch(exceeded)) => fault::damaged(path, place, exceeded.expected(), "more"),
        _ => fault::damaged(path, place, "a frame of a Waymo segment", "bytes that are none"),
    }
}
