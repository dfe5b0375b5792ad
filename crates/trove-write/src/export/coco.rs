//! COCO: objects with masks as run lengths, points of people, and the panoptic form of a picture and its segments.

use serde_json::{Value, json};
use trove_format::FrameFile;
use trove_model::{ClassMap, KEYPOINTS, Keypoints, Mask};

use super::dataset::{Dataset, Finished};
use super::labels::{Extent, MappedLabels, Segment, things};
use super::plan::Plan;
use super::tables::write_tables;
use super::unit::Unit;
use crate::masks::{packed, run_lengths, within};
use crate::{StoredFrame, WriteError, png_file};

/// `<split>/*.png`, `annotations/instances_<split>.json` and `annotations/person_keypoints_<split>.json`.
pub(super) struct CocoInstances {
    pub map: ClassMap,
}

/// `<split>/*.png`, `annotations/panoptic_<split>/*.png` and `annotations/panoptic_<split>.json`.
pub(super) struct CocoPanoptic {
    pub map: ClassMap,
}

const IMAGES: &str = "images";
const ANNOTATIONS: &str = "annotations";
/// Annotations of those whose points are known.
const PEOPLE: &str = "people";

/// The only category of COCO's keypoints.
const PERSON: u8 = 1;
/// COCO's lines between points, numbered from 1.
#[rustfmt::skip]
const SKELETON: [[u8; 2]; 19] = [
    [16, 14], [14, 12], [17, 15], [15, 13], [12, 13], [6, 12], [7, 13], [6, 7], [6, 8], [7, 9], [8, 10], [9, 11], [2, 3],
    [1, 2], [1, 3], [2, 4], [3, 5], [4, 6], [5, 7],
];

impl Dataset for CocoInstances {
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        for &number in frames {
            let (frame, labels) = image(plan, number, &self.map, unit)?;
            let masks = if frame.has(FrameFile::Masks) { frame.masks()?.objects } else { Vec::new() };
            let segments = labels.segments(&self.map);
            for (segment, extent) in segments.iter().filter(|(segment, _)| segment.object > 0) {
                // Of a rider and what is ridden there are two.
                let is_whole = segments.iter().filter(|(other, _)| other.object == segment.object).count() == 1;
                let is_person = self.map.class(segment.id).is_some_and(|class| class.name == "person");
                let mask = mask(&labels, *segment, extent.bounds);
                let runs = run_lengths(&mask, labels.ids.width, labels.ids.height);
                let mut annotation = json!({
                    "id": (number as u64) << 24 | u64::from(segment.id) << 16 | u64::from(segment.object),
                    "image_id": number,
                    "category_id": segment.id,
                    "bbox": extent.xywh(),
                    "area": extent.area,
                    "segmentation": { "size": [labels.ids.height, labels.ids.width], "counts": packed(&runs) },
                    "iscrowd": 0,
                    "track_id": segment.object,
                });
                let object = frame.table.objects.iter().find(|object| object.id == u32::from(segment.object));
                if let Some(object) = object.filter(|_| is_whole)
                    && let Some(masks) = masks.iter().find(|masks| masks.id == object.id)
                {
                    // As KINS names them.
                    annotation["a_segm"] = json!(masks.amodal);
                    annotation["a_area"] = json!(object.amodal_px);
                    annotation["a_bbox"] = json!(object.amodal_box.map(|bounds| Extent { area: 0, bounds }.xywh()));
                }
                unit.row(ANNOTATIONS, &annotation)?;
                if let Some(points) = object.filter(|_| is_whole || is_person).and_then(|object| object.keypoints) {
                    annotation["category_id"] = json!(PERSON);
                    annotation["keypoints"] = keypoints(&points);
                    annotation["num_keypoints"] =
                        json!(points.iter().filter(|[.., visibility]| *visibility > 0.0).count());
                    unit.row(PEOPLE, &annotation)?;
                }
            }
        }
        Ok(())
    }

    fn finish(&self, finished: &Finished<'_>, unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let things = self.map.counted().filter(|class| class.thing);
        let category = |class: &trove_model::MappedClass| json!({ "id": class.id, "name": class.name });
        let things: Vec<_> = things.map(category).collect();
        let person =
            json!([{ "id": PERSON, "name": "person", "keypoints": KEYPOINTS, "skeleton": SKELETON.map(Vec::from) }]);
        for split in &finished.plan.splits {
            for (file, categories, rows) in
                [("instances", json!(things), ANNOTATIONS), ("person_keypoints", person.clone(), PEOPLE)]
            {
                let path = format!("annotations/{file}_{split}.json");
                let fields = [("info", info(finished)), ("licenses", finished.licenses()), ("categories", categories)];
                write_tables(finished, split, &path, &fields, &[(IMAGES, IMAGES), (ANNOTATIONS, rows)], unit)?;
            }
        }
        Ok(())
    }
}

impl Dataset for CocoPanoptic {
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let things = things(&self.map);
        for &number in frames {
            let (_, labels) = image(plan, number, &self.map, unit)?;
            // Numbers of three bytes: the category's, and the object's above it.
            let segment_id = |segment: Segment| u32::from(segment.id) + 256 * u32::from(segment.object);
            let color = |(id, object): (&u8, &u16)| match things[usize::from(*id)] {
                None => [0; 3],
                Some(thing) => {
                    let [r, g, b, _] =
                        segment_id(Segment { id: *id, object: if thing { *object } else { 0 } }).to_le_bytes();
                    [r, g, b]
                }
            };
            let pixels: Vec<[u8; 3]> = labels.ids.data.iter().zip(&labels.instance.data).map(color).collect();
            let name = format!("{number:012}.png");
            let split = &plan.frames[number].split;
            let png = png_file::labels_rgb(&name, labels.ids.width, labels.ids.height, &pixels)?;
            unit.write(&format!("annotations/panoptic_{split}/{name}"), &png)?;
            let info = |(segment, extent): (Segment, Extent)| {
                let is_thing = things[usize::from(segment.id)] == Some(true);
                json!({
                    "id": segment_id(segment),
                    "category_id": segment.id,
                    "area": extent.area,
                    "bbox": extent.xywh(),
                    "iscrowd": u8::from(is_thing && segment.object == 0),
                })
            };
            let segments: Vec<_> = labels.segments(&self.map).into_iter().map(info).collect();
            unit.row(ANNOTATIONS, &json!({ "image_id": number, "file_name": name, "segments_info": segments }))?;
        }
        Ok(())
    }

    fn finish(&self, finished: &Finished<'_>, unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let category = |class: &trove_model::MappedClass| json!({ "id": class.id, "name": class.name, "isthing": u8::from(class.thing), "color": class.rgb });
        let categories: Vec<_> = self.map.counted().map(category).collect();
        for split in &finished.plan.splits {
            let path = format!("annotations/panoptic_{split}.json");
            let fields =
                [("info", info(finished)), ("licenses", finished.licenses()), ("categories", json!(categories))];
            write_tables(finished, split, &path, &fields, &[IMAGES, ANNOTATIONS].map(|table| (table, table)), unit)?;
        }
        Ok(())
    }
}

/// Puts the picture in its place, adds its row and reads its labels.
fn image(
    plan: &Plan,
    number: usize,
    map: &ClassMap,
    unit: &mut Unit<'_>,
) -> Result<(StoredFrame, MappedLabels), WriteError> {
    let planned = &plan.frames[number];
    let frame = plan.open(planned)?;
    let name = format!("{number:012}.png");
    unit.link(&format!("{}/{name}", planned.split), &frame.needed(FrameFile::Rgb)?)?;
    let (width, height) = (frame.table.width_px, frame.table.height_px);
    let row = json!({ "id": number, "file_name": name, "width": width, "height": height, "trove_path": planned.path });
    unit.row(IMAGES, &row)?;
    let labels = MappedLabels::read(&frame, map)?;
    Ok((frame, labels))
}

/// Column, row and visibility of each point in one list, as COCO has it: to a hundredth of a pixel.
fn keypoints(points: &Keypoints<[f64; 3]>) -> Value {
    json!(points.as_flattened().iter().map(|v| (v * 100.0).round() / 100.0).collect::<Vec<_>>())
}

fn mask(labels: &MappedLabels, segment: Segment, bounds: [u32; 4]) -> Mask {
    within(bounds, |x, y| *labels.instance.at(x, y) == segment.object && *labels.ids.at(x, y) == segment.id)
}

fn info(finished: &Finished<'_>) -> serde_json::Value {
    json!({ "description": "made by trove export", "version": finished.manifest.versions.trove })
}
