//! Cityscapes' tree: pictures, ids, training ids, objects, polygons, cameras, 3D boxes and panoptic files.

use std::collections::BTreeMap;

use glam::{DAffine3, DMat3, EulerRot};
use serde_json::{Value, json};
use trove_format::{FrameFile, FrameTable, ObjectRow};
use trove_model::{ClassMap, Raster};

use super::contours::components;
use super::dataset::{Dataset, Finished};
use super::geometry::{affine, camera_from_body, quaternion_wxyz};
use super::labels::{Extent, MappedLabels, Segment, things};
use super::plan::{Plan, PlannedFrame};
use super::stereo::{RightEye, right_eye};
use super::tables::write_tables;
use super::unit::Unit;
use crate::{StoredFrame, WriteError, png_file};

/// `leftImg8bit`, `gtFine`, `gtBbox3d`, `camera` and `timestamp`.
pub(super) struct Cityscapes {
    pub map: ClassMap,
}

/// Objects of a class in a picture that `instanceIds` can tell apart.
const MOST_OBJECTS: u32 = 1000;
/// Fewer pixels are no polygon: leaves and their gaps would be most of the file.
const LEAST_POLYGON_PX: u32 = 9;
/// What a pixel of a class that does not count has in `labelTrainIds`.
const IGNORED: u8 = 255;

impl Dataset for Cityscapes {
    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        for &number in frames {
            let planned = &plan.frames[number];
            let frame = plan.open(planned)?;
            let labels = MappedLabels::read(&frame, &self.map)?;
            let name = Name::of(planned, &frame.table);
            let (width, height) = (labels.ids.width, labels.ids.height);
            super::kitti::note_distortion(&frame.table, unit);
            unit.link(&name.path("leftImg8bit", "leftImg8bit.png"), &frame.needed(FrameFile::Rgb)?)?;

            let mut train_ids = [IGNORED; 256];
            let mut colors = [[0; 3]; 256];
            for class in &self.map.classes {
                colors[usize::from(class.id)] = class.rgb;
                train_ids[usize::from(class.id)] = class.train_id.unwrap_or(IGNORED);
            }
            let ids = &labels.ids.data;
            let greys = |of: &dyn Fn(u8) -> u8| -> Vec<u8> { ids.iter().map(|id| of(*id)).collect() };
            let mut gray = |kind: &str, pixels: &[u8]| {
                unit.write(&name.path("gtFine", kind), &png_file::grey(kind, width, height, pixels)?)
            };
            gray("gtFine_labelIds.png", ids)?;
            gray("gtFine_labelTrainIds.png", &greys(&|id| train_ids[usize::from(id)]))?;
            let color: Vec<[u8; 3]> = ids.iter().map(|id| colors[usize::from(*id)]).collect();
            let color = png_file::labels_rgb("gtFine_color.png", width, height, &color)?;
            unit.write(&name.path("gtFine", "gtFine_color.png"), &color)?;

            let segments = labels.segments(&self.map);
            let numbers = Numbers::of(&segments, unit);
            let instances = labels.ids.data.iter().zip(&labels.instance.data);
            let instances: Vec<u16> = instances.map(|(id, object)| numbers.of_pixel(*id, *object)).collect();
            let png = png_file::grey16("gtFine_instanceIds.png", width, height, &instances)?;
            unit.write(&name.path("gtFine", "gtFine_instanceIds.png"), &png)?;
            let instances = Raster { width, height, data: instances };
            let polygons = self.polygons(&instances);
            unit.write(&name.path("gtFine", "gtFine_polygons.json"), &text(&polygons))?;
            self.panoptic(&name, &instances, numbers.merged(&segments), unit)?;

            let eye = right_eye(plan, number, &frame.table)?;
            let baseline_m = eye.as_ref().map_or(0.0, |eye| eye.baseline_m);
            if let Some(eye) = &eye {
                disparity(&name, &frame, eye, unit)?;
            }
            unit.write(&name.path("camera", "camera.json"), &text(&camera(&frame.table, baseline_m)))?;
            let boxes = self.boxes(&frame.table, baseline_m, &numbers);
            unit.write(&name.path("gtBbox3d", "gtBbox3d.json"), &text(&boxes))?;
            unit.write(&name.path("timestamp", "timestamp.txt"), frame.table.time_ns.to_string().as_bytes())?;
        }
        Ok(())
    }

    fn finish(&self, finished: &Finished<'_>, unit: &mut Unit<'_>) -> Result<(), WriteError> {
        for split in &finished.plan.splits {
            for by_train_id in [false, true] {
                let category = |class: &trove_model::MappedClass| {
                    let id = if by_train_id { class.train_id.unwrap_or(IGNORED) } else { class.id };
                    let supercategory = SUPERCATEGORIES.iter().find(|(_, names)| names.contains(&class.name.as_str()));
                    json!({
                        "id": id,
                        "name": class.name,
                        "color": class.rgb,
                        "supercategory": supercategory.map_or("", |(name, _)| name),
                        "isthing": u8::from(class.thing),
                    })
                };
                let categories: Vec<_> = self.map.counted().map(category).collect();
                let ending = if by_train_id { "_trainId" } else { "" };
                let path = format!("gtFine/cityscapes_panoptic_{split}{ending}.json");
                let table = format!("annotations{ending}");
                let fields = [("categories", json!(categories))];
                let tables = [("images", "images"), ("annotations", table.as_str())];
                write_tables(finished, split, &path, &fields, &tables, unit)?;
            }
        }
        Ok(())
    }
}

/// Groups of classes, as cityscapesScripts names them.
const SUPERCATEGORIES: [(&str, &[&str]); 7] = [
    ("flat", &["road", "sidewalk"]),
    ("construction", &["building", "wall", "fence"]),
    ("object", &["pole", "traffic light", "traffic sign"]),
    ("nature", &["vegetation", "terrain"]),
    ("sky", &["sky"]),
    ("human", &["person", "rider"]),
    ("vehicle", &["car", "truck", "bus", "train", "motorcycle", "bicycle"]),
];

/// How a frame's files are called.
struct Name {
    split: String,
    city: String,
    /// `aachen_000000_000019`.
    stem: String,
}

impl Name {
    fn of(planned: &PlannedFrame, table: &FrameTable) -> Self {
        let place = if table.place.is_empty() { &table.scene } else { &table.place };
        // Tools split names at the underscores.
        let city: String = place.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect();
        let city = if city.is_empty() { "place".to_owned() } else { city };
        let stem = format!("{city}_{:06}_{:06}", planned.sequence, planned.keyframe);
        Self { split: planned.split.clone(), city, stem }
    }

    fn path(&self, folder: &str, kind: &str) -> String {
        format!("{folder}/{}/{}/{}_{kind}", self.split, self.city, self.stem)
    }
}

/// The numbers of a picture's objects among those of their class, from 0.
struct Numbers {
    /// Values in `instanceIds` of what is of an object.
    segments: BTreeMap<Segment, u16>,
}

impl Numbers {
    fn of(segments: &[(Segment, Extent)], unit: &mut Unit<'_>) -> Self {
        let mut numbers = Self { segments: BTreeMap::new() };
        let mut next = [0; 256];
        for (segment, _) in segments.iter().filter(|(segment, _)| segment.object > 0) {
            let number = &mut next[usize::from(segment.id)];
            if *number == MOST_OBJECTS {
                unit.clip("objects beyond 1000 of a class in a picture, which became a group", 1);
                continue;
            }
            numbers.segments.insert(*segment, u16::from(segment.id) * MOST_OBJECTS as u16 + *number as u16);
            *number += 1;
        }
        numbers
    }

    /// Of an object; where its rider has a number of its own, that of what is ridden.
    fn of_object(&self, object: u32) -> Option<u16> {
        self.segments.iter().rfind(|(segment, _)| u32::from(segment.object) == object).map(|(_, number)| *number)
    }

    fn of_pixel(&self, id: u8, object: u16) -> u16 {
        self.segments.get(&Segment { id, object }).copied().unwrap_or(id.into())
    }

    /// Segments by their value in `instanceIds`.
    fn merged(&self, segments: &[(Segment, Extent)]) -> BTreeMap<u16, Extent> {
        let mut merged: BTreeMap<u16, Extent> = BTreeMap::new();
        for (segment, extent) in segments {
            let number = self.of_pixel(segment.id, segment.object);
            merged.entry(number).and_modify(|known| *known = known.and(extent)).or_insert(*extent);
        }
        merged
    }
}

impl Cityscapes {
    fn class_of(&self, number: u16) -> Option<&trove_model::MappedClass> {
        let id = if number < 1000 { number } else { number / 1000 };
        self.map.class(id as u8)
    }

    /// Outlines from the largest to the smallest, so that painting them one over another gives the labels back.
    fn polygons(&self, instances: &Raster<u16>) -> Value {
        let mut found = components(&instances.map(|number| u32::from(*number) + 1), LEAST_POLYGON_PX);
        found.sort_by_key(|component| std::cmp::Reverse(twice_area(&component.outline)));
        let object = |component: super::contours::Component| {
            let number = (component.value - 1) as u16;
            let class = self.class_of(number)?;
            let group = if class.thing && number < 1000 { "group" } else { "" };
            (component.outline.len() > 2)
                .then(|| json!({ "label": format!("{}{group}", class.name), "polygon": component.outline }))
        };
        let objects: Vec<Value> = found.into_iter().filter_map(object).collect();
        json!({ "imgHeight": instances.height, "imgWidth": instances.width, "objects": objects })
    }

    /// The picture of segments, under the names of both numberings, and its rows.
    fn panoptic(
        &self,
        name: &Name,
        instances: &Raster<u16>,
        extents: BTreeMap<u16, Extent>,
        unit: &mut Unit<'_>,
    ) -> Result<(), WriteError> {
        let things = things(&self.map);
        let color = |number: &u16| {
            let id = if *number < 1000 { *number } else { *number / 1000 };
            if things[usize::from(id as u8)].is_some() {
                [(number & 0xff) as u8, (number >> 8) as u8, 0]
            } else {
                [0; 3]
            }
        };
        let pixels: Vec<[u8; 3]> = instances.data.iter().map(color).collect();
        let png = png_file::labels_rgb("gtFine_panoptic.png", instances.width, instances.height, &pixels)?;
        let file = format!("{}_gtFine_panoptic.png", name.stem);
        let [path, by_train_id] =
            ["", "_trainId"].map(|ending| format!("gtFine/cityscapes_panoptic_{}{ending}/{file}", name.split));
        unit.write(&path, &png)?;
        unit.link_own(&by_train_id, &path)?;
        for by_train_id in [false, true] {
            let ending = if by_train_id { "_trainId" } else { "" };
            let info = |(number, extent): (&u16, &Extent)| {
                let class = self.class_of(*number)?;
                let category = if by_train_id { class.train_id? } else { class.id };
                let crowd = u8::from(class.thing && *number < 1000);
                Some(json!({
                    "id": number, "category_id": category, "area": extent.area, "bbox": extent.xywh(), "iscrowd": crowd,
                }))
            };
            let segments: Vec<Value> = extents.iter().filter_map(info).collect();
            let row = json!({ "image_id": name.stem, "file_name": file, "segments_info": segments });
            unit.row(&format!("annotations{ending}"), &row)?;
        }
        let image = format!("{}_gtFine_leftImg8bit.png", name.stem);
        let row = json!({ "id": name.stem, "file_name": image, "width": instances.width, "height": instances.height });
        unit.row("images", &row)
    }

    /// 3D boxes of what is countable and seen, in ISO 8855's axes at the camera (x forward, y left, z up).
    fn boxes(&self, table: &FrameTable, baseline_m: f64, numbers: &Numbers) -> Value {
        let iso = camera_from_iso().inverse();
        let object = |object: &ObjectRow| {
            let number = numbers.of_object(object.id)?;
            let (label, [modal, amodal]) = (&self.class_of(number)?.name, [object.visible_box?, object.amodal_box?]);
            let iso_from_body = iso * camera_from_body(table, object);
            let xywh = |bounds| Extent { area: 0, bounds }.xywh();
            Some(json!({
                "2d": { "modal": xywh(modal), "amodal": xywh(amodal) },
                "3d": {
                    "center": iso_from_body.translation.to_array(),
                    "dimensions": object.size_m,
                    "rotation": quaternion_wxyz(&iso_from_body),
                    "type": object.kind.name(),
                    "format": "CRS_ISO8855",
                },
                "occlusion": object.occlusion,
                "truncation": object.truncation,
                "instanceId": number % 1000,
                "label": label,
                "score": 1.0,
            }))
        };
        let objects: Vec<Value> = table.objects.iter().filter_map(object).collect();
        let k = &table.intrinsics;
        json!({
            "imgWidth": table.width_px,
            "imgHeight": table.height_px,
            "sensor": {
                "sensor_T_ISO_8855": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]],
                "fx": k[0][0], "fy": k[1][1], "u0": k[0][2], "v0": k[1][2], "baseline": baseline_m,
            },
            "objects": objects,
            "ignore": [],
        })
    }
}

/// The right picture, and how far the left one's pixels are from where they are in it: 256 steps a pixel, from 1; 0 for
/// the sky.
fn disparity(name: &Name, left: &StoredFrame, eye: &RightEye, unit: &mut Unit<'_>) -> Result<(), WriteError> {
    unit.link(&name.path("rightImg8bit", "rightImg8bit.png"), &eye.frame.needed(FrameFile::Rgb)?)?;
    let mut beyond = 0;
    let step = |px: &f64| match (px * 256.0).round() + 1.0 {
        step if *px > 0.0 && step <= 65535.0 => step as u16,
        step => {
            beyond += u64::from(step > 65535.0);
            0
        }
    };
    let steps = eye.disparity_px(left)?.map(step);
    unit.clip("pixels whose disparity is beyond 255.99 pixels, which are invalid", beyond);
    let png = png_file::grey16("disparity.png", steps.width, steps.height, &steps.data)?;
    unit.write(&name.path("disparity", "disparity.png"), &png)
}

/// Intrinsics, and the camera's place on the vehicle where one carries it.
fn camera(table: &FrameTable, baseline_m: f64) -> Value {
    let k = &table.intrinsics;
    let ego_from_iso = match &table.world_from_ego {
        Some(world_from_ego) => affine(world_from_ego).inverse() * affine(&table.world_from_camera) * camera_from_iso(),
        None => DAffine3::IDENTITY,
    };
    let (_, rotation, place) = ego_from_iso.to_scale_rotation_translation();
    let (yaw, pitch, roll) = rotation.to_euler(EulerRot::ZYX);
    json!({
        "extrinsic": {
            "baseline": baseline_m, "pitch": pitch, "roll": roll, "x": place.x, "y": place.y, "yaw": yaw, "z": place.z,
        },
        "intrinsic": { "fx": k[0][0], "fy": k[1][1], "u0": k[0][2], "v0": k[1][2] },
    })
}

/// From x forward, y left, z up to Camera.
fn camera_from_iso() -> DAffine3 {
    DAffine3::from_mat3(DMat3::from_cols(glam::DVec3::Z, -glam::DVec3::X, -glam::DVec3::Y))
}

fn twice_area(outline: &[[u32; 2]]) -> i64 {
    let corner = |i: usize| outline[i % outline.len()].map(i64::from);
    let cross = |i| corner(i)[0] * corner(i + 1)[1] - corner(i + 1)[0] * corner(i)[1];
    (0..outline.len()).map(cross).sum::<i64>().abs()
}

fn text(value: &Value) -> Vec<u8> {
    value.to_string().into_bytes()
}
