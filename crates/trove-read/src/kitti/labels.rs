//! `label_2` and `label_02`: a line an object, in the rectified camera 0.

use glam::{DMat3, DQuat, DVec3};
use trove_model::{Body, Camera, Pose};

use super::text;

/// Nothing that is annotated is longer, metres.
const LONGEST_BOX_M: f64 = 200.0;
/// Nor farther away.
const FARTHEST_M: f64 = 1000.0;

/// One line.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Line {
    Object(Label),
    /// A region of the picture with objects that nobody annotated.
    DontCare,
}

/// One annotated object.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Label {
    pub(super) category: String,
    /// The words for truncation and occlusion, as the file has them.
    pub(super) truncation: String,
    pub(super) occlusion: String,
    pub(super) size_m: DVec3,
    pub(super) rectified_from_body: Pose<Camera, Body>,
}

/// An object's line from its class on; the error says what is wrong with it.
pub(super) fn line(words: &[&str]) -> Result<Line, &'static str> {
    let [category, truncation, occlusion, rest @ ..] = words else { return Err("fewer than 15 columns") };
    if *category == "DontCare" {
        return Ok(Line::DontCare);
    }
    // A detector's lines have a score at the end.
    if !(12..=13).contains(&rest.len()) {
        return Err("not 15 columns");
    }
    let numbers = rest.iter().map(|word| text::number(word)).collect::<Option<Vec<f64>>>();
    let numbers = numbers.ok_or("a column that is not a number")?;
    let [height, width, length, x, y, z, yaw_rad] = numbers[5..12] else { return Err("not 15 columns") };
    let size_m = DVec3::new(length, width, height);
    if size_m.min_element() <= 0.0 {
        return Err("box of zero or negative size");
    }
    if size_m.max_element() > LONGEST_BOX_M {
        return Err("box longer than 200 m");
    }
    let bottom_camera = DVec3::new(x, y, z);
    if bottom_camera.abs().max_element() > FARTHEST_M || yaw_rad.abs() > FARTHEST_M {
        return Err("box without a valid pose");
    }
    Ok(Line::Object(Label {
        category: (*category).to_owned(),
        truncation: (*truncation).to_owned(),
        occlusion: (*occlusion).to_owned(),
        size_m,
        rectified_from_body: pose(bottom_camera, yaw_rad, height),
    }))
}

/// A box from the middle of its bottom and its turn about the camera's y axis, which points down; at 0 it faces along x.
fn pose(bottom_camera: DVec3, yaw_rad: f64, height_m: f64) -> Pose<Camera, Body> {
    let (sin, cos) = yaw_rad.sin_cos();
    let axes = DMat3::from_cols(DVec3::new(cos, 0.0, -sin), DVec3::new(sin, 0.0, cos), -DVec3::Y);
    Pose::new(DQuat::from_mat3(&axes), bottom_camera - DVec3::Y * height_m / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Line, &'static str> {
        line(&text.split_whitespace().collect::<Vec<_>>())
    }

    #[test]
    fn a_line_is_a_box_on_its_bottom_s_middle() {
        let text = "Car 0.25 1 1.85 387.63 181.54 423.81 203.12 1.67 1.87 3.69 -16.53 2.39 58.49 1.5707963267948966";
        let Ok(Line::Object(label)) = read(text) else { panic!("no object") };
        assert_eq!(
            (label.category.as_str(), label.truncation.as_str(), label.occlusion.as_str()),
            ("Car", "0.25", "1")
        );
        assert_eq!(label.size_m, DVec3::new(3.69, 1.87, 1.67));
        let pose = label.rectified_from_body;
        assert!(pose.translation.distance(DVec3::new(-16.53, 2.39 - 1.67 / 2.0, 58.49)) < 1e-12);
        // A quarter turn faces the camera, and its left is then to the right.
        assert!(pose.vector(DVec3::X).distance(-DVec3::Z) < 1e-9);
        assert!(pose.vector(DVec3::Y).distance(DVec3::X) < 1e-9);
        assert!(pose.vector(DVec3::Z).distance(-DVec3::Y) < 1e-9);
        assert_eq!(read(&format!("{text} 0.9")).as_ref().ok(), read(text).as_ref().ok());
    }

    #[test]
    fn a_line_that_is_no_box_says_why() {
        let wrong = |text| read(text).unwrap_err();
        assert_eq!(wrong("Car 0"), "fewer than 15 columns");
        assert_eq!(wrong("Car 0 0 1 2 3"), "not 15 columns");
        assert_eq!(wrong("Car 0 0 1 2 3 4 5 1 1 nan 0 0 9 0"), "a column that is not a number");
        assert_eq!(wrong("Car 0 0 1 2 3 4 5 1 0 1 0 0 9 0"), "box of zero or negative size");
        assert_eq!(wrong("Car 0 0 1 2 3 4 5 1 1 201 0 0 9 0"), "box longer than 200 m");
        assert_eq!(wrong("Car 0 0 1 2 3 4 5 1 1 1 0 0 1e9 0"), "box without a valid pose");
        assert_eq!(read("DontCare -1 -1"), Ok(Line::DontCare));
    }
}
