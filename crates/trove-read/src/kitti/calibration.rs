//! Calibration files: a key, a colon (which some of tracking's lack) and numbers a line.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::{DMat3, DQuat, DVec2, DVec3};
use trove_model::{Camera, Distortion, Frame, Lens, Pose, SensorFrame};

use super::text;
use crate::ReadError;

/// No sensor is mounted farther from another, metres.
const FARTHEST_M: f64 = 100.0;
/// No image has a longer side, pixels.
const LARGEST_IMAGE_PX: f64 = 65_535.0;
/// KITTI's pixels have their centres at whole numbers.
const PIXEL_CENTRE: f64 = 0.5;

/// A file's lines by their keys; where a key comes twice the first counts.
pub(super) struct Calibration {
    path: PathBuf,
    lines: BTreeMap<String, Vec<f64>>,
}

/// A rectified or original camera.
pub(super) struct CameraModel {
    pub(super) lens: Lens,
    /// From the frame that the file mounts it in: rectified camera 0, or camera 0 as it is.
    pub(super) reference_from_camera: Pose<Camera, Camera>,
}

impl Calibration {
    /// Reads a file; lines that are not numbers, such as its date, are passed over.
    pub(super) fn read(path: &Path) -> Result<Self, ReadError> {
        let mut lines = BTreeMap::new();
        for line in text::read(path)?.lines() {
            let Some((key, values)) = line.trim().split_once([':', ' ']) else { continue };
            if let Some(values) = text::numbers(values).filter(|values| !values.is_empty()) {
                lines.entry(key.to_owned()).or_insert(values);
            }
        }
        Ok(Self { path: path.to_owned(), lines })
    }

    /// Whether the file has a key.
    pub(super) fn has(&self, key: &str) -> bool {
        self.lines.contains_key(key)
    }

    /// The numbers of the first of some keys that is there, which must be so many.
    fn values<const N: usize>(&self, keys: &[&str]) -> Result<[f64; N], ReadError> {
        let found = keys.iter().find_map(|key| self.lines.get(*key));
        let expected = || format!("{N} numbers at {}", keys.join(" or "));
        let values = found.ok_or_else(|| text::damaged(&self.path, keys[0], &expected(), "no such line of numbers"))?;
        let count = || text::damaged(&self.path, keys[0], &expected(), format!("{} numbers", values.len()));
        values.as_slice().try_into().map_err(|_| count())
    }

    /// The rotation of nine numbers, row by row.
    pub(super) fn rotation<Dst: Frame, Src: Frame>(&self, keys: &[&str]) -> Result<Pose<Dst, Src>, ReadError> {
        self.rigid(keys, self.values::<9>(keys)?, DVec3::ZERO)
    }

    /// The rigid motion of twelve numbers: three rows of a rotation's three and a translation's one.
    pub(super) fn motion<Dst: Frame, Src: Frame>(&self, keys: &[&str]) -> Result<Pose<Dst, Src>, ReadError> {
        let [a, b, c, x, d, e, f, y, g, h, i, z] = self.values::<12>(keys)?;
        self.rigid(keys, [a, b, c, d, e, f, g, h, i], DVec3::new(x, y, z))
    }

    /// The rigid motion of a rotation and a translation on lines of their own.
    pub(super) fn split_motion<Dst: Frame, Src: Frame>(&self, r: &str, t: &str) -> Result<Pose<Dst, Src>, ReadError> {
        self.rigid(&[r], self.values::<9>(&[r])?, DVec3::from_array(self.values::<3>(&[t])?))
    }

    fn rigid<Dst: Frame, Src: Frame>(
        &self,
        keys: &[&str],
        rows: [f64; 9],
        translation: DVec3,
    ) -> Result<Pose<Dst, Src>, ReadError> {
        let matrix = DMat3::from_cols_array(&rows).transpose();
        let is_rotation =
            (matrix * matrix.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-2) && matrix.determinant() > 0.0;
        if !is_rotation {
            return Err(text::damaged(&self.path, keys[0], "a rotation", "a matrix that is none"));
        }
        if translation.abs().max_element() > FARTHEST_M {
            let found = format!("{:.0} m", translation.length());
            return Err(text::damaged(&self.path, keys[0], "a sensor on the car", found));
        }
        Ok(Pose::new(DQuat::from_mat3(&matrix), translation))
    }

    /// A rectified camera from its 3 × 4 projection, whose fourth column is its place beside camera 0. Without a size the
    /// lens has none yet.
    pub(super) fn rectified(&self, key: &str, size_px: [u32; 2]) -> Result<CameraModel, ReadError> {
        let [fx, _, cx, px, _, fy, cy, py, _, _, _, pz] = self.values::<12>(&[key])?;
        let lens = self.lens(key, [fx, fy, cx, cy], size_px, Distortion::None)?;
        let camera_from_reference = DVec3::new((px - cx * pz) / fx, (py - cy * pz) / fy, pz);
        if !camera_from_reference.is_finite() || camera_from_reference.abs().max_element() > FARTHEST_M {
            return Err(text::damaged(&self.path, key, "a camera on the car", format!("{camera_from_reference} m")));
        }
        Ok(CameraModel { lens, reference_from_camera: Pose::new(DQuat::IDENTITY, -camera_from_reference) })
    }

    /// A camera as it is, of a number (`02`).
    pub(super) fn original(&self, number: &str) -> Result<CameraModel, ReadError> {
        let key = |name: &str| format!("{name}_{number}");
        let [fx, _, cx, _, fy, cy, _, _, _] = self.values::<9>(&[&key("K")])?;
        let coefficients = self.values::<5>(&[&key("D")])?;
        let distortion = Distortion::brown_conrady(&coefficients).unwrap_or(Distortion::None);
        let size_px = self.size_px(&key("S"))?;
        let lens = self.lens(&key("K"), [fx, fy, cx, cy], size_px, distortion)?;
        let camera_from_reference: Pose<Camera, Camera> = self.split_motion(&key("R"), &key("T"))?;
        Ok(CameraModel { lens, reference_from_camera: camera_from_reference.inverse() })
    }

    /// Width and height of pictures.
    pub(super) fn size_px(&self, key: &str) -> Result<[u32; 2], ReadError> {
        let size = self.values::<2>(&[key])?;
        if size.iter().any(|side| !(1.0..=LARGEST_IMAGE_PX).contains(side)) {
            return Err(text::damaged(&self.path, key, "the size of an image", format!("{size:?}")));
        }
        Ok(size.map(|side| side as u32))
    }

    /// The focal length of a projection.
    pub(super) fn focal_px(&self, key: &str) -> Result<f64, ReadError> {
        Ok(self.values::<12>(&[key])?[0])
    }

    /// Twice the principal point of a projection: about the size of its pictures.
    pub(super) fn likely_size_px(&self, key: &str) -> Result<[u32; 2], ReadError> {
        let values = self.values::<12>(&[key])?;
        Ok([values[2], values[6]].map(|middle| (2.0 * middle).clamp(1.0, LARGEST_IMAGE_PX) as u32))
    }

    fn lens(&self, key: &str, k: [f64; 4], size_px: [u32; 2], distortion: Distortion) -> Result<Lens, ReadError> {
        let [fx_px, fy_px, cx_px, cy_px] = k;
        let is_focal = |f: f64| f > 0.0 && f < 1e6;
        if !(is_focal(fx_px) && is_focal(fy_px) && DVec2::new(cx_px, cy_px).abs().max_element() < 1e6) {
            return Err(text::damaged(&self.path, key, "a camera's intrinsics", format!("{k:?}")));
        }
        let [width_px, height_px] = size_px;
        let (cx_px, cy_px) = (cx_px + PIXEL_CENTRE, cy_px + PIXEL_CENTRE);
        Ok(Lens { width_px, height_px, fx_px, fy_px, cx_px, cy_px, distortion })
    }

    /// The Velodyne in a benchmark's rectified camera 0, by either of its names.
    pub(super) fn rectified_from_velodyne(&self) -> Result<Pose<Camera, SensorFrame>, ReadError> {
        let rectify: Pose<Camera, Camera> = self.rotation(&["R0_rect", "R_rect"])?;
        Ok(rectify * self.motion(&["Tr_velo_to_cam", "Tr_velo_cam"])?)
    }
}
