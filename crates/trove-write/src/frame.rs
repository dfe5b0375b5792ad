//! A frame as exporters get it.

use trove_format::{FrameFile, FrameTable};
use trove_model::{Capture, Color, Labels, Raster, Scene, Shot};

use crate::frame_table::{FrameMeta, frame_table};
use crate::{WriteError, jpeg};

/// A frame: its table, its picture and its labels, all of one size.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Its folder below the output folder (`scene-0103/v00/k005/ego.CAM_FRONT`), with `/` between the parts.
    pub path: String,
    /// Camera and objects.
    pub table: FrameTable,
    /// The picture, as the sensor's JPEG left it; `None` where only labels were asked for.
    pub color: Option<Color>,
    /// The labels.
    pub labels: Labels,
    /// Where it differs from another scene's frame; `None` where there is no other.
    pub change: Option<Raster<bool>>,
}

impl Frame {
    /// The frame that a capture of a scene is.
    ///
    /// # Errors
    /// A capture, a shot and a scene that do not belong together, or a picture that JPEG cannot hold.
    pub fn of(
        path: String,
        scene: &Scene,
        shot: &Shot,
        capture: Capture,
        meta: &FrameMeta,
    ) -> Result<Self, WriteError> {
        let (width, height) = (shot.lens.width_px, shot.lens.height_px);
        check_sizes(&capture, width, height)?;
        let table = frame_table(scene, shot, &capture, meta)?;
        let Capture { mut color, labels, change, .. } = capture;
        if let (Some(color), Some(quality)) = (&mut color, shot.film.sensor.and_then(|sensor| sensor.jpeg_quality)) {
            color.srgb.data = jpeg::worn(FrameFile::Rgb.name(), width, height, &color.srgb.data, quality)?;
        }
        Ok(Self { path, table, color, labels, change })
    }
}

/// Every picture has the shot's size.
fn check_sizes(capture: &Capture, width: u32, height: u32) -> Result<(), WriteError> {
    let labels = &capture.labels;
    let (forward, backward) = (&labels.occluded_forward, &labels.occluded_backward);
    let mut found = vec![
        ("class", labels.class.width, labels.class.height, labels.class.data.len()),
        ("instance", labels.instance.width, labels.instance.height, labels.instance.data.len()),
        ("depth", labels.depth_m.width, labels.depth_m.height, labels.depth_m.data.len()),
        ("normal", labels.normal.width, labels.normal.height, labels.normal.data.len()),
        ("flow_forward", labels.flow_forward.width, labels.flow_forward.height, labels.flow_forward.data.len()),
        ("flow_backward", labels.flow_backward.width, labels.flow_backward.height, labels.flow_backward.data.len()),
        ("occluded_forward", forward.width, forward.height, forward.data.len()),
        ("occluded_backward", backward.width, backward.height, backward.data.len()),
    ];
    if let Some(Color { radiance, srgb, .. }) = &capture.color {
        found.push(("radiance", radiance.width, radiance.height, radiance.data.len()));
        found.push(("rgb", srgb.width, srgb.height, srgb.data.len()));
    }
    if let Some(change) = &capture.change {
        found.push(("change", change.width, change.height, change.data.len()));
    }
    match found.iter().find(|(_, w, h, len)| (*w, *h) != (width, height) || *len != width as usize * height as usize) {
        None if width > 0 && height > 0 => Ok(()),
        None => Err(WriteError::Mismatch(format!("an image of {width}×{height} pixels"))),
        Some((what, w, h, len)) => {
            Err(WriteError::Mismatch(format!("{what} of {w}×{h} pixels ({len} values) in a shot of {width}×{height}")))
        }
    }
}
