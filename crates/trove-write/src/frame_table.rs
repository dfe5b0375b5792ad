//! From a capture to what `frame.json` holds of it.

use std::collections::BTreeMap;

use glam::{DAffine3, Vec3};
use trove_format::{FrameTable, Matrix4, ObjectRow};
use trove_model::{Capture, Instance, MapProjection, ObjectLabel, Origin, PixelBox, Scene, SeenKeypoint, Shot};

use crate::WriteError;

/// Everything in `frame.json` that a shot, a scene and a capture do not hold.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameMeta {
    /// The drive (`scene-0103`).
    pub scene: String,
    /// The dataset (`nuscenes`).
    pub dataset: String,
    /// The dataset's name of the place (`boston-seaport`); empty where unknown.
    pub place: String,
    /// Which variation of the scene.
    pub variation: u32,
    /// Index of the keyframe in its drive, among all moments where there are others between.
    pub keyframe: u32,
    /// The dataset's name of the keyframe; empty where there is none.
    pub keyframe_token: String,
    /// Time of the keyframe, nanoseconds since 1970 UTC.
    pub keyframe_time_ns: i64,
    /// Index of the recorded keyframe that it is; `None` for a moment between keyframes.
    pub recorded_keyframe: Option<u32>,
    /// The dataset's name of the recorded picture that this view clones; `None` where it clones none.
    pub source_token: Option<String>,
    /// That picture's path below the dataset's root; `None` where it clones none or it is not at hand.
    pub source_image: Option<String>,
    /// From latitude and longitude to World.
    pub projection: MapProjection,
}

/// What `frame.json` holds.
pub(crate) fn frame_table(
    scene: &Scene,
    shot: &Shot,
    capture: &Capture,
    meta: &FrameMeta,
) -> Result<FrameTable, WriteError> {
    let mut instances: BTreeMap<u32, &Instance> = BTreeMap::new();
    for instance in scene.instances.iter().filter(|i| i.object.is_some()) {
        instances.entry(instance.id.0).or_insert(instance);
    }
    let carrier = shot.carrier.and_then(|id| instances.get(&id.0)?.object.as_deref());
    let carrier_track_token = carrier.and_then(|object| object.origin.track_token()).unwrap_or_default();
    let (lens, pose) = (&shot.lens, &shot.world_from_camera);
    Ok(FrameTable {
        scene: meta.scene.clone(),
        dataset: meta.dataset.clone(),
        place: meta.place.clone(),
        variation: meta.variation,
        keyframe: meta.keyframe,
        keyframe_token: meta.keyframe_token.clone(),
        keyframe_time_ns: meta.keyframe_time_ns,
        recorded_keyframe: meta.recorded_keyframe,
        view: shot.view.clone(),
        time_ns: shot.time_ns,
        source_token: meta.source_token.clone().unwrap_or_default(),
        source_image: meta.source_image.clone().unwrap_or_default(),
        width_px: lens.width_px,
        height_px: lens.height_px,
        intrinsics: [[lens.fx_px, 0.0, lens.cx_px], [0.0, lens.fy_px, lens.cy_px], [0.0, 0.0, 1.0]],
        lens_model: (&lens.distortion).into(),
        distortion: lens.distortion.coefficients(),
        exposure_s: shot.shutter.exposure_s,
        readout_s: shot.shutter.readout_s,
        drops: shot.drops.map_or(0.0, |drops| drops.share),
        world_from_camera: matrix(pose.affine()),
        world_from_camera_rotation_wxyz: [pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z],
        world_from_camera_translation_m: pose.translation.to_array(),
        world_from_camera_previous: shot.world_from_camera_previous.map(|p| matrix(p.affine())),
        world_from_camera_next: shot.world_from_camera_next.map(|p| matrix(p.affine())),
        world_from_ego: shot.world_from_ego.map(|p| matrix(p.affine())),
        carrier: shot.carrier.map(|id| id.0),
        carrier_track_token: carrier_track_token.into(),
        projection: (&meta.projection).into(),
        glass: shot.labels.glass.into(),
        exposure_ev: capture.color.as_ref().map(|c| c.exposure_ev),
        spp: shot.spp,
        denoised: capture.stats.denoised,
        seed: shot.seed.0,
        objects: capture.labels.objects.iter().map(|o| row(o, &instances)).collect::<Result<_, _>>()?,
    })
}

fn row(label: &ObjectLabel, instances: &BTreeMap<u32, &Instance>) -> Result<ObjectRow, WriteError> {
    let id = label.id.0;
    if id > u32::from(u16::MAX) {
        return Err(WriteError::TooManyObjects(label.id));
    }
    let found = instances.get(&id).and_then(|i| i.object.as_ref().map(|o| (i.class, o, i.world_from_mesh)));
    let (class, object, world_from_asset) =
        found.ok_or_else(|| WriteError::Mismatch(format!("a label of object {id}, which the scene does not have")))?;
    let [category, token, track_token] = match &object.origin {
        Origin::Recorded { category, annotation_token, track_token } => {
            [category.clone(), annotation_token.clone(), track_token.clone()]
        }
        Origin::Carrier | Origin::Added | Origin::Scenery => Default::default(),
    };
    Ok(ObjectRow {
        id,
        class,
        class_id: class.id(),
        kind: object.kind,
        origin: (&object.origin).into(),
        category,
        token,
        track_token,
        asset: object.asset.clone().unwrap_or_default(),
        world_from_body: matrix(object.cuboid.world_from_body.affine()),
        size_m: object.cuboid.size_m.to_array(),
        world_from_asset: object.asset.as_ref().map(|_| matrix(world_from_asset)),
        paint: object.paint.map(srgb),
        velocity_mps: object.velocity_mps.map(|v| v.to_array()),
        yaw_rate_radps: object.yaw_rate_radps,
        states: object.states.clone(),
        visible_px: label.visible_px,
        amodal_px: label.amodal_px,
        visible_box: label.visible_box.map(pixel_box),
        amodal_box: label.amodal_box.map(pixel_box),
        truncation: label.truncation,
        occlusion: label.occlusion,
        range_m: label.range_m,
        keypoints: label.keypoints.map(|points| points.map(keypoint)),
        keypoints_world_m: object.keypoints_world.map(|points| points.map(|p| p.to_array())),
    })
}

pub(crate) fn matrix(transform: DAffine3) -> Matrix4 {
    let (m, t) = (transform.matrix3.transpose(), transform.translation);
    let row = |r: glam::DVec3, t: f64| [r.x, r.y, r.z, t];
    [row(m.x_axis, t.x), row(m.y_axis, t.y), row(m.z_axis, t.z), [0.0, 0.0, 0.0, 1.0]]
}

/// A linear colour, 8-bit sRGB (IEC 61966-2-1).
fn srgb(linear: Vec3) -> [u8; 3] {
    let encoded = |c: f32| if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    linear.to_array().map(|c| (encoded(c.clamp(0.0, 1.0)) * 255.0).round() as u8)
}

fn keypoint(seen: Option<SeenKeypoint>) -> [f64; 3] {
    seen.map_or([0.0; 3], |seen| [seen.pixel.x, seen.pixel.y, if seen.is_visible { 2.0 } else { 1.0 }])
}

fn pixel_box(b: PixelBox) -> [u32; 4] {
    [b.min[0], b.min[1], b.max[0], b.max[1]]
}
