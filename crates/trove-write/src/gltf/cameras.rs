//! Nodes for cameras and for the sun.

use glam::{DMat4, DQuat, DVec3, Vec3};
use serde_json::{Value, json};
use trove_model::Shot;

/// Light's weight in lumens a watt at 555 nm: glTF counts in lux what others count in watts a square metre.
const LUX_PER_WATT: f32 = 683.0;

/// Nearest thing that a camera of the file shows, metres.
const NEAR_M: f64 = 0.05;

/// The sun, which a picture of the sky cannot hold: its disk is a thousand times as bright as the rest and half a
/// degree wide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunLight {
    /// Unit vector to its centre, World.
    pub to_sun: DVec3,
    /// Irradiance of a surface that faces it, linear Rec. 709 in the scale of [`trove_model::Light`].
    pub irradiance: Vec3,
    /// Angular radius of the disk.
    pub radius_rad: f64,
}

/// A camera and the node, in World, that carries it as camera number `index`.
///
/// glTF's cameras have no principal point and look along −z; the extras hold what they cannot say.
pub(super) fn camera(shot: &Shot, index: usize) -> (Value, Value) {
    let lens = &shot.lens;
    let vertical_fov = 2.0 * (0.5 * f64::from(lens.height_px) / lens.fy_px).atan();
    let aspect = f64::from(lens.width_px) * lens.fy_px / (f64::from(lens.height_px) * lens.fx_px);
    let camera = json!({
        "type": "perspective",
        "name": shot.view,
        "perspective": { "yfov": vertical_fov, "aspectRatio": aspect, "znear": NEAR_M },
    });
    let turned = shot.world_from_camera.affine() * glam::DAffine3::from_scale(DVec3::new(1.0, -1.0, -1.0));
    let node = json!({
        "name": shot.view,
        "camera": index,
        "matrix": DMat4::from(turned).to_cols_array(),
        "extras": {
            "width_px": lens.width_px,
            "height_px": lens.height_px,
            "fx_px": lens.fx_px,
            "fy_px": lens.fy_px,
            "cx_px": lens.cx_px,
            "cy_px": lens.cy_px,
            "carrier": shot.carrier.map(|id| id.0),
        },
    });
    (camera, node)
}

/// The sun as a directional light of `KHR_lights_punctual`, and the node that points it; its extras hold the disk's
/// angular radius.
pub(super) fn sun(sun: &SunLight) -> (Value, Value) {
    let brightest = sun.irradiance.max_element().max(f32::MIN_POSITIVE);
    let light = json!({
        "type": "directional",
        "name": "sun",
        "color": (sun.irradiance / brightest).max(Vec3::ZERO).to_array(),
        "intensity": brightest * LUX_PER_WATT,
    });
    // Such a light shines along −z.
    let turn = DQuat::from_rotation_arc(DVec3::Z, sun.to_sun.normalize());
    let node = json!({
        "name": "sun",
        "rotation": turn.to_array(),
        "extras": { "radius_rad": sun.radius_rad },
        "extensions": { "KHR_lights_punctual": { "light": 0 } },
    });
    (light, node)
}
