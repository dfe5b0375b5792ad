//! A frame's images as a browser shows them.

use std::collections::BTreeMap;

use anyhow::Result;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use trove_format::FrameFile;
use trove_model::Raster;
use trove_write::{StoredFrame, colors, encode_jpeg, encode_picture};

/// Depth in steps of its logarithm, 0.02 % apart: step 1 is 10 cm, the last 100 km, 0 the sky.
pub(super) const NEAR_M: f64 = 0.1;
pub(super) const STEP: f64 = 13.815_510_557_964_274 / 65_534.0;

const JPEG_QUALITY: u8 = 88;

/// Data URIs of the images by their names: `rgb`, `labels` (class red, object green and blue), `depth` (step green and
/// blue) and the layers that are colours alone.
#[derive(Serialize)]
pub(super) struct Pictures(BTreeMap<&'static str, String>);

impl Pictures {
    pub(super) fn of(frame: &StoredFrame) -> Result<Self> {
        let mut made = BTreeMap::new();
        if frame.has(FrameFile::Rgb) {
            made.insert("rgb", jpeg(&frame.rgb()?)?);
        }
        if frame.has(FrameFile::Class) {
            made.insert("labels", png(&labels(frame)?)?);
        }
        if frame.has(FrameFile::Depth) {
            let steps = frame.depth_m()?.map(|depth_m| step(f64::from(*depth_m)).to_be_bytes());
            made.insert("depth", png(&steps.map(|[high, low]| [0, *high, *low]))?);
        }
        for (file, name) in LAYERS {
            if frame.has(file) {
                made.insert(name, jpeg(&colored(frame, file)?)?);
            }
        }
        Ok(Self(made))
    }

    /// What a frame with these images can lay over its picture.
    pub(super) fn layers(&self) -> impl Iterator<Item = &'static str> {
        let labels = self.0.contains_key("labels").then_some(["class", "instance"]);
        let depth = self.0.contains_key("depth").then_some("depth");
        let others = LAYERS.into_iter().map(|(_, name)| name).filter(|name| self.0.contains_key(name));
        labels.into_iter().flatten().chain(depth).chain(others)
    }
}

/// Layers that are colours and nothing that is picked.
const LAYERS: [(FrameFile, &str); 6] = [
    (FrameFile::Normal, "normal"),
    (FrameFile::FlowForward, "flow_forward"),
    (FrameFile::FlowBackward, "flow_backward"),
    (FrameFile::OccludedForward, "occluded_forward"),
    (FrameFile::OccludedBackward, "occluded_backward"),
    (FrameFile::Albedo, "albedo"),
];

fn colored(frame: &StoredFrame, file: FrameFile) -> Result<Raster<[u8; 3]>> {
    Ok(match file {
        FrameFile::Normal => frame.normal()?.map(|normal| colors::of_normal(*normal)),
        FrameFile::FlowForward => flow(&frame.flow_forward()?),
        FrameFile::FlowBackward => flow(&frame.flow_backward()?),
        FrameFile::OccludedForward => frame.occluded_forward()?.map(|seen| [seen.value(); 3]),
        FrameFile::OccludedBackward => frame.occluded_backward()?.map(|seen| [seen.value(); 3]),
        other => frame.vectors(other)?.map(|color| colors::of_albedo(*color)),
    })
}

fn flow(flow: &Raster<[f32; 2]>) -> Raster<[u8; 3]> {
    let lengths = flow.data.iter().map(|[u, v]| u.hypot(*v));
    let most_px = lengths.filter(|length| length.is_finite()).fold(0.0, f32::max);
    flow.map(|flow| colors::of_flow(*flow, most_px))
}

fn labels(frame: &StoredFrame) -> Result<Raster<[u8; 3]>> {
    let class = frame.class()?;
    if !frame.has(FrameFile::Instance) {
        return Ok(class.map(|class| [class.id(), 0, 0]));
    }
    let instance = frame.instance()?;
    let both = class.data.iter().zip(&instance.data);
    let data = both.map(|(class, id)| [class.id(), (id >> 8) as u8, *id as u8]).collect();
    Ok(Raster { width: class.width, height: class.height, data })
}

fn step(depth_m: f64) -> u16 {
    if depth_m.is_finite() { 1 + ((depth_m / NEAR_M).ln() / STEP).round().clamp(0.0, 65_534.0) as u16 } else { 0 }
}

fn png(picture: &Raster<[u8; 3]>) -> Result<String> {
    Ok(format!("data:image/png;base64,{}", STANDARD.encode(encode_picture("picture", picture)?)))
}

fn jpeg(picture: &Raster<[u8; 3]>) -> Result<String> {
    let bytes = encode_jpeg("picture", picture.width, picture.height, &picture.data, JPEG_QUALITY)?;
    Ok(format!("data:image/jpeg;base64,{}", STANDARD.encode(bytes)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_is_told_to_a_fiftieth_of_a_percent() {
        for depth_m in [0.1, 0.5, 3.0, 50.0, 4321.0, 99_999.0] {
            let back = NEAR_M * (f64::from(step(depth_m) - 1) * STEP).exp();
            assert!((back / depth_m - 1.0).abs() < 2e-4, "{depth_m} m came back as {back} m");
        }
        assert_eq!(step(f64::INFINITY), 0);
        assert_eq!((step(0.01), step(1e9)), (1, u16::MAX));
    }
}
