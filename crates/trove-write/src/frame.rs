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

/// What a raster is called, its width and height, and how many values it has.
fn size<T>(what: &'static str, raster: &Raster<T>) -> (&'static str, u32, u32, usize) {
    (what, raster.width, raster.height, raster.data.len())
}

/// Every picture has the shot's size.
fn check_sizes(capture: &Capture, width: u32, height: u32) -> Result<(), WriteError> {
    let (labels, extra) = (&capture.labels, &capture.labels.extra);
    let mut found = vec![
        size("class", &labels.class),
        size("instance", &labels.instance),
        size("depth", &labels.depth_m),
        size("normal", &labels.normal),
        size("flow_forward", &labels.flow_forward),
        size("flow_backward", &labels.flow_backward),
        size("occluded_forward", &labels.occluded_forward),
        size("occluded_backward", &labels.occluded_backward),
    ];
    if let Some(Color { radiance, srgb, .. }) = &capture.color {
        found.extend([size("radiance", radiance), size("rgb", srgb)]);
    }
    found.extend(capture.change.iter().map(|change| size("change", change)));
    found.extend(extra.range_m.iter().map(|range| size("range", range)));
    found.extend(extra.normal_world.iter().map(|normal| size("normal_world", normal)));
    found.extend(extra.albedo.iter().map(|albedo| size("albedo", albedo)));
    found.extend(extra.roughness.iter().map(|roughness| size("roughness", roughness)));
    found.extend(extra.scene_flow_forward.iter().map(|flow| size("scene_flow_forward", flow)));
    found.extend(extra.scene_flow_backward.iter().map(|flow| size("scene_flow_backward", flow)));
    found.extend(extra.object_coordinates.iter().map(|points| size("object_coordinates", points)));
    found.extend(extra.coverage.iter().map(|coverage| size("coverage", coverage)));
    found.extend(extra.part.iter().map(|part| size("part", part)));
    match found.iter().find(|(_, w, h, len)| (*w, *h) != (width, height) || *len != width as usize * height as usize) {
        None if width > 0 && height > 0 => Ok(()),
        None => Err(WriteError::Mismatch(format!("an image of {width}×{height} pixels"))),
        Some((what, w, h, len)) => {
            Err(WriteError::Mismatch(format!("{what} of {w}×{h} pixels ({len} values) in a shot of {width}×{height}")))
        }
    }
}
