//! `trove inspect` of a rig: its cameras.

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use serde::Serialize;
use trove_model::RigCamera;
use trove_read::rig;

/// The cameras of a rig's file or of a preset that no folder has the name of.
pub(crate) fn own_rig(root: &Path) -> Option<Result<Vec<RigCamera>>> {
    if root.extension().is_some_and(|extension| extension == "toml") {
        return Some(rig::read(root).map_err(Into::into));
    }
    let preset = root.to_str().and_then(rig::preset).filter(|_| !root.exists());
    preset.map(Ok)
}

/// A camera as `trove inspect --json` prints it.
#[derive(Serialize)]
struct InspectedCamera<'a> {
    name: &'a str,
    size_px: [u32; 2],
    model: &'static str,
    focal_px: [f64; 2],
    position_m: [f64; 3],
    /// To the left of straight ahead.
    yaw_deg: f64,
    /// Up.
    pitch_deg: f64,
}

impl<'a> From<&'a RigCamera> for InspectedCamera<'a> {
    fn from(camera: &'a RigCamera) -> Self {
        let (lens, ahead_ego) = (&camera.lens, camera.ego_from_camera.vector(DVec3::Z));
        Self {
            name: &camera.name,
            size_px: [lens.width_px, lens.height_px],
            model: lens.distortion.name(),
            focal_px: [lens.fx_px, lens.fy_px],
            position_m: camera.ego_from_camera.translation.to_array(),
            yaw_deg: ahead_ego.y.atan2(ahead_ego.x).to_degrees(),
            pitch_deg: ahead_ego.z.clamp(-1.0, 1.0).asin().to_degrees(),
        }
    }
}

/// Prints them.
pub(crate) fn print_rig(cameras: &[RigCamera], as_json: bool) -> Result<()> {
    let cameras: Vec<InspectedCamera<'_>> = cameras.iter().map(Into::into).collect();
    if as_json {
        println!("{}", serde_json::to_string_pretty(&serde_json::json!({ "cameras": cameras }))?);
        return Ok(());
    }
    for camera in cameras {
        let InspectedCamera { name, size_px: [width, height], model, focal_px: [fx, _], .. } = camera;
        let [x, y, z] = camera.position_m;
        println!(
            "{name}: {width} × {height}, {model}, f = {fx:.1} px, at ({x:.2}, {y:.2}, {z:.2}) m, yaw {:.1}°, pitch {:.1}°",
            camera.yaw_deg, camera.pitch_deg
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rig_is_a_file_or_a_preset_and_a_folder_of_its_name_is_none() {
        assert_eq!(own_rig(Path::new("kitti")).unwrap().unwrap().len(), 4);
        assert!(own_rig(Path::new("no/my.toml")).unwrap().is_err());
        assert!(own_rig(Path::new("kitty")).is_none());
        let panorama = rig::preset("360").unwrap();
        let row = InspectedCamera::from(&panorama[0]);
        assert_eq!((row.model, row.size_px, row.yaw_deg.abs() < 1e-9), ("equirectangular", [2048, 1024], true));
    }
}
