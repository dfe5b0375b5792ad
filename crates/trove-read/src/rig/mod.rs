//! Rigs of cameras of one's own (TOML) → `RigCamera`s, and those of well-known datasets.

mod camera;

use std::path::Path;

use serde::Deserialize;
use trove_files::{LARGEST_TEXT, read_text};
use trove_model::RigCamera;

use crate::ReadError;
use crate::toml_fault;
use camera::CameraRow;

/// Rigs that need no file, by name.
const PRESETS: [(&str, &str); 9] = [
    ("360", include_str!("presets/360.toml")),
    ("argoverse2", include_str!("presets/argoverse2.toml")),
    ("cityscapes", include_str!("presets/cityscapes.toml")),
    ("dashcam", include_str!("presets/dashcam.toml")),
    ("kitti", include_str!("presets/kitti.toml")),
    ("nuscenes", include_str!("presets/nuscenes.toml")),
    ("stereo", include_str!("presets/stereo.toml")),
    ("surround-fisheye", include_str!("presets/surround-fisheye.toml")),
    ("waymo", include_str!("presets/waymo.toml")),
];
/// More cameras than any vehicle has.
const MOST_CAMERAS: usize = 64;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RigFile {
    /// Whose calibration it is; for people.
    #[serde(rename = "source")]
    _source: Option<String>,
    #[serde(default)]
    camera: Vec<CameraRow>,
}

/// Names of the rigs that need no file, in alphabetical order.
pub fn presets() -> impl Iterator<Item = &'static str> {
    PRESETS.iter().map(|(name, _)| *name)
}

/// The cameras of a rig that needs no file; `None` for a name that is no such rig's.
///
/// # Panics
/// Never: a test reads all of them.
pub fn preset(name: &str) -> Option<Vec<RigCamera>> {
    let (_, text) = PRESETS.iter().find(|(preset, _)| *preset == name)?;
    Some(parse(text).expect("a preset that a test reads"))
}

/// Reads a rig: `[[camera]]` tables with a name, a pose in Ego, a size and a lens.
///
/// # Errors
/// A file that cannot be read, is not TOML, has no camera, two of a name, or one whose numbers make no camera.
pub fn read(path: &Path) -> Result<Vec<RigCamera>, ReadError> {
    let text = read_text(path, LARGEST_TEXT).map_err(|source| ReadError::io(path, source))?;
    parse(&text).map_err(|fault| ReadError::Format {
        path: path.to_owned(),
        place: fault.place,
        expected: fault.expected,
        found: fault.found,
        remedy: "see docs/recipe.md, Rigs".into(),
    })
}

/// What is wrong with a rig's text.
#[derive(Debug)]
struct Fault {
    place: String,
    expected: String,
    found: String,
}

fn parse(text: &str) -> Result<Vec<RigCamera>, Fault> {
    let file: RigFile = toml::from_str(text).map_err(|error| {
        let place = toml_fault::place(text, &error);
        Fault { place, expected: "a rig in TOML".into(), found: error.message().to_owned() }
    })?;
    let whole = |expected: &str, found: String| Fault { place: "[[camera]]".into(), expected: expected.into(), found };
    if file.camera.is_empty() || file.camera.len() > MOST_CAMERAS {
        return Err(whole("1 to 64 cameras", file.camera.len().to_string()));
    }
    let mut cameras: Vec<RigCamera> = Vec::new();
    for (i, row) in file.camera.iter().enumerate() {
        let camera = row.camera().map_err(|(key, expected, found)| Fault {
            place: format!("camera {} ({:?}), {key}", i + 1, row.name),
            expected: expected.into(),
            found,
        })?;
        if cameras.iter().any(|other| other.name == camera.name) {
            return Err(whole("cameras with names of their own", format!("two that are named {:?}", camera.name)));
        }
        cameras.push(camera);
    }
    Ok(cameras)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, DVec3};
    use trove_model::Lens;

    fn one(keys: &str) -> Result<RigCamera, String> {
        let text = format!("[[camera]]\nname = \"A\"\nsize_px = [1000, 500]\nposition_m = [1, 2, 3]\n{keys}");
        parse(&text)
            .map(|mut cameras| cameras.remove(0))
            .map_err(|f| format!("{}: {}, {}", f.place, f.expected, f.found))
    }

    #[test]
    fn every_preset_is_a_rig_whose_cameras_see_forward_of_themselves() {
        let counts: Vec<(&str, usize)> = presets().map(|name| (name, preset(name).unwrap().len())).collect();
        let expect = [
            ("360", 1),
            ("argoverse2", 9),
            ("cityscapes", 2),
            ("dashcam", 1),
            ("kitti", 4),
            ("nuscenes", 6),
            ("stereo", 2),
            ("surround-fisheye", 4),
            ("waymo", 5),
        ];
        assert_eq!(counts, expect);
        for camera in presets().flat_map(|name| preset(name).unwrap()) {
            let Lens { width_px, height_px, .. } = camera.lens;
            let middle = DVec2::new(f64::from(width_px), f64::from(height_px)) / 2.0;
            let ahead = camera.lens.unproject(middle).unwrap();
            assert!(ahead.z > 0.9, "{}", camera.name);
            // None hangs its head, and those in front look to where they are named after.
            let up_ego = camera.ego_from_camera.vector(-DVec3::Y);
            assert!(up_ego.z > 0.6, "{}: {up_ego}", camera.name);
            let ahead_ego = camera.ego_from_camera.vector(DVec3::Z);
            let name = camera.name.to_lowercase();
            let is_front = name.contains("front") && !name.contains("left") && !name.contains("right");
            assert!(!is_front || ahead_ego.x > 0.9, "{name}: {ahead_ego}");
            let is_left = name.contains("side_left") || name == "cam_front_left" || name == "front_left";
            assert!(!is_left || ahead_ego.y > 0.5, "{name}: {ahead_ego}");
        }
        assert!(preset("nuscene").is_none());
    }

    #[test]
    fn angles_and_a_quaternion_say_the_same_pose() {
        // To the left, 30° down, leaning right.
        let by_angles = one("yaw_deg = 90\npitch_deg = -30\nroll_deg = 10\nhorizontal_fov_deg = 90").unwrap();
        let ahead = by_angles.ego_from_camera.vector(DVec3::Z);
        assert!(ahead.distance(DVec3::new(0.0, 0.75f64.sqrt(), -0.5)) < 1e-12, "{ahead}");
        let right = by_angles.ego_from_camera.vector(DVec3::X);
        assert!(right.x > 0.98 && right.z < -0.1, "{right}");
        let q = by_angles.ego_from_camera.rotation;
        let again = one(&format!("rotation_wxyz = [{}, {}, {}, {}]\nfocal_px = 500", q.w, q.x, q.y, q.z)).unwrap();
        assert!(again.ego_from_camera.vector(DVec3::Z).distance(ahead) < 1e-9);
        assert_eq!(again.ego_from_camera.translation, DVec3::new(1.0, 2.0, 3.0));
        assert!((again.lens.fx_px - by_angles.lens.fx_px).abs() < 1e-9);
    }

    #[test]
    fn a_field_of_view_reaches_to_the_edges_of_the_picture_with_every_lens() {
        for (model, fov_deg) in [("pinhole", 80.0f64), ("kannala-brandt", 190.0), ("equirectangular", 300.0)] {
            let lens = one(&format!("yaw_deg = 0\nhorizontal_fov_deg = {fov_deg}\nmodel = \"{model}\"")).unwrap().lens;
            let half = (fov_deg / 2.0).to_radians();
            let edge = lens.project(DVec3::new(half.sin(), 0.0, half.cos())).unwrap();
            assert!(edge.distance(DVec2::new(1000.0, 250.0)) < 1e-6, "{model}: {edge}");
        }
    }

    #[test]
    fn what_makes_no_camera_is_told_with_its_place() {
        for (keys, expect) in [
            ("yaw_deg = 0", "horizontal_fov_deg or focal_px"),
            ("yaw_deg = 0\nfocal_px = 0", "focal_px"),
            ("yaw_deg = 0\nfocal_px = nan", "focal_px"),
            ("yaw_deg = 0\nhorizontal_fov_deg = 180", "horizontal_fov_deg"),
            ("focal_px = 500", "rotation_wxyz"),
            ("focal_px = 500\nyaw_deg = 0\nrotation_wxyz = [1, 0, 0, 0]", "rotation_wxyz"),
            ("focal_px = 500\nrotation_wxyz = [1, 1, 0, 0]", "length 1"),
            ("focal_px = 500\nyaw_deg = inf", "yaw_deg"),
            ("focal_px = 500\nyaw_deg = 0\ndistortion = [0.1]", "distortion"),
            ("focal_px = 500\nyaw_deg = 0\nmodel = \"fisheye\"", "kannala-brandt"),
            ("focal_px = 500\nyaw_deg = 0\nfocl_px = 3", "unknown field `focl_px`"),
        ] {
            let error = one(keys).unwrap_err();
            assert!(error.contains(expect), "{keys}: {error}");
        }
        let camera = "[[camera]]\nsize_px = [9, 9]\nposition_m = [0, 0, 1]\nyaw_deg = 0\nfocal_px = 9\n";
        let named = |name: &str| format!("{camera}name = \"{name}\"\n");
        for (text, expect) in [
            (String::new(), "1 to 64 cameras"),
            (named("A") + &named("A"), "two that are named \"A\""),
            (named("../A"), "name"),
            (named("A").replace("[9, 9]", "[0, 9]"), "size_px"),
            (named("A").replace("[0, 0, 1]", "[0, 0, 1e9]"), "position_m"),
        ] {
            let fault = parse(&text).unwrap_err();
            let told = format!("{}: {}, {}", fault.place, fault.expected, fault.found);
            assert!(told.contains(expect), "{told}");
        }
    }
}
