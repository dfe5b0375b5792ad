//! Ultralytics' text files: a line an object, with its box or its outline in shares of the picture.

use std::fmt::Write as _;

use trove_format::FrameFile;
use trove_model::{ClassMap, Raster};

use super::contours::components;
use super::dataset::{Dataset, Finished};
use super::labels::MappedLabels;
use super::plan::Plan;
use super::unit::Unit;
use crate::WriteError;

/// `images/<split>`, `labels/<split>` and `data.yaml`.
pub(super) struct Yolo {
    pub map: ClassMap,
    /// Outlines instead of boxes.
    pub outlines: bool,
}

/// Parts of an object that are smaller than this share of its largest are left out of its outline.
const LEAST_PART: f64 = 0.05;

impl Dataset for Yolo {
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        for planned in frames.iter().map(|i| &plan.frames[*i]) {
            let (frame, name) = (plan.open(planned)?, planned.flat_name());
            unit.link(&format!("images/{}/{name}.png", planned.split), &frame.needed(FrameFile::Rgb)?)?;
            let labels = MappedLabels::read(&frame, &self.map)?;
            let [width, height] = [labels.ids.width, labels.ids.height].map(f64::from);
            let mut text = String::new();
            for (segment, extent) in labels.segments(&self.map) {
                let place = self.map.counted().filter(|class| class.thing).position(|class| class.id == segment.id);
                let Some(class) = place.filter(|_| segment.object > 0) else { continue };
                let _ = write!(text, "{class}"); // strings take everything
                if self.outlines {
                    let [x0, y0, w, h] = extent.xywh();
                    let belongs = |x: u32, y: u32| {
                        let (x, y) = (x0 + x, y0 + y);
                        u32::from(*labels.instance.at(x, y) == segment.object && *labels.ids.at(x, y) == segment.id)
                    };
                    for [x, y] in outline(&Raster::from_fn(w, h, belongs)) {
                        let [x, y] = [(x0 + x, width), (y0 + y, height)].map(|(px, of)| (f64::from(px) + 0.5) / of);
                        let _ = write!(text, " {x:.6} {y:.6}");
                    }
                } else {
                    let [x, y, w, h] = extent.xywh().map(f64::from);
                    let (x, y) = ((x + w / 2.0) / width, (y + h / 2.0) / height);
                    let _ = write!(text, " {x:.6} {y:.6} {:.6} {:.6}", w / width, h / height);
                }
                text.push('\n');
            }
            unit.write(&format!("labels/{}/{name}.txt", planned.split), text.as_bytes())?;
        }
        Ok(())
    }

    fn finish(&self, finished: &Finished<'_>, unit: &mut Unit<'_>) -> Result<(), WriteError> {
        // Without a path, folders are taken as below this file's; a relative one would be below the reader's.
        let mut text = String::new();
        let splits = &finished.plan.splits;
        let first = splits.first().map_or("train", String::as_str);
        for split in ["train", "val"] {
            // The tool asks for both.
            let of = if splits.iter().any(|known| known == split) { split } else { first };
            let _ = writeln!(text, "{split}: images/{of}"); // strings take everything
        }
        text.push_str("names:\n");
        for (i, class) in self.map.counted().filter(|class| class.thing).enumerate() {
            let _ = writeln!(text, "  {i}: {:?}", class.name);
        }
        unit.write("data.yaml", text.as_bytes())
    }
}

/// One outline of an object in several parts: each part's is walked from the corner that is nearest to the first's, and the
/// way there and back has no width.
fn outline(mask: &Raster<u32>) -> Vec<[u32; 2]> {
    let mut parts = components(mask, 1);
    parts.sort_by_key(|part| std::cmp::Reverse(part.pixels));
    let Some((largest, others)) = parts.split_first() else { return Vec::new() };
    let mut all = largest.outline.clone();
    let least = f64::from(largest.pixels) * LEAST_PART;
    for part in others.iter().filter(|part| f64::from(part.pixels) >= least) {
        let distance = |a: &[u32; 2], b: &[u32; 2]| a[0].abs_diff(b[0]).pow(2) + a[1].abs_diff(b[1]).pow(2);
        let pairs = (0..all.len()).flat_map(|i| (0..part.outline.len()).map(move |j| (i, j)));
        let Some((i, j)) = pairs.min_by_key(|(i, j)| distance(&all[*i], &part.outline[*j])) else { continue };
        let around = part.outline[j..].iter().chain(&part.outline[..=j]).copied();
        let detour: Vec<[u32; 2]> = around.chain([all[i]]).collect();
        all.splice(i + 1..i + 1, detour);
    }
    all
}
