//! Cameras.

use trove_format::{LensModel, PlainCamera};
use trove_model::{Camera, Ego, Lens, Pose};

use super::poses;

/// No picture has a longer side, pixels.
const LARGEST_PX: u32 = 65_535;

/// A lens and its mounting; the error says what is wrong with them.
pub(crate) fn camera(camera: &PlainCamera) -> Result<(Lens, Pose<Ego, Camera>), String> {
    let PlainCamera { width_px, height_px, fx_px, fy_px, cx_px, cy_px, lens_model, distortion, ego_from_camera } =
        camera;
    let is_side = |px: u32| (1..=LARGEST_PX).contains(&px);
    if !is_side(*width_px) || !is_side(*height_px) {
        return Err(format!("expected a picture of 1 to {LARGEST_PX} pixels a side, found {width_px} × {height_px}"));
    }
    let lens = Lens {
        width_px: *width_px,
        height_px: *height_px,
        fx_px: *fx_px,
        fy_px: fy_px.unwrap_or(*fx_px),
        cx_px: cx_px.unwrap_or(0.5 * f64::from(*width_px)),
        cy_px: cy_px.unwrap_or(0.5 * f64::from(*height_px)),
        distortion: lens_model.unwrap_or(LensModel::Pinhole).distortion(distortion)?,
    };
    let is_focal = |f: f64| f > 0.0 && f < 1e6;
    if !(is_focal(lens.fx_px) && is_focal(lens.fy_px) && lens.cx_px.abs() < 1e6 && lens.cy_px.abs() < 1e6) {
        let found = (lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px);
        return Err(format!("expected focal lengths above 0 and a principal point, in pixels, found {found:?}"));
    }
    Ok((lens, poses::mounting("ego_from_camera", ego_from_camera)?))
}
