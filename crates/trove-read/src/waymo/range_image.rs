//! Range images → points.

use std::f64::consts::PI;

use glam::{DAffine3, DMat3, DVec3, Vec3};
use trove_model::{Ego, SensorFrame};

use super::poses;
use super::records::{GlobalFromEgo, LaserRecord};

/// Nothing farther away returns, metres.
const FARTHEST_RETURN_M: f32 = 1000.0;

/// Numbers of an image, row by row and pixel by pixel.
pub(super) struct Grid {
    rows: usize,
    columns: usize,
    channels: usize,
    values: Vec<f32>,
}

impl Grid {
    /// `None` where the shape is not that of the values.
    pub(super) fn new(shape: &[i64], values: Vec<f32>) -> Option<Self> {
        let &[rows, columns, channels] = shape else { return None };
        let side = |n: i64| usize::try_from(n).ok();
        let (rows, columns, channels) = (side(rows)?, side(columns)?, side(channels)?);
        let count = rows.checked_mul(columns)?.checked_mul(channels)?;
        (count == values.len() && count > 0).then_some(Self { rows, columns, channels, values })
    }
}

/// What a LiDAR saw in one return, and what moved meanwhile.
pub(super) struct Scan<'a> {
    pub(super) laser: &'a LaserRecord,
    /// Range, intensity, elongation, whether in a zone without labels.
    pub(super) image: &'a Grid,
    /// Roll, pitch, yaw, x, y, z of the vehicle in the global frame at every pixel; `None` where the image is already of
    /// one moment.
    pub(super) poses: Option<&'a Grid>,
    pub(super) global_from_ego: &'a GlobalFromEgo,
}

impl Scan<'_> {
    /// Appends the points in the vehicle at the frame's pose; the error says what is wrong with the scan.
    pub(super) fn append_to(&self, points_ego: &mut Vec<Vec3>) -> Result<(), &'static str> {
        let Grid { rows, columns, channels, values } = self.image;
        let laser = poses::pose::<Ego, SensorFrame>(&self.laser.vehicle_from_laser)
            .ok_or("calibration without a valid pose")?
            .affine();
        let beams: Vec<_> = inclinations(self.laser, *rows)?.into_iter().map(f64::sin_cos).collect();
        let azimuths: Vec<_> = azimuths(&self.laser.vehicle_from_laser, *columns).map(f64::sin_cos).collect();
        if let Some(poses) = self.poses
            && (poses.rows, poses.columns, poses.channels) != (*rows, *columns, 6)
        {
            return Err("poses of another shape than the range image");
        }
        let ego_from_global = self.global_from_ego.inverse().affine();
        // A column is taken at one moment, so the pose of the pixel above is mostly this one's.
        let mut moved: Vec<([f32; 6], DAffine3)> = vec![([f32::NAN; 6], DAffine3::IDENTITY); *columns];
        for (i, pixel) in values.chunks_exact(*channels).enumerate() {
            let range_m = pixel[0];
            if !(range_m > 0.0 && range_m < FARTHEST_RETURN_M) {
                continue;
            }
            let ((sin_beam, cos_beam), column) = (beams[i / columns], i % columns);
            let (sin_azimuth, cos_azimuth) = azimuths[column];
            let direction = DVec3::new(cos_azimuth * cos_beam, sin_azimuth * cos_beam, sin_beam);
            let mut point = laser.transform_point3(direction * f64::from(range_m));
            if let Some(poses) = self.poses {
                let pose: &[f32; 6] = poses.values.as_chunks().0.get(i).ok_or("poses that end early")?;
                if moved[column].0 != *pose {
                    moved[column] = (*pose, ego_from_global * pixel_pose(pose));
                }
                point = moved[column].1.transform_point3(point);
            }
            if point.abs().max_element() < 2.0 * f64::from(FARTHEST_RETURN_M) {
                points_ego.push(point.as_vec3());
            }
        }
        Ok(())
    }
}

/// Of each row: the top one is the highest.
fn inclinations(laser: &LaserRecord, rows: usize) -> Result<Vec<f64>, &'static str> {
    let (low, high) = (laser.lowest_rad, laser.highest_rad);
    let mut inclinations = laser.inclinations_rad.clone();
    if inclinations.is_empty() {
        let even = |row: usize| low + (high - low) * (row as f64 + 0.5) / rows as f64;
        inclinations = (0..rows).map(even).collect();
    }
    if inclinations.len() != rows {
        return Err("another number of beams than its calibration");
    }
    if !inclinations.iter().all(|angle| angle.abs() <= PI) {
        return Err("calibration without usable inclinations");
    }
    inclinations.reverse();
    Ok(inclinations)
}

/// Of each column, from the left to the right as seen from above: from behind over the left to behind again, in the
/// vehicle's axes but for the tilt of the mounting.
fn azimuths(vehicle_from_laser: &[f64; 16], columns: usize) -> impl Iterator<Item = f64> {
    let yaw_rad = vehicle_from_laser[4].atan2(vehicle_from_laser[0]);
    (0..columns).map(move |column| {
        let share = (columns - column) as f64 - 0.5;
        (share / columns as f64 * 2.0 - 1.0) * PI - yaw_rad
    })
}

/// Yaw, pitch and roll about z, y and x, one after the other.
fn pixel_pose(&[roll, pitch, yaw, x, y, z]: &[f32; 6]) -> DAffine3 {
    let rotation = DMat3::from_rotation_z(f64::from(yaw))
        * DMat3::from_rotation_y(f64::from(pitch))
        * DMat3::from_rotation_x(f64::from(roll));
    DAffine3::from_mat3_translation(rotation, Vec3::new(x, y, z).as_dvec3())
}

/// Where a LiDAR stands.
pub(super) fn origin_ego(laser: &LaserRecord) -> Option<DVec3> {
    Some(poses::pose::<Ego, SensorFrame>(&laser.vehicle_from_laser)?.translation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_model::{Pose, World};

    fn laser(yaw_rad: f64) -> LaserRecord {
        let (sin, cos) = yaw_rad.sin_cos();
        LaserRecord {
            inclinations_rad: vec![-0.2, 0.1],
            lowest_rad: -0.3,
            highest_rad: 0.2,
            vehicle_from_laser: [cos, -sin, 0.0, 1.0, sin, cos, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 1.0],
        }
    }

    fn points(laser: &LaserRecord, ranges: [f32; 8], poses: Option<&Grid>) -> Result<Vec<Vec3>, &'static str> {
        let image = Grid::new(&[2, 4, 1], ranges.to_vec()).unwrap();
        let (mut points, global_from_ego) = (Vec::new(), Pose::<World, Ego>::IDENTITY);
        Scan { laser, image: &image, poses, global_from_ego: &global_from_ego }.append_to(&mut points)?;
        Ok(points)
    }

    #[test]
    fn the_top_row_is_the_highest_beam_and_the_columns_turn_clockwise() {
        // However the LiDAR is turned on its mounting, the columns look 135°, 45°, −45°, −135° from the vehicle's front.
        for yaw_rad in [0.0, 1.0, -2.5] {
            let seen = points(&laser(yaw_rad), [10.0, 0.0, 0.0, 0.0, 0.0, 0.0, 10.0, 0.0], None).unwrap();
            let flat = 10.0 * 0.5f64.sqrt();
            let expected = [
                DVec3::new(1.0 - flat * 0.1f64.cos(), flat * 0.1f64.cos(), 2.0 + 10.0 * 0.1f64.sin()),
                DVec3::new(1.0 + flat * 0.2f64.cos(), -flat * 0.2f64.cos(), 2.0 - 10.0 * 0.2f64.sin()),
            ];
            assert_eq!(seen.len(), 2);
            for (seen, expected) in seen.iter().zip(expected) {
                assert!(seen.as_dvec3().distance(expected) < 1e-5, "{seen} {expected}");
            }
        }
    }

    #[test]
    fn evenly_spaced_beams_look_along_the_middles_of_their_rows() {
        let even = LaserRecord { inclinations_rad: Vec::new(), ..laser(0.0) };
        let angles = inclinations(&even, 2).unwrap();
        assert!((angles[0] - 0.075).abs() < 1e-12 && (angles[1] + 0.175).abs() < 1e-12);
    }

    #[test]
    fn each_pixel_is_seen_from_where_the_vehicle_was() {
        let mut values = vec![0.0; 48];
        values[..6].copy_from_slice(&[0.0, 0.0, std::f32::consts::FRAC_PI_2, 100.0, 50.0, 0.0]);
        let poses = Grid::new(&[2, 4, 6], values).unwrap();
        let flat = laser(0.0);
        let still = points(&flat, [10.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], None).unwrap()[0];
        let moved = points(&flat, [10.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], Some(&poses)).unwrap()[0];
        assert!((moved - Vec3::new(100.0 - still.y, 50.0 + still.x, still.z)).length() < 1e-4, "{moved} {still}");
    }

    #[test]
    fn what_does_not_fit_together_is_refused() {
        let one = [10.0; 8];
        assert!(points(&LaserRecord { inclinations_rad: vec![0.0; 3], ..laser(0.0) }, one, None).is_err());
        assert!(points(&LaserRecord { inclinations_rad: vec![f64::NAN; 2], ..laser(0.0) }, one, None).is_err());
        assert!(points(&LaserRecord { vehicle_from_laser: [0.0; 16], ..laser(0.0) }, one, None).is_err());
        assert!(points(&laser(0.0), one, Grid::new(&[1, 4, 6], vec![0.0; 24]).as_ref()).is_err());
        assert!(
            points(&laser(0.0), [f32::NAN, f32::INFINITY, -1.0, 1e9, 0.0, 0.0, 0.0, 0.0], None).unwrap().is_empty()
        );
        for shape in [&[2, 4][..], &[2, 4, 2], &[-1, 4, 1], &[i64::MAX, i64::MAX, 1], &[0, 4, 1]] {
            assert!(Grid::new(shape, vec![0.0; 8]).is_none(), "{shape:?}");
        }
    }
}
