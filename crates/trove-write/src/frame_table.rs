//! `frame.json`: the camera and one row an object.
//!
//! | field | meaning |
//! |---|---|
//! | `scene`, `dataset`, `place`, `variation`, `keyframe` | which frame; `keyframe` counts from 0 in its drive |
//! | `keyframe_token`, `keyframe_time_ns` | the dataset's keyframe; nanoseconds since 1970 UTC |
//! | `view`, `time_ns` | the camera (`ego.CAM_FRONT`) and its own time, which differs from the keyframe's |
//! | `source_token`, `source_image` | the recorded picture that the view clones; empty where it clones none |
//! | `width_px`, `height_px`, `intrinsics` | image size and K (3×3, rows first); pixel centres are at .5 |
//! | `lens_model`, `distortion` | `pinhole`, `brown-conrady` (k₁ k₂ p₁ p₂ k₃ k₄ k₅ k₆ in OpenCV's order) or `kannala-brandt` (a fisheye: k₁ k₂ k₃ k₄) |
//! | `exposure_s`, `readout_s` | for how long a row is exposed and how long after the first row the last one is; `world_from_camera`, `time_ns` and all labels belong to the middle of it all |
//! | `world_from_camera` | 4×4, rows first: takes a point in Camera (x right, y down, z forward) to World (x east, y north, z up, metres) |
//! | `world_from_camera_rotation_wxyz`, `world_from_camera_translation_m` | the same as a unit quaternion, w first, and the camera's position |
//! | `world_from_camera_previous`, `…_next` | the same camera at the neighbouring keyframes, which flow leads to; null where there is none |
//! | `world_from_ego` | the vehicle that carries the camera (x forward, y left, z up); null where there is none |
//! | `carrier` | id of that vehicle where it is one of the objects, left out of the picture; null otherwise |
//! | `projection` | World = (Δlon·R·cos lat₀, Δlat·R) − `anchor_m`, R = 6,378,137 m, from the origin |
//! | `exposure_ev` | radiance was multiplied by 2 to this power; null without `rgb.png` |
//! | `spp`, `denoised`, `seed` | how the picture was made |
//! | `objects` | every object of which a pixel would be seen if nothing else were there, in the order of ids |
//!
//! A row of `objects`:
//!
//! | field | meaning |
//! |---|---|
//! | `id` | its value in `instance.png`, the same in all views and keyframes of a scene |
//! | `class`, `class_id`, `kind` | name and id in the class table; what it is, finer |
//! | `category`, `token`, `track_token` | the dataset's category, annotation and track; empty for scenery and added road users |
//! | `asset` | the model that stands for it; empty for what was built for this place |
//! | `world_from_body`, `size_m` | its box: 4×4 from Body (x forward, y left, z up, origin in the centre) to World; length, width, height |
//! | `velocity_mps` | in World; null where unknown |
//! | `visible_px`, `amodal_px` | pixels that show it; that would if nothing else were there |
//! | `visible_box`, `amodal_box` | \[x0, y0, x1, y1\] of those, first and last pixel, both included; null where there are none |
//! | `truncation`, `occlusion` | share outside the image; share of the amodal pixels that other things hide |
//! | `distance_m` | from the camera to the centre of its box |

use std::collections::BTreeMap;
use std::io;

use glam::DAffine3;
use serde::Serialize;
use serde_json::ser::Formatter;
use trove_model::{Capture, Instance, Kind, ObjectLabel, PixelBox, Scene, Shot};

use crate::{FrameMeta, WriteError};

type Matrix4 = [[f64; 4]; 4];

#[derive(Serialize)]
struct FrameTable<'a> {
    scene: &'a str,
    dataset: &'a str,
    place: &'a str,
    variation: u32,
    keyframe: u32,
    keyframe_token: &'a str,
    keyframe_time_ns: i64,
    view: &'a str,
    time_ns: i64,
    source_token: &'a str,
    source_image: &'a str,
    width_px: u32,
    height_px: u32,
    intrinsics: [[f64; 3]; 3],
    lens_model: &'static str,
    distortion: Vec<f64>,
    exposure_s: f64,
    readout_s: f64,
    world_from_camera: Matrix4,
    world_from_camera_rotation_wxyz: [f64; 4],
    world_from_camera_translation_m: [f64; 3],
    world_from_camera_previous: Option<Matrix4>,
    world_from_camera_next: Option<Matrix4>,
    world_from_ego: Option<Matrix4>,
    carrier: Option<u32>,
    projection: ProjectionRow,
    exposure_ev: Option<f64>,
    spp: u32,
    denoised: bool,
    seed: u64,
    objects: Vec<ObjectRow<'a>>,
}

#[derive(Serialize)]
struct ProjectionRow {
    origin_lat_deg: f64,
    origin_lon_deg: f64,
    anchor_m: [f64; 2],
}

#[derive(Serialize)]
struct ObjectRow<'a> {
    id: u32,
    class: &'static str,
    class_id: u8,
    kind: String,
    category: &'a str,
    token: &'a str,
    track_token: &'a str,
    asset: &'a str,
    world_from_body: Matrix4,
    size_m: [f64; 3],
    velocity_mps: Option<[f64; 3]>,
    visible_px: u32,
    amodal_px: u32,
    visible_box: Option<[u32; 4]>,
    amodal_box: Option<[u32; 4]>,
    truncation: f32,
    occlusion: f32,
    distance_m: f32,
}

/// `frame.json`'s bytes.
pub(crate) fn frame_table(
    scene: &Scene,
    shot: &Shot,
    capture: &Capture,
    meta: &FrameMeta,
) -> Result<Vec<u8>, WriteError> {
    let mut instances: BTreeMap<u32, &Instance> = BTreeMap::new();
    for instance in scene.instances.iter().filter(|i| i.object.is_some()) {
        instances.entry(instance.id.0).or_insert(instance);
    }
    let (lens, pose) = (&shot.lens, &shot.world_from_camera);
    let table = FrameTable {
        scene: &meta.scene,
        dataset: &meta.dataset,
        place: &meta.place,
        variation: meta.variation,
        keyframe: meta.keyframe,
        keyframe_token: &meta.keyframe_token,
        keyframe_time_ns: meta.keyframe_time_ns,
        view: &shot.view,
        time_ns: shot.time_ns,
        source_token: &meta.source_token,
        source_image: &meta.source_image,
        width_px: lens.width_px,
        height_px: lens.height_px,
        intrinsics: [[lens.fx_px, 0.0, lens.cx_px], [0.0, lens.fy_px, lens.cy_px], [0.0, 0.0, 1.0]],
        lens_model: lens.distortion.name(),
        distortion: lens.distortion.coefficients(),
        exposure_s: shot.shutter.exposure_s,
        readout_s: shot.shutter.readout_s,
        world_from_camera: matrix(pose.affine()),
        world_from_camera_rotation_wxyz: [pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z],
        world_from_camera_translation_m: pose.translation.to_array(),
        world_from_camera_previous: shot.world_from_camera_previous.map(|p| matrix(p.affine())),
        world_from_camera_next: shot.world_from_camera_next.map(|p| matrix(p.affine())),
        world_from_ego: meta.world_from_ego.map(|p| matrix(p.affine())),
        carrier: shot.carrier.map(|id| id.0),
        projection: ProjectionRow {
            origin_lat_deg: meta.projection.origin_lat_deg,
            origin_lon_deg: meta.projection.origin_lon_deg,
            anchor_m: meta.projection.anchor_m.to_array(),
        },
        exposure_ev: capture.color.as_ref().map(|c| c.exposure_ev),
        spp: shot.spp,
        denoised: capture.stats.denoised,
        seed: shot.seed.0,
        objects: capture.labels.objects.iter().map(|o| row(o, &instances)).collect::<Result<_, _>>()?,
    };
    let mut bytes = Vec::new();
    let mut serializer = serde_json::Serializer::with_formatter(&mut bytes, RowFormatter::default());
    let encoding = |e: serde_json::Error| WriteError::Encoding { name: "frame.json".into(), found: e.to_string() };
    table.serialize(&mut serializer).map_err(encoding)?;
    bytes.push(b'\n');
    Ok(bytes)
}

fn row<'a>(label: &ObjectLabel, instances: &BTreeMap<u32, &'a Instance>) -> Result<ObjectRow<'a>, WriteError> {
    let id = label.id.0;
    if id > u32::from(u16::MAX) {
        return Err(WriteError::TooManyObjects(label.id));
    }
    let found = instances.get(&id).and_then(|i| i.object.as_ref().map(|o| (i.class.row(), o)));
    let (class, object) =
        found.ok_or_else(|| WriteError::Mismatch(format!("a label of object {id}, which the scene does not have")))?;
    Ok(ObjectRow {
        id,
        class: class.name,
        class_id: class.class.id(),
        kind: kind_name(object.kind),
        category: &object.category,
        token: &object.annotation_token,
        track_token: &object.track_token,
        asset: &object.asset,
        world_from_body: matrix(object.cuboid.world_from_body.affine()),
        size_m: object.cuboid.size_m.to_array(),
        velocity_mps: object.velocity_mps.map(|v| v.to_array()),
        visible_px: label.visible_px,
        amodal_px: label.amodal_px,
        visible_box: label.visible_box.map(pixel_box),
        amodal_box: label.amodal_box.map(pixel_box),
        truncation: label.truncation,
        occlusion: label.occlusion,
        distance_m: label.range_m,
    })
}

/// `BicycleWithRider` → `bicycle_with_rider`.
pub(crate) fn kind_name(kind: Kind) -> String {
    let mut name = String::new();
    for c in format!("{kind:?}").chars() {
        if c.is_ascii_uppercase() && !name.is_empty() {
            name.push('_');
        }
        name.push(c.to_ascii_lowercase());
    }
    name
}

fn matrix(transform: DAffine3) -> Matrix4 {
    let (m, t) = (transform.matrix3.transpose(), transform.translation);
    let row = |r: glam::DVec3, t: f64| [r.x, r.y, r.z, t];
    [row(m.x_axis, t.x), row(m.y_axis, t.y), row(m.z_axis, t.z), [0.0, 0.0, 0.0, 1.0]]
}

fn pixel_box(b: PixelBox) -> [u32; 4] {
    [b.min[0], b.min[1], b.max[0], b.max[1]]
}

/// One line a field and one line an object: files that are read by people, by `grep` and by `diff`.
#[derive(Default)]
struct RowFormatter {
    /// How many brackets are open.
    depth: usize,
}

impl RowFormatter {
    fn open<W: ?Sized + io::Write>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.depth += 1;
        writer.write_all(bracket)
    }

    fn close<W: ?Sized + io::Write>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.depth -= 1;
        writer.write_all(if self.depth == 0 { b"\n" } else { b"" })?;
        writer.write_all(bracket)
    }
}

impl Formatter for RowFormatter {
    fn begin_array<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.open(writer, b"[")
    }

    fn end_array<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, b"]")
    }

    fn begin_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        // An object in a list of the table's is a row.
        self.open(writer, if self.depth == 2 { b"\n{" } else { b"{" })
    }

    fn end_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, b"}")
    }

    fn begin_object_key<W: ?Sized + io::Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        writer.write_all(if first { b"" } else { b"," })?;
        writer.write_all(if self.depth == 1 { b"\n" } else { b"" })
    }
}
