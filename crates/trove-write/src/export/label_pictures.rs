//! Folders of pictures beside folders of labels, for tools that take their classes from a list.

use serde_json::json;
use trove_format::FrameFile;
use trove_model::ClassMap;

use super::dataset::{Dataset, Finished};
use super::labels::MappedLabels;
use super::plan::Plan;
use super::unit::Unit;
use crate::{WriteError, png_file};

/// `img_dir/<split>` and `ann_dir/<split>` of mmsegmentation: training ids, 255 ignored; `metainfo.json` names them.
pub(super) struct MmSegmentation {
    pub map: ClassMap,
}

/// `images/<split>`, `labels/<split>` in the map's own ids, and `colors/<split>`; `classes.json` names them.
pub(super) struct LabelPictures {
    pub map: ClassMap,
}

/// What a pixel that does not count has.
const IGNORED: u8 = 255;

impl Dataset for MmSegmentation {
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let train_ids = self.map.train_ids().map(|id| id.unwrap_or(IGNORED));
        for planned in frames.iter().map(|i| &plan.frames[*i]) {
            let (frame, name) = (plan.open(planned)?, planned.flat_name());
            unit.link(&format!("img_dir/{}/{name}.png", planned.split), &frame.needed(FrameFile::Rgb)?)?;
            let labels = MappedLabels::read(&frame, &self.map)?.ids.map(|id| train_ids[usize::from(*id)]);
            let png = png_file::grey("labels", labels.width, labels.height, &labels.data)?;
            unit.write(&format!("ann_dir/{}/{name}.png", planned.split), &png)?;
        }
        Ok(())
    }

    fn finish(&self, _: &Finished<'_>, unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let names: Vec<&str> = self.map.counted().map(|class| class.name.as_str()).collect();
        let palette: Vec<[u8; 3]> = self.map.counted().map(|class| class.rgb).collect();
        let text = json!({ "classes": names, "palette": palette, "reduce_zero_label": false, "ignore_index": IGNORED });
        unit.write("metainfo.json", text.to_string().as_bytes())
    }
}

impl Dataset for LabelPictures {
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let mut colors = [[0; 3]; 256];
        self.map.classes.iter().for_each(|class| colors[usize::from(class.id)] = class.rgb);
        for planned in frames.iter().map(|i| &plan.frames[*i]) {
            let (frame, name) = (plan.open(planned)?, planned.flat_name());
            unit.link(&format!("images/{}/{name}.png", planned.split), &frame.needed(FrameFile::Rgb)?)?;
            let labels = MappedLabels::read(&frame, &self.map)?.ids;
            let png = png_file::grey("labels", labels.width, labels.height, &labels.data)?;
            unit.write(&format!("labels/{}/{name}.png", planned.split), &png)?;
            let painted = labels.map(|id| colors[usize::from(*id)]);
            let png = png_file::labels_rgb("colors", labels.width, labels.height, &painted.data)?;
            unit.write(&format!("colors/{}/{name}.png", planned.split), &png)?;
        }
        Ok(())
    }

    fn finish(&self, _: &Finished<'_>, unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let class = |class: &trove_model::MappedClass| json!({ "id": class.id, "name": class.name, "rgb": class.rgb, "counts": class.train_id.is_some() });
        let classes: Vec<_> = self.map.classes.iter().map(class).collect();
        unit.write("classes.json", json!(classes).to_string().as_bytes())
    }
}
