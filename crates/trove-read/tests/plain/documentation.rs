//! The documentation's example is a drive.

use std::path::Path;

use glam::{DVec2, DVec3};
use trove_model::{DriveOrigin, Kind, Report};

use super::{put, read};

/// The first JSON in docs/plain-drive.md.
pub(crate) fn example() -> String {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/plain-drive.md");
    let text = std::fs::read_to_string(page).unwrap();
    text.split("```json\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap().to_owned()
}

#[test]
fn the_example_is_a_drive_with_the_defaults_that_are_promised() {
    let (root, report) = (tempfile::tempdir().unwrap(), Report::default());
    put(root.path(), "first-try/drive.json", example());
    let drive = read(root.path(), &report).unwrap();
    assert_eq!(
        (drive.id.as_str(), drive.dataset.as_str(), drive.origin),
        ("first-try", "trove", DriveOrigin::Recorded)
    );
    assert!(drive.is_georeferenced);
    let (lat_deg, lon_deg) = drive.projection.geo_from_world(DVec2::new(-12.0, -5.0));
    let keyframe = &drive.keyframes[0];
    // World's origin is the first position, rounded.
    assert_eq!(keyframe.world_from_ego.translation, DVec3::ZERO);
    assert!((lat_deg - 49.0094).abs() < 1e-9 && (lon_deg - 8.4044).abs() < 1e-9, "{lat_deg} {lon_deg}");
    let lens = drive.rig[0].lens;
    assert_eq!((lens.fy_px, lens.cx_px, lens.cy_px), (1142.5, 800.0, 450.0));
    let looks_to = keyframe.exposures[0].world_from_camera().vector(DVec3::Z);
    assert!((looks_to.truncate().to_angle() - 0.3).abs() < 1e-12 && looks_to.z.abs() < 1e-12, "{looks_to}");
    let car = &keyframe.boxes[0];
    assert_eq!((car.kind, car.category.as_str(), car.velocity_mps), (Kind::Car, "car", None));
    let expected = keyframe.world_from_ego.point(DVec3::new(18.0, -1.5, 0.8));
    assert!(car.cuboid.world_from_body.translation.distance(expected) < 1e-12);
    assert!((car.cuboid.world_from_body.yaw_rad() - 0.3).abs() < 1e-12);
}
