//! Panoptic labels of pictures, as both forms of the dataset hold them.
//!
//! Sources: `camera_segmentation.proto`, `dataset.proto`, and `CameraSegmentationLabelComponent` of `v2/perception`.

use std::num::NonZero;
use std::path::Path;

use trove_model::{Outcome, Report};

use super::components::camera_numbers;
use super::tfrecord::{Next, Records};
use super::{fault, vocabulary};
use crate::ReadError;
use crate::drive_source::LabelPicture;
use crate::parquet::{Sink, Table};
use crate::protobuf::{Fields, Malformed};

/// The component that has them; few segments have a file of it.
pub(super) const COMPONENT: &str = "camera_segmentation";
/// The class map of the numbers.
const CLASSES: &str = "waymo";
/// What a PNG begins with.
const PNG: &[u8; 8] = b"\x89PNG\r\n\x1a\n";

/// Hands out the labels of a v1 segment, in the order of its frames.
pub(super) fn of_records(path: &Path, report: &Report, each: &mut dyn FnMut(LabelPicture)) -> Result<(), ReadError> {
    let io = |source| ReadError::io(path, source);
    let mut records = Records::open(path).map_err(io)?;
    loop {
        let example = format!("{}: {}", path.display(), records.place());
        match records.read().map_err(io)? {
            Next::Record(record) => match of_frame(record) {
                Ok(found) => found.into_iter().for_each(|raw| hand_out(raw, &example, report, each)),
                Err(Malformed) => report.note(Outcome::Dropped, "Waymo labels: bytes that are not a message", example),
            },
            Next::Damaged(why) => report.note(Outcome::Dropped, &format!("Waymo labels: {why}"), example),
            Next::Lost(why) => {
                report.note(Outcome::Dropped, &format!("Waymo labels of the rest of a segment: {why}"), example);
                return Ok(());
            }
            Next::End => return Ok(()),
        }
    }
}

/// Hands out the labels of a v2 segment, in the order of the component's rows.
pub(super) fn of_component(path: &Path, report: &Report, each: &mut dyn FnMut(LabelPicture)) -> Result<(), ReadError> {
    let table = Table::open(path)?;
    let name = |column: &str| format!("[CameraSegmentationLabelComponent].{column}");
    let (times, cameras) = (table.integers("key.frame_timestamp_micros")?, camera_numbers(&table)?);
    let divisors = table.integers(&name("panoptic_label_divisor"))?;
    let mut pictures = table.column(&name("panoptic_label"))?;
    for (row, ((time_us, camera), divisor)) in times.into_iter().zip(cameras).zip(divisors).enumerate() {
        let mut bytes = Vec::new();
        if !pictures.read(&mut Sink::Texts(&mut bytes))? {
            return Err(fault::damaged(path, format!("row {row}"), "as many labels as times", "none"));
        }
        let raw = Raw {
            time_us: time_us.unwrap_or(0),
            camera,
            divisor: divisor.unwrap_or(0),
            png: bytes.pop().unwrap_or_default(),
        };
        hand_out(raw, &format!("{}: row {row}", path.display()), report, each);
    }
    Ok(())
}

/// Labels before they are looked at.
struct Raw {
    time_us: i64,
    camera: i64,
    divisor: i64,
    png: Vec<u8>,
}

/// The labels of a frame's pictures.
fn of_frame(message: &[u8]) -> Result<Vec<Raw>, Malformed> {
    let (mut time_us, mut found) = (0, Vec::new());
    for field in Fields::new(message) {
        match field? {
            (2, value) => time_us = value.varint()? as i64,
            (4, value) => found.extend(of_picture(value.bytes()?)?),
            _ => {}
        }
    }
    found.iter_mut().for_each(|raw| raw.time_us = time_us);
    Ok(found)
}

fn of_picture(message: &[u8]) -> Result<Option<Raw>, Malformed> {
    let (mut camera, mut label) = (0, None);
    for field in Fields::new(message) {
        match field? {
            (1, value) => camera = value.varint()? as i64,
            (10, value) => label = Some(value.bytes()?),
            _ => {}
        }
    }
    let Some(label) = label else { return Ok(None) };
    let mut raw = Raw { time_us: 0, camera, divisor: 0, png: Vec::new() };
    for field in Fields::new(label) {
        match field? {
            (1, value) => raw.divisor = value.varint()? as i64,
            (2, value) => raw.png = value.bytes()?.to_vec(),
            _ => {}
        }
    }
    Ok(Some(raw))
}

fn hand_out(raw: Raw, example: &str, report: &Report, each: &mut dyn FnMut(LabelPicture)) {
    let Raw { time_us, camera, divisor, png } = raw;
    let dropped = |why: &str| report.note(Outcome::Dropped, &format!("Waymo labels: {why}"), example);
    let Some(camera) = vocabulary::camera_name(camera) else { return dropped("unknown camera") };
    let Some(instance_divisor) = u16::try_from(divisor).ok().and_then(NonZero::new) else {
        return dropped("a divisor that 16 bits do not hold");
    };
    if !png.starts_with(PNG) {
        return dropped("no PNG");
    }
    let time_ns = time_us.saturating_mul(1000);
    each(LabelPicture { time_ns, camera: camera.to_owned(), classes: CLASSES, instance_divisor, png });
}
