//! MCAP with Foxglove's messages: pictures, labels, cameras and boxes of a scene in one file.

use std::collections::BTreeMap;
use std::io::{self, Write};

use glam::DAffine3;
use trove_files::{LARGEST_FILE, read_regular};
use trove_format::{FrameFile, FrameTable, LensModel, ObjectOrigin, ObjectRow};
use trove_model::Class;

use super::dataset::Dataset;
use super::geometry::{affine, quaternion_wxyz};
use super::mcap_file::McapFile;
use super::plan::{Plan, PlannedFrame};
use super::protobuf::{Message, descriptors};
use super::unit::Unit;
use crate::{StoredFrame, WriteError};

/// `<split>/<scene>_v<variation>.mcap`.
pub(super) struct Mcap;

/// The frame that all others are placed in.
const WORLD: &str = "world";
/// Lines and letters on pictures, pixels.
const LINE_PX: f64 = 2.0;
const LETTERS_PX: f64 = 12.0;

impl Dataset for Mcap {
    fn units(&self, plan: &Plan) -> Vec<Vec<usize>> {
        plan.grouped(|frame| (frame.split.clone(), frame.scene.clone(), frame.variation))
    }

    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let PlannedFrame { split, scene, variation, .. } = &plan.frames[frames[0]];
        let mut by_moment = frames.to_vec();
        by_moment.sort_by_key(|i| plan.frames[*i].keyframe);
        let mut fault = None;
        unit.stream(&format!("{split}/{scene}_v{variation:02}.mcap"), |writer| {
            let mut recording = Recording { file: McapFile::begin(writer)?, descriptors: descriptors() };
            for moment in by_moment.chunk_by(|a, b| plan.frames[*a].keyframe == plan.frames[*b].keyframe) {
                let views = moment.iter().map(|i| recording.view(plan, *i)).collect::<Result<Vec<_>, _>>();
                let views = views.map_err(|error| {
                    fault = Some(error);
                    io::Error::from(io::ErrorKind::InvalidData)
                })?;
                recording.boxes(&views);
                recording.file.end_chunk()?;
            }
            recording.file.end()
        })
        .map_err(|error| fault.unwrap_or(error))
    }
}

struct Recording<W: Write> {
    file: McapFile<W>,
    descriptors: Vec<u8>,
}

impl<W: Write> Recording<W> {
    fn add(&mut self, topic: &str, kind: &'static str, time_ns: i64, message: Message) {
        let channel = self.file.channel(topic, kind, &self.descriptors);
        // Before 1970 there is no time in MCAP.
        self.file.message(channel, u64::try_from(time_ns).unwrap_or(0), &message.into_bytes());
    }

    /// All messages of one picture; returns what else its table says.
    fn view(&mut self, plan: &Plan, number: usize) -> Result<FrameTable, WriteError> {
        let planned = &plan.frames[number];
        let frame = plan.open(planned)?;
        let table = &frame.table;
        let (view, time_ns) = (&planned.view, table.time_ns);
        let topic = |name: &str| format!("/{}/{name}", view.replace('.', "/"));
        frame.needed(FrameFile::Rgb)?;
        for (file, name) in [(FrameFile::Rgb, "image"), (FrameFile::Class, "class"), (FrameFile::Instance, "instance")]
        {
            if frame.has(file) {
                let path = frame.path(file);
                let png = read_regular(&path, LARGEST_FILE).map_err(WriteError::storage(&path, "read the file"))?;
                let image = Message::new("foxglove.CompressedImage")
                    .message("timestamp", &time(time_ns))
                    .text("frame_id", view)
                    .data("data", &png)
                    .text("format", "png");
                self.add(&topic(name), "foxglove.CompressedImage", time_ns, image);
            }
        }
        if frame.has(FrameFile::Depth) {
            let depth = depth(&frame)?;
            self.add(&topic("depth"), "foxglove.RawImage", time_ns, depth);
        }
        self.add(&topic("calibration"), "foxglove.CameraCalibration", time_ns, calibration(table));
        self.add(&topic("annotations"), "foxglove.ImageAnnotations", time_ns, annotations(table));
        let camera = transform(view, time_ns, &affine(&table.world_from_camera));
        self.add("/tf", "foxglove.FrameTransform", time_ns, camera);
        if let Some(world_from_ego) = &table.world_from_ego {
            let vehicle = view.split('.').next().unwrap_or_default();
            self.add("/tf", "foxglove.FrameTransform", time_ns, transform(vehicle, time_ns, &affine(world_from_ego)));
        }
        Ok(frame.table)
    }

    /// The boxes of all that some view of a moment shows.
    fn boxes(&mut self, views: &[FrameTable]) {
        let Some(FrameTable { keyframe_time_ns, .. }) = views.first() else { return };
        let objects: BTreeMap<u32, &ObjectRow> = views
            .iter()
            .flat_map(|table| &table.objects)
            .filter(|object| object.origin != ObjectOrigin::Scenery)
            .map(|object| (object.id, object))
            .collect();
        let time = time(*keyframe_time_ns);
        // What was there a moment ago goes first.
        let deletion = Message::new("foxglove.SceneEntityDeletion").message("timestamp", &time).choice("type", "ALL");
        let mut update = Message::new("foxglove.SceneUpdate").message("deletions", &deletion);
        for object in objects.into_values() {
            let world_from_body = affine(&object.world_from_body);
            let pose = Message::new("foxglove.Pose")
                .message("position", &vector(world_from_body.translation.to_array()))
                .message("orientation", &quaternion(&world_from_body));
            let cube = Message::new("foxglove.CubePrimitive")
                .message("pose", &pose)
                .message("size", &vector(object.size_m))
                .message("color", &color(object.class, 0.5));
            let mut entity = Message::new("foxglove.SceneEntity")
                .message("timestamp", &time)
                .text("frame_id", WORLD)
                .text("id", &object.id.to_string())
                .message("cubes", &cube);
            for (key, value) in
                [("class", object.class.row().name), ("kind", object.kind.name()), ("asset", &object.asset)]
            {
                let pair = Message::new("foxglove.KeyValuePair").text("key", key).text("value", value);
                entity = entity.message("metadata", &pair);
            }
            update = update.message("entities", &entity);
        }
        self.add("/boxes", "foxglove.SceneUpdate", *keyframe_time_ns, update);
    }
}

fn time(time_ns: i64) -> Message {
    let second = 1_000_000_000;
    Message::new("google.protobuf.Timestamp")
        .integer("seconds", time_ns.div_euclid(second))
        .integer("nanos", time_ns.rem_euclid(second))
}

fn vector([x, y, z]: [f64; 3]) -> Message {
    Message::new("foxglove.Vector3").double("x", x).double("y", y).double("z", z)
}

fn quaternion(transform: &DAffine3) -> Message {
    let [w, x, y, z] = quaternion_wxyz(transform);
    Message::new("foxglove.Quaternion").double("x", x).double("y", y).double("z", z).double("w", w)
}

fn color(class: Class, opacity: f64) -> Message {
    let [r, g, b] = class.row().rgb.map(|part| f64::from(part) / 255.0);
    Message::new("foxglove.Color").double("r", r).double("g", g).double("b", b).double("a", opacity)
}

fn transform(child: &str, time_ns: i64, world_from_child: &DAffine3) -> Message {
    Message::new("foxglove.FrameTransform")
        .message("timestamp", &time(time_ns))
        .text("parent_frame_id", WORLD)
        .text("child_frame_id", child)
        .message("translation", &vector(world_from_child.translation.to_array()))
        .message("rotation", &quaternion(world_from_child))
}

fn depth(frame: &StoredFrame) -> Result<Message, WriteError> {
    let depth_m = frame.depth_m()?;
    let data: Vec<u8> = depth_m.data.iter().flat_map(|value| value.to_le_bytes()).collect();
    Ok(Message::new("foxglove.RawImage")
        .message("timestamp", &time(frame.table.time_ns))
        .text("frame_id", &frame.table.view)
        .size("width", depth_m.width)
        .size("height", depth_m.height)
        .text("encoding", "32FC1")
        .size("step", 4 * depth_m.width)
        .data("data", &data))
}

fn calibration(table: &FrameTable) -> Message {
    // ROS' names of the models; of a panorama there is none.
    let model = match table.lens_model {
        LensModel::Pinhole => "",
        LensModel::BrownConrady => "rational_polynomial",
        LensModel::KannalaBrandt => "kannala_brandt",
        LensModel::Equirectangular => "equirectangular",
    };
    let k = &table.intrinsics;
    let projection: Vec<f64> = k.iter().flat_map(|row| [row[0], row[1], row[2], 0.0]).collect();
    Message::new("foxglove.CameraCalibration")
        .message("timestamp", &time(table.time_ns))
        .text("frame_id", &table.view)
        .size("width", table.width_px)
        .size("height", table.height_px)
        .text("distortion_model", model)
        .doubles("D", &table.distortion)
        .doubles("K", k.as_flattened())
        .doubles("R", &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0])
        .doubles("P", &projection)
}

/// The visible boxes of road users, with their kinds.
fn annotations(table: &FrameTable) -> Message {
    let time = time(table.time_ns);
    let point = |x: u32, y: u32| Message::new("foxglove.Point2").double("x", x.into()).double("y", y.into());
    let mut all = Message::new("foxglove.ImageAnnotations").message("timestamp", &time);
    for object in table.objects.iter().filter(|object| object.origin != ObjectOrigin::Scenery) {
        let Some([x0, y0, x1, y1]) = object.visible_box else { continue };
        // Along the outer edges of the pixels.
        let [x1, y1] = [x1 + 1, y1 + 1];
        let mut outline = Message::new("foxglove.PointsAnnotation")
            .message("timestamp", &time)
            .choice("type", "LINE_LOOP")
            .message("outline_color", &color(object.class, 1.0))
            .double("thickness", LINE_PX);
        for [x, y] in [[x0, y0], [x1, y0], [x1, y1], [x0, y1]] {
            outline = outline.message("points", &point(x, y));
        }
        let text = Message::new("foxglove.TextAnnotation")
            .message("timestamp", &time)
            .message("position", &point(x0, y0))
            .text("text", &format!("{} {}", object.kind.name(), object.id))
            .double("font_size", LETTERS_PX)
            .message("text_color", &color(object.class, 1.0));
        all = all.message("points", &outline).message("texts", &text);
    }
    all
}
