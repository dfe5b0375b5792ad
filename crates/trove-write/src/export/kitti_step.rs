//! KITTI-STEP: panoptic maps whose objects keep their numbers over a sequence.

use trove_format::FrameFile;
use trove_model::ClassMap;

use super::dataset::Dataset;
use super::labels::MappedLabels;
use super::plan::Plan;
use super::unit::Unit;
use crate::{WriteError, png_file};

/// `images/<split>/<sequence>/<frame>.png` and `panoptic_maps/…`: red is the class, green (high byte) and blue the object.
pub(super) struct KittiStep {
    pub map: ClassMap,
}

impl Dataset for KittiStep {
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let mut things = [false; 256];
        self.map.classes.iter().for_each(|class| things[usize::from(class.id)] = class.thing);
        for planned in frames.iter().map(|i| &plan.frames[*i]) {
            let frame = plan.open(planned)?;
            let name = format!("{}/{:04}/{:06}.png", planned.split, planned.sequence, planned.index);
            unit.link(&format!("images/{name}"), &frame.needed(FrameFile::Rgb)?)?;
            let labels = MappedLabels::read(&frame, &self.map)?;
            let pixel = |(id, object): (&u8, &u16)| {
                let [high, low] = if things[usize::from(*id)] { object.to_be_bytes() } else { [0; 2] };
                [*id, high, low]
            };
            let pixels: Vec<[u8; 3]> = labels.ids.data.iter().zip(&labels.instance.data).map(pixel).collect();
            let png = png_file::labels_rgb("panoptic map", labels.ids.width, labels.ids.height, &pixels)?;
            unit.write(&format!("panoptic_maps/{name}"), &png)?;
        }
        Ok(())
    }
}
