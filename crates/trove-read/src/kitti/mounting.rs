//! Where the sensors are on the car.

use std::path::Path;

use glam::{DQuat, DVec3};
use trove_model::{Camera, Ego, Outcome, Pose, Report, RigCamera, SensorFrame};

use super::calibration::Calibration;
use super::facts::FACTS;
use crate::ReadError;

/// Cameras, in the order of their numbers.
const NUMBERS: [&str; 4] = ["00", "01", "02", "03"];

/// The sensors of a recording.
pub(super) struct Mounting {
    pub(super) rig: Vec<RigCamera>,
    pub(super) ego_from_imu: Pose<Ego, SensorFrame>,
    pub(super) ego_from_velodyne: Pose<Ego, SensorFrame>,
    /// Of labels that are in the rectified camera 0.
    pub(super) ego_from_rectified: Pose<Ego, Camera>,
}

/// Where a calibration's IMU and Velodyne are in Ego, which stands below the IMU and is in the middle, as the Velodyne.
fn ego_frames(velodyne_from_imu: Pose<SensorFrame, SensorFrame>) -> (Pose<Ego, SensorFrame>, Pose<Ego, SensorFrame>) {
    let imu_from_velodyne = velodyne_from_imu.inverse();
    let imu_ego = DVec3::new(0.0, -imu_from_velodyne.translation.y, FACTS.imu_height_m());
    let ego_from_imu = Pose::new(DQuat::IDENTITY, imu_ego);
    (ego_from_imu, ego_from_imu * imu_from_velodyne)
}

/// `image_00` … `image_03`.
pub(super) fn camera_name(number: &str) -> String {
    format!("image_{number}")
}

impl Mounting {
    /// Of a recording day's three files; rectified where the pictures are.
    pub(super) fn of_day(day: &Path, is_rectified: bool) -> Result<Self, ReadError> {
        let [cameras, velodyne, imu] = files_of_day(day).map(|path| Calibration::read(&path));
        let (cameras, velodyne, imu) = (cameras?, velodyne?, imu?);
        let (ego_from_imu, ego_from_velodyne) = ego_frames(imu.split_motion("R", "T")?);
        let camera_from_velodyne: Pose<Camera, SensorFrame> = velodyne.split_motion("R", "T")?;
        let rectify: Pose<Camera, Camera> = cameras.rotation(&["R_rect_00"])?;
        let ego_from_camera = ego_from_velodyne * camera_from_velodyne.inverse();
        let ego_from_rectified = ego_from_camera * rectify.inverse();
        let mut rig = Vec::new();
        for number in NUMBERS.into_iter().filter(|number| cameras.has(&format!("P_rect_{number}"))) {
            let (model, ego_from_reference) = if is_rectified {
                let size_px = cameras.size_px(&format!("S_rect_{number}"))?;
                (cameras.rectified(&format!("P_rect_{number}"), size_px)?, ego_from_rectified)
            } else {
                (cameras.original(number)?, ego_from_camera)
            };
            rig.push(RigCamera {
                name: camera_name(number),
                lens: model.lens,
                ego_from_camera: ego_from_reference * model.reference_from_camera,
            });
        }
        Ok(Self { rig, ego_from_imu, ego_from_velodyne, ego_from_rectified })
    }

    /// Of a benchmark's file; `size_px` finds the size of a camera's pictures (`image_02`).
    pub(super) fn of_benchmark(
        path: &Path,
        size_px: impl Fn(&str) -> Option<[u32; 2]>,
        report: &Report,
    ) -> Result<Self, ReadError> {
        let file = Calibration::read(path)?;
        let (ego_from_imu, ego_from_velodyne) = ego_frames(file.motion(&["Tr_imu_to_velo", "Tr_imu_velo"])?);
        let ego_from_rectified = ego_from_velodyne * file.rectified_from_velodyne()?.inverse();
        let mut rig = Vec::new();
        for number in NUMBERS {
            let key = format!("P{}", &number[1..]);
            if !file.has(&key) {
                continue;
            }
            let name = camera_name(number);
            let size_px = match size_px(&name) {
                Some(size_px) => size_px,
                None => {
                    report.note(Outcome::Guessed, "size of KITTI pictures that are not there, from the lens", &name);
                    FACTS.picture_size_px(file.focal_px(&key)?).map_or_else(|| file.likely_size_px(&key), Ok)?
                }
            };
            let model = file.rectified(&key, size_px)?;
            let ego_from_camera = ego_from_rectified * model.reference_from_camera;
            rig.push(RigCamera { name, lens: model.lens, ego_from_camera });
        }
        Ok(Self { rig, ego_from_imu, ego_from_velodyne, ego_from_rectified })
    }
}

/// A recording day's calibrations: of the cameras, the Velodyne and the IMU.
pub(super) fn files_of_day(day: &Path) -> [std::path::PathBuf; 3] {
    ["calib_cam_to_cam.txt", "calib_velo_to_cam.txt", "calib_imu_to_velo.txt"].map(|name| day.join(name))
}
