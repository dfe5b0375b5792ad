//! One camera of a rig's file.

use std::f64::consts::TAU;

use glam::{DMat3, DQuat, DVec3};
use serde::Deserialize;
use trove_files::PathComponent;
use trove_model::{Camera, Distortion, Ego, Lens, Pose, RigCamera};

/// Larger pictures and farther cameras are mistakes, pixels and metres.
const LARGEST_PX: u32 = 16_384;
const FARTHEST_M: f64 = 100.0;
/// How far a quaternion's length may be from 1.
const ROUNDING: f64 = 0.01;

/// `[[camera]]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraRow {
    pub name: String,
    size_px: [u32; 2],
    /// In Ego: x forward, y left, z up from the ground below the rear axle.
    position_m: [f64; 3],
    /// Ego from Camera (x right, y down, z forward) …
    rotation_wxyz: Option<[f64; 4]>,
    /// … or where it looks: to the left of straight ahead,
    yaw_deg: Option<f64>,
    /// up,
    pitch_deg: Option<f64>,
    /// and how far it leans to its right.
    roll_deg: Option<f64>,
    /// Along x and y.
    focal_px: Option<Focal>,
    /// In place of it, what is seen along the row through the middle.
    horizontal_fov_deg: Option<f64>,
    /// Without it the picture's middle.
    centre_px: Option<[f64; 2]>,
    #[serde(default)]
    model: Model,
    #[serde(default)]
    distortion: Vec<f64>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged)]
enum Focal {
    Both(f64),
    Each([f64; 2]),
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Model {
    #[default]
    Pinhole,
    BrownConrady,
    KannalaBrandt,
    Equirectangular,
}

/// The key at fault, what was expected, and what was found.
type Fault = (&'static str, &'static str, String);

impl CameraRow {
    pub(super) fn camera(&self) -> Result<RigCamera, Fault> {
        PathComponent::new(&self.name).map_err(|error| ("name", "a name that a folder can have", error.to_string()))?;
        if !self.size_px.iter().all(|side| (1..=LARGEST_PX).contains(side)) {
            return Err(("size_px", "two numbers of 1 to 16384", format!("{:?}", self.size_px)));
        }
        let position_m = DVec3::from_array(self.position_m);
        if !(position_m.abs().max_element() <= FARTHEST_M && position_m.is_finite()) {
            return Err(("position_m", "three numbers of at most 100", format!("{:?}", self.position_m)));
        }
        let ego_from_camera = Pose::<Ego, Camera>::new(self.rotation()?, position_m);
        Ok(RigCamera { name: self.name.clone(), lens: self.lens()?, ego_from_camera })
    }

    fn rotation(&self) -> Result<DQuat, Fault> {
        let angles = [("yaw_deg", self.yaw_deg), ("pitch_deg", self.pitch_deg), ("roll_deg", self.roll_deg)];
        let has_angles = angles.iter().any(|(_, deg)| deg.is_some());
        if let Some([w, x, y, z]) = self.rotation_wxyz {
            let rotation = DQuat::from_xyzw(x, y, z, w);
            if has_angles {
                let found = "both".into();
                return Err(("rotation_wxyz", "it, or yaw_deg, pitch_deg and roll_deg", found));
            }
            if (rotation.length() - 1.0).abs() >= ROUNDING || !rotation.is_finite() {
                return Err(("rotation_wxyz", "a quaternion of length 1", format!("length {}", rotation.length())));
            }
            return Ok(rotation.normalize());
        }
        if !has_angles {
            return Err(("rotation_wxyz", "it, or yaw_deg with pitch_deg and roll_deg", "neither".into()));
        }
        for (key, deg) in angles {
            if deg.is_some_and(|deg| !(-360.0..=360.0).contains(&deg)) {
                return Err((key, "-360 to 360", format!("{}", deg.unwrap_or_default())));
            }
        }
        let [yaw, pitch, roll] = angles.map(|(_, deg)| deg.unwrap_or(0.0).to_radians());
        let ahead = DQuat::from_mat3(&DMat3::from_cols(-DVec3::Y, -DVec3::Z, DVec3::X));
        Ok(DQuat::from_rotation_z(yaw) * DQuat::from_rotation_y(-pitch) * DQuat::from_rotation_x(roll) * ahead)
    }

    fn lens(&self) -> Result<Lens, Fault> {
        let given = &self.distortion;
        let distortion = match self.model {
            Model::Pinhole => given.is_empty().then_some(Distortion::None),
            Model::BrownConrady => Distortion::brown_conrady(given),
            Model::KannalaBrandt => Distortion::kannala_brandt(given),
            Model::Equirectangular => given.is_empty().then_some(Distortion::Equirectangular),
        };
        let expected =
            "none for pinhole and equirectangular, up to 8 finite numbers for brown-conrady, 4 for kannala-brandt";
        let distortion = distortion.ok_or_else(|| ("distortion", expected, format!("{given:?}")))?;
        let [width_px, height_px] = self.size_px;
        let middle_px = [f64::from(width_px) / 2.0, f64::from(height_px) / 2.0];
        let [cx_px, cy_px] = self.centre_px.unwrap_or(middle_px);
        if !(cx_px.abs() <= f64::from(LARGEST_PX) && cy_px.abs() <= f64::from(LARGEST_PX)) {
            return Err(("centre_px", "two numbers of at most 16384", format!("{:?}", [cx_px, cy_px])));
        }
        let unit = Lens { width_px, height_px, fx_px: 1.0, fy_px: 1.0, cx_px: 0.0, cy_px: 0.0, distortion };
        let [fx_px, fy_px] = match (self.focal_px, self.horizontal_fov_deg) {
            (Some(Focal::Both(f)), None) => [f, f],
            (Some(Focal::Each(each)), None) => each,
            (None, Some(fov_deg)) => {
                let half = fov_deg.to_radians() / 2.0;
                // What a focal length of one pixel makes of half of it.
                let edge = Some(half).filter(|half| *half > 0.0 && *half <= TAU / 2.0);
                let reach = edge.and_then(|half| unit.project(DVec3::new(half.sin(), 0.0, half.cos())));
                let Some(reach) = reach.filter(|reach| reach.x > 0.0) else {
                    let expected =
                        "more than 0, and as much as the lens model can see (less than 180 without a fisheye)";
                    return Err(("horizontal_fov_deg", expected, fov_deg.to_string()));
                };
                [middle_px[0] / reach.x; 2]
            }
            (focal, _) => {
                let found = if focal.is_some() { "both" } else { "neither" };
                return Err(("focal_px", "horizontal_fov_deg or focal_px", found.into()));
            }
        };
        if ![fx_px, fy_px].iter().all(|f| *f >= 1.0 && *f <= 1e6) {
            return Err(("focal_px", "1 to 1000000", format!("{:?}", [fx_px, fy_px])));
        }
        Ok(Lens { fx_px, fy_px, cx_px, cy_px, ..unit })
    }
}
